#!/bin/bash
# A signal ends a run after its present step: exit code 0, a checkpoint, a valid summary that says so, and a run that can go on.
# SLOW
. "$SCENES/functions"
scene_from bed <<END
subsection Contacts
  set Residual tolerance = 1e-5
  set Largest violation  = 1e-3
end
subsection Time
  set End time = 1000
end
END

interrupted() { # SIGNAL RANKS
  local run=("$ALLUVIUM" bed.prm) pid
  [ "$2" -eq 1 ] || run=(mpirun -np "$2" "${run[@]}")
  rm -rf output
  "${run[@]}" >screen-output 2>error-output </dev/null &
  pid=$!
  for ((i = 0; i < 300; ++i)); do
    [ "$(wc -l 2>/dev/null <output/statistics.csv || echo 0)" -gt 4 ] && break
    sleep 0.1
  done
  kill -s "$1" $pid
  wait $pid || fail "exit code $? after SIG$1 on $2 rank(s)"

  [ -d output/checkpoint ] && [ ! -e output/checkpoint.new ] || fail "no checkpoint, or half of one"
  /usr/bin/python3 - <<'END' || fail "summary.json or statistics.csv is not as it should be"
import csv, json
summary = json.load(open("output/summary.json"))
assert summary["ended"] == "interrupted" and summary["exit_code"] == 0 and "SIG" in summary["reason"], summary
run = summary["run"]
assert summary["time_s"] == run["time_s"]
assert run["interrupted"] is True and run["time_s"] < 1000 and run["steps"] > 3, run
rows = list(csv.reader(open("output/statistics.csv")))
assert len(rows) == run["steps"] + 2 and all(len(row) == len(rows[0]) for row in rows), len(rows)
assert abs(float(rows[-1][0]) - run["time_s"]) < 1e-4 * run["time_s"]
END
  rows=$(wc -l <output/statistics.csv)
  must_run 1 bed.prm --set 'Output/Restart=true' \
    --set "Time/End time=$(tail -n 1 output/statistics.csv | awk -F, '{ print $1 + 0.002 }')"
  [ "$(wc -l <output/statistics.csv)" -eq $((rows + 2)) ] || fail "expected two more rows after the restart"
  grep -q '"interrupted": false' output/summary.json || fail "the restarted run was not interrupted"
}

interrupted TERM 1
interrupted INT 1
interrupted USR1 2 # what mpirun hands on
