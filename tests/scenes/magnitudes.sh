#!/bin/bash
# Numbers that no scene can have, of a wall, a grain, a fluid: the message names the parameter, or the file's line, and what was expected.
# SLOW
. "$SCENES/functions"
scene_from tiny </dev/null
refused() { # REGEX SETTING...
  must_fail "$1" 1 --check tiny.prm "${@:2}"
}
for value in 1e300 1e30 1e12 1e-300; do
  refused "'Fluid/Density' cannot be '$value': expected a number from 1e-06 to 1e\+09" --set "Fluid/Density=$value"
done
for value in 1e300 1e16 1e-300; do
  refused "'Fluid/Viscosity' cannot be '$value': expected a number from 1e-12 to 1e\+15" --set "Fluid/Viscosity=$value"
done
refused "'Gravity' cannot be '0,-1e300': expected 2 values" --set Gravity=0,-1e300
refused "'Gravity' cannot be '0,-1e-300': expected .* of a size from 1e-30 to 1e30" --set Gravity=0,-1e-300
refused "'Grains/Density' cannot be '1e300'" --set Grains/Density=1e300
refused "'Time/End time' cannot be '1e300': expected a number >= 0, of a size" --set 'Time/End time=1e300'
refused "Domain: in x it reaches from 0 to 1e\+20 m; expected" --set 'Domain/Upper right corner=1e20, 1'
refused "Domain: in y it reaches from 0 to 1e-12 m; expected" --set 'Domain/Upper right corner=1, 1e-12'
refused "Extra walls: the wall 'net: 0.001, 0.002 -> 0.001, 0.002' has no length" --set 'Grains/Extra walls=net: 0.001, 0.002 -> 0.001, 0.002'
refused "Extra walls: the wall .0, 0.002 -> 1e-15, 0.002' is 1e-15 m long; expected" --set 'Grains/Extra walls=0, 0.002 -> 1e-15, 0.002'
refused "Extra walls: expected .* in metres, got '0, 0.002 -> 1e300, 0.002'" --set 'Grains/Extra walls=0, 0.002 -> 1e300, 0.002'
for deposit in 'settled bed/Smallest diameter' 'random suspension/Smallest diameter' 'lattice/Diameter'; do
  refused "The deposit '${deposit%/*}' cannot have a '${deposit#*/}' of 1e-20 m; expected" --set "Grains/Deposit=${deposit%/*}" --set "Grains/Deposit: $deposit=1e-20"
done

table() { # ROW
  printf 'x,y,radius,density,vx\n0.001,0.001,5e-4,2630,0\n%s\n' "$1" >table.csv
}
own=(--set 'Grains/Deposit: file/File=table.csv')
table 0.003,0.003,1e-12,2630,0
refused 'table.csv, line 3: radius = 1e-12: expected metres, from 1e-09 to' "${own[@]}"
table 0.003,0.003,1e300,2630,0
refused 'table.csv, line 3: radius = 1e\+300: expected' "${own[@]}"
table 0.003,0.003,1e-4,1e300,0
refused 'table.csv, line 3: density = 1e\+300: expected' "${own[@]}"
table 0.003,0.003,1e-4,2630,1e300
refused 'table.csv, line 3: a velocity = 1e\+300: expected' "${own[@]}"

# a grain that is small beside the others: it is named, not the one that moves
printf 'x,y,radius,density,vx\n0.001,0.001,5e-4,2630,10\n0.003,0.003,2e-9,2630,0\n' >table.csv
must_fail 'Grain 1 at \(0.003, 0.003\) m has a radius of 2e-09 m' 1 tiny.prm "${own[@]}" --set Fluid/Model=none
table 0.001,0.0015005,1e-6,2630,0
refused 'Grain 1 at \(0.001, 0.0015005\) m, of diameter 2e-06 m, overlaps grain 0' "${own[@]}" --set 'Grains/Overlap tolerance=1e-9'
