"""contrib/lab on a small study: it lists, runs, resumes, shows what fails, checks claims, draws and reports.

  lab.py BUILD-FOLDER"""

import csv
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
STUDY = '''"""Discs that fall.

A small study.
"""
from laboratory.study import Chart, Map, Point

scene = "scene.prm"
always = {"Output/Interval of statistics": 0.01}
chart = CHART


def points(quick):
    yield Point("fine", "0.1 ms", {"Time/Time step": 1e-4}, x=1, y=1, reference=True)
    yield Point("coarse", "1 ms", {"Time/Time step": 1e-3}, x=2, y=1, default=True)
    yield Point("coarse", "bad", {"Time/Time step": -1}, x=3, y=1)
    yield Point("coarse", "nothing", command=["sh", "-c", "echo it broke; exit 7"], x=4, y=2)
    yield Point("coarse", "wrong number", {"Time/Time step": 2e-3, "Time/End time": 0.005}, x=5, y=2)
    if not quick:
        yield Point("coarse", "5 ms", {"Time/Time step": 5e-3}, x=5, y=1)


def measure(run, point):
    step = lambda: float(run.parameter("Time/Time step"))
    return {"sum": 1 + step() if run.time[-1] > 0.009 else float("nan")}


def error(values, reference):
    return abs(values["sum"] / reference["sum"] - 1)


def says(r):
    return "One millisecond is wrong by %.2g." % r.error("coarse", "1 ms")


def claims(r):
    yield "it falls", lambda: r.value("fine", "0.1 ms", "sum"), "<", BOUND
    yield "a step that is negative fails", lambda: r.failed("coarse", "bad"), "==", 1
    yield "only in full", lambda: r.error("coarse", "5 ms"), "<", 1
'''


def lab(*arguments):
    result = subprocess.run([os.path.join(ROOT, "contrib", "lab"), "--build", build, "--studies", studies, "--to", target, "--scratch", os.path.join(folder, "scratch"),
                             "--jobs", "2", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return result.returncode, result.stdout


def write(chart="Chart()", bound="2"):
    with open(os.path.join(studies, "falling", "study.py"), "w") as file:
        file.write(STUDY.replace("CHART", chart).replace("BOUND", bound))


def text(*path):
    with open(os.path.join(target, *path)) as file:
        return file.read()


def rows():
    return {row["label"]: row for row in csv.DictReader(text("falling", "results.csv").splitlines())}


build = os.path.abspath(sys.argv[1])
with tempfile.TemporaryDirectory() as folder:
    studies, target = os.path.join(folder, "studies"), os.path.join(folder, "results")
    os.makedirs(os.path.join(studies, "falling"))
    with open(os.path.join(studies, "falling", "scene.prm"), "w") as file:
        file.write("include part.prm\nsubsection Grains\n set Deposit = lattice\n subsection Deposit: lattice\n  set Diameter = 1e-3\n  set Area fraction = 0.2\n end\nend\n")
    with open(os.path.join(studies, "falling", "part.prm"), "w") as file:
        file.write("set Gravity = 0, -9.81\nsubsection Time\n set End time = 0.01\nend\nsubsection Domain\n set Upper right corner = 0.01, 0.02\nend\nsubsection Fluid\n set Model = none\nend\n"
                   "subsection Output\n set Observers = bed\nend\n")
    write()
    code, said = lab("--list")
    assert code == 0 and "Discs that fall (6 points, quick 5)" in said, said
    code, said = lab("no-such-study")
    assert code == 1 and "there is no study 'no-such-study'; there are: falling" in said, said

    # what fails is said, kept and shown, with its reason; the claims hold
    code, said = lab("falling", "--quick", "--check")
    assert code == 0 and "5 points, 5 to run" in said and "holds: it falls" in said and "not looked at: only in full" in said, said
    assert "coarse, nothing: FAILED, exit code 7: it broke" in said, said
    found = rows()
    assert found["1 ms"]["status"] == "done" and float(found["1 ms"]["error"]) > 0 and float(found["1 ms"]["cpu_s"]) > 0, found
    assert found["bad"]["status"] == "failed" and found["bad"]["exit_code"] == "1" and "Time step" in found["bad"]["reason"], found
    assert "nothing was measured: sum" in found["wrong number"]["reason"], found
    page = text("falling", "README.md")
    assert "One millisecond is wrong by" in page and "| coarse, nothing | 7 | it broke |" in page and "| 10 % | coarse, 1 ms |" in page, page
    for end in (".png", ".svg"):
        assert os.path.getsize(os.path.join(target, "falling", "falling" + end)) > 1000
    assert ">bad<" in text("falling", "falling.svg") and "failed" in text("falling", "falling.svg")

    # what has been run is not run again, failed or not; what is new is; another scene is another point
    code, said = lab("falling")
    assert code == 0 and "6 points, 1 to run" in said and "holds: only in full" in said, said
    with open(os.path.join(studies, "falling", "part.prm"), "a") as file:
        file.write("# another text\n")
    code, said = lab("falling", "--quick")
    assert code == 0 and "5 points, 4 to run" in said, said  # the command has no scene

    # a claim that does not hold is a failure, on the page too; a map has crosses
    write(chart='Map(x="a", y="b", value="sum", lines=lambda s: [("theory", [1, 2], [1, 2])])', bound="1e-6")
    code, said = lab("falling", "--quick", "--check")
    assert code == 1 and "DOES NOT HOLD: it falls" in said and "0 to run" in said, said
    assert "**does not hold**" in text("falling", "README.md") and "theory" in text("falling", "falling.svg")

    # the list of all, and the report
    with open(os.path.join(target, "README.md"), "w") as file:
        file.write("before\n<!-- studies: contrib/lab index -->\nold\n<!-- end of studies -->\nafter\n")
    code, said = lab("index", "--quick")
    page = text("README.md")
    assert code == 0 and "old" not in page and "[Discs that fall](falling/README.md)" in page and page.startswith("before") and page.endswith("after\n"), said + page
    try:
        import markdown_it
    except ImportError:
        sys.exit(0)
    code, said = lab("report", "--quick")
    page = text("report.html")
    assert code == 0 and "data:image/png;base64," in page and "<h1>Discs that fall</h1>" in page, said
