"""The paper's figure 3: motion and head, whatever the cells.

The paper raises the water pressure under a bed of 0.13 m and draws, for cells of 0.25 to 8 diameters at the bed's faces, the fraction of mass that has moved by a
diameter and the head over the bed. Here are the same two curves for 2,000 discs (the bed of `ramp.prm`, 9 mm high, where a run takes seconds), with cells refined once at
the faces, as in the paper, and with cells that follow them. The full size, 138,389 discs, is below: it takes tens of minutes on two ranks, and is run with `--heavy` only.

The paper reads 0.69 s, 0.72 s and 22 cm off its full size, and 19 cm off the experiment. What of that is exact: the bed weighs as one of discs packed phi_m, so it is carried at
the head (s phi_m - phi_b) L, a closed form (errors of the onset are against it): s is the grains' density over the water's, L the bed's height, phi_m and phi_b the packing by mass and the one that
the water sees ([theory](../../theory/equations.md)). What is not: the detector. A grain has to move by a diameter before it counts (the first movement is that of 5 % of the mass, the heave that of 95 %), and meanwhile the pressure rises. [How much](../ramp-and-lag/README.md) follows from the ramp; [walls](../width-and-walls/README.md) hold narrow beds longer.
So of the 1.8 cm between onset and heave at full size the formula for a rigid bed explains 1.4 cm of imposed head; water that has to come in below the bed, and walls, the rest.

What stays open: the paper prints neither the height of its bed nor of its box. 0.13 m in 0.3 m of water are ours, with 22 cm in mind. In a box of 0.3 m the paper's 0.69 s would be 20.7 cm, less than this bed's
onset, and 0.72 s could not give 22 cm: its box was higher than 0.305 m, its bed lower or lighter. A bed that weighs what the water sees, as sand does, would be carried at 11 cm; so the paper's weighs as its discs do.
Pictures and numbers of the two runs: [full-size](full-size/summary.json), [full-size-light](full-size-light/summary.json).

![The bed at full size](full-size/bed.png)
"""
import os
import shutil
import subprocess
import sys

import matplotlib.image

from laboratory import ROOT
from laboratory.meshes import at_faces
from laboratory.study import Curves, Point

order = 40
scene = "../fluidised-bed/ramp.prm"
limit = 1500
MOTION, HEAD, FULL_MOTION, FULL_HEAD = "mass in motion, 2,000 discs", "head over the bed, 2,000 discs", "mass in motion, full size", "head over the bed, full size"
FULL = {"full size": {}, "full size, weighs what the water sees": {"Grains/Mass follows": "fluid radius", "Time/End time": 0.55}}
PAPER = {"first movement": 0.69, "total heave": 0.72}  # [s]; the head at the heave is around 0.22 m
PAPER_HEAD, EXPERIMENT = 0.22, 0.19


def beside(panel, results):
    if not any(r.point.heavy and r.done for r in results):
        return
    exact = lambda label: [100 * r.values["exact head [m]"] for r in results if r.done and r.point.label == label]
    if panel == FULL_MOTION:
        yield "the paper's first movement and heave, read from its text", list(PAPER.values()), [5, 95], "marks"
    if panel == FULL_HEAD:
        yield "the paper's first movement and heave, read from its text", [PAPER["total heave"]], [100 * PAPER_HEAD], "marks"
        yield "the experiment's head at the heave", [0.3, 0.9], [100 * EXPERIMENT] * 2, "line"
        for label in FULL:
            if exact(label):
                yield "exact head of the onset", [0.3, 0.9], exact(label) * 2, "line"


chart = Curves(panels={MOTION: ("time [s]", "mass that moved by d [%]"), HEAD: ("time [s]", "differential head [mm]"),
                       FULL_MOTION: ("time [s]", "mass that moved by d [%]"), FULL_HEAD: ("time [s]", "differential head [cm]")}, beside=beside)
error_title = "error of the onset"


def points(quick):
    for h in [8, 2] if quick else [8, 4, 2, 1, 0.5, 0.25]:
        # what changes at the faces is refined at the start, and stays
        yield Point("refined at the start", "%g d" % h, {**at_faces(h), "Mesh refinement/Interval": 0}, reference=h == (2 if quick else 0.5))
    for h in [] if quick else [2, 1, 0.5]:
        yield Point("cells follow the faces", "%g d, following" % h, at_faces(h), default=h == 1)
    if not quick:
        for label, settings in FULL.items():
            yield Point("full size, 2 ranks", label, {"Output/Interval of pictures": 0.05, **settings}, scene="../../../prm/fluidised-bed-full.prm", ranks=2, heavy=True)


def measure(run, point):
    summary = run.summary
    start = 0.0 if point.heavy else 0.7  # of the ramp [s]
    values = {"onset over exact": summary["onset by force balance"]["over_exact"], "exact head [m]": summary["onset by force balance"]["exact_head_m"]}
    for event in PAPER:
        values[event + " [s]"] = start + summary[event]["time_s"]
        values["head at " + event + " [m]"] = summary[event]["differential_head_m"]
    return values


def curves(run, point):
    start, scale = (0.0, 100) if point.heavy else (0.7, 1000)
    motion, head = (FULL_MOTION, FULL_HEAD) if point.heavy else (MOTION, HEAD)
    rows = [i for i, t in enumerate(run.time) if start + t > (0.3 if point.heavy else 0.74)]
    times = [start + run.time[i] for i in rows]
    return {motion: (times, [100 * run.columns["moved_mass_fraction"][i] for i in rows]), head: (times, [scale * run.columns["differential_head_m"][i] for i in rows])}


def keep(folder, point, target):
    """Statistics, summary and the picture of the runs at full size."""
    if not point.heavy:
        return
    place = os.path.join(target, "full-size" if point.label == "full size" else "full-size-light")
    os.makedirs(place, exist_ok=True)
    for name in ("statistics.csv", "summary.json"):
        shutil.copy(os.path.join(folder, name), place)
    subprocess.run([sys.executable, os.path.join(ROOT, "contrib", "plot"), folder, "--to", place, "--snapshots", "3"], check=True)
    os.remove(os.path.join(place, "mesh.png"))
    bed = os.path.join(place, "bed.png")
    matplotlib.image.imsave(bed, matplotlib.image.imread(bed)[::2, ::2])  # 140,000 discs at full resolution are megabytes


def error(values, reference):
    same_bed = abs(values["exact head [m]"] / reference["exact head [m]"] - 1) < 0.05  # not that of the full size
    return {"the onset": abs(values["onset over exact"] - 1),
            "the head at heave": abs(values["head at total heave [m]"] / reference["head at total heave [m]"] - 1) if same_bed else None}


SCALED = ("refined at the start", "cells follow the faces")


def spread(r, name):
    found = [x.values[name] for s in SCALED for x in r.of(s) if x.done and name in x.values and x.point.label != "8 d"]
    return max(found) / min(found) - 1


def claims(r):
    yield "the onset is exact within 1 % with cells of 8 d", lambda: r.error("refined at the start", "8 d", "the onset"), "<", 1e-2
    yield "and within 0.1 % with cells of 2 d", lambda: r.error("refined at the start", "2 d", "the onset"), "<", 1e-3
    yield "the head at the heave differs by less than 5 % between cells of 8 d and the finest here", lambda: r.error("refined at the start", "8 d", "the head at heave"), "<", 5e-2
    yield "by less than 2 % among all from 4 d to 0.25 d", lambda: r.done("refined at the start", "0.25 d") and spread(r, "head at total heave [m]"), "<", 2e-2
    full = lambda name: r.value("full size, 2 ranks", "full size", name)
    yield "at full size the onset is exact within 0.1 %", lambda: abs(full("onset over exact") - 1), "<", 1e-3
    yield "the head at the heave is the paper's within a tenth", lambda: abs(full("head at total heave [m]") / PAPER_HEAD - 1), "<", 0.1


def says(r):
    coarse = r.done("refined at the start", "8 d")
    text = "From cells of 4 d to 0.25 d the head at the heave differs by %.1f %%, and cells of 8 d are %.1f %% off: the paper's finding, that cells hardly matter, holds. " % (
        100 * spread(r, "head at total heave [m]"), 100 * coarse.errors["the head at heave"])
    full = {x.point.label: x.values for x in r if x.point.heavy and x.done}
    if "full size" not in full:
        return text
    v, light = full["full size"], full.get("full size, weighs what the water sees")
    if light:
        after = (" A bed that weighs what the water sees is carried at %.1f cm and heaves at %.3f s and %.1f cm."
                 % (100 * light["exact head [m]"], light["total heave [s]"], 100 * light["head at total heave [m]"]))
    return text + ("At full size the bed is carried at %.1f cm, exact within %.2g %%; the first movement is seen at %.3f s, the heave at %.3f s and %.1f cm, where the paper has 0.69 s, 0.72 s and around 22 cm."
                   % (100 * v["exact head [m]"], 100 * abs(v["onset over exact"] - 1), v["first movement [s]"], v["total heave [s]"], 100 * v["head at total heave [m]"])) + (after if light else "")
