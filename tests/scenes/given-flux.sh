#!/bin/bash
# A given velocity is a flux, on every mesh: through a slot narrower than a cell, under a bed that rests on the inlet, beside
# no-slip walls, on ranks. Parts of sides by name.
# SLOW
. "$SCENES/functions"
scene_from tiny <<'END'
subsection Boundary conditions
  set No-slip walls =
  set Slip walls    = left, right
  set Velocity      = bottom: 0 | 0.01
end
subsection Grains
  set Fixed = true
end
subsection Output
  set Overwrite output folder = true
  set Interval of statistics  = 0
end
END

flux_must_be() { # COLUMN FLUX WHAT
  python3 - "$@" <<'END' || fail "$3"
import csv, sys
row = list(csv.DictReader(open("output/statistics.csv")))[-1]
name, wanted = sys.argv[1], float(sys.argv[2])
given, measured = float(row["flux_%s_m2_per_s" % name]), float(row["flux_top_m2_per_s"])
print(sys.argv[3], given, measured)
sys.exit(not (abs(given + wanted) <= 1e-10 * wanted and abs(measured - wanted) <= 1e-8 * wanted))
END
}

for size in 0.5 1 4; do
  must_run 1 tiny.prm --set "Mesh refinement/Criteria: uniform/Cell size=$size"
  flux_must_be bottom 4e-5 "the bed on the inlet, cells of $size d"
  [ $size = 4 ] && ranks=1 || ranks=2 # a single cell
  must_run $ranks tiny.prm --set "Mesh refinement/Criteria: uniform/Cell size=$size" --set 'Boundary conditions/Slip walls=' \
    --set 'Boundary conditions/No-slip walls=left, right'
  flux_must_be bottom 4e-5 "between no-slip walls, cells of $size d"
  must_run 1 tiny.prm --set "Mesh refinement/Criteria: uniform/Cell size=$size" --set 'Boundary conditions/No-slip walls=bottom' \
    --set 'Domain/Named parts=inlet = bottom: 0.0031 < x < 0.0033' --set 'Boundary conditions/Velocity=inlet: 0 | 0.1'
  flux_must_be inlet 2e-5 "a slot, cells of $size d"
  must_run 1 tiny.prm --set "Mesh refinement/Criteria: uniform/Cell size=$size" \
    --set 'Boundary conditions/Velocity=bottom: 0 | if(abs(x-0.0032)<1e-4, 0.1, 0)'
  flux_must_be bottom 2e-5 "a slot by formula, cells of $size d"
done

# a part that covers its side leaves nothing of it that wants a condition
must_run 1 tiny.prm --set 'Domain/Named parts=inlet = bottom: x < 1' --set 'Boundary conditions/Velocity=inlet: 0 | 0.01'
flux_must_be inlet 4e-5 "a part that is the whole side"
must_fail "there is no boundary named 'bottom'" 1 tiny.prm --set 'Domain/Named parts=inlet = bottom: x < 1'

must_fail "Domain/Named parts: .*expected a range" 1 tiny.prm --set 'Domain/Named parts=inlet = bottom: 1'
must_fail "Domain/Named parts: .*there is no boundary named 'lid'" 1 tiny.prm --set 'Domain/Named parts=inlet = lid: x < 1'
must_fail "'b' and 'a' overlap on 'bottom'" 1 tiny.prm --set 'Domain/Named parts=a = bottom: x < 0.002; b = bottom: x > 0.001'
must_fail "boundary 'inlet' has none" 1 tiny.prm --set 'Domain/Named parts=inlet = bottom: x < 0.001'
