"""A silo: Janssen's law.

What walls with friction carry does not reach the floor. Janssen (Z. Ver. Dtsch. Ing. 39, 1895, 1045) has for a silo between two walls a distance W apart, filled to H,

    floor force / weight = (l/H) (1 - exp(-H/l)),        l = W/(2 mu K)

with mu the friction that is used at the walls and K the ratio of horizontal to vertical stress, both taken to be the same everywhere. Discs of 0.2 to 0.24 mm, 16 mean diameters from wall to wall, filled to half to eight widths; the floor sinks by a
diameter, and the means over the second half of that are compared: with one K fitted to all heights, and with K and mu as measured in each run (mean contact stress; what the walls carry over what presses on them; the friction used follows from the floor's share itself, so that
this second comparison tests the exponential alone).

**What can be compared.** Janssen's formula in two dimensions is as good as in three; only l differs (W/4 mu K in a cylinder). Landry, Grest and Plimpton (Powder Technol. 139, 2004, 233; cond-mat/0302115) find in simulations from two to three
dimensions that Janssen's theory does not hold near the top, where the stress grows as in a liquid, and that forces at walls are close to slipping, those inside far from it.
Janssen's mu is a wall's only where grains slip along it: discs can roll down it instead.

**What cannot.** K is no constant of nature: it depends on how the silo was filled. A bed that was only deposited uses any part of its friction: its floor force is shown beside, and is the deposit's, not a law's.
"""
import math

import numpy as np

from laboratory.study import Curves, Missing, Point

order = 53
scene = "silo.prm"
limit = 300
always = {"Output/Interval of pictures": 0.5}
G, D, AREA, PACKING, WIDTH = 9.81, 2.2e-4, 3.812e-8, 0.81, 16  # [m], [m^2], -, [d]
HEIGHTS = [0.5, 1, 2, 4, 8]  # over the width
FRICTIONS = [0.4, 0.2]
WAY = 1.0  # of the floor [d]
SHARE, RATIO = "force on the floor", "stress ratio and friction used"


def points(quick):
    for friction in FRICTIONS:
        for h in [1, 2] if quick else HEIGHTS:
            top = 1.6 * h * WIDTH * D + 10 * D
            yield Point("wall friction %g" % friction, "H = %g W" % h, {
                "Domain/Upper right corner": "%g, %g" % (WIDTH * D, top), "Grains/Deposit: settled bed/Number of grains": round(h * (WIDTH * D) ** 2 * PACKING / AREA),
                "Contacts/Wall friction coefficient": friction, "Grains/Motion of walls": "bottom: 0, %g" % (-WAY * D / 0.5)})


def measure(run, point):
    late = run.time > 0.5 * run.time[-1]
    mean = lambda name: float(run.columns[name][late].mean())
    width, height = WIDTH * D, float(run.columns["bed_height_m"][late].mean())
    _, grains = run.picture("grains", 0)
    area = math.pi * float(np.sum(grains.fields["radius"] ** 2))
    weight = 2630 * G * area
    share = mean("floor_force_over_weight")
    sideways, down = -mean("grain_stress_xx_Pa"), -mean("grain_stress_yy_Pa")
    normal = sideways * area / width  # on each wall: the sum of branch vector times force over all contacts is the walls' force times their distance
    used = (1 - share) * weight / (2 * normal)
    ratio = sideways / down
    length = width / (2 * used * ratio)
    first = run.columns["floor_force_over_weight"]
    return {"H / W": height / width, "floor / weight": share, "at rest": float(first[1]), "K": ratio, "friction used": used, "fluctuation": float(first[late].std()),
            "Janssen, K and friction as measured": length / height * (1 - math.exp(-height / length))}


# --- what is shown and said

def janssen(height, length):
    return length / height * (1 - np.exp(-height / length))


def fitted(r, friction):
    """Janssen's length over the width that fits all heights of a friction best, by least squares in the share."""
    found = [(x.values["H / W"], x.values["floor / weight"]) for x in r.some("wall friction %g" % friction, "floor / weight")]
    lengths = np.geomspace(0.2, 20, 2000)
    return float(lengths[np.argmin([sum((janssen(h, length) - share) ** 2 for h, share in found) for length in lengths])])


def beside(panel, r):
    heights = np.geomspace(0.4, 9, 60)
    if panel == SHARE:
        yield "all of the weight", [0.4, 9], [1, 1], "line", 6
    for colour, friction in enumerate(FRICTIONS):
        try:
            found = sorted((x.values["H / W"], x.values) for x in r.some("wall friction %g" % friction, "K"))
        except Missing:
            continue
        hs = [h for h, _ in found]
        if panel == SHARE:
            yield "floor sinks, wall friction %g; dashed: Janssen, K fitted" % friction, hs, [v["floor / weight"] for _, v in found], "marks", colour
            yield "_fitted %g" % friction, heights, janssen(heights, fitted(r, friction)), "line", colour
            yield "as deposited, wall friction %g" % friction, hs, [v["at rest"] for _, v in found], "marks", colour + 3
        else:
            yield "K, wall friction %g" % friction, hs, [v["K"] for _, v in found], "both", colour
            yield "friction used, of %g" % friction, hs, [v["friction used"] for _, v in found], "both", colour + 3


chart = Curves(panels={SHARE: ("height of the fill / width", "floor force / weight"), RATIO: ("height of the fill / width", "K, friction used")}, log={SHARE: "x", RATIO: "x"}, beside=beside)


def off(r, name=None):
    """Largest relative difference of the floor's share from Janssen's, with K as measured or (no name) fitted."""
    found = []
    for friction in FRICTIONS:
        for x in r.of("wall friction %g" % friction):
            if x.done:
                theory = x.values[name] if name else float(janssen(x.values["H / W"], fitted(r, friction)))
                found.append(abs(x.values["floor / weight"] / theory - 1))
    if not found:
        raise Missing("no silo was run")
    return max(found)


def used(r):
    return [x.values["friction used"] / friction for friction in FRICTIONS for x in r.of("wall friction %g" % friction) if x.done]


def claims(r):
    yield "with K and friction as measured the floor carries Janssen's share within 15 %, at all heights", lambda: off(r, "Janssen, K and friction as measured"), "<", 0.15
    yield "with one K fitted to all heights within 25 %", lambda: off(r), "<", 0.25
    yield "where the floor sinks walls use at most their friction", lambda: max(used(r)), "<=", 1.001
    yield "and more than half of it", lambda: min(used(r)), ">", 0.5
    yield "a wall friction of 0.2 is used up: in silos of one width and more to within 2 %", lambda: min(x.values["friction used"] for x in r.some("wall friction 0.2", "K") if x.values["H / W"] > 0.9) / 0.2, ">", 0.98
    yield "from four widths to eight the floor gets less than 15 % of what is added", lambda: added(r), "<", 0.15


def added(r):
    short, tall = (r.done("wall friction 0.4", "H = %g W" % h).values for h in (4, 8))
    return (tall["floor / weight"] * tall["H / W"] - short["floor / weight"] * short["H / W"]) / (tall["H / W"] - short["H / W"])


def says(r):
    values = lambda friction, name: [x.values[name] for x in r.some("wall friction %g" % friction, name)]
    mean = lambda numbers: sum(numbers) / len(numbers)
    return ("The floor's share follows Janssen's law within %.0f %% with K and friction as measured, and within %.0f %% with one product of K and friction for all heights, though K grows with the height of the fill (%.2f to %.2f). "
            "Of a wall friction of 0.2 all is used (%.2f), of 0.4 only %.2f: discs roll down such a wall instead of slipping, so that twice the friction takes not twice the load. From four widths to eight the floor gets %.0f %% of what is added (wall friction 0.4). As deposited, before the floor sinks, the share is anything between %.2f and %.2f of that of a sinking floor."
            % (*(math.ceil(100 * x) for x in (off(r, "Janssen, K and friction as measured"), off(r))), min(values(0.2, "K")), max(values(0.4, "K")), *(mean(values(f, "friction used")) for f in (0.2, 0.4)),
               100 * added(r), *(pick(x.values["at rest"] / x.values["floor / weight"] for x in r if x.done) for pick in (min, max))))
