#!/bin/bash
# A named part of a side that is open to grains: they leave through it and nowhere else, and are counted under its name.
. "$SCENES/functions"
scene_from dry-bed <<'END'
subsection Time
  set End time = 0.1
end
subsection Domain
  set Named parts    = hole = bottom: 0.001 < x < 0.003
  set Open to grains = hole
end
subsection Output
  set Observers            = motion, bed, leavers
  set Interval of pictures = 0.001
  set Digits               = 17
end
END
for ranks in 1 2; do
  must_run $ranks dry-bed.prm --set "Output/Output folder=out-$ranks"
  /usr/bin/python3 - out-$ranks <<'END' || fail "out-$ranks"
import csv, json, os, sys
sys.path.insert(0, os.environ["SCENES"] + "/../../contrib")
import vtu
folder = sys.argv[1]
rows = list(csv.DictReader(open(folder + "/statistics.csv")))
summary = json.load(open(folder + "/summary.json"))
left = summary["grains that left"]
assert list(left) == ["hole"] and 20 < left["hole"]["number"] < 200, left
assert left["hole"]["number"] == float(rows[-1]["grains_left"])
gone, before = 0, {}
for time, files in vtu.read_pvd(folder + "/grains.pvd"):
    grains = vtu.read_vtu(files)
    now = dict(zip(grains.fields["id"], zip(grains.points, grains.fields["radius"])))
    for id, ((x, y, _), r) in now.items():
        # in the box; beside the hole nobody is in the floor, in it nobody beyond its ends
        assert 0.99 * r < x < 0.004 - 0.99 * r, (time, id, x)
        assert y > 0.99 * r or 0.001 < x < 0.003, (time, id, x, y)
    for id in before.keys() - now.keys():
        (x, y, _), r = before[id]
        assert 0.001 < x < 0.003 and y < 0.0004, (time, id, x, y)
        gone += 1
    before = now
# a grain that has crossed in the last step is counted, and taken out in the next
assert 0 <= left["hole"]["number"] - gone <= 5, (gone, left)
END
done
cmp out-1/statistics.csv out-2/statistics.csv || fail "two ranks differ"
must_run 1 dry-bed.prm --set 'Output/Output folder=half' --set 'Time/End time=0.04'
must_run 1 dry-bed.prm --set 'Output/Output folder=half' --set 'Output/Restart=true'
cmp out-1/statistics.csv half/statistics.csv || fail "a restart differs"
# the same side with another hole, beside the bed's middle: nobody leaves where it is closed
must_fail "no boundary named 'whole'" 1 dry-bed.prm --set 'Output/Output folder=no' --set 'Domain/Open to grains=whole'
