"""Test of contrib/steps.py: what of a step's text it finds wrong."""

import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "contrib"))
sys.dont_write_bytecode = True
import steps

SCENE = "set A = 1\n\nsubsection B\n  set C = 2 # why\n  set D = 3\nend\n"
OUTPUT = "speed = 16.753 +- 0.03  # [mm/s]\ncells = 1568 +- 0.1  # cells\ncpu = 3.4 +- free  # s\nsmall = 4.8e-05 +- 1e-06  # [d]\n"
GOOD = """Text with 16.75<!-- speed --> mm/s on 1,568<!-- cells --> cells in 3<!-- cpu --> s, 4.8e-5<!-- small --> d.

<!-- from a.prm -->
```
set A = 1
...
subsection B
  set C = 2 # why
```

[a scene](a.prm), [elsewhere](https://www.dealii.org)

<!-- printed by a -->
```
  costs  800 steps; 3.9 s
```
"""


def problems(text):
    with tempfile.TemporaryDirectory() as folder:
        for name, content in (("a.prm", SCENE), ("output", OUTPUT), ("README.md", text)):
            with open(os.path.join(folder, name), "w") as file:
                file.write(content)
        return steps.check_text(folder)


def expect(condition, what):
    if not condition:
        sys.exit("FAILED: " + what)


expect(problems(GOOD) == [], "a good text: %s" % problems(GOOD))
for good, bad, wanted in (("16.75<", "16.85<", "the text says 16.85 for speed"),
                          ("16.75<", "17<", None),  # rounded
                          ("1,568<", "1,500<", "the text says 1,500"),
                          ("3<!-- cpu", "4<!-- cpu", "the text says 4 for cpu"),
                          ("4.8e-5", "4.8e-4", "the text says 4.8e-4"),
                          ("<!-- speed", "<!-- sped", "nothing of this name"),
                          ("  set C = 2 # why", "  set C = 2", "not in a.prm"),
                          ("...\n", "", "not in a.prm"),
                          ("from a.prm", "from b.prm", "there is no b.prm"),
                          ("from a.prm", "form a.prm", "a mark that nothing belongs to"),
                          ("(a.prm)", "(c.prm)", "there is no c.prm")):
    found = problems(GOOD.replace(good, bad, 1))
    expect(found == [] if wanted is None else any(wanted in problem for problem in found), "%s: %s" % (bad, found))

numbers = {"a": (1.0, 0.1, ""), "cpu": (5.0, steps.FREE, "")}
expect(steps.compare(numbers, {"a": (1.09, 0.1, ""), "cpu": (50.0, steps.FREE, "")}) == [], "within the tolerance")
expect(len(steps.compare(numbers, {"a": (1.2, 0.1, ""), "cpu": (5.0, steps.FREE, "")})) == 1, "outside the tolerance")
expect(len(steps.compare(numbers, {"a": (float("nan"), 0.1, ""), "cpu": (5.0, steps.FREE, "")})) == 1, "not a number")
expect(len(steps.compare(numbers, {"a": (1.0, 0.1, "")})) == 1, "not printed")
expect(steps.masked("  grain  12.5e-3 m, in /tmp/x/output  3") == steps.masked("  grain 7 m, in /home/output 100"), "numbers, paths and columns are masked")
print("ok")
