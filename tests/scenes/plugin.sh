#!/bin/bash
# Plug-ins from a shared library (tests/plugin/plugins.cc) that the scene names: a drag law whose flux follows its parameter, boundary
# conditions that do what a formula does, a new kind of them, with --check, --print-parameters, on two ranks, in a restart and from the
# parameters.prm of the run; and what is said of libraries that are no good.
# SLOW
. "$SCENES/functions"
mkdir scene elsewhere && mv data scene && cp "$TEST_PLUGINS" scene/libplug-ins.so
{ echo "include $SCENES/data/bed.prm" && cat; } >scene/bed.prm <<'END'
set Additional shared libraries = ./libplug-ins.so
subsection Time
  set End time  = 2
  set Time step = 0.4
end
subsection Fluid
  set Convection = false
end
subsection Boundary conditions
  set Pressure = top: 0; bottom: rho*g*H + 0.01*rho*g*L
end
subsection Coupling
  set Drag law = linear
end
subsection Grains
  set Fixed = true
end
END
# relative to the scene, wherever the program is started
cd elsewhere
none=(--set 'Additional shared libraries=')
must_fail "parameter 'Coupling/Drag law' cannot be 'linear'" 1 ../scene/bed.prm "${none[@]}"
must_run 1 ../scene/bed.prm --check
grep -q 'drag law    linear' screen-output || fail "--check does not know the law"
must_run 1 ../scene/bed.prm --print-parameters
grep -A6 'subsection Drag law: linear' screen-output >section
grep -q 'The same drag everywhere \[N s/m^4\]' section && grep -q 'set Resistance = ' section || fail "its parameter is not printed"
grep -q "'linear': A constant, for tests" screen-output || fail "its explanation is not printed"
must_run 1 --print-parameters --set 'Additional shared libraries=../scene/libplug-ins.so'
grep -q "'rising water': Hydrostatic" screen-output || fail "without a scene, libraries are not relative to where one is"

for resistance in 2e7 4e7 8e7; do
  must_run 1 ../scene/bed.prm --set "Coupling/Drag law: linear/Resistance=$resistance" \
    --set "Output/Output folder=output-$resistance"
done
must_run 2 ../scene/bed.prm --set "Coupling/Drag law: linear/Resistance=2e7" --set "Output/Output folder=output-two-ranks"
must_agree output-2e7/statistics.csv output-two-ranks/statistics.csv --ignore flux_imbalance

/usr/bin/python3 - <<'END' || fail "the flux does not follow the drag law"
import json
flux = [json.load(open("output-%s/summary.json" % r))["flux"]["top_m2_per_s"] for r in ("2e7", "4e7", "8e7")]
print("flux %g %g %g m^2/s" % tuple(flux))
assert flux[0] > 0 and all(abs(a / b - 2) < 0.02 for a, b in zip(flux, flux[1:])), flux
END

# boundary conditions: those of a formula
conditions=(--set 'Coupling/Drag law: linear/Resistance=2e7' --set 'Boundary conditions/Pressure=top: 0')
must_run 1 ../scene/bed.prm "${conditions[@]}" --set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H*(1 + 0.003*t)' \
  --set 'Output/Output folder=formula'
rising=(--set 'Boundary conditions/Plug-ins=bottom: rising water' --set 'Boundary conditions/Plug-ins: rising water/Rate=0.003')
must_run 1 ../scene/bed.prm "${conditions[@]}" "${rising[@]}" --set 'Output/Output folder=plug-in'
must_agree formula/statistics.csv plug-in/statistics.csv --ignore flux_imbalance
must_run 1 ../scene/bed.prm "${conditions[@]}" --set 'Boundary conditions/Velocity=bottom: 0 | 1e-5' --set 'Output/Output folder=v-formula'
must_run 1 ../scene/bed.prm "${conditions[@]}" --set 'Boundary conditions/Plug-ins=bottom: suction' \
  --set 'Boundary conditions/Plug-ins: suction/Velocity=1e-5' --set 'Output/Output folder=v-plug-in'
must_agree v-formula/statistics.csv v-plug-in/statistics.csv --ignore flux_imbalance

# a kind of boundary condition that the program does not have: a wall with pores above the bed, whose resistance adds to the bed's
pressed=(--set 'Coupling/Drag law: linear/Resistance=2e7' --set Output/Observers=flux)
leaky=("${pressed[@]}" --set 'Boundary conditions/Pressure=bottom: rho*g*H + 1' --set 'Boundary conditions/Leaky walls=top: 1e-5 | 0')
must_run 1 ../scene/bed.prm --check "${leaky[@]}"
grep -q 'top: leaky 1e-5 | 0, a wall' screen-output || fail "--check does not know the kind"
for ranks in 1 2; do
  must_run $ranks ../scene/bed.prm "${leaky[@]}" --set "Output/Output folder=leaky-$ranks"
done
must_agree leaky-1/statistics.csv leaky-2/statistics.csv --ignore flux_imbalance
must_run 1 ../scene/bed.prm "${pressed[@]}" --set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H + 1' --set 'Output/Output folder=open'
/usr/bin/python3 - <<'END' || fail "the flux through the wall is not what its conductance says"
import csv, json
flux = lambda folder: json.load(open(folder + "/summary.json"))["flux"]["top_m2_per_s"]
pressure, width, conductance = 1, 0.004, 1e-5
of_bed, of_both = flux("open"), flux("leaky-1")
expected = pressure / (pressure / of_bed + 1 / (conductance * width))
imbalance = float(list(csv.DictReader(open("leaky-1/statistics.csv")))[-1]["flux_imbalance"])
print("flux %g m^2/s through the bed, %g through bed and wall, expected %g, imbalance %g" % (of_bed, of_both, expected, imbalance))
assert 0.2 * of_bed < of_both < 0.8 * of_bed and abs(of_both / expected - 1) < 1e-3 and abs(imbalance) < 1e-8
END
must_fail "Boundary conditions/Leaky walls: boundary 'top': '-1 . 0' is -1 at .*; expected a conductance of at least 0" 1 ../scene/bed.prm \
  "${leaky[@]}" --set 'Boundary conditions/Leaky walls=top: -1 | 0' --check

# a restart, also from parameters.prm beside the scene (its grains' file is relative); the library keeps its place
must_run 1 ../scene/bed.prm "${conditions[@]}" "${rising[@]}" --set 'Output/Output folder=half' --set 'Time/End time=0.8'
cp half/parameters.prm ../scene/used.prm
must_run 1 ../scene/used.prm --set Output/Restart=true --set 'Time/End time=2'
grep -q 'changed: Additional' screen-output && fail "the library seems to have changed"
must_agree plug-in/statistics.csv half/statistics.csv --ignore flux_imbalance
mkdir third && cp ../scene/used.prm third && ln -s ../../scene/data third/data
must_run 1 third/used.prm --check --set 'Output/Output folder=new'

# what is no good
must_fail "there is no boundary condition named 'tide'; known are: rising water, suction" 1 ../scene/bed.prm \
  --set 'Boundary conditions/Plug-ins=bottom: tide'
must_fail "Boundary conditions/Plug-ins: boundary 'bottom' already has another condition" 1 ../scene/bed.prm \
  --set 'Boundary conditions/Plug-ins=bottom: suction'
must_fail "Boundary conditions/Plug-ins: there is no boundary named 'floor'" 1 ../scene/bed.prm "${conditions[@]}" \
  --set 'Boundary conditions/Plug-ins=floor: suction'
must_fail "Plug-ins: expected .name: plug-in., got 'suction'" 1 ../scene/bed.prm --set 'Boundary conditions/Plug-ins=suction'
library() { # NAME [options of the compiler]: from C++ on the standard input
  c++ -x c++ -shared -fPIC -o "../scene/$1" - "${@:2}" || fail "no library"
}
must_fail "Additional shared libraries: '/.*/scene/libmine.so': there is no such file" 1 ../scene/bed.prm --set 'Additional shared libraries=libmine.so'
must_fail "bed.prm' cannot be loaded: .*invalid ELF header" 1 ../scene/bed.prm --set 'Additional shared libraries=bed.prm'
library libundefined.so <<<'int missing(); int x = missing();'
must_fail "libundefined.so' cannot be loaded: .*undefined symbol: .*missing" 1 ../scene/bed.prm --set 'Additional shared libraries=libundefined.so'
library libempty.so <<<'int x;'
must_fail "libempty.so' was loaded, but it registers no plug-in" 1 ../scene/bed.prm --set 'Additional shared libraries=libempty.so'
cp ../scene/libplug-ins.so ../scene/libagain.so
must_fail "libagain.so' has a plug-in named '.*', and there is one of this name and kind already" 1 ../scene/bed.prm \
  --set 'Additional shared libraries=libplug-ins.so, libagain.so'
library liballuvium_core.so.0.0 -Wl,-soname,liballuvium_core.so.0.0 <<<'int other_version;'
library libold.so -L../scene -l:liballuvium_core.so.0.0 -Wl,-rpath,"$PWD/../scene" <<<'extern int other_version; int &x = other_version;'
must_fail "libold.so' was built against another version of Alluvium: it wants '.*liballuvium_core.so.0.0' beside" 1 ../scene/bed.prm \
  --set 'Additional shared libraries=libold.so'
must_fail "libundefined.so' cannot be loaded" 2 ../scene/bed.prm --set 'Additional shared libraries=libundefined.so'
