#!/bin/bash
# Inputs that are odd rather than wrong: each brings a warning, or is read as it is meant.
# SLOW
. "$SCENES/functions"
scene_from tiny </dev/null
warned() { # REGEX SETTING...
  must_run 1 --check tiny.prm "${@:2}"
  [ "$(grep -cE -- "^alluvium: warning: .*$1" error-output)" -eq 1 ] || fail "expected one warning that matches '$1'"
}
silent() { # SETTING...
  must_run 1 --check tiny.prm "$@"
  [ ! -s error-output ] || fail "a warning without a reason: $*"
}
silent
dry=(--set Fluid/Model=none)

# twice in one file
{ cat tiny.prm && printf 'subsection Time\n set End time = 1e-3\n set End time = 2e-3\nend\n'; } >twice.prm
must_run 1 --check twice.prm
grep -qE "^alluvium: warning: twice.prm:4: parameter 'Time/End time' is set twice in this file: '2e-3' overrides the '1e-3' of line 3" error-output ||
  fail "a parameter that is set twice"
silent --set 'Time/End time=1e-3' # that of an included file

# blanks and dashes of web pages
{ cat tiny.prm && printf 'subsection Time\n set End\302\240time\302\240= 1e-3\nend\n'; } >blanks.prm
must_run 1 blanks.prm --set 'Output/Interval of statistics=1e-3'
[ "$(wc -l <output/statistics.csv)" -eq 3 ] || fail "a no-break space is no blank"
rm -r output
minus=$(printf '\342\210\222')
must_fail "'Gravity' cannot be .* another character than the minus sign" 1 --check tiny.prm --set "Gravity=0, ${minus}9.81"
must_fail "cannot understand .* another character than the minus sign" 1 --check tiny.prm --set "Boundary conditions/Pressure=top: ${minus}1"
must_fail "cannot understand '-'; it may use" 1 --check tiny.prm --set 'Boundary conditions/Pressure=top: -'
[ "$(wc -l <error-output)" -eq 1 ] || fail "deal.II prints something of its own"

warned "'10\*L' uses L, the height of the bed .* which is 0" --set Grains/Deposit=none --set 'Boundary conditions/Pressure=top: 10*L'
warned 'all nodes of the mesh are on walls' --set 'Grains/Deposit=none' --set 'Domain/Coarse cell size=0.004' --set 'Mesh refinement/Criteria=function' \
  --set 'Mesh refinement/Criteria: function/Cell size=100' --set 'Boundary conditions/No-slip walls=top, bottom' \
  --set 'Boundary conditions/Pressure=left: 1; right: 0' --set 'Boundary conditions/Add hydrostatic pressure=left, right'
warned "'bottom' is to move at times that this run, from 0 to 0.002 s, does not have" "${dry[@]}" --set 'Grains/Motion of walls=bottom: 0, 1e-6 from 100'
warned "ask for cells of 0.1 mean grain diameters, but 'Finest cell size' is 0.25" --set 'Mesh refinement/Criteria: uniform/Cell size=0.1'
warned 'the void fraction is 0 where cells lie within a grain' --set 'Coupling/Filter radius=grain' --set 'Mesh refinement/Criteria: uniform/Cell size=0.25'
must_fail "Extra walls: ': 0,0.003 -> 0.004,0.003' has no name" 1 --check tiny.prm --set 'Grains/Extra walls=: 0,0.003 -> 0.004,0.003'

bed=("${dry[@]}" --set 'Grains/Deposit=settled bed' --set 'Grains/Deposit: settled bed/Number of grains=20' --set 'Grains/Deposit: settled bed/Cache folder=')
silent "${bed[@]}"
warned 'no wall is there: the bed will fall' "${bed[@]}" --set 'Domain/Periodic directions=y'
warned 'no wall is there: the bed will fall' "${bed[@]}" --set 'Grains/Deposit: settled bed/Box=0, 0.001, 0.004, 0.004'
warned 'no wall is there: the bed will fall' "${bed[@]}" --set 'Domain/Open to grains=bottom'
silent "${bed[@]}" --set 'Grains/Deposit: settled bed/Box=0, 0.001, 0.004, 0.004' --set Grains/Fixed=true
silent "${bed[@]}" --set 'Grains/Deposit: settled bed/Box=0, 0.001, 0.004, 0.004' --set 'Grains/Extra walls=net: 0, 0.001 -> 0.004, 0.001'
silent "${bed[@]}" --set Gravity=9.81,0
