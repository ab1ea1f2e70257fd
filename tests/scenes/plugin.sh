#!/bin/bash
# A drag law from a file of its own, tests/plugin/linear_drag.cc, has its parameter in --print-parameters, and the flux through a bed
# of fixed grains follows it: under a given head, twice the resistance lets through half as much.
. "$SCENES/functions"
scene_from bed <<'END'
subsection Time
  set End time  = 2
  set Time step = 0.4
end
subsection Fluid
  set Convection = false
end
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 0.01*rho*g*L
end
subsection Grains
  set Fixed = true
end
END

must_fail "parameter 'Coupling/Drag law' cannot be 'linear'" 1 bed.prm --set 'Coupling/Drag law=linear'
ALLUVIUM=$ALLUVIUM_WITH_PLUGIN
must_run 1 --print-parameters
grep -A6 'subsection Drag law: linear' screen-output >section
grep -q 'The same drag everywhere \[N s/m^4\]' section && grep -q 'set Resistance = ' section || fail "its parameter is not printed"
grep -q "'linear': A constant, for tests" screen-output || fail "its explanation is not printed"

for resistance in 2e7 4e7 8e7; do
  must_run 1 bed.prm --set 'Coupling/Drag law=linear' --set "Coupling/Drag law: linear/Resistance=$resistance" \
    --set "Output/Output folder=output-$resistance"
done
must_run 2 bed.prm --set 'Coupling/Drag law=linear' --set "Coupling/Drag law: linear/Resistance=2e7" \
  --set "Output/Output folder=output-two-ranks"
must_agree output-2e7/statistics.csv output-two-ranks/statistics.csv --ignore flux_imbalance

/usr/bin/python3 - <<'END' || fail "the flux does not follow the drag law"
import json
flux = [json.load(open("output-%s/summary.json" % r))["flux"]["top_m2_per_s"] for r in ("2e7", "4e7", "8e7")]
print("flux %g %g %g m^2/s" % tuple(flux))
assert flux[0] > 0 and all(abs(a / b - 2) < 0.02 for a, b in zip(flux, flux[1:])), flux
END
