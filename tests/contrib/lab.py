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
    yield "and so do two more", lambda: r.failed("coarse", "nothing") + r.failed("coarse", "wrong number"), "==", 2
    yield "only in full", lambda: r.error("coarse", "5 ms"), "<", 1
'''


# grains that our program has settled, for another program, which counts its own time; and one that is not there at first
COMPARED = '''"""Two programs.

They have the same grains.
"""
import json
import numpy
from laboratory import peers
from laboratory.study import Chart, Point

scene, bed, chart, jobs = "scene.prm", "bed.prm", Chart(), 1
program, cpu_says = peers.program, "Times are of steps."
COUNT = "import json, sys; print(json.dumps({'program': 'Peer 3.1', 'cpu_s': 0.125, 'grains': sum(line[:1].isdigit() for line in open(sys.argv[1]))}))"
LATER = "test -e %r/there && echo '{\\"program\\": \\"Late 1.0\\", \\"cpu_s\\": 0.5, \\"grains\\": 7}' || { echo 'Late is not installed: buy it' >&2; exit 3; }"


def points(quick):
    yield Point("ours", "from the table", {"Grains/Deposit": "file", "Grains/Deposit: file/File": "{bed}"}, reference=True)
    yield Point("theirs", "counts", command=["{peers}", "-c", COUNT, "{bed}"])
    yield Point("theirs", "later", command=["sh", "-c", LATER % FOLDER])


def measure(run, point):
    if point.command:
        return {"CPU [s]": peers.said(run)["cpu_s"], "grains": peers.said(run)["grains"]}
    return {"CPU [s]": peers.cpu_of_steps(run), "grains": run.summary["scene"]["grains"]}


def error(values, reference):
    return abs(values["grains"] / reference["grains"] - 1)


def says(r):
    return "Peers have %g grains." % r.value("theirs", "counts", "grains")


def claims(r):
    yield "all have 40 grains", lambda: r.value("theirs", "counts", "grains"), "==", 40
    yield "the other runs", lambda: r.failed("theirs", "later"), "==", 0
    yield "and has some grains", lambda: r.value("theirs", "later", "grains"), ">", 0
'''
BED = """set Gravity = 0, -9.81
subsection Time
 set End time = 1e-4
 set Time step = 1e-4
end
subsection Domain
 set Upper right corner = 0.002, 0.02
end
subsection Fluid
 set Model = none
end
subsection Grains
 set Deposit = settled bed
 subsection Deposit: settled bed
  set Number of grains = 40
 end
end
"""


def lab(*arguments):
    result = subprocess.run([os.path.join(ROOT, "contrib", "lab"), "--build", build, "--studies", studies, "--to", target, "--scratch", os.path.join(folder, "scratch"),
                             "--jobs", "2", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return result.returncode, result.stdout


def write(chart="Chart()", bound="2", replace=None):
    study = STUDY.replace("CHART", chart).replace("BOUND", bound)
    assert not replace or replace[0] in study, replace
    with open(os.path.join(studies, "falling", "study.py"), "w") as file:
        file.write(study.replace(*replace) if replace else study)


def text(*path):
    with open(os.path.join(target, *path)) as file:
        return file.read()


def rows(study="falling"):
    return {row["label"]: row for row in csv.DictReader(text(study, "results.csv").splitlines())}


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

    # a claim of a point that failed, or that is none, does not hold; a reference that fails leaves no picture of an earlier run
    for old, new, why in (('lambda: r.value("fine", "0.1 ms", "sum")', 'lambda: r.error("coarse", "bad")', "coarse, bad failed"),
                          ('r.failed("coarse", "nothing") + r.failed("coarse", "wrong number"), "==", 2', '2, "==", 2', "FAILED, and no claim expects it: coarse, nothing (exit code 7)"),
                          ('lambda: r.value("fine", "0.1 ms", "sum")', 'lambda: r.error("coarse", "worse")', "the study has no point 'coarse, worse'"),
                          ('{"Time/Time step": 1e-4}, x=1, y=1, reference=True', '{"Time/Time step": -1}, x=1, y=1, reference=True', "fine, 0.1 ms failed")):
        write(replace=(old, new))
        code, said = lab("falling", "--quick", "--check")
        assert code == 1 and why in said and "points failed" in said, said
    assert not os.path.exists(os.path.join(target, "falling", "falling.png")) and "No picture" in text("falling", "README.md")

    # what has other settings now is not drawn as if it had not
    write(replace=('{"Time/Time step": 1e-3}', '{"Time/Time step": 1.5e-3}'))
    code, said = lab("falling", "--quick", "--redraw")
    assert code == 0 and "left out, since results.csv has other settings for them: 2 points" in said, said
    assert "Not run yet: 2 of 5 points: " in text("falling", "README.md"), text("falling", "README.md")

    # a mistake in a study is said in a line that names it
    for old, new, why in (("def measure", "def measures", "falling/study.py has no measure(run, point)"),
                          ('"scene.prm"', '"scenes.prm"', "the scene of the point 'fine, 0.1 ms', scenes.prm, is no file in"),
                          ('"1 ms", {', '"bad", {', "two points are called 'coarse, bad'"),
                          ('x=2, y=1, default', 'x=2, y=1, reference=True, default', "two points are the reference: 'fine, 0.1 ms' and 'coarse, 1 ms'"),
                          ("def error(values, reference):", "def error(values, reference)", "falling/study.py, line 27: SyntaxError: expected ':'"),
                          ('values["sum"]', 'values["sun"]', "falling/study.py, line 28, error() of the point 'fine, 0.1 ms': KeyError: 'sun'"),
                          ('return abs(values["sum"] / reference["sum"] - 1)', 'return float("nan")', "gives a number that is not finite"),
                          ('"<", 2', '"=<", 2', "one of < <= > >= ==, bound), got ('it falls'"),
                          ('lambda: r.error("coarse", "5 ms")', 'r.error("coarse", "5 ms")', "looks a number up at once (coarse, 5 ms was not run)"),
                          ("chart = Chart()", 'chart = Map(value="sun")', "the chart shows 'sun', which measure() does not give for the point 'fine, 0.1 ms'")):
        write(replace=(old, new))
        code, said = lab("falling", "--quick")
        assert code == 1 and why in said and "Traceback" not in said, said
    write()
    for arguments, why in ((["falling", "--read", "1 ms"], "--read: expected LABEL=FOLDER, got '1 ms'"), (["falling", "--read", "2 ms=" + folder], "falling has no point with the label '2 ms'"),
                           (["falling", "--read", "1 ms=" + folder], "is no run's folder of output"), (["all", "index"], "'all' goes without other names"),
                           (["all", "--check", "--studies", os.path.join(folder, "none")], "there is no folder of studies"),
                           (["all", "--check", "--studies", folder + "/scratch"], "holds no study"), (["falling", "--redraw", "--to", os.path.join(folder, "empty")], "nothing of it is known")):
        code, said = lab(*arguments)
        assert code == 1 and why in said and "Traceback" not in said, said

    # a run that is read must be the point's
    for step, label, right in (("1e-3", "1 ms", True), ("1e-3", "5 ms", False)):
        output = os.path.join(folder, "run-" + step)
        subprocess.run([os.path.join(build, "alluvium"), os.path.join(studies, "falling", "scene.prm"), "--set", "Output/Output folder=" + output, "--set", "Time/Time step=" + step,
                        "--set", "Output/Interval of statistics=0.01", "--set", "Output/Overwrite output folder=true"], check=True, stdout=subprocess.DEVNULL)
        code, said = lab("falling", "--read", "%s=%s" % (label, output))
        assert (code == 0) == right and ("has 'Time/Time step = 1e-3', the point 'coarse, 5 ms' has '0.005'" in said) != right, said

    # other programs: the same grains, their own time, their names; what is not installed is no failure of a claim, and is tried again
    os.makedirs(os.path.join(studies, "compared"))
    for name, words in (("study.py", COMPARED.replace("FOLDER", repr(folder))), ("bed.prm", BED), ("scene.prm", "include bed.prm\n")):
        with open(os.path.join(studies, "compared", name), "w") as file:
            file.write(words)
    code, said = lab("compared", "--check", "--peers", sys.executable)
    assert code == 0 and "holds: all have 40 grains" in said and said.count("not looked at") == 2 and "Late is not installed: buy it" in said, said
    found = rows("compared")
    assert found["counts"]["cpu_s"] == "0.125" and found["counts"]["version"] == "Peer 3.1" and found["counts"]["error"] == "0", found
    assert 0 < float(found["from the table"]["cpu_s"]) < 1, found
    page = text("compared", "README.md")
    assert "| theirs, later | 3 | Late is not installed: buy it |" in page and "Peer 3.1" in page and "Times are of steps." in page, page
    code, said = lab("compared", "--check")
    assert code == 0 and "3 points, 1 to run" in said and "not looked at" in said, said
    with open(os.path.join(folder, "there"), "w"):
        pass
    code, said = lab("compared", "--check")
    assert code == 0 and "3 points, 1 to run" in said and "holds: the other runs" in said and "not looked at" not in said and "Late 1.0" in text("compared", "README.md"), said
    code, said = lab("compared")
    assert code == 0 and "3 points, 0 to run" in said, said

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
