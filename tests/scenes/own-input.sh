#!/bin/bash
# A run never replaces what it reads: its parameter file, the run whose grains it starts with, whatever way their paths are written.
# SLOW
. "$SCENES/functions"
scene_from tiny </dev/null
must_run 1 tiny.prm --set 'Fluid/Model=none' --set 'Output/Output folder=dry'
ln -s dry link
contents dry >before
deposit=(--set 'Grains/Deposit=end of a run' --set 'Output/Overwrite output folder=true' --set 'Grains/Overlap tolerance=0.1')
for source in dry link ./dry "$PWD/dry" "../$(basename "$PWD")/dry"; do
  for target in dry link ./dry/ "$PWD/dry"; do
    for check in --check ''; do
      must_fail "output folder '.*' holds 'checkpoint', which this run reads" 1 tiny.prm "${deposit[@]}" \
        --set "Grains/Deposit: end of a run/Output folder=$source" --set "Output/Output folder=$target" $check
    done
    contents dry | cmp - before || fail "it changed its own source"
  done
done
must_run 1 tiny.prm "${deposit[@]}" --set 'Grains/Deposit: end of a run/Output folder=dry' --set 'Output/Output folder=wet'
contents dry | cmp - before || fail "it changed its source"
# a restart reads no deposit
must_run 1 tiny.prm "${deposit[@]}" --set 'Grains/Deposit: end of a run/Output folder=dry' --set 'Output/Output folder=wet' \
  --set Output/Restart=true --set 'Time/End time=0.1'

# the parameter file, or one that it includes
mkdir own && ln -s "$SCENES/data" own/data
cp tiny.prm own/parameters.prm
echo 'include own/parameters.prm' >outer.prm
ln own/parameters.prm hard.prm
cp own/parameters.prm mine
for scene in own/parameters.prm "$PWD/own/parameters.prm" outer.prm hard.prm; do
  must_fail "output folder '.*' holds 'parameters.prm', which this run reads" 1 "$scene" --set 'Output/Output folder=own' \
    --set 'Output/Overwrite output folder=true'
  cmp own/parameters.prm mine || fail "it replaced its own parameter file"
done
cd own
must_fail "output folder '.' holds 'parameters.prm', which this run reads" 1 parameters.prm --set 'Output/Output folder=.' \
  --set 'Output/Overwrite output folder=true'
cmp parameters.prm ../mine || fail "it replaced its own parameter file"

# tables that somebody has put beside a run stay
mv parameters.prm scene.prm
printf 'x,y,radius\n0.002,0.003,1e-4\n' >mine.csv
for n in 1 2; do
  must_run 1 scene.prm --set 'Output/Output folder=.' --set 'Output/Overwrite output folder=true' --set 'Grains/Deposit: file/File=mine.csv'
  [ -f mine.csv ] || fail "it removed a table of grains"
done
