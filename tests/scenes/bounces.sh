#!/bin/bash
# Correct runs in which the kinetic energy is next to none at times are not taken for run-aways: a grain that bounces, at its highest
# point, and grains that overlap a little without gravity.
. "$SCENES/functions"
cat >scene.prm <<'END2'
set Gravity = 0, -9.81
subsection Fluid
  set Model = none
end
subsection Time
  set End time = 1
end
subsection Domain
  set Upper right corner = 0.01, 0.02
end
subsection Grains
  set Deposit = file
  subsection Deposit: file
    set File = grains.csv
  end
end
subsection Output
  set Interval of pictures = 0
  set Interval of statistics = 0
  set Overwrite output folder = true
end
END2
printf 'x,y,radius\n0.005,0.0052,2e-4\n' >grains.csv
for restitution in 1 0.9 0.7 0.3; do
  for dt in 1e-3 3e-4 1e-4; do
    must_run 1 scene.prm --set "Contacts/Restitution=$restitution" --set "Time/Time step=$dt"
  done
done
printf 'x,y,radius\n0.002,0.0052,2e-4\n0.004,0.0072,2e-4\n0.006,0.0062,2e-4\n' >grains.csv
for restitution in 1 0.9; do
  must_run 1 scene.prm --set "Contacts/Restitution=$restitution"
done
for overlap in 1e-4 5e-3; do
  for dt in 1e-3 1e-5; do
    printf 'x,y,radius\n0.005,0.005,2e-4\n%s,0.005,2e-4\n' "$(/usr/bin/python3 -c "print(0.005 + 4e-4 * (1 - $overlap))")" >grains.csv
    must_run 1 scene.prm --set 'Gravity=0, 0' --set "Time/Time step=$dt" --set "Time/End time=$(/usr/bin/python3 -c "print(50.3 * $dt)")"
  done
done
