"""A column collapses in a liquid, dense and loose.

Rondon, Pouliquen and Aussillous (Phys. Fluids 23, 2011, 073301) let columns of glass beads of 0.225 mm collapse in a liquid of 12 mPa s. What decides is how they are packed. A loose column (0.55) contracts as it shears, the liquid carries part of it, and
it runs out fast and far; a dense one (0.60) must dilate first, sucks liquid in, and creeps. Their fronts, the pressure of the liquid under the column and their final shapes are those of the tables that come with SedFoam's tutorial
2DCollapse (github.com/SedFoam/sedfoam, tutorials/Py/DATA/Rondon2012), read off by its authors. Beads, liquid and drag (law `sphere`) are the experiment's.

**Size and time.** The experiment's columns of 6 cm hold 50,000 beads in a plane; here they have 400 discs, 17 d high instead of 200, 1,200 and, with `--heavy`, 3,600, 51 d high. Lengths are over L_0. Times are over eta H_0/((rho_p - rho) g d^2), in which the liquid drains through a column as high as
that, 0.7 s in the experiment and 0.06 s here; pressures over phi (rho_p - rho) g H_0.

**How packing is mapped.** Discs cannot be packed 0.55. They are deposited as loosely and as densely as deposits go, %.2g (0.79 the 3,600) and %.2g by area; the fluid sees discs that are smaller, so that its packing is the experiment's, 0.55 and 0.60, and they weigh as
these. So drag, weight and head are right. What is not: by how much a bed contracts or dilates before it flows. Spheres at 0.55 and 0.60 are 3.5 %% below and 5.3 %% above the packing at which they flow (0.57 in SedFoam's model); discs at 0.78 and 0.83 are 2.5 %% below and 3.7 %% above
some 0.80. A third column, `loosened`, has discs of random sizes, %.2g by area, on a triangular lattice, which do not touch yet: looser than a deposit can be, it tells how much of the difference is the mapping's.

**What can be compared**, then: the order of the two, the sign of the pressure, its size over the weight, and the times' ratio. **What not**: lengths in beads, and what happens within a few beads of the front. The pressure of such small columns is not steady either: with 300 discs the loose one's mean over the
first unit of time was -0.11, with 400 it is positive.
"""
import math
import random

import numpy as np

from laboratory.study import Curves, Missing, Point

LOOSE, DENSE, LOOSENED = 0.78, 0.83, 0.73
__doc__ = __doc__ % (LOOSE, DENSE, LOOSENED)

order = 54
scene = "column.prm"
limit = 4000
G, D, DRHO, ETA, AREA = 9.81, 0.2255e-3, 1490.0, 0.01212, 4.0e-8  # mean diameter [m], area of a disc [m^2]
KINDS = {"loose": (LOOSE, 0.55, 4.8 / 6), "dense": (DENSE, 0.60, 4.2 / 6), "loosened": (LOOSENED, 0.55, 4.8 / 6)}  # packing of the discs, of the fluid, aspect ratio
FRONT, PRESSURE, SHAPE = "front", "pressure of the liquid under the column", "deposit"
EXPERIMENT = {"loose": (0.06, 0.048), "dense": (0.06, 0.042)}  # L_0, H_0 [m]

# Rondon and others 2011 as read off by SedFoam's authors: time [s], length [cm]; time [s], excess pressure 2 cm from the wall [Pa]; x, y [cm] of the deposit
FRONTS = {"loose": [(0.085, 6.921), (0.636, 16.271), (1.314, 19.719), (1.907, 20.301), (2.585, 20.747), (3.22, 21.022), (3.941, 21.161), (4.534, 21.231), (5.89, 21.201)],
          "dense": [(0.042, 7.092), (0.551, 8.765), (1.229, 8.358), (1.907, 9.282), (2.542, 9.523), (3.093, 9.797), (3.771, 10.448), (4.407, 11.201), (5.0, 11.475), (5.508, 11.648),
                    (6.229, 12.094), (7.5, 11.962), (8.686, 12.068), (10.0, 12.107)]}
PRESSURES = {"loose": [(1.127, 133.32), (1.972, 144.078), (3.38, 126.458), (4.507, 104.229), (5.915, 82.005), (6.479, 65.904), (8.169, 51.358), (8.732, 44.463), (10.704, 38.363)],
             "dense": [(1.127, -126.015), (1.972, -63.85), (3.38, -52.314), (6.197, -52.26), (7.324, -56.842), (8.732, -40.703), (10.423, -28.394)]}
SHAPES = {"loose": [(0.14, 2.617), (1.515, 2.383), (3.2, 2.358), (4.345, 2.202), (5.433, 2.047), (6.892, 1.865), (8.209, 1.684), (9.325, 1.58), (11.099, 1.373), (12.93, 1.166), (14.877, 0.907),
                    (16.537, 0.7), (18.283, 0.466), (19.801, 0.207)],
          "dense": [(0.401, 4.219), (1.632, 4.167), (2.692, 3.75), (3.608, 3.125), (4.553, 2.734), (5.47, 2.188), (6.386, 1.719), (7.56, 1.328), (8.648, 0.99), (9.794, 0.651), (10.825, 0.417),
                    (11.713, 0.208)]}


def clock(height):
    """Unit of time [s] of a column of this height [m]."""
    return ETA * height / (DRHO * G * D**2)


def size(kind, n):
    """L_0 and H_0 [m] of a column of n discs."""
    packing, _, aspect = KINDS[kind]
    width = math.sqrt(n * AREA / (packing * aspect))
    return width, aspect * width


def loosened(n):
    """CSV of n discs of random sizes near the places of a triangular lattice that do not touch."""
    draw = random.Random(1)
    width, _ = size("loosened", n)
    largest = 0.247e-3
    spacing = math.sqrt(AREA / LOOSENED * 2 / math.sqrt(3))
    columns = round(width / spacing - 0.5)
    pitch = width / (columns + 0.5)
    discs = []
    for k in range(n):
        row, column = divmod(k, columns)
        radius = 0.5 * draw.uniform(0.205e-3, 0.246e-3)
        room, angle = 0.5 * (min(pitch, spacing) - largest) * math.sqrt(draw.uniform(0, 1)), draw.uniform(0, 2 * math.pi)
        discs.append(((column + 0.5 + 0.5 * (row % 2)) * pitch + max(room, 0) * math.cos(angle), (0.5 + row * 0.5 * math.sqrt(3)) * spacing + max(room, 0) * math.sin(angle), radius))
    return "x,y,radius\n" + "".join("%.9g,%.9g,%.9g\n" % disc for disc in discs)


def column(kind, n, end, seed=1):
    packing, of_fluid, _ = KINDS[kind]
    packing = max(packing, 0.79) if n == 3600 and kind == "loose" else packing  # a deposit so large cannot be looser
    width, height = size(kind, n)
    step = end * clock(height) / 100
    places = {"Grains/Deposit": "file", "Grains/Deposit: file/File": "{folder}/discs.csv"} if kind == "loosened" else {
        "Grains/Deposit: settled bed/Box": "0, 0, %.5g, %.5g" % (width, 1.7 * height),
        "Grains/Deposit: settled bed/Number of grains": n, "Grains/Deposit: settled bed/Packing fraction": packing, "Grains/Deposit: settled bed/Seed": seed}
    return {**places, "Domain/Upper right corner": "%.5g, %.5g" % (5 * width, 2 * height), "Grains/Fluid packing fraction": of_fluid, "Time/End time": end * clock(height), "Output/Interval of pictures": step}


def points(quick):
    for kind in KINDS:
        files = {"discs.csv": loosened(400)} if kind == "loosened" else {}
        if quick:
            if not files:
                yield Point(kind, "400 discs", column(kind, 400, 4))
            continue
        yield Point(kind, "400 discs", column(kind, 400, 24), files=files)
    for kind in [] if quick else KINDS:
        if kind == "loosened":
            yield Point(kind, "1200 discs", column(kind, 1200, 8), files={"discs.csv": loosened(1200)})
        yield Point(kind, "3600 discs", column(kind, 3600, 12), files={"discs.csv": loosened(3600)} if kind == "loosened" else {}, heavy=True)


def front_of(grains, width):
    """Front over L_0: to where, from the wall on, stretches of 2 d hold more than half a layer."""
    x, area = grains.points[:, 0], math.pi * grains.fields["radius"] ** 2
    edges = np.arange(0, 5 * width, 2 * D)
    thick = np.histogram(x, edges, weights=area)[0] / (2 * D)
    end = int(np.argmax(thick < 0.4 * D)) if np.any(thick < 0.4 * D) else len(thick)
    return edges[end] / width


def top_of(grains, width):
    """Deposit: highest disc of stretches of 3 d, x and y over L_0."""
    x, y = grains.points[:, 0], grains.points[:, 1] + grains.fields["radius"]
    edges = np.arange(0, front_of(grains, width) * width, 3 * D)
    tops = [(0.5 * (a + b) / width, float(np.max(y[(x >= a) & (x < b)])) / width) for a, b in zip(edges[:-1], edges[1:]) if np.any((x >= a) & (x < b))]
    return [a for a, _ in tops], [b for _, b in tops]


def history(run, point):
    """Of each picture: time over the clock, front over L_0, excess pressure at a third of L_0 over the column's weight."""
    kind, n = point.series, int(point.label.split()[0])
    width, height = size(kind, n)
    weight = KINDS[kind][1] * DRHO * G * height
    times, fronts, pressures = [], [], []
    for (time, grains), (_, fluid) in zip(run.grains(), run.fluid()):
        floor = fluid.points[:, 1] < 1e-9
        x, p = fluid.points[floor, 0], fluid.fields["pressure"][floor]
        at = np.argsort(x)
        times.append(time / clock(height))
        fronts.append(front_of(grains, width))
        pressures.append(float(np.interp(width / 3, x[at], p[at]) - p[at][-1]) / weight)
    return times, fronts, pressures


def measure(run, point):
    width, _ = size(point.series, int(point.label.split()[0]))
    times, fronts, pressures = history(run, point)
    _, last = run.picture("grains", run.time[-1])
    largest = max(pressures[1:], key=abs)
    half = 0.5 * (fronts[0] + fronts[-1])
    return {"front at the end / L_0": fronts[-1], "front at 3 / L_0": float(np.interp(3, times, fronts)), "half of the way at": float(np.interp(half, np.maximum.accumulate(fronts), times)),
            "height at the end / L_0": top_of(last, width)[1][0], "largest pressure / weight": largest, "at time": times[1:][pressures[1:].index(largest)],
            "mean pressure to 1 / weight": float(np.mean([p for t, p in zip(times, pressures) if 0 < t <= 1]))}


def curves(run, point):
    width, _ = size(point.series, int(point.label.split()[0]))
    times, fronts, pressures = history(run, point)
    _, last = run.picture("grains", run.time[-1])
    found = {FRONT: (times, fronts), PRESSURE: (times[1:], pressures[1:])}
    return found if point.label == "1200 discs" else {**found, SHAPE: top_of(last, width)}


# --- what is shown and said

def beside(panel, r):
    for kind in EXPERIMENT:
        width, height = EXPERIMENT[kind]
        weight = KINDS[kind][1] * DRHO * G * height
        if panel == FRONT:
            data = [(t / clock(height), 0.01 * x / width) for t, x in FRONTS[kind]]
        elif panel == PRESSURE:
            data = [(t / clock(height), p / weight) for t, p in PRESSURES[kind]]
        else:
            data = [(0.01 * x / width, 0.01 * y / width) for x, y in SHAPES[kind]]
        yield "experiment, %s" % kind, [a for a, _ in data], [b for _, b in data], "marks", {"loose": 0, "dense": 1}[kind]


chart = Curves(panels={FRONT: ("time / (eta H_0/(drho g d^2))", "front / L_0"), PRESSURE: ("time / (eta H_0/(drho g d^2))", "pressure / (phi drho g H_0)"), SHAPE: ("x / L_0", "y / L_0")}, beside=beside)


def value(r, kind, name):
    return r.value(kind, "400 discs", name)


def claims(r):
    yield "loose: the liquid is pressed while the column begins to move", lambda: value(r, "loose", "mean pressure to 1 / weight"), ">", 0
    yield "dense: the liquid is sucked in", lambda: value(r, "dense", "mean pressure to 1 / weight"), "<", 0
    yield "a column that the liquid carries whole, loosened, presses it with its weight at first, within 15 %", lambda: abs(r.value("loosened", "400 discs", "mean pressure to 1 / weight") - 1), "<", 0.15
    yield "three times as many discs spread farther in the same units of time: way of the front at three, 1,200 over 400 discs", lambda: (
        r.value("loosened", "1200 discs", "front at 3 / L_0") - 1) / (r.value("loosened", "400 discs", "front at 3 / L_0") - 1), ">", 1.2
    yield "nine times as many discs come nearer to the experiment: dense front at the end, of 3,600 after twelve units over that of 400 after twice as many", lambda: (
        r.value("dense", "3600 discs", "front at the end / L_0") / value(r, "dense", "front at the end / L_0")), ">", 1.1
    yield "at three units of time the loose front is farther than the dense one", lambda: value(r, "loose", "front at 3 / L_0") / value(r, "dense", "front at 3 / L_0"), ">", 1.05


def says(r):
    of = lambda kind: r.done(kind, "400 discs").values
    loose, dense = of("loose"), of("dense")
    more = r.value("loosened", "1200 discs", "front at 3 / L_0")
    return ("The order and the signs are the experiment's: loose the pressure under the column is first %+.2f of its weight, dense %+.2f (experiment, later: %+.2f and %+.2f), and after 24 units of time the front is at %.2f and %.2f L_0, still moving (experiment, at rest: %.2f and %.2f). "
            "The sizes are not. A loosened column, which the liquid carries whole at first (%.2f of its weight), comes to %.2f L_0: the mapping of the packing is not all. Columns of 17 layers are too small: with three times as many discs the front is at %.2f instead of %.2f L_0 after three units. "
            "Viscosity of the mixture, which spreads a column in a time that goes with (d/H_0)^2 of these units, counts a hundred times more in them than in the experiment.%s"
            % (loose["mean pressure to 1 / weight"], dense["mean pressure to 1 / weight"], *(PRESSURES[k][1 if k == "loose" else 0][1] / (KINDS[k][1] * DRHO * G * EXPERIMENT[k][1]) for k in EXPERIMENT),
               loose["front at the end / L_0"], dense["front at the end / L_0"], *(FRONTS[k][-1][1] / 6 for k in EXPERIMENT), of("loosened")["mean pressure to 1 / weight"], of("loosened")["front at the end / L_0"],
               more, of("loosened")["front at 3 / L_0"], tall(r)))


def tall(r):
    """What the columns of 51 layers say, of those that have been run."""
    fronts = ["%s at %.2f" % (kind, x.values["front at the end / L_0"]) for kind in KINDS for x in r.of(kind) if x.done and x.point.label == "3600 discs"]
    if not fronts:
        return ""
    return (" Columns of 3,600 discs, 51 layers, come nearer: after twelve units their fronts are, in L_0, %s, and their deposits come close to the shape of the experiment's, but for the last of the way." % ", ".join(fronts))
