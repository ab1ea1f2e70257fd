#!/bin/bash
# The mesh under a steady flow through a fixed bed changes, finer and back: the force on the grains hardly feels it, although the
# flux belongs to the mesh.
. "$SCENES/functions"

# A formula of x, y and t decides: at t = 0.02 s the cells at the bed's top are halved twice, at t = 0.04 s joined again.
scene_from bed <<'EOF'
subsection Time
  set End time  = 0.055
  set Time step = 1e-3
end
subsection Grains
  set Fixed = true
end
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 0.5*rho*g*L
end
subsection Mesh refinement
  set Criteria = function
  set Interval = 20
  subsection Criteria: function
    set Cell size = if((t > 0.015) && (t < 0.035), if(abs(y - 0.0025) < 0.0005, 0.5, 4), 4)
  end
end
subsection Output
  set Interval of statistics = 0
  set Digits                 = 12
  set Observers              = support, flux, mesh changes
end
EOF

must_run 1 bed.prm
python3 - <<'EOF' || fail "the force on the grains jumps"
import csv, json, sys
rows = list(csv.DictReader(open("output/statistics.csv")))[1:]
force = {round(1e3 * float(r["time_s"])): float(r["fluid_force_over_weight"]) for r in rows}
flux = {round(1e3 * float(r["time_s"])): float(r["flux_top_m2_per_s"]) for r in rows}
imbalance = max(abs(float(r["flux_imbalance"])) for r in rows[10:])
print("flux on both meshes:", flux[20], flux[40])
good = abs(flux[40] / flux[20] - 1) > 0.005 and imbalance < 1e-6
for change in (20, 40):
    jumps = [abs(force[change + k] / force[change + 14] - 1) for k in range(1, 15)]
    print("after", change, "ms:", *(f"{j:.1e}" for j in jumps[:5]))
    good = good and max(jumps) < 2e-3 and max(jumps[3:]) < 1e-4
changed = [r for r in rows if r["mesh_change_share"]]
good = good and [round(1e3 * float(r["time_s"])) for r in changed] == [21, 41]
value = lambda change, name, stage: float(changed[change][f"mesh_change_{name}_{stage}"])
for name in ("solid_volume_m2", "momentum_y_kg_per_s", "mass_residual"):
    print(name, [[value(k, name, stage) for stage in ("before", "interpolated", "after")] for k in (0, 1)])
for k in (0, 1):
    good = good and all(abs(value(k, "solid_volume_m2", stage) / value(0, "solid_volume_m2", "before") - 1) < 1e-10
                        for stage in ("before", "interpolated", "after"))
    # at once those of a flow that has long been on this mesh: it has another flux, so momentum is not to be kept
    for name, size in (("momentum_y_kg_per_s", 5e-3), ("mass_residual", 2e-2)):
        good = good and abs(value(k, name, "after") / value(1 - k, name, "before") - 1) < size
        good = good and abs(value(k, name, "after") / value(k, name, "before") - 1) > 0.05
changes = json.load(open("output/summary.json"))["mesh changes"]
good = good and changes["number"] == 2 and changes["largest_change_of_solid_volume"] < 1e-10
sys.exit(not good)
EOF
