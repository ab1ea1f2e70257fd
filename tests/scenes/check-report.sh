#!/bin/bash
# What --check says of a scene, against formulas, and its permeability against the run's own.
# SLOW
. "$SCENES/functions"
scene_from bed <<'END'
subsection Time
  set End time = 0.0205
end
subsection Output
  set Observers = flux, head
end
END
number() { # REGEX with one group
  /usr/bin/python3 -c 'import re, sys; print(re.search(sys.argv[1], open("screen-output").read())[1])' "$1"
}
for mass in 'contact radius' 'fluid radius'; do
  must_run 1 --check bed.prm --set "Grains/Mass follows=$mass"
  /usr/bin/python3 - "$mass" "$(number 'critical gradient ([0-9.e-]+)')" "$(number "1 - n = [0-9.]+: ([0-9]+[.][0-9]+)")" \
    "$(number 'Archimedes number ([0-9.e-]+)')" "$(number 'stress of ([0-9.e-]+) Pa')" "$(number 'packing fraction ([0-9.e-]+) ')" <<'END' || fail "$mass"
import sys
mass, critical, terzaghi, archimedes, shields, contact = sys.argv[1], *map(float, sys.argv[2:])
s, phi = 2.63, 0.52
expected = s * (contact if mass == "contact radius" else phi) - phi
assert abs(critical / expected - 1) < 0.01, (critical, expected)
assert abs(terzaghi / ((s - 1) * phi) - 1) < 0.01, terzaghi
# of the mean grain as the fluid sees it
d, rho_p = 2.2e-4 * (phi / contact) ** 0.5, 2630 * (contact / phi if mass == "contact radius" else 1)
assert abs(shields / ((rho_p - 1000) * 9.81 * d) - 1) < 0.03, shields
assert abs(archimedes / ((rho_p - 1000) * 1000 * 9.81 * d ** 3 / 1e-6) - 1) < 0.06, archimedes
END
done
grep -q 'the same' screen-output || fail "with mass by fluid radius the gradients are the same"
must_run 1 --check bed.prm
grep -q 'They differ as' screen-output || fail "it does not say why the gradients differ"
for text in 'left: slip, a wall for grains' 'bottom: pressure rho\*g\*H.*, a wall for grains' 'tau_p' 'Courant number' 'Stokes number' '21 steps; roughly .* GB of memory'; do
  grep -q -- "$text" screen-output || fail "missing: $text"
done

# A time step above the limit of a scheme that has one: 2 eps^2 (1 - r) tau_p, r = (1 - eps)/(eps s); none in a bed of r > 1
limit_of() { # ARGUMENTS...
  must_run 1 --check "$@"
  grep -oE 'Time scheme = .*: the time step .*|Time scheme = .*: it is unstable at any time step at void fraction .*' error-output || true
}
suspension=("$SCENES/suspension.prm" --set 'Coupling/Time scheme=explicit')
found=$(limit_of "${suspension[@]}" --set 'Time/Time step=0.01' --set 'Time/End time=0.1')
/usr/bin/python3 - "$found" "$(number 'suspension of void fraction ([0-9.e-]+)')" "$(number 'tau_p [(]([0-9.e-]+) s')" <<'END' || fail "limit of the time step: '$found'"
import re, sys
mean, tau_p = map(float, sys.argv[2:])
number = lambda text: float(re.search(text, sys.argv[1])[1])
assert sys.argv[1].startswith("Time scheme = explicit: the time step of 0.01 s is "), sys.argv[1]
eps = number("at void fraction ([0-9.]+), that of the densest tenth")
assert 0.8 * mean < eps < mean, (eps, mean)
limit = 2 * eps**2 * (1 - (1 - eps) / eps / 2.63) * tau_p * (eps / mean)**2.8
assert abs(number("s is ([0-9.e+-]+) times its limit") / (0.01 / limit) - 1) < 0.08, limit
assert abs(number("use iterated, .*, or Time/Time step <= ([0-9.e-]+) [(]at t = 0 s") / limit - 1) < 0.08, limit
END
[ -z "$(limit_of "${suspension[@]}" --set 'Time/Time step=0.001')" ] || fail "a warning of a time step that is stable"
[ -z "$(limit_of "$SCENES/suspension.prm" --set 'Time/Time step=0.01' --set 'Time/End time=0.1')" ] || fail "a warning of a scheme without a limit"
limit_of bed.prm --set 'Coupling/Time scheme=implicit drag' --set 'Grains/Fluid packing fraction=0' |
  grep -qE 'at void fraction 0\.[12][0-9]*, that of the densest tenth of the grains, since this is below 1/\(1 \+ s\) = 0\.28 .*use iterated, which has no such limit' ||
  fail "no warning of a bed that has no stable time step"

# Grains that settle come to lie so dense that a step that was stable is so no longer: the run says so before it diverges.
[ -z "$(limit_of "$SCENES/suspension.prm" --set 'Coupling/Time scheme=implicit drag' --set 'Time/Time step=0.001')" ] || fail "stable at first"
alluvium 1 "$SCENES/suspension.prm" --set 'Coupling/Time scheme=implicit drag' --set 'Time/Time step=0.001' --set 'Time/End time=0.3' --set 'Output/Interval of pictures=0'
[ $? -eq 3 ] || fail "it should have diverged"
/usr/bin/python3 - <<'END' || fail "no warning of a step that has become too long"
import json, re
summary = json.load(open("output/summary.json"))
said = [w for w in summary["warnings"] if "times its limit of stability" in w]
assert len(said) == 1, summary["warnings"]
factor, first = float(re.search(r"s is ([0-9.]+) times", said[0])[1]), float(re.search(r"first at t = ([0-9.e-]+) s", said[0])[1])
assert 1 <= factor and 0 < first < summary["time_s"], said
END

# What touches nothing is no bed, and has no critical gradient; held where it is, it is one to the fluid.
must_run 1 --check "$SCENES/suspension.prm"
grep -q '^  suspension .*packing fraction' screen-output && grep -q 'held up at a superficial velocity' screen-output ||
  fail "a suspension"
! grep -qE '^  (bed|heave) |[^a-z]bed of' screen-output || fail "a suspension is called a bed"
must_run 1 --check "$SCENES/suspension.prm" --set Grains/Fixed=true
grep -q '^  bed ' screen-output || fail "a fixed bed"

# Darcy's law of the run
rm -r output
must_run 1 bed.prm --set 'Grains/Fixed=true' --set 'Time/Time step=0.01' --set 'Time/End time=0.2' --set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H + 0.05*rho*g*L'
/usr/bin/python3 - "$(number 'permeability ([0-9.e-]+) m')" "$(number 'bed +([0-9.e-]+) m to')" "$(number 'bed +[0-9.e-]+ m to ([0-9.e-]+) m')" <<'END' || fail "the permeability is not the run's"
import csv, sys
permeability, bottom, top = map(float, sys.argv[1:])
row = list(csv.DictReader(open("output/statistics.csv")))[-1]
measured = float(row["flux_top_m2_per_s"]) / 0.004 * 1e-3 / (1000 * 9.81 * float(row["differential_head_m"]) / (top - bottom))
print("permeability said", permeability, "measured", measured)
assert abs(permeability / measured - 1) < 0.07, (permeability, measured)
END
