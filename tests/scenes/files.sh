#!/bin/bash
# Files as users have them: byte order marks, folders in the place of files, caches that are cut off, folders that another run uses, long
# paths, ranks without grains.
# SLOW
. "$SCENES/functions"
scene_from tiny </dev/null

# byte order marks, in a scene, in what it includes and in a table; UTF-16
mkdir marked
{ printf '\357\273\277'; sed 's/five-grains.csv/marked.csv/' "$SCENES/data/tiny.prm"; } >marked/inner.prm
printf '\357\273\277include inner.prm\n' >marked/outer.prm
mkdir marked/data
{ printf '\357\273\277'; cat "$SCENES/data/five-grains.csv"; } >marked/data/marked.csv
must_run 1 marked/outer.prm
must_run 1 tiny.prm --set 'Output/Output folder=plain'
must_agree output/statistics.csv plain/statistics.csv --tolerance 0
iconv -t UTF-16 tiny.prm >utf16.prm
must_fail "'utf16.prm' is saved as UTF-16" 1 utf16.prm

# folders in the place of files
mkdir -p folder
must_fail "'folder' is a folder" 1 folder
must_fail "folder' is a folder" 1 --check tiny.prm --set 'Grains/Deposit: file/File=folder'
must_fail "folder'? cannot be read" 1 --check tiny.prm --set 'Domain/Mesh file=folder'

# a cache that is cut off
bed=(--set 'Grains/Deposit=settled bed' --set 'Grains/Deposit: settled bed/Number of grains=40')
must_run 1 tiny.prm "${bed[@]}" --set 'Output/Output folder=bed'
cache=$(ls deposits/*.csv)
cp "$cache" whole
head -n 20 whole >"$cache"
must_run 1 --check tiny.prm "${bed[@]}" --set 'Output/Output folder=bed-2'
grep -q "40 discs" screen-output || fail "it believes a cache that is cut off"
grep -q "warning: The settled bed in '.*' is cut off" error-output || fail "it does not say that the cache is cut off"
[ "$(wc -l <"$cache")" -eq 20 ] || fail "--check writes the cache"
must_run 1 tiny.prm "${bed[@]}" --set 'Output/Output folder=bed-2'
cmp "$cache" whole || fail "the cache is not mended"

# two runs in one folder; and what one that was killed leaves behind
"$ALLUVIUM" tiny.prm --set 'Time/End time=1000' --set 'Output/Output folder=used' >first 2>&1 </dev/null &
pid=$!
for ((i = 0; i < 300; ++i)); do
  [ "$(wc -l 2>/dev/null <used/statistics.csv || echo 0)" -gt 4 ] && break
  sleep 0.1
done
for more in --check 'Output/Overwrite output folder=true' 'Output/Restart=true'; do
  [ "$more" = --check ] && options=(--check) || options=(--set "$more")
  must_fail "output folder 'used' is in use by another run \(process $pid on " 1 tiny.prm "${options[@]}" \
    --set 'Output/Output folder=used'
done
kill -KILL $pid
wait $pid 2>/dev/null
[ -f used/statistics.csv ] || fail "another run has removed the files of one that goes on"
must_run 1 tiny.prm --set 'Output/Output folder=used' --set 'Output/Overwrite output folder=true'
[ ! -e used/in-use ] || fail "the lock is not taken away"

# --check finds what a run would, and says what would be in its way
must_fail "cannot be made: there is no folder" 1 --check tiny.prm --set 'Output/Output folder=none/output'
must_fail "there is no output folder 'none'" 1 --check tiny.prm --set 'Output/Restart=true' --set 'Output/Output folder=none'
must_run 1 --check tiny.prm --set 'Output/Output folder=used'
grep -q "warning: a run would be refused: the output folder 'used' holds an older run" error-output ||
  fail "--check does not see the older run"
must_run 1 --check tiny.prm --set 'Output/Output folder=used' --set 'Output/Restart=true' --set 'Time/End time=3e-3'
grep -q "Continues from t = 0.002 s" screen-output || fail "--check does not look at the checkpoint"

# long paths: pictures of both kinds, checkpoints of a mesh that changes, a restart
long=$PWD/$(printf 'x%.0s' $(seq 200))
mkdir "$long"
adaptive=(--set 'Mesh refinement/Criteria=uniform, bed faces' --set 'Mesh refinement/Coarsest cell size=8'
  --set 'Mesh refinement/Interval=1')
for format in vtu hdf5; do
  folder=$long/$(printf 'y%.0s' $(seq 80))-$format
  must_run 1 tiny.prm "${adaptive[@]}" --set "Output/Output folder=$folder" --set "Output/Format=$format" \
    --set 'Output/Interval of pictures=1e-3' --set 'Output/Interval of checkpoints=1e-3'
  must_run 1 tiny.prm "${adaptive[@]}" --set "Output/Output folder=$folder" --set "Output/Format=$format" \
    --set 'Output/Interval of pictures=1e-3' --set 'Output/Restart=true' --set 'Time/End time=3e-3'
  for picture in fluid-00003 grains-00003; do
    [ -s "$folder/$picture.${format/hdf5/h5}" ] || fail "there is no $picture in a folder of a long name"
  done
done

# a rank without grains
printf 'x,y,radius\n0.002,0.003,1e-4\n' >one.csv
for model in volume-averaged none; do
  must_run 2 tiny.prm --set 'Grains/Deposit: file/File=one.csv' --set 'Output/Format=hdf5' --set "Fluid/Model=$model" \
    --set 'Output/Interval of pictures=1e-3' --set "Output/Output folder=one-$model"
  [ "$(grep -c "<Grid Name" one-$model/grains.xdmf)" -eq 4 ] || fail "a picture of the grains is missing"
  [ -s one-$model/grains-00002.h5 ] || fail "there is no picture of the grain"
done
must_run 2 tiny.prm --set 'Grains/Deposit: file/File=one.csv' --set 'Output/Interval of pictures=1e-3' \
  --set "Output/Output folder=one-vtu"
grep -q 'NumberOfPoints="1"' one-vtu/grains-00002.vtu || fail "the picture of one grain has no point"
