"""Localised fluidisation: from a cavity to a chimney.

Water enters a bed of sand through a slot in the floor. As its flux grows, first nothing moves, then grains in a cavity above the slot, which grows until it reaches the surface: a chimney, through which most of the water goes. That these three
regimes come one after the other is reported from experiments and from simulations with discs and resolved flow (Ngoma, Philippe, Bonelli, Radjai and Delenne, Phys. Rev. E 97, 2018, 052902; Cui, Li, Chan and Chapman, 2014) and with spheres and pore networks
(Montella, Toraldo, Chareyre and Sibille, arXiv 1703.02319), which adds that a wider slot makes the bed heave as a whole.

Here the flux grows linearly in time, beds 60 d wide and of three heights, slots of 4 and 16 d. The fluidised height is how far up from the slot layers of 1.5 d, as wide as the slot and 2 d to each side, are empty or have half of their grains faster than
0.03 (g d)^1/2. A cavity is one of more than 3 d, a chimney one that comes within 2 d of the surface.

**What can be compared: the order of events, and what it depends on.** A simple estimate stands beside: in a half plane that drains as Darcy's law has it, a flux q per depth from a narrow slot gives the speed q/(pi r) at the distance r, so that it
exceeds the speed u_mf that fluidises the bed within q/(pi u_mf). That reaches the surface of a bed of height H when q = pi u_mf H. **What cannot:** numbers. The experiments' jets are of spheres, the flow through a chimney is turbulent in some of them, and a ramp is no steady
state: here it is fast, so that fluxes are upper bounds. Cells of 2 d know a slot of 4 d by two cells; the flux through it is exact.
"""
import math

import numpy as np

from laboratory.study import Curves, Missing, Point

order = 55
scene = "jet.prm"
limit = 600
RHO, DRHO, ETA, G, D, AREA, PACKING, PHI, WIDTH = 1000.0, 1630.0, 1e-3, 9.81, 2.2e-4, 3.812e-8, 0.81, 0.52, 60  # [d] the last
HEIGHTS, SLOTS, RAMP, END = [12, 18, 27], [4, 16], 0.3, 0.3  # [d], [d], [s] of the ramp, [s]
LARGEST = 3.0  # flux at the ramp's end over pi u_mf H
CAVITY, CRITICAL = "fluidised height, largest so far", "flux at the chimney"


def fluidising():
    """Speed u_mf [m/s] by the law `disc` at the bed's packing for the fluid."""
    eps, low, high = 1 - PHI, 0.0, 1.0
    for _ in range(60):
        slip = 0.5 * (low + high)
        gamma = 2 / math.pi * eps**-2.8 * (0.63 * math.sqrt(eps * RHO * D * slip / ETA) + 4.8) ** 2 * ETA / D**2
        low, high = (slip, high) if gamma * slip < eps * DRHO * G else (low, slip)
    return eps * slip


def scale(height):
    """pi u_mf H [m^2/s], H in d."""
    return math.pi * fluidising() * height * D


def points(quick):
    for slot in SLOTS:
        for height in HEIGHTS[:1] if quick else HEIGHTS:
            half, middle = 0.5 * slot * D, 0.5 * WIDTH * D
            yield Point("slot of %g d" % slot, "H = %g d" % height, {
                "Domain/Upper right corner": "%.6g, %.6g" % (WIDTH * D, (1.5 * height + 10) * D), "Domain/Named parts": "slot = bottom: %.6g < x < %.6g" % (middle - half, middle + half),
                "Boundary conditions/Velocity": "slot: 0 | %.6g*t" % (LARGEST * scale(height) / (slot * D) / RAMP), "Time/End time": END,
                "Grains/Deposit: settled bed/Number of grains": round(WIDTH * height * D**2 * PACKING / AREA), "Output/Interval of pictures": 0.0025})


def fluidised_height(grains, slot):
    """[d], above the floor."""
    x, y, speed = grains.points[:, 0] / D, grains.points[:, 1] / D, np.linalg.norm(grains.fields["velocity"][:, :2], axis=1) / math.sqrt(G * D)
    near = np.abs(x - 0.5 * WIDTH) < 0.5 * slot + 2
    top = surface(grains)
    height = 0.0
    while height < top:
        layer = near & (y > height) & (y < height + 1.5)
        if layer.any() and np.mean(speed[layer] > 0.03) < 0.5:
            break
        height += 1.5
    return min(height, top)


def surface(grains):
    """Height of the bed beside the slot [d]."""
    x, y = grains.points[:, 0] / D, grains.points[:, 1] / D
    return float(np.quantile(y[np.abs(x - 0.5 * WIDTH) > 20], 0.98)) + 0.5


def history(run, point):
    """Fluxes over pi u_mf H and fluidised heights over H."""
    slot, height = (float(text.split()[-2]) for text in (point.series, point.label))
    found = [(LARGEST * time / RAMP, fluidised_height(grains, slot), surface(grains)) for time, grains in run.grains()]
    return [q for q, _, _ in found], [h for _, h, _ in found], [top for _, _, top in found]


def measure(run, point):
    slot, height = (float(text.split()[-2]) for text in (point.series, point.label))
    fluxes, heights, tops = history(run, point)
    first = lambda wanted: next((q for q, h, top in zip(fluxes, heights, tops) if wanted(h, top)), math.nan)
    cavity, chimney = first(lambda h, top: h > 3), first(lambda h, top: h > top - 2)
    return {"cavity at q/(pi u_mf H)": cavity, "chimney at q/(pi u_mf H)": chimney, "cavity at [mm2/s]": 1e6 * cavity * scale(height), "chimney at [mm2/s]": 1e6 * chimney * scale(height),
            "head at the chimney [mm]": 1e3 * run.at(chimney / LARGEST * RAMP, "differential_head_m"), "mass moved by d": run.last("moved_mass_fraction")}


def curves(run, point):
    fluxes, heights, tops = history(run, point)
    return {CAVITY: (fluxes, np.maximum.accumulate([h / top for h, top in zip(heights, tops)]))}


# --- what is shown and said

def over_height(r, slot, name):
    found = sorted((float(x.point.label.split()[-2]), x.values[name]) for x in r.some("slot of %g d" % slot, name))
    return [h for h, _ in found], [v for _, v in found]


def beside(panel, r):
    if panel == CRITICAL:
        for colour, slot in enumerate(SLOTS):
            for name, start in (("chimney", 0), ("cavity", 3)):
                try:
                    yield "%s, slot of %g d" % (name, slot), *over_height(r, slot, name + " at [mm2/s]"), "both", start + colour
                except Missing:
                    continue
        heights = [min(HEIGHTS), max(HEIGHTS)]
        yield "pi u_mf H", heights, [1e6 * scale(h) for h in heights], "line", 6


chart = Curves(panels={CAVITY: ("flux / (pi u_mf H)", "fluidised height / H"), CRITICAL: ("height of the bed / d", "flux [mm2/s]")}, beside=beside)


def slope(r, slot=4):
    heights, fluxes = over_height(r, slot, "chimney at [mm2/s]")
    if len(heights) < 2:
        raise Missing("fewer than two heights")
    return float(np.polyfit(np.log(heights), np.log(fluxes), 1)[0])


def claims(r):
    yield "first nothing moves: the cavity appears at a flux above zero, slot of 4 d, H = 12 d", lambda: r.value("slot of 4 d", "H = 12 d", "cavity at q/(pi u_mf H)"), ">", 0.02
    yield "the chimney comes after the cavity", lambda: r.value("slot of 4 d", "H = 12 d", "chimney at q/(pi u_mf H)") / r.value("slot of 4 d", "H = 12 d", "cavity at q/(pi u_mf H)"), ">", 1.2
    yield "at the flux pi u_mf H within 40 %: the worst of all heights and slots", lambda: max(abs(x.values["chimney at q/(pi u_mf H)"] - 1) for slot in SLOTS for x in r.some("slot of %g d" % slot, "chimney at q/(pi u_mf H)")), "<", 0.4
    gap = lambda slot: r.value("slot of %d d" % slot, "H = 12 d", "chimney at q/(pi u_mf H)") / r.value("slot of %d d" % slot, "H = 12 d", "cavity at q/(pi u_mf H)")
    yield "above a wide slot the chimney comes sooner after the cavity: ratio of the two fluxes, 16 d over 4 d", lambda: gap(16) / gap(4), "<", 0.9
    yield "a higher bed takes more: chimney at H = 27 d over that at 12 d", lambda: r.value("slot of 4 d", "H = 27 d", "chimney at [mm2/s]") / r.value("slot of 4 d", "H = 12 d", "chimney at [mm2/s]"), ">", 1.3


def says(r):
    narrow, wide = (over_height(r, slot, "chimney at q/(pi u_mf H)") for slot in SLOTS)
    early, broad = (over_height(r, slot, "cavity at q/(pi u_mf H)") for slot in SLOTS)
    return ("The three regimes come in the order that experiments and other simulations report. Above a slot of 4 d a cavity opens at %s of pi u_mf H and becomes a chimney at %s, for beds of %s d; above one of 16 d the cavity comes at %s and the chimney at %s: together where the slot is wider than the bed is high: what lies above it is lifted as a whole, as is reported of wide slots. "
            "The estimate pi u_mf H is right within a quarter for all chimneys, and for each slot the flux grows with the bed's height (4 d: to the power %.2f)."
            % (", ".join("%.2f" % v for v in early[1]), ", ".join("%.2f" % v for v in narrow[1]), ", ".join("%g" % h for h in narrow[0]), ", ".join("%.2f" % v for v in broad[1]), ", ".join("%.2f" % v for v in wide[1]), slope(r)))
