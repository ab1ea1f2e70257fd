#!/bin/bash
# The mesh under a suspension that sinks becomes coarser: what interpolation leaves must not pass for an acceleration of the fluid.
# Left alone, it made the force on the grains jump by 45 % and their speed by 2 %; now it is 5 % and 0.9 %, the slip's own relaxation.
. "$SCENES/functions"

must_run 1 "$SCENES/settling.prm" --set "Domain/Upper right corner=0.0032, 0.0064" \
  --set "Time/Time step=1e-4" --set "Time/End time=0.0205" \
  --set "Mesh refinement/Criteria=function" --set "Mesh refinement/Interval=200" --set "Mesh refinement/Coarsest cell size=8" \
  --set "Mesh refinement/Criteria: function/Cell size=if(t > 0.01, 4, 1)" \
  --set "Grains/Deposit=random suspension" --set "Grains/Deposit: random suspension/Area fraction=0.2" \
  --set "Output/Observers=support, settling" --set "Output/Observers: settling/Bottom=0.0016" \
  --set "Output/Observers: settling/Top=0.0048" --set "Output/Interval of statistics=0" --set "Output/Digits=12"
python3 - <<'EOF' || fail "the force on the grains or their speed jumps"
import csv, json, sys
rows = list(csv.DictReader(open("output/statistics.csv")))
changes = json.load(open("output/summary.json"))["counts"]["mesh adaptations"]
jump = {name: max(abs(float(rows[k][name]) / float(rows[200][name]) - 1) for k in (201, 202, 203))
        for name in ("fluid_force_over_weight", "settling_speed_m_per_s")}
print("mesh changes:", changes, "jumps:", jump)
sys.exit(not (changes >= 1 and jump["fluid_force_over_weight"] < 0.08 and jump["settling_speed_m_per_s"] < 0.01))
EOF

# Where few cells change, under grains that move, nothing is done: interpolation leaves less there than a new flow would.
must_run 1 "$SCENES/settling.prm" --set "Domain/Upper right corner=0.0032, 0.0064" \
  --set "Time/Time step=1e-3" --set "Time/End time=0.022" --set "Coupling/Filter radius=2 d" \
  --set "Mesh refinement/Criteria=function" --set "Mesh refinement/Interval=20" --set "Mesh refinement/Coarsest cell size=8" \
  --set "Mesh refinement/Criteria: function/Cell size=if((t > 0.01) && (y < 0.0004), 1, 4)" \
  --set "Output/Observers=support" --set "Output/Output folder=small" --set "Output/Interval of statistics=0" --set "Output/Digits=12"
python3 - <<'EOF' || fail "a small change of the mesh is felt"
import csv, json, sys
rows = list(csv.DictReader(open("small/statistics.csv")))
counts = json.load(open("small/summary.json"))["counts"]
force = [float(row["fluid_force_over_weight"]) for row in rows]
kink = abs(force[21] - 2 * force[20] + force[19]) / force[20]
print("mesh changes:", counts["mesh adaptations"], "rebalanced:", counts["rebalanced flows"], "second difference:", kink)
sys.exit(not (counts["mesh adaptations"] >= 1 and counts["rebalanced flows"] == 0 and kink < 5e-3))
EOF
