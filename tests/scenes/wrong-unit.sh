#!/bin/bash
# Scenes in millimetres, and beds that cannot fit, are refused at once and in little memory; wide boxes with few grains are not.
# SLOW
. "$SCENES/functions"
ulimit -v 8000000

cat >base.prm <<END
subsection Time
  set End time  = 2e-3
  set Time step = 1e-3
end
subsection Domain
  set Upper right corner = 0.01, 0.02
end
subsection Boundary conditions
  set Slip walls = left, right
  set Pressure   = top: 0; bottom: rho*g*H
end
subsection Grains
  subsection Deposit: settled bed
    set Number of grains  = 100
    set Smallest diameter = 0.5e-3
    set Cache folder      =
  end
end
subsection Output
  set Interval of pictures = 0
end
END
printf 'x,y,radius\n0.005,0.005,2e-4\n0.003,0.006,2e-4\n' >two.csv
printf 'x,y,radius\n0.005,0.012,1e-6\n' >silt.csv

quick() { # SECONDS COMMAND...: a bound on processor time
  local before after
  before=$(awk '{ print $16 + $17 }' /proc/$$/stat)
  "${@:2}"
  after=$(awk '{ print $16 + $17 }' /proc/$$/stat)
  [ $((after - before)) -le $(($1 * 100)) ] || fail "$((after - before)) hundredths of a second for: ${*:2}"
}

# a rectangle in mm: by its mesh, and without a fluid by its size in diameters
quick 3 must_fail "Are lengths in mm" 1 base.prm --set 'Domain/Upper right corner=10, 20'
quick 3 must_fail "Are lengths in mm" 1 base.prm --set 'Domain/Upper right corner=10, 20' --set 'Fluid/Model=none'
must_run 1 base.prm --check --set 'Domain/Upper right corner=10, 20' --set 'Fluid/Model=none' \
  --set 'Domain/Max diameters across=1e5'
quick 3 must_fail "Are lengths in mm" 1 base.prm --set 'Domain/Upper right corner=1000, 2000' \
  --set 'Grains/Deposit: settled bed/Number of grains=0' --set 'Grains/Deposit: settled bed/Bed height=500'
# a mesh in mm
cat >mm.msh <<END
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$PhysicalNames
2
1 1 "side"
2 2 "all"
\$EndPhysicalNames
\$Nodes
4
1 0 0 0
2 10 0 0
3 10 20 0
4 0 20 0
\$EndNodes
\$Elements
5
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 1 1 3 4
4 1 2 1 1 4 1
5 3 2 2 1 1 2 3 4
\$EndElements
END
dry=(--set 'Grains/Deposit=file' --set 'Fluid/Model=none')
quick 3 must_fail "Are lengths in mm" 1 base.prm "${dry[@]}" --set 'Domain/Mesh file=mm.msh' \
  --set 'Grains/Deposit: file/File=two.csv'

# what cannot fit
for n in 10000 100000 3000000; do
  quick 3 must_fail "cannot fit" 1 base.prm --set "Grains/Deposit: settled bed/Number of grains=$n"
done

# few grains in a wide box
quick 3 must_run 1 base.prm "${dry[@]}" --set 'Domain/Upper right corner=1, 2' --set 'Grains/Deposit: file/File=two.csv'
rm -r output
quick 3 must_run 1 base.prm "${dry[@]}" --set 'Grains/Deposit: file/File=silt.csv'

# SIGTERM ends a set-up
"$ALLUVIUM" base.prm --set 'Domain/Upper right corner=0.1, 1' --set 'Output/Output folder=other' \
  --set 'Grains/Deposit: settled bed/Number of grains=50000' >screen-output 2>error-output </dev/null &
pid=$!
sleep 2
kill -TERM $pid
for ((i = 0; i < 20; ++i)); do
  kill -0 $pid 2>/dev/null || break
  sleep 0.1
done
kill -9 $pid 2>/dev/null && fail "SIGTERM does not end a set-up"
wait $pid
[ ! -e other ] || fail "it left a folder"
