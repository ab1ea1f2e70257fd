#!/bin/bash
# What the program says of a drag law: range, permeability and fluidisation velocity of the bed before the run, and one warning after
# it that names the grains which the law was not made for.
. "$SCENES/functions"
scene_from bed <<'END'
subsection Time
  set End time = 0.003
end
subsection Grains
  set Fixed = true
end
END

for law in disc sphere paper Ergun Wen-Yu Gidaspow Beetstra Tang Koch-Hill Rong; do
  must_run 1 --check bed.prm --set "Coupling/Drag law=$law"
  grep -E "drag law +$law \(void fraction" screen-output | grep -q 'permeability [1-9].*fluidised at a superficial velocity of 0\.00' ||
    fail "$law: permeability or fluidisation velocity is missing"
done

# packed beds have void fractions below 0.4; on cells finer than a grain, without a filter, far below
must_run 1 bed.prm --set 'Coupling/Drag law=Wen-Yu' --set 'Coupling/Filter radius=grain' --set 'Mesh refinement/Criteria=uniform' \
  --set 'Mesh refinement/Criteria: uniform/Cell size=0.5'
[ "$(grep -cE "^Warning: [1-9][0-9]+ of 200 grains .* range of the drag law 'Wen-Yu' \(void fraction 0.4 to 1.*\): ids ([0-9]+, ){20}\.\.\." screen-output)" -eq 1 ] ||
  fail "expected one warning with the first of many grains"
grep -q "outside the range of the drag law 'Wen-Yu'" output/summary.json || fail "the warning is not in summary.json"
must_run 1 bed.prm --set 'Coupling/Drag law=Gidaspow' --set 'Output/Output folder=output-2'
! grep -q '^Warning: .*drag law' screen-output || fail "no grain is outside the range"
