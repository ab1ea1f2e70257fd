#!/bin/bash
# contrib/run from a scene to its pictures, a result that stands there replaced. (The program is built already.)
# SLOW
. "$SCENES/functions"
scene_from tiny <<'END_OF_SCENE'
subsection Output
  set Output folder = of-tiny
end
END_OF_SCENE
for _ in first second; do
  BUILD=$(dirname "$ALLUVIUM") "$SCENES/../../contrib/run" tiny.prm --set "Output/Interval of pictures=1e-3" >screen-output 2>error-output ||
    fail "exit code $? of contrib/run"
done
ls of-tiny/*.png >/dev/null || fail "no pictures"
BUILD=$(dirname "$ALLUVIUM") "$SCENES/../../contrib/run" tiny.prm --set "Output/Output folder=elsewhere" >screen-output 2>error-output ||
  fail "exit code $? with another folder"
[ -f elsewhere/summary.json ] || fail "not in the folder that was asked for"
