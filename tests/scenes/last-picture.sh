#!/bin/bash
# The end of a run is a picture, too, where it is no multiple of their interval; a run that goes on from there is as one that has not
# ended there.
. "$SCENES/functions"
scene_from tiny <<'END'
subsection Output
  set Interval of pictures = 1e-3
end
END
times() { # FOLDER EXPECTED: of all its lists
  for list in "$1"/*.pvd; do
    found=$(sed -n 's/.*timestep="\([^"]*\)".*/\1/p' "$list" | xargs)
    [ "$found" = "$2" ] || fail "$list has pictures of t = $found, not of $2"
    for file in $(sed -n 's/.*file="\([^"]*\)".*/\1/p' "$list"); do
      [ -s "$1/$file" ] || fail "there is no $file"
    done
  done
}
for ranks in 1 2; do
  must_run $ranks tiny.prm --set 'Time/End time=2.5e-3' --set "Output/Output folder=out-$ranks"
  times out-$ranks '0 0.001 0.002 0.0025'
done
must_run 1 tiny.prm --set 'Output/Output folder=multiple'
times multiple '0 0.001 0.002'
must_run 1 tiny.prm --set 'Output/Interval of pictures=0.01' --set 'Output/Output folder=long'
times long '0 0.002'
must_run 1 tiny.prm --set 'Output/Interval of pictures=0' --set 'Output/Output folder=none'
! ls none/*.pvd >/dev/null 2>&1 || fail "pictures that nobody wants"
must_run 1 tiny.prm --set 'Time/End time=4e-3' --set 'Output/Output folder=out-1' --set Output/Restart=true
times out-1 '0 0.001 0.002 0.0035 0.004'
