"""What `Accuracy` chooses: the table in the program's source and in README.md are what doc/lab/accuracy/results.csv gives, and of levels with
known errors the right one is chosen."""

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
studied.compare(found)
results = Results(found, studied.get("floor"))
choices = accuracy.choose(studied, results)
assert accuracy.rows() == accuracy.table(choices), "run contrib/lab choose: source/scene/accuracy_table.h is not what the results give"
with open(os.path.join(ROOT, "README.md")) as readme:
    assert "\n".join(accuracy.readme_table(studied, results)) in readme.read(), "run contrib/lab choose: README.md"


# --- levels with known errors
def chosen(errors, floor=None):
    """Of contacts in dry scenes, whose levels change the runout by `errors`: what is chosen for 10 %, 1 %, 0.1 %."""
    known = []
    for p in points:
        values = {studied.module.NAMES[name]: studied.module.reference[studied.module.NAMES[name]] or 0.0 for _, names in studied.module.SCENES.values() for name in names}
        for level, error in errors.items():
            if (p.series, p.label) == studied.module.name_of("runout", "contacts", level):
                values["runout [m]"] *= 1 + error
        known.append(Result(p, "done", 0, "", 1.0, values, "", ""))
    studied.compare(known)
    return [c.level for c in accuracy.choose(studied, Results(known, floor or {})) if (c.kind, c.group) == ("dry", "contacts")]


levels = list(accuracy.LEVELS["dry"]["contacts"])
share = accuracy.SHARES["contacts"]
assert chosen(dict(zip(levels, (0.2 * share, 0.05 * share, 0.005 * share, 0)))) == [levels[1], levels[2], levels[3]]
# a loose level that is right by luck, beside a tighter one that is not, is not taken
assert chosen(dict(zip(levels, (0, 0.2 * share, 0.005 * share, 0)))) == [levels[2], levels[2], levels[3]]
# what no run knows costs nothing
assert chosen(dict(zip(levels, (0.2 * share, 0.05 * share, 0.005 * share, 0))), {"runout": 0.06 * share}) == [levels[1], levels[1], levels[1]]
try:
    accuracy.choose(studied, Results([], {}))
    assert False, "a scan that was not run gives no table"
except Missing:
    pass
