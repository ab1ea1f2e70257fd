#!/bin/bash
# A run in two parts is the run in one, which writes no checkpoint: 20 steps at once against 10, a checkpoint, and 10 more. On the
# number of ranks that wrote the checkpoint not one of 17 digits may differ, nor summary.json but for its timings. On other ranks
# round-off differs, which moving contacts amplify: there a bed at rest, with tight tolerances.
# SLOW
. "$SCENES/functions"

# two_parts RANKS: whole/ with ${common} options, half/ with ${common} and ${every}, continued on RANKS.
two_parts() {
  rm -rf whole half
  must_run 1 bed.prm "${common[@]}" --set 'Output/Output folder=whole'
  must_run 1 bed.prm "${common[@]}" "${every[@]}" --set 'Output/Output folder=half' --set 'Time/End time=0.01'
  [ -d half/checkpoint ] || fail "no checkpoint"
  [ $kind != dry ] || mv half/checkpoint half/checkpoint.before # as if killed while a new one took its place
  cp half/statistics.csv first-half.csv
  must_run "$1" bed.prm "${common[@]}" "${every[@]}" --set 'Output/Output folder=half' --set 'Output/Restart=true'
  [ "$(wc -l <half/statistics.csv)" -eq 22 ] || fail "expected a header and 21 rows"
  head -n 12 half/statistics.csv | cmp - first-half.csv || fail "the first half has changed"
  grep -q 'Continues from t = 0.01 s, step 10' screen-output || fail "it does not say where it goes on from"
  grep -q 'changed: Time/End time: 0.01 -> 0.02' screen-output || fail "it does not say what has changed"
}

as_it_comes=(--set 'Contacts/Residual tolerance=1e-5' --set 'Contacts/Largest violation=1e-3' --set 'Contacts/Stagnation tolerance factor=10'
             --set 'Fluid/Linear solver/Tolerance=1e-8' --set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H + 1.5*rho*g*L')
every=(--set 'Output/Interval of checkpoints=0.01')

for kind in bed adaptive uniform triangles dry; do
  case $kind in
    bed) more= ;;
    adaptive) more=$'subsection Mesh refinement\n set Interval = 4\n subsection Criteria: bed faces\n  set Half width = 1\n end\nend' ;;
    uniform) more=$'subsection Mesh refinement\n set Criteria = uniform\nend' ;;
    triangles) more=$'subsection Domain\n set Mesh file = data/bed.msh\nend' ;;
    dry) more=$'subsection Fluid\n set Model = none\nend\nset Gravity = 5, -8' ;;
  esac
  echo "$more" | scene_from bed

  common=("${as_it_comes[@]}" --set 'Output/Digits=17')
  [ $kind != adaptive ] || common+=(--set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H + 6*rho*g*L')
  two_parts 1
  cmp whole/statistics.csv half/statistics.csv || fail "$kind: a restart differs from the uninterrupted run"
  [ $kind != adaptive ] || grep -q '"mesh adaptations": [2-9]' half/summary.json || fail "expected the mesh to change"

  common=()
  two_parts 2
  grep -q 'written on 1 rank' screen-output || fail "it does not say that round-off differs"
  echo "$kind, continued on two ranks:"
  case $kind in
    dry) must_agree whole/statistics.csv half/statistics.csv --tolerance 1e-5 ;;
    *) must_agree whole/statistics.csv half/statistics.csv --tolerance 1e-5 --ignore flux_imbalance ;;
  esac
done
