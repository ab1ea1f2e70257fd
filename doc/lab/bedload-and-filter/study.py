"""Bedload and the filter: what a numerical width does to a physical answer.

A lid drags a viscous liquid over a bed of 760 discs (`prm/bedload-under-moving-lid.prm`; Shields number around 1.5). The flux of grains per width, the sum of area times speed over the box's length, is averaged from 0.5 to
1 s. Swept: the radius R of the filter over which a grain gives to and reads from the fluid; cells; the filter's shape; the deposit's seed; the lid's speed, for R of the grain and of two diameters.

**Why it must depend on R.** The stress that the fluid brings to the bed is given by the flow above. What R decides is how deep it goes: the bed's edge is smeared over 2 R, and the fluid shears that far into it. The share of the stress that
the topmost layer of grains takes is here computed from a bed at rest in one dimension, d/dy(eps eta du/dy) = phi gamma u, with the same drag law and the same filter and no mesh: the exact side. Less of it on grains that
are free to go, less bedload.

**What can be compared.** In resolved simulations and experiments of bedload in laminar flow the flux goes with the third power of the Shields number (Kidanemariam and Uhlmann, Int. J. Multiphase Flow 67, 2014, 174, on 24 of their own
runs and the experiments of Aussillous and others 2013): a power of the excess over a threshold, here over a range too short to fit both. **What cannot:** the flux itself. Spheres stick out of a bed of spheres and are met by the flow on
all sides; discs are slices. A kernel has no counterpart in an experiment: it is a length of the model, to be chosen, and said.
"""
import math

import numpy as np

from laboratory.study import Curves, Missing, Point

order = 52
scene = "bedload.prm"
limit = 400
RHO, ETA, DRHO, G, D, LENGTH, HEIGHT, PHI = 1000.0, 2e-2, 500.0, 9.81, 0.396e-3, 0.02, 0.01, 0.52
RADII = {"grain": 0.5, "1 d": 1, "2 d": 2, "3 d": 3}
FLUX, SHARE, SHIELDS = "flux and filter radius", "stress on the topmost layer", "flux and stress"
MIDDLE = "cells of 1.5 d"


def settings(radius="2 d", h=1.5, speed=0.5, seed=1, shape="top-hat"):
    return {"Coupling/Filter radius": radius, "Coupling/Filter shape": shape, "Mesh refinement/Criteria: uniform/Cell size": h, "Mesh refinement/Coarsest cell size": max(8, h),
            "Grains/Deposit: settled bed/Seed": seed, "Boundary conditions/Velocity": "top: %g*min(1, t/0.1) | 0" % speed}


def points(quick):
    if quick:
        for radius in ["grain", "2 d"]:
            yield Point(MIDDLE, radius, {**settings(radius), "Time/End time": 0.4})
        return
    for radius in RADII:
        yield Point(MIDDLE, radius, settings(radius), default=radius == "2 d")
    yield Point(MIDDLE, "smooth 2.5 d", settings("2.5 d", shape="parabolic"))
    for radius in ["grain", "2 d"]:
        yield Point("another seed", radius, settings(radius, seed=2))
    for h in [0.75, 3]:
        for radius in RADII if h > 1 else ["grain", "2 d"]:
            yield Point("cells of %g d" % h, radius, settings(radius, h))
    for speed in [0.35, 0.7]:
        for radius in ["grain", "2 d"]:
            yield Point("lid at %g m/s" % speed, radius, settings(radius, speed=speed))


def measure(run, point):
    end, length = run.time[-1], 0.02
    fluxes, depth = [], []
    for time, grains in run.grains():
        if time > 0.499 * end:
            area, v = math.pi * grains.fields["radius"] ** 2, grains.fields["velocity"][:, 0]
            fluxes.append(float(np.sum(area * v)) / length)
            fast = v > 0.01 * v.max()
            depth.append((np.quantile(grains.points[:, 1], 0.99) - np.quantile(grains.points[fast, 1], 0.05)) / 0.396e-3)
    late = run.time > 0.5 * end
    speed = float(point.settings["Boundary conditions/Velocity"].split("*")[0].split(":")[1])
    stress = float(run.columns["power_boundaries_W_per_m"][late].mean()) / (speed * length)
    return {"flux [1e-6 m2/s]": 1e6 * float(np.mean(fluxes)), "fluctuation [1e-6 m2/s]": 1e6 * float(np.std(fluxes)), "stress of the lid [Pa]": stress, "Shields number": stress / (500 * 9.81 * 0.396e-3),
            "moved": run.last("moved_mass_fraction"), "depth in motion [d]": float(np.mean(depth))}


# --- the exact side

def share(radius, stress=2.8, n=3000):
    """Share of the stress that the topmost layer, centres over one diameter, takes of a flow over a bed at rest; radius of the filter in d."""
    depth, above = 14 * D, 6 * D
    y = np.linspace(-depth, above, n)  # the topmost centre is at -d/2
    dy, R = y[1] - y[0], radius * D
    spread = lambda z: 2 * np.sqrt(np.clip(R**2 - z**2, 0, None)) / (math.pi * R**2)  # a disc's area over height
    below = lambda z: np.clip(0.5 + (np.clip(z / R, -1, 1) * np.sqrt(1 - np.clip(z / R, -1, 1) ** 2) + np.arcsin(np.clip(z / R, -1, 1))) / math.pi, 0, 1)
    phi = PHI * below(-0.5 * D - y)
    eps, u = 1 - phi, np.zeros(n)
    for _ in range(40):
        gamma = 2 / math.pi * eps**-2.8 * (0.63 * np.sqrt(eps * RHO * D * np.abs(u) / ETA) + 4.8) ** 2 * ETA / D**2
        middle = 0.5 * (eps[1:] + eps[:-1]) * ETA / dy**2
        diagonal, right = np.zeros(n), np.zeros(n)
        diagonal[1:-1] = middle[:-1] + middle[1:] + (phi * gamma)[1:-1]
        diagonal[0], diagonal[-1] = 1, 1 / dy
        lower, upper = np.concatenate([-middle[:-1], [-1 / dy]]), np.concatenate([[0], -middle[1:]])
        right[-1] = stress / ETA
        new = tridiagonal(lower, diagonal, upper, right)
        if np.max(np.abs(new - u)) < 1e-9 * np.max(np.abs(new)):
            break
        u = 0.5 * (u + new) if _ else new
    force = gamma * u
    centres = y[(y > -1.5 * D) & (y < -0.5 * D)]
    on_layer = sum(PHI * float(np.sum(spread(y - c) * force)) * dy for c in centres) * dy
    return on_layer / float(np.sum(phi * force) * dy)


def tridiagonal(lower, diagonal, upper, right):
    """Thomas' algorithm."""
    d, b = diagonal.copy(), right.copy()
    for i in range(1, len(d)):
        w = lower[i - 1] / d[i - 1]
        d[i] -= w * upper[i - 1]
        b[i] -= w * b[i - 1]
    x = np.empty_like(b)
    x[-1] = b[-1] / d[-1]
    for i in range(len(b) - 2, -1, -1):
        x[i] = (b[i] - upper[i] * x[i + 1]) / d[i]
    return x


# --- what is shown and said

def flux(r, series, radius):
    return r.value(series, radius, "flux [1e-6 m2/s]")


def over_radius(r, series, name="flux [1e-6 m2/s]"):
    found = [(RADII[x.point.label], x.values[name]) for x in r.of(series) if x.done and x.point.label in RADII]
    return [a for a, _ in found], [b for _, b in found]


def over_shields(r, radius):
    found = sorted((x.values["Shields number"], x.values["flux [1e-6 m2/s]"]) for s in ("lid at 0.35 m/s", MIDDLE, "lid at 0.7 m/s") for x in r.of(s) if x.done and x.point.label == radius)
    return [a for a, _ in found], [b for _, b in found]


def power(r, radius):
    theta, q = over_shields(r, radius)
    if len(q) < 3:
        raise Missing("fewer than three speeds of the lid")
    return float(np.polyfit(np.log(theta), np.log(q), 1)[0])


def beside(panel, r):
    if panel == FLUX:
        for colour, series in enumerate([MIDDLE, "cells of 0.75 d", "cells of 3 d", "another seed"]):
            radii, found = over_radius(r, series)
            if found:
                yield series, radii, found, "both" if series != "another seed" else "marks", colour
        smooth = [x for x in r.of(MIDDLE) if x.done and x.point.label == "smooth 2.5 d"]
        if smooth:
            yield "smooth, 2.5 d", [2.5 * math.sqrt(2 / 3)], [smooth[0].values["flux [1e-6 m2/s]"]], "marks", 6
    if panel == SHARE:
        radii = np.linspace(0.5, 3, 11)
        yield "topmost layer's share, theory in one dimension", radii, [share(x) for x in radii], "line", 6
        radii, found = over_radius(r, MIDDLE)
        if found:
            yield "flux over that of R = grain, to the power 1/3", radii, [(q / found[0]) ** (1 / 3) * share(0.5) for q in found], "marks", 0
    if panel == SHIELDS:
        for colour, radius in enumerate(["grain", "2 d"]):
            theta, q = over_shields(r, radius)
            if len(q) > 1:
                yield "R = %s" % radius, theta, q, "marks", colour
                yield "third power", theta, [q[len(q) // 2] * (t / theta[len(q) // 2]) ** 3 for t in theta], "line", colour


chart = Curves(panels={FLUX: ("filter radius / d", "flux [1e-6 m2/s]"), SHARE: ("filter radius / d", "share of the stress"), SHIELDS: ("Shields number", "flux [1e-6 m2/s]")},
               log={SHIELDS: "xy"}, beside=beside)


def claims(r):
    yield "with a filter of the grain's own radius more than 1.3 times as much is carried as with 2 d", lambda: flux(r, MIDDLE, "grain") / flux(r, MIDDLE, "2 d"), ">", 1.3
    yield "the stress that the lid exerts is the same within 15 %", lambda: abs(r.value(MIDDLE, "grain", "stress of the lid [Pa]") / r.value(MIDDLE, "2 d", "stress of the lid [Pa]") - 1), "<", 0.15
    yield "theory: the topmost layer's share of the stress with 2 d, over that with the grain's radius", lambda: share(2) / share(0.5), "<", 0.8


def says(r):
    fluxes = [flux(r, MIDDLE, radius) for radius in RADII]
    seeds = max(abs(flux(r, "another seed", radius) / flux(r, MIDDLE, radius) - 1) for radius in ("grain", "2 d"))
    cells = max(abs(flux(r, "cells of %g d" % h, radius) / flux(r, MIDDLE, radius) - 1) for h in (0.75, 3) for radius in ("grain", "2 d"))
    return ("The flux is %s e-6 m2/s with filters of the grain's radius, 1 d, 2 d and 3 d: the width is no detail. Cells of 0.75 to 3 d change it by up to %.0f %%, another deposit by up to %.0f %%. "
            "The lid's stress is the same; theory has the topmost layer's share of it fall from %.2f to %.2f between the grain's radius and 3 d. With the stress the flux goes as its power %.1f (grain) and %.1f (2 d); "
            "resolved simulations have 3. Choose 2 d where the flow through the bed matters, the grain's radius (cells of 1.5 d and more) where single grains on it do, and give both as the range."
            % (", ".join("%.2g" % q for q in fluxes), 100 * cells, 100 * seeds, share(0.5), share(3), power(r, "grain"), power(r, "2 d")))
