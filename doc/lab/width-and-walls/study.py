"""Narrow beds heave later: their walls hold them.

The paper's bed at its full height, 0.13 m in 0.3 m of water, in boxes from 16 to 64 diameters wide, and with both conventions for the mass: discs weigh as they touch
(the paper), or as the water sees them. A bed of a tenth of that height shows what the walls' friction (0.4) does: to settle 600 layers between smooth walls takes too long. The sample of 227 diameters is run with `--heavy` only, on two ranks. The ramp starts where the bed is all but carried, and goes on as the paper's.
The onset by balance of forces counts what the floor carries, so friction at the sides shows in it.
"""
import csv
import os

from laboratory.study import Curves, Point

order = 42
scene = "tall-bed.prm"
limit = 3000
MOTION, SUPPORT = "mass in motion", "what the floor carries"
LATER = "head at the heave, over the onset's"
D = 2.2e-4


def full_size():
    """[(width over d, head at the heave over the exact onset, head [m])] of the paper's sample, from the study of its figure."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "paper-figure", "results.csv")) as file:
        return [(0.05 / D, float(row["value: head at total heave [m]"]) / float(row["value: exact head [m]"]), float(row["value: head at total heave [m]"]))
                for row in csv.DictReader(file) if row["label"] == "full size" and row["status"] == "done"]


def beside(panel, results):
    if panel != LATER:
        return
    found = sorted([(r.values["width over d"], r.values["heave over exact"]) for r in results
                    if r.done and r.point.series == "walls with friction" and "low" not in r.point.label] + [full[:2] for full in full_size()])
    yield "by width; the widest is the paper's", [w for w, _ in found], [h for _, h in found], "both"


chart = Curves(panels={MOTION: ("head over the bed / exact onset", "mass that moved by d [%]"), SUPPORT: ("head over the bed / exact onset", "force on the floor / weight"),
                       LATER: ("width over d", "head at heave / exact onset")}, log={LATER: "x"}, beside=beside)


def box(w):
    return {"Domain/Upper right corner": "%g, 0.3" % w}


def ramp(start):
    """Pressure at the bottom: up to `start` of the water column's weight at once, then as the paper's."""
    return {"Boundary conditions/Pressure": "top: 103e3; bottom: 103e3 + rho*g*H*(1 + min(20*t, %g + (t - %g)))" % (start, start / 20)}


# made between smooth walls, too: else the bed would hang on walls that let go of it
SMOOTH = {"Contacts/Wall friction coefficient": 0, "Grains/Deposit: settled bed/Friction while settling": 0}


def points(quick):
    low = {"Grains/Deposit: settled bed/Bed height": 0.012, "Domain/Upper right corner": "0.0036, 0.03", **ramp(0.55), "Time/End time": 0.25}
    yield Point("walls with friction", "16 d, low", low)
    yield Point("smooth walls", "16 d, low, smooth", {**low, **SMOOTH})
    if quick:
        return
    for w, word in [(0.0036, "16 d"), (0.0072, "33 d"), (0.0144, "65 d")]:
        yield Point("walls with friction", word, {**box(w), **ramp(0.62)}, heavy=w > 0.01)
    yield Point("weighs what the water sees", "16 d, light", {**box(0.0036), "Grains/Mass follows": "fluid radius", **ramp(0.3)})


def measure(run, point):
    summary = run.summary
    onset, heave = summary["onset by force balance"], summary["total heave"]
    exact = onset["exact_head_m"]
    width = float(str(point.settings["Domain/Upper right corner"]).split(",")[0])
    return {"width over d": width / D, "exact head [m]": exact, "onset over exact": onset["over_exact"], "bed height [m]": run.columns["bed_height_m"][0],
            "head at first movement [m]": summary["first movement"]["differential_head_m"], "head at heave [m]": heave["differential_head_m"],
            "heave over exact": heave["differential_head_m"] / exact, "heave [s]": heave["time_s"]}


def curves(run, point):
    """Over the differential head, since scenes of other height and mass have other times."""
    exact = run.summary["onset by force balance"]["exact_head_m"]
    rows = [i for i, head in enumerate(run.columns["differential_head_m"]) if head > 0.9 * exact]
    return {MOTION: ([run.columns["differential_head_m"][i] / exact for i in rows], [100 * run.columns["moved_mass_fraction"][i] for i in rows]),
            SUPPORT: ([run.columns["differential_head_m"][i] / exact for i in rows], [run.columns["floor_force_over_weight"][i] for i in rows])}


LOW, SMOOTH_LOW = ("walls with friction", "16 d, low"), ("smooth walls", "16 d, low, smooth")


def claims(r):
    yield "walls with friction hold a bed of 16 d longer than smooth ones", lambda: r.value(*LOW, "heave over exact") - r.value(*SMOOTH_LOW, "heave over exact"), ">", 0.0
    yield "between smooth walls the onset is exact within 0.5 %", lambda: abs(r.value(*SMOOTH_LOW, "onset over exact") - 1), "<", 5e-3
    yield "a bed twice as wide heaves earlier", lambda: r.value("walls with friction", "16 d", "heave over exact") - r.value("walls with friction", "33 d", "heave over exact"), ">", 0.0


def says(r):
    value = lambda label, name, series="walls with friction": r.value(series, label, name)
    exact = 100 * value("16 d", "exact head [m]")
    return ("At the full height a bed of 16 d heaves at %.1f cm of head, of 33 d at %.1f cm, the paper's of 227 d at %.1f cm; the exact onset is at %.1f cm. A bed of 55 layers and 16 d heaves at %.2f times its exact onset between walls with friction, at %.2f between smooth ones. "
            "A bed that weighs what the water sees, as sand does, has its onset at %.1f cm and heaves at %.1f cm: what mass is meant matters more than all else here."
            % (100 * value("16 d", "head at heave [m]"), 100 * value("33 d", "head at heave [m]"), 100 * full_size()[0][2], exact, r.value(*LOW, "heave over exact"), r.value(*SMOOTH_LOW, "heave over exact"),
               100 * value("16 d, light", "exact head [m]", "weighs what the water sees"), 100 * value("16 d, light", "head at heave [m]", "weighs what the water sees")))
