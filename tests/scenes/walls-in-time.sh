#!/bin/bash
# Walls that move or vanish at given times: a gate that is lifted, one that is taken away, a side that opens; on ranks, over restarts.
# SLOW
. "$SCENES/functions"
scene_from dry-bed <<'END'
subsection Time
  set End time = 0.12
end
subsection Domain
  set Upper right corner = 0.012, 0.006
end
subsection Grains
  set Extra walls = gate: 0.004, 0 -> 0.004, 0.006
end
subsection Output
  set Observers = motion, support, bed, audit, walls
  set Interval of pictures = 0.01
  set Digits = 17
end
END

lift='gate: 0, 0.1 rigid from 0.0205 to 0.0705'

check() { # FOLDER: the column stands until 0.02 s, and has slumped at the end; how far, and where the gate is
  /usr/bin/python3 - "$1" "$2" <<'END' || fail "$1"
import csv, json, sys
sys.path.insert(0, __import__("os").environ["SCENES"] + "/../../contrib")
import vtu
folder, what = sys.argv[1:]
rows = [{k: float(v) if v else None for k, v in row.items()} for row in csv.DictReader(open(folder + "/statistics.csv"))]
assert len(rows) == 121 and json.load(open(folder + "/summary.json"))["scene"]["grains"] == 200
before = [r for r in rows if r["time_s"] < 0.0201]
assert all(r["largest_grain_velocity_m_per_s"] < 1e-3 for r in before), max(r["largest_grain_velocity_m_per_s"] for r in before)
assert abs(before[-1]["wall_gate_force_x_N_per_m"]) > 1e-3
front = {}
for time, files in vtu.read_pvd(folder + "/grains.pvd"):
    grains = vtu.read_vtu(files)
    assert len(grains.points) == 200
    front[round(time, 3)] = max(grains.points[:, 0] + grains.fields["radius"])
assert front[0.02] < 0.00401, front
assert front[0.12] > 0.008, front
assert sorted(front.values()) == [front[t] for t in sorted(front)] or max(front.values()) > 0.011, front
assert rows[-1]["bed_height_m"] < 0.8 * rows[0]["bed_height_m"], (rows[0]["bed_height_m"], rows[-1]["bed_height_m"])
walls = {round(t, 3): len(vtu.read_vtu(f).points) for t, f in vtu.read_pvd(folder + "/walls.pvd")}
if what == "lift":
    assert abs(rows[-1]["wall_gate_y_m"] - 0.008) < 1e-15 and rows[-1]["wall_gate_x_m"] == 0.004
    assert abs(rows[50]["wall_gate_y_m"] - (0.003 + 0.1 * (0.05 - 0.0205))) < 1e-15
    assert walls[0.12] == walls[0.]
else:
    assert rows[-1]["wall_gate_y_m"] == 0.003
    there = [r["wall_gate_is_there"] for r in rows]
    assert there == [1.] * 31 + [0.] * 90, there
    assert rows[-1]["wall_gate_force_x_N_per_m"] == 0.
    assert walls[0.12] < walls[0.]
END
}

for what in lift vanish; do
  if [ $what = lift ]; then
    motion=(--set "Grains/Motion of walls=$lift")
  else
    motion=(--set 'Grains/Presence of walls=gate: to 0.03')
  fi
  must_run 1 dry-bed.prm "${motion[@]}" --set "Output/Output folder=$what"
  check $what $what
  ! grep -q 'does not see' error-output || fail "a warning of the fluid in a dry run"
  # ranks that share the contacts give the same digits
  must_run 2 dry-bed.prm "${motion[@]}" --set "Output/Output folder=$what-2" --set 'Contacts/Least grains a rank=1'
  cmp $what/statistics.csv $what-2/statistics.csv || fail "$what: two ranks differ"
  # restarts: before anything moves, and while it does, or has gone
  for end in 0.015 0.05; do
    rm -rf half
    must_run 1 dry-bed.prm "${motion[@]}" --set 'Output/Output folder=half' --set "Time/End time=$end"
    must_run 1 dry-bed.prm "${motion[@]}" --set 'Output/Output folder=half' --set 'Output/Restart=true'
    cmp $what/statistics.csv half/statistics.csv || fail "$what: a restart at $end s differs"
    check half $what
  done
done
grep -q 'gate: .*moves at (0, 0.1) m/s from 0.0205 s to 0.0705 s, as a whole' <("$ALLUVIUM" --check dry-bed.prm --set "Grains/Motion of walls=$lift") ||
  fail "the scene's report does not tell how the gate moves"

# A formula, and phases that add up.
must_run 1 dry-bed.prm --set 'Grains/Motion of walls=gate: 0 | if(t < 0.03, 0, 0.1); gate: 0, 0.05 rigid from 0.08' --set 'Output/Output folder=formula'
/usr/bin/python3 -c '
import csv
y = float(list(csv.DictReader(open("formula/statistics.csv")))[-1]["wall_gate_y_m"])
assert abs(y - (0.003 + 0.1 * 0.09 + 0.05 * 0.04)) < 1e-12, y' || fail "a formula"

# A side that opens: grains leave, and are counted; without its name under Open to grains that is refused.
open=(--set 'Grains/Extra walls=' --set 'Domain/Upper right corner=0.004, 0.006' --set 'Grains/Presence of walls=right: to 0.02' --set 'Time/End time=0.1')
must_fail 'right.*Open to grains' 1 dry-bed.prm "${open[@]}" --set 'Output/Output folder=refused'
must_run 1 dry-bed.prm "${open[@]}" --set 'Domain/Open to grains=right' --set 'Output/Output folder=opens' --set 'Output/Observers=motion, bed, leavers'
/usr/bin/python3 -c '
import csv
rows = list(csv.DictReader(open("opens/statistics.csv")))
left = {round(float(r["time_s"]), 4): float(r["grains_left"]) for r in rows}
assert left[0.02] == 0 and 50 < left[0.1] < 200, left' || fail "a side that opens"

# What cannot be read, or fits nothing.
must_fail "Motion of walls: expected.*from.*got 'gate: 0, 0.1 form 0.2'" 1 dry-bed.prm --set 'Grains/Motion of walls=gate: 0, 0.1 form 0.2' --set 'Output/Output folder=no'
must_fail "Motion of walls: expected" 1 dry-bed.prm --set 'Grains/Motion of walls=gate: 0, 0.1 from 0.2 to 0.1' --set 'Output/Output folder=no'
must_fail "depend on t only" 1 dry-bed.prm --set 'Grains/Motion of walls=gate: 0 | x' --set 'Output/Output folder=no'
must_fail "Presence of walls: expected" 1 dry-bed.prm --set 'Grains/Presence of walls=gate: 0.3' --set 'Output/Output folder=no'
must_fail "Presence of walls: there is no wall 'gat'" 1 dry-bed.prm --set 'Grains/Presence of walls=gat: to 0.3' --set 'Output/Output folder=no'

# The fluid sees none of it, which is said, once.
must_run 1 dry-bed.prm --set "Grains/Motion of walls=$lift" --set 'Fluid/Model=volume-averaged' --set 'Time/End time=0.003' --set 'Output/Output folder=wet' \
  --set 'Boundary conditions/Slip walls=left, right' --set 'Output/Observers=motion'
[ "$(grep -c "warning: the fluid does not see the walls 'gate'" error-output)" -eq 1 ] || fail "no word of the fluid"
must_run 1 dry-bed.prm --set "Grains/Motion of walls=$lift" --set 'Grains/Fixed=true' --set 'Time/End time=0.003' --set 'Output/Output folder=fixed'
grep -q 'warning: Grains/Fixed = true: walls stay' error-output || fail "no word of fixed grains"

# Grains that lie on a wall that stands still inside the fluid: it passes that without resistance, which is said.
must_run 1 dry-bed.prm --set 'Fluid/Model=volume-averaged' --set 'Time/End time=0.002' --set 'Output/Output folder=sieve' --set 'Boundary conditions/Slip walls=left, right' \
  --set 'Output/Observers=motion' --set 'Grains/Extra walls=floor: 0, 0 -> 0.004, 0; gate: 0.004, 0 -> 0.004, 0.006' --set 'Domain/Lower left corner=0, -0.002'
[ "$(grep -c "warning: grains lie on 'floor' inside the fluid" error-output)" -eq 1 ] || fail "no word of a floor inside the fluid"
