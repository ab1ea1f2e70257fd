#!/usr/bin/python3
"""contrib/new-scene: every combination of answers is a scene that passes --check, or is refused in one clear line; one scene of each kind
runs a few steps; questions take the same answers; bad answers are named."""

import concurrent.futures
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NEW_SCENE = os.path.join(ROOT, "contrib", "new-scene")
ALLUVIUM = os.path.abspath(sys.argv[1])
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
SMALL = "%s 10 x 8"
GRAINS = "%s, 0.5-0.6 mm, 40"


def new_scene(*arguments, text=""):
    return subprocess.run([NEW_SCENE, "--alluvium", ALLUVIUM, *arguments], input=text, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def answers(what, where, fluid, grains, drive):
    return ["--what", what, "--where", where, "--fluid", fluid, "--grains", grains, "--drive", drive]


def impossible(what, where, fluid, drive):
    return ((fluid == "none" and drive not in ("gravity", "slope")) or (drive in ("seepage", "jet") and (what != "bed" or where == "box"))
            or (drive == "lid" and (what == "column" or where == "tank")) or (drive == "slope" and what == "suspension"))


def one(combination):
    what, where, fluid, grains, drive = combination
    name = "-".join(combination) + ".prm"
    result = new_scene(*answers(what, SMALL % where, fluid, GRAINS % grains, drive), "--output", name)
    if impossible(what, where, fluid, drive):
        good = result.returncode == 1 and re.fullmatch(r"new-scene: error: drive: .*\n", result.stderr) and not os.path.exists(name)
    else:
        good = (result.returncode == 0 and not result.stderr and "passes alluvium --check" in result.stdout
                and re.search(r"Costs: .* steps; roughly .* on an idle machine", result.stdout))
    return None if good else "%s: exit code %d\n%s%s" % (name, result.returncode, result.stdout, result.stderr)


def runs(combination):
    """A few steps of a scene, whose grains stay in the domain."""
    name = "-".join(combination)
    command = [ALLUVIUM, name + ".prm", "--set", "Time/End time=0.005", "--set", "Time/Time step=5e-4", "--set", "Output/Interval of pictures=0",
               "--set", "Output/Progress=silent"]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=ENVIRONMENT)
    if result.returncode != 0:
        return "%s: exit code %d\n%s" % (name, result.returncode, result.stdout)
    with open("output-%s/summary.json" % name) as file:
        summary = json.load(file)
    return None if summary["ended"] == "finished" and summary["bed"]["final_height_m"] > 0 else "%s: %s" % (name, summary)


def must_refuse(expected, *arguments, text=""):
    result = new_scene(*arguments, text=text)
    lines = result.stderr.splitlines()
    assert result.returncode == 1 and lines[-1].startswith("new-scene: error: "), (arguments, result)
    assert re.search(expected, lines[-1]), (expected, lines[-1])
    assert "Traceback" not in result.stderr, result.stderr


def bad_answers():
    good = dict(what="bed", where="tank 20 x 12", fluid="water", grains="sand", drive="gravity")
    for name, answer, expected in (
            ("what", "heap", "what: 'heap' is none of: bed, column, suspension"),
            ("what", "", "what: '' is none of"),
            ("where", "lake 20 x 12", "'lake' is none of: box, tank, channel"),
            ("where", "box 20", "width and height in mm"),
            ("where", "box 0 x 12", "above 0"),
            ("where", "box 2 x 12", "at least ten diameters"),
            ("fluid", "beer", "'beer' is none of: water, glycerol, air, none, and no density and viscosity"),
            ("fluid", "1000", "no density and viscosity"),
            ("fluid", "1000 1e9", "expected 0.01 to 20000 and 1e-6 to 1000"),
            ("fluid", "5000 1e-3", "do not sink"),
            ("grains", "peas", "'peas' is none of: sand, glass, plastic, and no density"),
            ("grains", "sand, big", "neither diameters such as"),
            ("grains", "sand, 0.4-0.3 mm", "the smallest first"),
            ("grains", "sand, 0.3 mm, 100000", "do not fit: .* takes at most"),
            ("grains", "2", "expected 10 to 30000"),
            ("drive", "hope", "'hope' is none of: gravity, slope, seepage, jet, lid")):
        options = {**good, name: answer}
        must_refuse(expected, *answers(*options.values()), "--output", "bad.prm")
        assert not os.path.exists("bad.prm"), answer
    must_refuse("no answer to: Where", "--what", "bed")
    must_refuse("does not end in .prm", *answers(*good.values()), "--output", "bad.txt")
    must_refuse("cannot be written", *answers(*good.values()), "--output", "no/such/folder/bad.prm")
    open("there.prm", "w").close()
    must_refuse("there is a 'there.prm' already", *answers(*good.values()), "--output", "there.prm")
    assert os.path.getsize("there.prm") == 0


def questions():
    """The same answers, typed, some of them wrong at first or left out."""
    typed = "mess\nbed\nbox 12 x 8\nwater\nsand, 0.4 mm, 60\nlid\n"
    result = new_scene("--output", "typed.prm", text=typed)
    assert result.returncode == 0 and "'mess' is none of" in result.stderr, result
    result = new_scene(*answers("bed", "box 12 x 8", "water", "sand, 0.4 mm, 60", "lid"), "--output", "typed-2.prm")
    assert result.returncode == 0, result
    with open("typed.prm") as one, open("typed-2.prm") as other:
        assert one.read().replace("typed", "typed-2") == other.read()
    result = new_scene(text="\n\n\n\n\n")
    assert result.returncode == 0 and os.path.exists("bed-tank-water-sand-gravity.prm"), result


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    bad_answers()
    questions()
    # grains differ in nothing but their density: they take turns
    combinations = itertools.product(("bed", "column", "suspension"), ("box", "tank", "channel"), ("water", "glycerol", "air", "none"),
                                     ("gravity", "slope", "seepage", "jet", "lid"))
    combinations = [(*c[:3], ("sand", "glass", "plastic")[i % 3], c[3]) for i, c in enumerate(combinations)]
    kinds = {}
    for c in combinations:
        if not impossible(c[0], c[1], c[2], c[4]):
            kinds.setdefault((c[0], c[4], c[2] == "none"), []).append(c)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        failures = [f for f in pool.map(one, combinations) if f]
        # of each kind not always the first one, so that fluids, grains and places differ
        chosen = [scenes[(7 * i) % len(scenes)] for i, scenes in enumerate(kinds.values())]
        failures += [f for f in pool.map(runs, chosen) if f]
    print("%d combinations, %d of which are scenes; ran %d" % (len(combinations), sum(map(len, kinds.values())), len(chosen)))
    if failures:
        sys.exit("\n".join(failures[:5]) + "\n%d failures" % len(failures))
