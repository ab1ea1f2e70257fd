#!/bin/bash
# Names and places that observers look for are those of the scene: what is not there is a mistake, in --check too, and is named.
# SLOW
. "$SCENES/functions"
scene_from bed </dev/null
refused() { # REGEX SETTING...
  must_fail "$1" 1 bed.prm "${@:2}"
  [ ! -e output ] || fail "it left an output folder"
  must_fail "$1" 1 --check bed.prm "${@:2}"
}
refused "Floor: there is no wall 'flor'. The walls are .*'bottom'" --set 'Output/Observers: support/Floor=flor'
refused "Head between: there is no boundary named 'lift'. The domain's boundaries are .*'left'" --set 'Output/Head between=lift, right'
refused 'Head between: expected the names of two' --set 'Output/Head between=left'
refused "Bottom' = 0.02 m" --set 'Output/Observers=settling' --set 'Output/Observers: settling/Bottom=0.02'
refused "no wall 'botom'" --set 'Grains/Motion of walls=botom: 0, 1'
refused "no boundary named 'botom'" --set 'Domain/Open to grains=botom'
refused "no boundary named 'botom'" --set 'Boundary conditions/Slip walls=left, right, botom'

# another wall may be the floor
must_run 1 bed.prm --set 'Output/Observers: support/Floor=left' --set 'Time/End time=0.001'
# without the default one, nothing is said of a floor
rm -r output
must_run 1 bed.prm --set 'Domain/Open to grains=bottom' --set 'Grains/Extra walls=net: 0, 0 -> 0.004, 0' --set 'Time/End time=0.001'
! grep -q floor_force output/statistics.csv output/summary.json || fail "there is no floor"
