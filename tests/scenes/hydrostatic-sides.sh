#!/bin/bash
# Flow between vertical sides with given pressures: plane Poiseuille flow if the pressure of the fluid at rest is added; a warning if a
# constant lets it fall.
. "$SCENES/functions"
scene_from layer <<'END'
subsection Domain
  set Periodic directions =
  set Upper right corner  = 0.02, 0.005
end
subsection Boundary conditions
  set No-slip walls = bottom, top
  set Slip walls    =
  set Pressure      = left: 12.8; right: 0
  set Pin pressure  = false
end
subsection Output
  set Overwrite output folder = true
end
END

must_run 1 layer.prm --set 'Boundary conditions/Add hydrostatic pressure=left, right'
python3 - <<'END' || fail 'no Poiseuille flow'
import csv, sys
row = list(csv.DictReader(open("output/statistics.csv")))[-1]
u, flux = float(row["largest_fluid_velocity_m_per_s"]), float(row["flux_right_m2_per_s"])
print(u, flux)
sys.exit(not (abs(u - 0.1) < 2e-3 and abs(flux - 0.1 * 0.005 * 2 / 3) < 2e-2 * 3.33e-4))
END
grep -q "fluid falls" error-output && fail 'a warning without reason'
alluvium 1 --check layer.prm || fail 'the check failed'
for side in left right; do
  grep -q "the pressure given on '$side' is the same at all its levels" error-output || fail "no hint for $side"
done
must_fail "Add hydrostatic pressure: 'top' is no boundary with a given pressure" 1 layer.prm \
  --set 'Boundary conditions/Add hydrostatic pressure=top'
