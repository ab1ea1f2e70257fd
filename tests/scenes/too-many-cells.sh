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
refused 'ask for about [0-9.e+]+ cells, and .Max cells. is' --set 'Mesh refinement/Criteria=uniform, bed faces' --set "$fine" \
  --set 'Mesh refinement/Criteria: uniform/Cell size=0.001'
refused 'unrefined cells of .* would be .*Max cells' --set 'Mesh refinement/Criteria=uniform' --set "$fine" \
  --set 'Mesh refinement/Criteria: uniform/Cell size=0.001'
refused 'ask for about' --set "$fine" --set 'Mesh refinement/Criteria: bed faces/Cell size at the top=0.001'
refused 'ask for about' --set 'Mesh refinement/Criteria=function' --set "$fine" \
  --set 'Mesh refinement/Criteria: function/Cell size=if(x > 0.001, 0.001, 4)'
refused 'ask for about' --set 'Mesh refinement/Criteria=moving grains, void fraction' --set "$fine" \
  --set 'Mesh refinement/Criteria: void fraction/Cell size=0.001' --set 'Mesh refinement/Criteria: void fraction/Threshold=0'
refused 'unrefined cells of .* would be .*Max cells' --set 'Domain/Coarse cell size=1e-7'
# fine unrefined cells, and finer ones in a part of the domain
refused 'ask for about' --set 'Domain/Coarse cell size=1e-6' --set 'Mesh refinement/Criteria=function' --set "$fine" \
  --set 'Mesh refinement/Criteria: function/Cell size=if(x > 0.002, 0.001, 4)'
# cells are as square as they can be, so a flat domain has many
refused 'unrefined cells of .* would be .*Max cells' --set 'Grains/Deposit=none' \
  --set 'Domain/Coarse cell size=1e-3' --set 'Domain/Upper right corner=1, 1e-9'
# a mesh file, whose cells are there already
refused 'ask for about' --set 'Domain/Mesh file=data/bed.msh' --set "$fine" \
  --set 'Mesh refinement/Criteria: bed faces/Cell size at the top=0.001' --set 'Boundary conditions/Slip walls=left, right'
