#!/bin/bash
# A checkpoint that is damaged, cut off or missing is refused with one message, and the folder stays as it was.
# SLOW
. "$SCENES/functions"
scene=tiny.prm
scene_from tiny </dev/null
restart=("$scene" --set Output/Restart=true --set 'Time/End time=4e-3')

must_fail "there is no output folder 'output' to restart from" 1 "${restart[@]}"
[ ! -e output ] || fail "it made an output folder"

must_run 1 "$scene"
rm -r output/checkpoint
must_fail "there is no checkpoint in 'output'" 1 "${restart[@]}"
rm -r output

must_run 1 "$scene" --set 'Output/Interval of checkpoints=2e-3'
cp -r output good
must_run 1 "${restart[@]}"

refused() { # REGEX RANKS, once output/checkpoint has been spoilt
  contents output >before
  must_fail "$1" "$2" "${restart[@]}"
  contents output | cmp - before || fail "it changed the folder of the run"
}

n=0
for file in $(cd good/checkpoint && find . -type f); do
  n=$((n + 1))
  rm -rf output && cp -r good output
  truncate -s -3 "output/checkpoint/$file"
  refused 'checkpoint' 1

  rm -rf output && cp -r good output
  # one byte in the last quarter
  size=$(stat -c %s "output/checkpoint/$file")
  at=$((size * 4 / 5))
  old=$(dd if="output/checkpoint/$file" bs=1 skip=$at count=1 status=none | od -An -tu1 | tr -d ' ')
  printf "\\x$(printf %02x $(((old + 1) % 256)))" | dd of="output/checkpoint/$file" bs=1 seek=$at conv=notrunc status=none
  refused 'checkpoint' $((1 + n % 2))

  rm -rf output && cp -r good output
  rm "output/checkpoint/$file"
  refused 'checkpoint' 1
done
[ $n -ge 4 ] || fail "a checkpoint has only $n files?"
