#!/bin/bash
# What the program says of a drag law: range, permeability and fluidisation velocity of the bed before the run, and one warning after
# it that names the grains which the law was not made for.
# SLOW
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
python3 - <<'END' || fail "the summary does not tell how much of the drag was outside the law's range"
import json
law = json.load(open("output/summary.json"))["drag law"]
assert 10 < law["grains_ever_outside_its_range"] <= 200, law
assert 0 < law["share_of_drag_outside_its_range"] < 1, law
END
[ "$(grep -c "range of the drag law 'Wen-Yu'" error-output)" -eq "$(python3 -c '
import json
print(int(json.load(open("output/summary.json"))["drag law"]["share_of_drag_outside_its_range"] > 0.2))')" ] ||
  fail "a fifth of the drag outside the law's range is what to warn of"
grep -q "outside the range of the drag law 'Wen-Yu'" output/summary.json || fail "the warning is not in summary.json"
must_run 1 bed.prm --set 'Coupling/Drag law=Gidaspow' --set 'Output/Output folder=output-2'
! grep -q '^Warning: .*drag law' screen-output || fail "no grain is outside the range"
