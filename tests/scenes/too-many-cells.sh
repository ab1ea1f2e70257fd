#!/bin/bash
# Meshes of too many cells are refused by counting, before a cell is made, whatever asks for them. (Making as many as are allowed here,
# to find that there are more, would take minutes.)
. "$SCENES/functions"
scene_from bed </dev/null
refused() { # REGEX SETTING...
  local begin=$SECONDS
  must_fail "$1" 1 --check bed.prm --set 'Mesh refinement/Max cells=1e8' --set 'Mesh refinement/Max levels=25' "${@:2}"
  [ $((SECONDS - begin)) -le 15 ] || fail "it took $((SECONDS - begin)) s to find too many cells"
}
fine='Mesh refinement/Finest cell size=0.001'
refused 'unrefined cells of .* would be .*Max cells' --set 'Mesh refinement/Criteria=uniform, bed faces' --set "$fine" \
  --set 'Mesh refinement/Criteria: uniform/Cell size=0.001'
refused 'unrefined cells of .* would be .*Max cells' --set 'Mesh refinement/Criteria=uniform' --set "$fine" \
  --set 'Mesh refinement/Criteria: uniform/Cell size=0.001'
refused 'ask for about' --set "$fine" --set 'Mesh refinement/Criteria: bed faces/Cell size at the top=0.001'
refused 'ask for about' --set 'Mesh refinement/Criteria=function' --set "$fine" \
  --set 'Mesh refinement/Criteria: function/Cell size=if(x > 0.001, 0.001, 4)'
refused 'unrefined cells of .* would be .*Max cells' --set 'Domain/Coarse cell size=1e-7'
# fine unrefined cells, and finer ones in a part of the domain
refused 'ask for about' --set 'Domain/Coarse cell size=1e-6' --set 'Mesh refinement/Criteria=function' --set "$fine" \
  --set 'Mesh refinement/Criteria: function/Cell size=if(x > 0.002, 0.001, 4)'
# cells are as square as they can be, so a flat domain has many
refused 'unrefined cells of .* would be .*Max cells' --set 'Grains/Deposit=none' \
  --set 'Domain/Coarse cell size=1e-3' --set 'Domain/Upper right corner=1, 1e-9'
# a mesh file, whose cells are there already
cat >two.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
1 1 "bottom"
1 2 "right"
1 3 "top"
1 4 "left"
2 5 "fluid"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 0.004 0 0
3 0.004 0.003 0
4 0.004 0.006 0
5 0 0.006 0
6 0 0.003 0
$EndNodes
$Elements
8
1 1 2 1 1 1 2
2 1 2 2 2 2 3
3 1 2 2 2 3 4
4 1 2 3 3 4 5
5 1 2 4 4 5 6
6 1 2 4 4 6 1
7 3 2 5 1 1 2 3 6
8 3 2 5 1 6 3 4 5
$EndElements
END
refused 'ask for about' --set 'Domain/Mesh file=two.msh' --set 'Mesh refinement/Max cells=1e7' --set "$fine" --set 'Mesh refinement/Criteria: bed faces/Cell size at the top=0.001'
