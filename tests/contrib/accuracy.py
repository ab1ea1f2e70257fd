"""What `Accuracy` chooses: the table in the program's source and in README.md are what doc/lab/accuracy/results.csv gives, and of settings with
known errors the right ones are chosen."""

import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path[:0] = [os.path.join(ROOT, "contrib"), os.path.join(ROOT, "contrib", "python")]

from laboratory import accuracy, running, study  # noqa: E402
from laboratory.study import Missing, Result, Results  # noqa: E402

studied = study.Study(os.path.join(ROOT, "doc", "lab", "accuracy"))

# --- the tables are what was measured
file = os.path.join(ROOT, "doc", "lab", "accuracy", "results.csv")
rows = {(row["series"], row["label"]): row for row in running.read_rows(file)}
points = studied.points(False)
missing = [p.name for p in points if (p.series, p.label) not in rows]
assert not missing, "run contrib/lab accuracy: %s" % missing
found = [running.from_row(rows[p.series, p.label], p) for p in points]
found += studied.module.taken(False)
studied.compare(found)
results = Results(found, studied.get("floor"))
choices = accuracy.choose(studied, results)
assert accuracy.rows() == accuracy.table(choices), "run contrib/lab choose: source/scene/accuracy_table.h is not what the results give"
with open(os.path.join(ROOT, "README.md")) as readme:
    assert "\n".join(accuracy.readme_table(studied, results)) in readme.read(), "run contrib/lab choose: README.md"


# --- rungs with known errors
def chosen(errors, cpu=None, floor=None):
    """Of the ladder of dry scenes, whose rungs change the runout by `errors`: the rungs for 10 %, 1 %, 0.1 %."""
    module, known = studied.module, []
    exact = {module.NAMES[name]: module.reference[module.NAMES[name]] for _, names in module.SCENES.values() for name in names}
    for p in points:
        rungs = [module.label_of("runout", levels) for levels in accuracy.LADDERS["dry"]]
        at = rungs.index(p.label) if p.label in rungs else None
        values = {**exact, **({"runout [m]": exact["runout [m]"] * (1 + errors[at])} if at is not None else {})}
        known.append(Result(p, "done", 0, "", 1.0 if at is None or not cpu else cpu[at], values, "", ""))
    known += module.taken(False)
    studied.compare(known)
    return [accuracy.LADDERS["dry"].index(c.levels) for c in accuracy.choose(studied, Results(known, floor or {})) if c.kind == "dry"]


cheap_first = (1, 2, 3, 4, 5)
assert len(accuracy.LADDERS["dry"]) == len(cheap_first)
assert chosen((0.5, 0.05, 0.005, 0.0005, 0), cheap_first) == [1, 2, 3]
# a loose rung that is right by luck, beside a tighter one that is not, is not taken
assert chosen((0, 0.5, 0.005, 0.0005, 0), cheap_first) == [2, 2, 3]
# a tighter one that is cheaper is
assert chosen((0.5, 0.05, 0.005, 0.0005, 0), (1, 4, 2, 3, 5)) == [2, 2, 3]
# what is not known of the reference is no error
assert chosen((0.5, 0.05, 0.02, 0.02, 0.02), cheap_first, {"runout": 0.03}) == [1, 2, 2]
# where none does, the tightest is taken
assert chosen((0.5, 0.4, 0.3, 0.2, 0.15), cheap_first) == [4, 4, 4]
try:
    accuracy.choose(studied, Results([], {}))
    assert False, "ladders that were not run give no table"
except Missing:
    pass
