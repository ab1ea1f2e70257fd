#!/bin/bash
# A restart with other walls, or other laws of contact, takes them: what was at rest wakes, walls in new places stand where their motion
# has brought them, and columns come and go. A restart without changes is tested elsewhere (restart.sh).
# SLOW
. "$SCENES/functions"

# column FILE NAME: its last value
column() {
  /usr/bin/python3 -c 'import csv, sys; print(list(csv.DictReader(open(sys.argv[1])))[-1][sys.argv[2]])' "$1" "$2"
}
near() { # A B TOLERANCE WHAT
  /usr/bin/python3 -c 'import sys; a, b, e = map(float, sys.argv[1:4]); sys.exit(not abs(a - b) <= e)' "$@" || fail "$4: $1 is not $2"
}
again() { # FOLDER ARGUMENTS...: the run in output goes on in a copy
  rm -rf "$1" && cp -r output "$1"
  must_run 1 scene.prm --set Output/Restart=true --set "Output/Output folder=$1" "${@:2}"
}

cat >scene.prm <<'END2'
set Gravity = 2, -9.6
subsection Fluid
  set Model = none
end
subsection Time
  set End time = 0.05
end
subsection Domain
  set Upper right corner = 0.05, 0.01
end
subsection Grains
  set Deposit = file
  set Extra walls = stop: 0.001, 0.0021 -> 0.002, 0.0021; gate: 0.04, 0.002 -> 0.04, 0.004
  subsection Deposit: file
    set File = grain.csv
  end
end
subsection Contacts
  set Grains rotate = false
end
subsection Output
  set Interval of pictures = 0
  set Interval of statistics = 0
  set Digits = 12
end
END2
printf 'x,y,radius\n0.005,0.0002,0.0002\n' >grain.csv

# a grain rests on a slope by friction; each change lets it go, with an exact acceleration
must_run 1 scene.prm
grep -q '"contact steps at rest": *[1-9]' output/summary.json || grep -q 'at_rest' output/summary.json || fail "it does not rest"
v=largest_grain_velocity_m_per_s
near "$(column output/statistics.csv $v)" 0 1e-12 "at rest"
again same --set 'Time/End time=0.1'
near "$(column same/statistics.csv $v)" 0 1e-12 "at rest, nothing changed"
again slides --set 'Time/End time=0.1' --set 'Contacts/Friction of single walls=bottom: 0'
near "$(column slides/statistics.csv $v)" 0.1 1e-4 "without friction of the bottom"
again slides --set 'Time/End time=0.1' --set 'Contacts/Wall friction coefficient=0.1'
near "$(column slides/statistics.csv $v)" 0.052 1e-4 "with less friction"
again rolls --set 'Time/End time=0.1' --set 'Contacts/Grains rotate=true'
near "$(column rolls/statistics.csv $v)" 0.066667 1e-4 "that rolls"

# the same for a wall that is no more, or not there
sed -i 's/^  set Extra walls = .*/  set Extra walls = shelf: 0.001, 0.0048 -> 0.01, 0.0048/' scene.prm
printf 'x,y,radius\n0.005,0.005,0.0002\n' >grain.csv
must_run 1 scene.prm --set 'Output/Overwrite output folder=true'
near "$(column output/statistics.csv $v)" 0 1e-12 "on a shelf"
for change in 'Extra walls=' 'Presence of walls=shelf: to 0.02' 'Extra walls=shelf: 0.001, 0.004 -> 0.01, 0.004' ; do
  again falls --set 'Time/End time=0.06' --set "Grains/$change"
  near "$(column falls/statistics.csv $v)" 0.0980612 1e-3 "Grains/$change"
done

# walls that move: those in new places are where a run from the start with them has them, the others where they were
sed -i 's/^  set Extra walls = .*/  set Extra walls = a: 0.02, 0.005 -> 0.02, 0.006; b: 0.03, 0.005 -> 0.03, 0.006; c: 0.04, 0.005 -> 0.04, 0.006\
  set Motion of walls = a: 0.1, 0 from 0.01; b: 0.05*cos(20*t) | 0; c: 0, 0, 10, 0.04, 0.005/' scene.prm
must_run 1 scene.prm --set 'Output/Overwrite output folder=true'
moved='Grains/Extra walls=0.001, 0.001 -> 0.002, 0.001; c: 0.041, 0.005 -> 0.041, 0.006; b: 0.031, 0.005 -> 0.031, 0.006; a: 0.02, 0.005 -> 0.02, 0.006'
again new --set 'Time/End time=0.06' --set "$moved"
must_run 1 scene.prm --set 'Time/End time=0.06' --set "$moved" --set 'Output/Output folder=fresh'
for wall in a b c; do
  for d in x y; do
    near "$(column new/statistics.csv wall_${wall}_${d}_m)" "$(column fresh/statistics.csv wall_${wall}_${d}_m)" 1e-9 "$d of the wall $wall"
  done
done

# a motion that ends leaves the wall where it is; one that begins takes it from there; their columns stay, and come
again still --set 'Time/End time=0.06' --set 'Grains/Motion of walls=c: 0, 0, 10, 0.04, 0.005'
again back --set 'Time/End time=0.06' --set 'Grains/Motion of walls=a: 0, -0.1 rigid; c: 0, 0, 10, 0.04, 0.005'
near "$(column back/statistics.csv wall_a_x_m)" 0.024 1e-9 "x of the wall that turns off"
near "$(column back/statistics.csv wall_a_y_m)" 0.0045 1e-9 "y of the wall that turns off"
[ "$(head -n 1 still/statistics.csv)" = "$(head -n 1 output/statistics.csv)" ] || fail "columns have gone"
[ -z "$(column still/statistics.csv wall_a_x_m)" ] || fail "a column of what is not measured any more is filled"
again fixed --set 'Time/End time=0.06' --set Grains/Fixed=true
sed -i '/Motion of walls/d' scene.prm
must_run 1 scene.prm --set 'Output/Overwrite output folder=true'
again begins --set 'Time/End time=0.06' --set 'Grains/Motion of walls=c: 0, 0.1, 5, 0.04, 0.005'
/usr/bin/python3 - <<'END2' || fail "columns that come"
import csv
old, new = (list(csv.DictReader(open(f"{name}/statistics.csv"))) for name in ("output", "begins"))
assert list(new[0])[: len(old[0])] == list(old[0])
for a, b in zip(old, new):
    assert all(a[k] == b[k] for k in a) and b["wall_c_y_m"] == ""
assert abs(float(new[-1]["wall_c_y_m"]) - 0.0065) < 1e-5, new[-1]  # its middle turns by 0.05 and rises by 0.001
END2

# where walls are held with the grains, one that is put elsewhere stands there
printf 'x,y,radius\n0.005,0.0002,0.0002\n' >grain.csv
sed -i 's/^  set Extra walls = .*/&\n  set Motion of walls = a: 0.1, 0; b: 0.1, 0/' scene.prm
must_run 1 scene.prm --set 'Output/Overwrite output folder=true' --set Grains/Fixed=true
again held --set 'Time/End time=0.06' --set Grains/Fixed=true --set "$moved"
again freed --set 'Time/End time=0.06' --set "$moved"
near "$(column held/statistics.csv wall_b_x_m)" 0.031 1e-12 "a wall in a new place, held"
near "$(column freed/statistics.csv wall_b_x_m)" 0.032 1e-9 "a wall in a new place, held until now"
near "$(column freed/statistics.csv wall_a_x_m)" 0.021 1e-9 "a wall in its place, held until now"

# two names that columns would call the same
sed -i '/Extra walls/d; s/^  set Motion of walls = .*/  set Extra walls = a b: 0.02, 0.005 -> 0.02, 0.006; a_b: 0.03, 0.005 -> 0.03, 0.006\
  set Motion of walls = a b: 0.1, 0; a_b: 0.2, 0/' scene.prm
must_run 1 scene.prm --set 'Output/Overwrite output folder=true'
near "$(column output/statistics.csv wall_a_b_x_m)" 0.025 1e-9 "the wall 'a b'"
near "$(column output/statistics.csv wall_a_b_2_x_m)" 0.04 1e-9 "the wall 'a_b'"
