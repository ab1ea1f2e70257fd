#!/bin/bash
# A bed is thrown up on two ranks, in short steps, and its mesh changes dozens of times: also where a rank owns as many nodes as before
# and has other neighbours. Each step is that of one rank, until round-off has grown.
# SLOW
. "$SCENES/functions"
scene_from bed <<'END'
subsection Mesh refinement
  set Interval = 4
  subsection Criteria: bed faces
    set Half width = 1
  end
end
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 6*rho*g*L
end
subsection Time
  set Time step = 1.25e-4
  set End time  = 24e-3
end
subsection Contacts
  set Least grains a rank = 20
end
END
must_run 2 bed.prm --set 'Output/Output folder=two'
must_run 1 bed.prm --set 'Output/Output folder=one'
changes() { grep -o '"mesh adaptations": [0-9]*' "$1/summary.json" | cut -d' ' -f3; }
[ "$(changes two)" -ge 10 ] || fail "expected the mesh to change"
for folder in one two; do
  head -n 42 $folder/statistics.csv >$folder.csv
done
must_agree one.csv two.csv --tolerance 1e-4 --ignore flux_imbalance
