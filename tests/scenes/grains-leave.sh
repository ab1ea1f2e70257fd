#!/bin/bash
# A grain that leaves through an open side is taken out and counted, the run goes on: on ranks, over restarts, and without any grain left.
# SLOW
. "$SCENES/functions"
scene_from bed <<'END'
subsection Time
  set End time = 0.05
end
subsection Domain
  set Open to grains = bottom
end
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 1000*d
end
subsection Grains
  set Fluid packing fraction = 0
  subsection Deposit: file
    set File = three.csv
  end
end
subsection Output
  set Observers = motion, support, flux, bed, audit, leavers, stress
  set Digits    = 17
end
END
printf 'x,y,radius,vy\n0.001,0.00025,0.0001,-0.02\n0.002,0.0006,0.00011,-0.02\n0.003,0.004,0.0001,0.19\n' >three.csv

check() { # FOLDER: what has left, against the grains of the table
  /usr/bin/python3 - "$1" <<'END' || fail "$1: what has left"
import csv, json, math, sys
rows = [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(open(sys.argv[1] + "/statistics.csv"))]
left = json.load(open(sys.argv[1] + "/summary.json"))["grains that left"]["bottom"]
mass = [2630 * math.pi * r * r for r in (1e-4, 1.1e-4)]
assert [row["grains_left"] for row in rows][0] == 0 and rows[-1]["grains_left"] == 2 == left["number"], left
assert all(a["grains_left"] <= b["grains_left"] for a, b in zip(rows, rows[1:]))
assert abs(left["mass_kg_per_m"] / sum(mass) - 1) < 1e-12, (left, mass)
assert abs(rows[-1]["mass_left_kg_per_m"] / sum(mass) - 1) < 1e-12
# they leave at speeds between those of their start and of grains that sink
assert -0.2 * sum(mass) < left["momentum_N_s_per_m"][1] < -0.005 * sum(mass), left
assert rows[-1]["time_s"] == 0.05 and len(rows) == 51
END
}

for fluid in volume-averaged none; do
  common=(--set "Fluid/Model=$fluid")
  must_run 1 bed.prm "${common[@]}" --set "Output/Output folder=whole-$fluid"
  check whole-$fluid
  must_run 2 bed.prm "${common[@]}" --set "Output/Output folder=two-$fluid"
  check two-$fluid
  # a restart between the departures, and after them
  for end in 0.018 0.04; do
    rm -rf half
    must_run 1 bed.prm "${common[@]}" --set 'Output/Output folder=half' --set "Time/End time=$end"
    must_run 1 bed.prm "${common[@]}" --set 'Output/Output folder=half' --set 'Output/Restart=true'
    cmp whole-$fluid/statistics.csv half/statistics.csv || fail "$fluid: a restart at $end s differs"
    check half
  done
done

# All leave.
sed -i '/0.003,0.004/d' three.csv
for ranks in 1 2; do
  must_run $ranks bed.prm --set "Output/Output folder=empty-$ranks" --set 'Output/Interval of pictures=0.01' --set 'Mesh refinement/Interval=4'
  check empty-$ranks
done
must_run 1 bed.prm --set 'Output/Output folder=empty-1' --set 'Output/Restart=true' --set 'Time/End time=0.055'

# Grains that rest on one another, and the lowest fall out: the others follow.
must_run 2 bed.prm --set 'Grains/Deposit: file/File=data/bed.csv' --set 'Time/End time=0.02' --set 'Output/Output folder=bed'
/usr/bin/python3 -c 'import json; assert json.load(open("bed/summary.json"))["grains that left"]["bottom"]["number"] > 5' || fail "a bed does not fall out"
