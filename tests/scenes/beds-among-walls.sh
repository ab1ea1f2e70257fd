#!/bin/bash
# Beds settle around what stands in the domain: a pile of the mesh, a slope, a plate; whatever way gravity points. They stay when
# the run starts.
# SLOW
. "$SCENES/functions"
at_rest() { # FOLDER NUMBER
  /usr/bin/python3 - "$1" "$2" <<'END' || fail "$1: the bed moves"
import csv, json, sys
rows = list(csv.DictReader(open(sys.argv[1] + "/statistics.csv")))
assert json.load(open(sys.argv[1] + "/summary.json"))["scene"]["grains"] == int(sys.argv[2])
assert float(rows[-1]["moved_mass_fraction"]) == 0, rows[-1]
assert float(rows[-1]["wall_force_over_weight"]) > 0.999, rows[-1]
END
}
slope() { # DIRECTION GRAVITY LOWER UPPER WALL
  cat >$1.prm <<END
set Gravity = $2
subsection Time
  set End time = 0.05
end
subsection Domain
  set Lower left corner  = $3
  set Upper right corner = $4
end
subsection Fluid
  set Model = none
end
subsection Grains
  set Extra walls = $5
  subsection Deposit: settled bed
    set Number of grains = 300
    set Cache folder     =
  end
end
subsection Output
  set Output folder = $1
  set Observers     = motion, support
end
END
  must_run 1 $1.prm
  at_rest $1 300
}
slope down '0, -9.81' '0, 0' '0.004, 0.008' 'slope: 0, 0.002 -> 0.004, 0.001'
slope right '9.81, 0' '-0.008, 0' '0, 0.004' 'slope: -0.002, 0 -> -0.001, 0.004'
slope left '-9.81, 0' '0, 0' '0.008, 0.004' 'slope: 0.002, 0.004 -> 0.001, 0; plate: 0.0065, 0 -> 0.0065, 0.004'
must_run 2 down.prm --set 'Output/Output folder=two'
at_rest two 300
# the cache tells walls from no walls
for walls in 'slope: 0, 0.002 -> 0.004, 0.001' ''; do
  must_run 1 down.prm --set 'Grains/Deposit: settled bed/Cache folder=kept' --set "Grains/Extra walls=$walls" --set "Output/Output folder=cached-${#walls}"
  at_rest cached-${#walls} 300
done
[ "$(ls kept | wc -l)" -eq 2 ] || fail "one cached bed for two scenes"
