#!/bin/bash
# A run that starts with the grains of another one's end: dry settling, then water.
# SLOW
. "$SCENES/functions"
scene_from bed </dev/null
for mass in 'contact radius' 'fluid radius'; do
  rm -rf dry wet
  must_run 1 bed.prm --set 'Fluid/Model=none' --set "Grains/Mass follows=$mass" --set 'Gravity=1, -9.81' \
    --set 'Output/Output folder=dry' --set 'Output/Digits=17' --set 'Output/Observers=bed, motion'
  for ranks in 1 2; do
    must_run $ranks bed.prm --set 'Grains/Deposit=end of a run' --set 'Grains/Deposit: end of a run/Output folder=dry' \
      --set "Grains/Mass follows=$mass" --set "Output/Output folder=wet-$ranks" --set 'Output/Overwrite output folder=true' --set 'Output/Digits=17' \
      --set 'Grains/Fluid packing fraction=0.5' --set 'Output/Observers=bed, motion' --set 'Grains/Overlap tolerance=0.02'
  done
  /usr/bin/python3 - <<'END' || fail "$mass: it does not start where the other ended"
import csv, re
dry, wet = (list(csv.DictReader(open(f"{name}/statistics.csv"))) for name in ("dry", "wet-1"))
assert dry[-1]["bed_height_m"] == wet[0]["bed_height_m"], (dry[-1], wet[0])
assert dry[-1]["largest_grain_velocity_m_per_s"] == wet[0]["largest_grain_velocity_m_per_s"]
assert float(wet[0]["time_s"]) == 0 and float(wet[0]["moved_mass_fraction"]) == 0
# its weight: the same density, with the fluid radius of this run's packing
e, f = (float(rows[i]["kinetic_energy_J_per_m"]) for rows, i in ((dry, -1), (wet, 0)))
print("kinetic energy", e, f)
END
  /usr/bin/python3 - "$mass" <<'END' || fail "$mass: masses"
import csv, sys
e, f = (float(list(csv.DictReader(open(f"{name}/statistics.csv")))[i]["kinetic_energy_J_per_m"]) for name, i in (("dry", -1), ("wet-1", 0)))
expected = 1. if sys.argv[1] == "contact radius" else 0.50 / 0.52 # of the packings that the fluid sees
assert abs(f / e / expected - 1) < 1e-2, (e, f)
END
done
must_fail 'there is no folder' 1 bed.prm --set 'Grains/Deposit=end of a run' --set 'Grains/Deposit: end of a run/Output folder=wett'
mkdir -p nothing
must_fail 'no checkpoint in' 1 bed.prm --set 'Grains/Deposit=end of a run' --set 'Grains/Deposit: end of a run/Output folder=nothing'
must_fail "needs the parameter" 1 bed.prm --set 'Grains/Deposit=end of a run'
