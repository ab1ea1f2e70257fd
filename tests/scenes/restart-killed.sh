#!/bin/bash
# Killed or stopped at random moments and resumed, a run leaves the same statistics.csv and summary.json as an undisturbed one that
# writes no checkpoints. MORE=1 (ctest -L restart): 20 ends each, all time schemes, contact solvers and kinds of mesh.
# SLOW
. "$SCENES/functions"

lifted=$'subsection Mesh refinement\n set Interval = 4\n subsection Criteria: bed faces\n  set Half width = 1\n end\nend
subsection Boundary conditions\n set Pressure = top: 0; bottom: rho*g*H + 6*rho*g*L\nend'
periodic=$'subsection Domain\n set Periodic directions = x\nend
subsection Boundary conditions\n set Slip walls =\n set No-slip walls = bottom, top\n set Pressure =\n set Pin pressure = true\nend
subsection Grains\n set Deposit = random suspension\n set Fluid packing fraction = 0
 subsection Deposit: random suspension\n  set Area fraction = 0.2\n  set Smallest gap = 4e-5\n end\nend'
dry=$'subsection Fluid\n set Model = none\nend\nset Gravity = 5, -8'
resting=
triangles=$'subsection Domain\n set Mesh file = data/bed.msh\nend'
uniform=$'subsection Mesh refinement\n set Criteria = uniform\nend'

as_it_comes=(--set 'Contacts/Residual tolerance=1e-5' --set 'Contacts/Largest violation=1e-3' --set 'Contacts/Stagnation tolerance factor=10'
             --set 'Fluid/Linear solver/Tolerance=1e-8' --set 'Contacts/Least grains a rank=20')

disturb() { # KIND RANKS KILLS SEED STEPS [ARGUMENTS...]
  echo "${!1}" | scene_from bed
  "$SCENES/kill-and-resume" ${same_checkpoints:+--same-checkpoints} --ranks "$2" --kills "$3" --seed "$4" bed.prm "${as_it_comes[@]}" \
    --set "Time/End time=${5}e-3" "${@:6}" || fail "$1 on $2 rank(s): ${*:6}"
  rm bed.prm
}

if [ -z "${MORE:-}" ]; then
  disturb lifted 1 4 1 24
  disturb periodic 2 3 2 18
  disturb dry 2 3 3 18
  same_checkpoints=1 disturb lifted 2 4 4 24 --set 'Time/Time step=auto'
  exit 0
fi
for ranks in 1 2; do
  for kind in lifted periodic dry; do
    same_checkpoints=1 disturb $kind $ranks 10 $((30 + ranks)) 60 --set 'Time/Time step=auto'
  done
  for kind in lifted periodic dry resting triangles uniform; do
    disturb $kind $ranks 20 $((10 + ranks)) 100
  done
  # explicit drag is stable in steps far below the grains' relaxation time only
  disturb resting $ranks 5 19 1 --set 'Coupling/Time scheme=explicit' --set 'Time/Time step=2e-5' --set 'Time/End time=6e-4'
  # with implicit drag a lifted bed diverges in steps of 1e-3 s, in those of 2e-4 s it does not
  disturb lifted $ranks 5 20 6 --set 'Coupling/Time scheme=implicit drag' --set 'Time/Time step=2e-4'
  for scheme in 'semi-implicit per piece' 'semi-implicit per grain' iterated; do
    disturb lifted $ranks 5 20 30 --set "Coupling/Time scheme=$scheme"
  done
  disturb lifted $ranks 5 21 30 --set 'Coupling/Rotation=true'
  for solver in 'Gauss-Seidel' 'SOR' 'accelerated Jacobi' 'work queue'; do
    [ "$ranks/$solver" = '2/work queue' ] && continue # it runs on one rank only
    disturb lifted $ranks 5 22 30 --set "Contacts/Contact solver=$solver"
    disturb dry $ranks 5 23 30 --set "Contacts/Contact solver=$solver"
  done
  for cohesion in 'constant force' 'liquid bridge'; do
    disturb dry $ranks 5 24 30 --set "Contacts/Cohesion=$cohesion"
  done
  disturb dry $ranks 5 25 12 --set 'Contacts/Contact model=soft-sphere'
  disturb dry $ranks 5 26 30 --set 'Grains/Motion of walls=left: 0.01, 0'
done
