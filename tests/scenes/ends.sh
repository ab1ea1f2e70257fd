#!/bin/bash
# However a run ends, summary.json says how, log.txt has what was printed, and there is a checkpoint to go on from.
# SLOW
. "$SCENES/functions"

ended() { # LINES of `path = regex`
  "$SCENES/check-summary" output/summary.json <<<"$1" || fail "summary.json"
}

scene_from bed </dev/null

# Finished, and prolonged.
must_run 1 bed.prm --set 'Time/End time=0.005'
ended $'ended = ^finished$\nexit_code = ^0$\ntime_s = ^0.005$\nreason = end time'
[ -d output/checkpoint ] || fail "a finished run left no checkpoint"
grep -q 'pieces of grains' output/log.txt || fail "log.txt has not what was printed"
must_run 1 bed.prm --set 'Time/End time=0.008' --set 'Output/Restart=true'
ended $'ended = ^finished$\ntime_s = ^0.008$'
[ "$(wc -l <output/statistics.csv)" -eq 10 ] || fail "expected a header and 9 rows"
[ "$(grep -c '^--- alluvium' output/log.txt)" -eq 2 ] || fail "the log of a restart goes on in the same file"

# The last step ends at the end time; where little is left for it, it shares with the one before.
for end in 0.005 0.0041 0.001; do
  rm -rf output
  must_run 1 bed.prm --set "Time/End time=$end" --set 'Time/Time step=0.002'
  ended "ended = ^finished\$
time_s = ^$end\$"
  /usr/bin/python3 - "$end" <<'END' || fail "the steps to t = $end"
import csv, sys
times = [float(row["time_s"]) for row in csv.DictReader(open("output/statistics.csv"))]
expected = {"0.005": [0, 0.002, 0.004, 0.005], "0.0041": [0, 0.002, 0.00305, 0.0041], "0.001": [0, 0.001]}[sys.argv[1]]
assert len(times) == len(expected) and all(abs(a - b) < 1e-12 for a, b in zip(times, expected)), times
END
done
must_run 1 bed.prm --set 'Time/End time=0.004' --set 'Time/Time step=0.002' --set 'Output/Restart=true'
ended $'time_s = ^0.004$'
rm -rf output

# A step that is longer than the run is as long as the run, before anything is tried with it.
for step in 0.001 1000; do
  must_run 1 bed.prm --set 'Time/End time=0.001' --set "Time/Time step=$step" --set "Output/Output folder=output-$step"
done
must_agree output-0.001/statistics.csv output-1000/statistics.csv --tolerance 0
must_run 1 bed.prm --set 'Time/End time=0.001' --set 'Time/Time step=auto' --set 'Time/Automatic time step/Largest time step=1000'
rm -rf output output-0.001 output-1000

# A grain leaves the domain, some steps after the start, as the floor gives way under it: the mistake of a user.
printf 'x,y,radius\n0.001,0.00015,0.0001\n0.002,0.004,0.0001\n' >two.csv
for ranks in 1 2; do
  rm -rf output
  must_fail 'Grain 0 .*left' $ranks bed.prm --set 'Grains/Motion of walls=bottom: 0, -0.05' --set 'Time/End time=0.2' \
    --set 'Grains/Deposit: file/File=two.csv' --set 'Grains/Fluid packing fraction=0' \
    --set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H'
  ended $'ended = ^failed$\nexit_code = ^1$\nreason = left\nrun/checkpoint = ^step [0-9]+\nrun/steps = ^[1-9]'
  grep -q 'left' output/log.txt || fail "log.txt has not the error"
  [ "$(wc -l <output/statistics.csv)" -gt 3 ] || fail "no statistics"
done

# The checkpoint of a failed run is one to restart from.
time=$(/usr/bin/python3 -c 'import json, re; print(re.search("t = ([0-9.e-]+)", json.load(open("output/summary.json"))["run"]["checkpoint"])[1])')
must_run 2 bed.prm --set 'Grains/Motion of walls=bottom: 0, -0.05' --set "Time/End time=$(awk "BEGIN { print $time + 0.002 }")" \
  --set 'Grains/Deposit: file/File=two.csv' --set 'Grains/Fluid packing fraction=0' \
  --set 'Boundary conditions/Pressure=top: 0; bottom: rho*g*H' --set 'Output/Restart=true'
ended $'ended = ^finished$'

# Killed: what there is says so.
rm -rf output
"$ALLUVIUM" bed.prm --set 'Time/End time=1000' >screen-output 2>error-output </dev/null &
for ((i = 0; i < 300; ++i)); do
  [ "$(wc -l 2>/dev/null <output/statistics.csv || echo 0)" -gt 4 ] && break
  sleep 0.1
done
kill -s KILL $!
wait $! 2>/dev/null
ended $'ended = ^failed$\nreason = killed'
