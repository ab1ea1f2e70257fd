#!/bin/bash
# Correct runs in which the kinetic energy is next to none at times are not taken for run-aways: a grain that bounces, at its highest
# point, grains that overlap a little without gravity, and soft ones, while their springs hold it.
# SLOW
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

# springs give back what they hold, with gravity and without, between grains and at walls, over a restart in the midst of a bounce
soft=(--set 'Contacts/Contact model=soft-sphere' --set 'Contacts/Soft spheres/Restitution=1')
printf 'x,y,radius,vx,vy\n0.005,0.0052,2e-4,0.1,-0.2\n0.007,0.0052,2e-4,-0.1,0.1\n' >grains.csv
for gravity in '0, -9.81' '0, 0'; do
  for stiffness in 1e5 1e7; do
    for dt in 2e-4; do
      must_run 1 scene.prm "${soft[@]}" --set "Gravity=$gravity" --set "Contacts/Soft spheres/Stiffness=$stiffness" --set "Time/Time step=$dt"
      [ "$(/usr/bin/python3 -c 'import json; print(json.load(open("output/summary.json"))["audit"]["largest_unexplained_energy_over_bound"] < 0.5)')" = True ] ||
        fail "springs of $stiffness Pa, steps of $dt s, gravity $gravity: energy is not explained"
    done
  done
done
printf 'x,y,radius,vx,vy\n0.005,0.00021,2e-4,0,-0.1\n' >grains.csv
for end in 2e-4 6e-4; do
  must_run 1 scene.prm "${soft[@]}" --set 'Gravity=0, 0' --set 'Contacts/Soft spheres/Stiffness=3e3' --set 'Time/Time step=1e-4' --set "Time/End time=$end"
  must_run 1 scene.prm "${soft[@]}" --set 'Gravity=0, 0' --set 'Contacts/Soft spheres/Stiffness=3e3' --set 'Time/Time step=1e-4' --set Output/Restart=true
done
