"""Batch sedimentation: Richardson and Zaki's exponent, and Kynch's fronts.

Equal discs of 0.2 mm, 2,630 kg/m^3, sink in liquids of four viscosities between a floor and a lid. The lone disc's Reynolds number is then 0.07 to 28. Two things of the literature can be
compared.

**The exponent.** Richardson and Zaki (Trans. Inst. Chem. Eng. 32, 1954, 35): a suspension of spheres sinks as eps^n, n from 4.65 in creeping flow to 2.4 at large Reynolds numbers; here in the smooth
form n = (4.7 + 0.41 Re^0.75)/(1 + 0.175 Re^0.75) (Rowe, Chem. Eng. Sci. 42, 1987, 2795). Brzinski and Durian (Phys. Rev. Fluids 3, 2018, 124303) find 4.48 +- 0.04 in 15 studies of slow spheres. Between it
and the program stands the drag law, an exact side: without net flux gamma w = eps (rho_p - rho) g for the slip w, and grains sink with eps w. So a law with eps^-2.8 has n = 4.8 in creeping flow, and
2.4 at large Reynolds numbers. All n are slopes of log speed over log eps, least squares over packings of 0.05 to 0.4.

**The fronts.** Kynch (Trans. Faraday Soc. 48, 1952, 166): a suspension whose speed is a function of its packing alone settles by shocks and fans, here solved with the drag law's speed and the deposit's own packing.

**What cannot be compared.** Discs in a plane pack to 0.8, spheres to 0.6: above 0.4 the same packing is not the same suspension. The law is that of spheres (`sphere`); there is no measured law for discs that sink along
the plane in which they are cut. Discs at random places drag their water along in crowds, and sink up to 14 % faster ([report](../reports/settling.md)); in two dimensions that is stronger than
in three.
"""
import math
import random

import numpy as np

import suspensions
from laboratory.study import Curves, Missing, Point

order = 50
scene = "suspension.prm"
limit = 300
D, RHO, RHO_P, G = 2e-4, 1000.0, 2630.0, 9.81
VISCOSITIES = {"0.07": 1e-2, "0.7": 3e-3, "4.5": 1e-3, "28": 3e-4}  # name of the series: Reynolds number of a lone disc, rounded
PACKINGS = [0.05, 0.1, 0.2, 0.3, 0.4]
SPEED, EXPONENT, FRONT = "speed of evenly spread discs", "exponent", "batch: height of the upper front"
BATCH_WIDTH, BATCH_HEIGHT, BATCH_VISCOSITY = 24, 80, 1e-3  # [d], [Pa s]
BATCH = [0.1, 0.2, 0.3]


# --- the exact side

def by_law(phi, viscosity, di_felice=False):
    """Speed at no net flux [m/s] and relaxation time [s] by the law `sphere`, as doc/theory/drag.md has it."""
    eps = 1 - phi

    def gamma(slip):
        re = RHO * D * eps * slip / viscosity
        power = 2.7 - 0.65 * math.exp(-0.5 * (1.5 - math.log10(max(re, 1e-30))) ** 2) if di_felice else 2.8
        return 0.75 * eps**-power * (0.63 * math.sqrt(re) + 4.8) ** 2 * viscosity / D**2

    low, high = 0.0, 1.0
    for _ in range(60):
        slip = 0.5 * (low + high)
        low, high = (slip, high) if gamma(slip) * slip < eps * (RHO_P - RHO) * G else (low, slip)
    return eps * slip, eps * (phi * RHO + eps * RHO_P) / gamma(slip)


def reynolds(viscosity):
    return RHO * D * by_law(0, viscosity)[0] / viscosity


def exponent(pairs):
    """Slope of log speed over log eps, of [(phi, speed)]."""
    return np.polyfit([math.log(1 - phi) for phi, _ in pairs], [math.log(speed) for _, speed in pairs], 1)[0]


def exponent_of_law(viscosity, di_felice=False, packings=PACKINGS):
    return exponent([(phi, by_law(phi, viscosity, di_felice)[0]) for phi in packings])


def of_spheres(re):
    return (4.7 + 0.41 * re**0.75) / (1 + 0.175 * re**0.75)


def kynch(phi, packed, end, n=400):
    """Times [s] and heights [d] of the upper front, below which 95 % of the discs are: Godunov's scheme for d phi/dt = d(phi u(phi))/dy between floor and lid, u by the law."""
    table = np.linspace(0, packed, 801)
    flux = np.array([x * by_law(x, BATCH_VISCOSITY)[0] for x in table])
    flux[-1] = 0  # packed discs stay
    speed = np.max(np.abs(np.gradient(flux[:-1], table[:-1])))
    top = int(np.argmax(flux))
    g = lambda x: np.interp(x, table, flux)
    dy, y = BATCH_HEIGHT * D / n, (np.arange(n) + 0.5) / n * BATCH_HEIGHT
    dt = 0.4 * dy / speed
    grid, profile, times, heights = np.arange(n + 1), np.full(n, float(phi)), [], []
    for step in range(int(end / dt) + 1):
        if step % 20 == 0:
            mass = np.concatenate([[0], np.cumsum(profile)])
            times.append(step * dt)
            heights.append(float(np.interp(0.95 * mass[-1], mass, grid)) / n * BATCH_HEIGHT)
        below, above = profile[:-1], profile[1:]
        # downward flux between two cells: least of the table between them where the lower is denser, largest where the upper is; it has one maximum
        peak = (np.minimum(below, above) < table[top]) & (np.maximum(below, above) > table[top])
        down = np.where(above <= below, np.minimum(g(below), g(above)), np.where(peak, flux[top], np.maximum(g(below), g(above))))
        down = np.concatenate([[0], down, [0]])
        profile = np.clip(profile + dt / dy * (down[1:] - down[:-1]), 0, packed)
    return np.array(times), np.array(heights)


def half_time(times, heights):
    """When the front has come half of its way down."""
    way = (heights[0] - np.asarray(heights)) / (heights[0] - heights[-1])
    return float(np.interp(0.5, way, times))


# --- runs

def places(phi, make):
    discs, _, _ = make(phi, random.Random(1))
    return "x,y,radius\n" + "".join("%.9g,%.9g,%.9g\n" % (x * D, y * D, D / 2) for x, y in discs)


def point(series, phi, viscosity, make, **settings):
    _, tau = by_law(phi, viscosity, "Coupling/Drag law: sphere/Exponent" in settings)
    return Point(series, "%g" % phi, {"Grains/Deposit: file/File": "{folder}/discs.csv", "Fluid/Viscosity": viscosity, "Time/Time step": tau / 3, "Time/End time": 8 * tau, **settings},
                 files={"discs.csv": places(phi, make)})


def points(quick):
    packings = [0.1, 0.2, 0.4] if quick else PACKINGS
    for name, viscosity in VISCOSITIES.items():
        if quick and name in ("0.7", "28"):
            continue
        for phi in packings:
            yield point("Re " + name, phi, viscosity, suspensions.one_in_each_square)
    for name, viscosity in [] if quick else VISCOSITIES.items():
        for phi in packings:
            yield point("Re %s, Di Felice" % name, phi, viscosity, suspensions.one_in_each_square, **{"Coupling/Drag law: sphere/Exponent": "Di Felice"})
    for phi in [] if quick else PACKINGS:
        yield point("Re 4.5, random", phi, 1e-3, suspensions.anywhere)
    for phi in [0.3] if quick else BATCH:
        end = 1.5 * BATCH_HEIGHT * (1 - phi / 0.8) * D / by_law(phi, BATCH_VISCOSITY)[0]
        yield Point("batch", "packing %g" % phi, shown="batch, packing %g; dashed: Kynch" % phi, settings={
            "Domain/Upper right corner": "%g, %g" % (BATCH_WIDTH * D, BATCH_HEIGHT * D), "Fluid/Viscosity": BATCH_VISCOSITY, "Grains/Deposit": "random suspension",
            "Grains/Deposit: random suspension/Smallest diameter": D, "Grains/Deposit: random suspension/Size ratio": 1, "Grains/Deposit: random suspension/Area fraction": phi,
            "Time/Time step": 2e-3, "Time/End time": end, "Output/Interval of statistics": 0.02, "Output/Interval of pictures": 0.03, "Output/Observers: settling/Bottom": 0,
            "Output/Observers: settling/Top": BATCH_HEIGHT * D})


def fronts(run):
    """Times [s] and heights [d] below which 95 % of the discs are, from the top of discs that touch the lid."""
    found = [(time, (np.quantile(grains.points[:, 1], 0.95)) / D) for time, grains in run.grains()]
    return [t for t, _ in found], [h for _, h in found]


def measure(run, point):
    if point.series == "batch":
        times, heights = fronts(run)
        _, last = run.picture("grains", times[-1])
        low, high = 2 * D, np.quantile(last.points[:, 1], 0.8)
        inside = (last.points[:, 1] > low) & (last.points[:, 1] < high)
        return {"half of the way down [s]": half_time(times, heights), "packing at the end": inside.sum() * math.pi / 4 * D**2 / ((high - low) * BATCH_WIDTH * D),
                "front at the end [d]": heights[-1]}
    late = run.time > 5 / 8 * run.time[-1]
    mean = lambda name: float(run.columns[name][late].mean())
    phi, di_felice = mean("settling_packing_fraction"), "Di Felice" in point.series
    speed = mean("settling_speed_m_per_s")
    return {"packing": phi, "speed [mm/s]": 1e3 * speed, "over the drag law's": speed / by_law(phi, point.settings["Fluid/Viscosity"], di_felice)[0]}


def curves(run, point):
    return {FRONT: fronts(run)} if point.series == "batch" else {}


# --- what is shown and said

def speeds(r, series):
    """[(packing, speed [m/s])] of a series, all that were run."""
    found = [(x.values["packing"], x.values["speed [mm/s]"] / 1e3) for x in r.some(series, "packing")]
    if len(found) < 3:
        raise Missing("%s was run at less than three packings" % series)
    return found


def exponents(r, end=""):
    """Reynolds numbers and exponents of the series that were run."""
    found = []
    for name, viscosity in VISCOSITIES.items():
        try:
            found.append((reynolds(viscosity), exponent(speeds(r, "Re " + name + end))))
        except Missing:
            continue
    return [a for a, _ in found], [b for _, b in found]


def beside(panel, r):
    if panel == SPEED:
        phis = np.linspace(0, 0.42, 43)
        for colour, (name, viscosity) in enumerate(VISCOSITIES.items()):
            alone = by_law(0, viscosity)[0]
            try:
                found = speeds(r, "Re " + name)
            except Missing:
                continue
            yield "program, Re %s; lines in its colour: the drag law" % name, [1 - phi for phi, _ in found], [speed / alone for _, speed in found], "marks", colour
            yield "_law %s" % name, 1 - phis, [by_law(phi, viscosity)[0] / alone for phi in phis], "line", colour
        eps = 1 - phis
        yield "spheres, Richardson and Zaki (left: Re 28 and 0.07)", np.concatenate([eps, [np.nan], eps]), np.concatenate([eps ** of_spheres(reynolds(1e-2)), [np.nan], eps ** of_spheres(reynolds(3e-4))]), "line", 6
    if panel == EXPONENT:
        viscosities = np.geomspace(2e-2, 2e-4, 40)
        res = [reynolds(v) for v in viscosities]
        yield "program, exponent n of the default's eps^-2.8", *exponents(r), "marks", 0
        yield "_default", res, [exponent_of_law(v) for v in viscosities], "line", 0
        yield "program, n of Di Felice's exponent", *exponents(r, ", Di Felice"), "marks", 1
        yield "_di felice", res, [exponent_of_law(v, True) for v in viscosities], "line", 1
        yield "program, n of discs at random places, eps^-2.8", *exponents(r, ", random"), "marks", 2
        yield "spheres, Richardson and Zaki (left: Re 28 and 0.07)", res, [of_spheres(re) for re in res], "line", 6
        yield "slow spheres: Brzinski and Durian", [min(res) * 1.2], [4.48], "marks", 6
    if panel == FRONT:
        for colour, x in enumerate(x for x in r.of("batch") if x.done):
            phi = float(x.point.label.split()[1])
            times, heights = kynch(phi, x.values["packing at the end"], x.point.settings["Time/End time"])
            yield "_kynch %g" % phi, times, heights, "line", colour


chart = Curves(panels={SPEED: ("void fraction", "speed / that of a lone disc"), EXPONENT: ("Reynolds number of a lone disc", "n"), FRONT: ("time [s]", "height / d")},
               log={SPEED: "xy", EXPONENT: "x"}, beside=beside)


def worst(r, packings=(0.1, 0.2, 0.3, 0.4)):
    """Largest difference of evenly spread discs from the drag law."""
    found = [abs(x.values["over the drag law's"] - 1) for name in VISCOSITIES for end in ("", ", Di Felice") for x in r.of("Re " + name + end)
             if x.done and float(x.point.label) in packings]
    if not found:
        raise Missing("no suspension was run")
    return max(found)


def off_law(r, end=""):
    """Largest difference of exponents, program and law over the same packings."""
    found = []
    for name, viscosity in VISCOSITIES.items():
        try:
            pairs = speeds(r, "Re " + name + end)
        except Missing:
            continue
        found.append(abs(exponent(pairs) - exponent_of_law(viscosity, bool(end), [phi for phi, _ in pairs])))
    if not found:
        raise Missing("no exponent was measured")
    return max(found)


def off_spheres(r, end=""):
    """Largest difference of the program's exponents from Richardson and Zaki's."""
    res, ns = exponents(r, end)
    if not ns:
        raise Missing("no exponent was measured")
    return max(abs(n - of_spheres(re)) for re, n in zip(res, ns))


def late(r, phi):
    """Time in which the front comes half of its way down, over Kynch's."""
    x = r.done("batch", "packing %g" % phi)
    return x.values["half of the way down [s]"] / half_time(*kynch(phi, x.values["packing at the end"], x.point.settings["Time/End time"]))


def claims(r):
    yield "evenly spread discs of packing 0.1 to 0.4 sink as the drag law says, within 4 %", lambda: worst(r), "<", 0.04
    yield "their exponent is the law's within 0.15", lambda: off_law(r), "<", 0.15
    yield "up to a Reynolds number of 4.5 the default's exponent is Richardson and Zaki's within 0.5", lambda: max(
        abs(n - of_spheres(re)) for re, n in zip(*exponents(r)) if re < 10), "<", 0.5
    yield "with Di Felice's exponent it is within 0.3 at all Reynolds numbers here", lambda: off_spheres(r, ", Di Felice"), "<", 0.3
    yield "the upper front of a batch of packing 0.3 falls in Kynch's time within 15 %", lambda: abs(late(r, 0.3) - 1), "<", 0.15


def says(r):
    res, ns = exponents(r)
    _, felice = exponents(r, ", Di Felice")
    if not felice:
        raise Missing("Di Felice's exponent was not run")
    return ("With the default drag law the exponent falls from %.2f at Re %.2g to %.2f at Re %.2g, where spheres have %.2f and %.2f; with Di Felice's exponent from %.2f to %.2f, and within %.2g of spheres everywhere: "
            "take that to compare with suspensions of sand or glass. The program follows its law within %.1f %% in speed, %.2g in n; discs at random places have n = %.2f at Re 4.5. "
            "The upper front of a batch takes %s times Kynch's time to half of its way: discs at random places sink in crowds, the more so the fewer they are."
            % (ns[0], res[0], ns[-1], res[-1], of_spheres(res[0]), of_spheres(res[-1]), felice[0], felice[-1], off_spheres(r, ", Di Felice"), 100 * worst(r), max(off_law(r), off_law(r, ", Di Felice")),
               exponents(r, ", random")[1][0], ", ".join("%.2f (packing %g)" % (late(r, phi), phi) for phi in BATCH)))
