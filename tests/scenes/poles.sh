#!/bin/bash
# What is given as a formula in t is looked at over the time of the run before it starts, at the ends of its steps and between them.
# SLOW
. "$SCENES/functions"
scene_from tiny </dev/null
refused() { # REGEX SETTING...
  must_fail "$1" 1 --check tiny.prm --set 'Time/End time=0.02' --set 'Time/Time step=1e-4' "${@:2}"
  must_fail "$1" 1 tiny.prm --set 'Time/End time=0.02' --set 'Time/Time step=1e-4' "${@:2}"
  [ ! -e output ] || fail "it left an output folder"
}
dry=(--set 'Fluid/Model=none')
refused "Pressure: boundary 'top'.*'1/\(0.01234-t\)' .* t = 0.01234 s" --set 'Boundary conditions/Pressure=top: 1/(0.01234-t)'
refused "Velocity: boundary 'left'.*'0 . tan\(pi/2\*t/0.0171\)' grows beyond all bounds near t = 0.0171 s" \
  --set 'Boundary conditions/No-slip walls=right, bottom' --set 'Boundary conditions/Velocity=left: 0 | tan(pi/2*t/0.0171)'
refused "Body force: '0 . 1/\(t-0.0103\)' .* t = 0.0103 s" --set 'Fluid/Body force=0 | 1/(t-0.0103)'
refused "Motion of walls: 'bottom': '0 . sqrt\(0.01-t\)' is -?nan at t = 0.01" "${dry[@]}" --set 'Grains/Motion of walls=bottom: 0 | sqrt(0.01-t)'
refused "Motion of walls: 'bottom': '0 . 1/\(t-0.01234\)' .* t = 0.01234 s" "${dry[@]}" --set 'Grains/Motion of walls=bottom: 0 | 1/(t-0.01234)'
refused "Motion of walls: 'bottom': '1/t . 0' is inf at t = 0 s" "${dry[@]}" --set 'Grains/Motion of walls=bottom: 1/t | 0'
periodic=(--set 'Domain/Periodic directions=x' --set 'Boundary conditions/No-slip walls=bottom')
refused "Mean pressure gradient: '1/\(t-0.01234\) . 0' .* t = 0.01234 s" "${periodic[@]}" --set 'Fluid/Mean pressure gradient=1/(t-0.01234) | 0'
refused "function/Cell size: .* at .* t = " --set 'Mesh refinement/Criteria=function' --set 'Mesh refinement/Interval=10' \
  --set 'Mesh refinement/Criteria: function/Cell size=4 - t/0.004'

# before it moves and after it a wall's velocity may be anything
must_run 1 tiny.prm "${dry[@]}" --set 'Time/End time=0.004' --set 'Grains/Motion of walls=bottom: 0 | -1e-9/t from 0.001 to 0.002; bottom: 0 | 1e-3*sqrt(0.001-t) to 0.001'
must_run 1 tiny.prm "${dry[@]}" --set 'Time/End time=0.004' --set 'Time/Time step=auto' --set 'Output/Overwrite output folder=true' \
  --set 'Grains/Motion of walls=bottom: 0 | 1e-3*sqrt(0.002-t) to 0.002'
