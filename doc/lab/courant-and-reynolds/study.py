"""Streams through open boundaries: Courant number and the cell's Reynolds number.

A jet of 0.1 m/s that swings blows into a box of 24 by 12 cells and leaves by the open right side; no grains. Each point runs for
3 passages of the box, but 30 steps at least. Growth is the largest velocity of the last third of the run over that of the jet at its
fastest, 0.13 m/s: what an inflow of kinetic energy alone cannot make much larger than 1. The lines are those beyond which other
methods stop: explicit convection beyond a Courant number of 1, central differences beyond a Reynolds number of 2 a cell. The scheme,
backward Euler with a stabilised convection by the velocity of t^n, has neither limit; what may fail is the open boundary.
"""
import numpy as np

from laboratory.study import Map, Point

order = 13
scene = "jet.prm"
measure_failed = True

U, h, rho, length, fastest = 0.1, 1e-3, 1000.0, 0.024, 0.13
ALL, FEW = "all terms of the open boundary (default)", "none of them"
series = {ALL: {}, FEW: {"Fluid/Open boundary terms": "none"}}


def lines(name):
    yield "Courant number 1", [1, 1], [0.1, 1e5]
    yield "cell's Reynolds number 2", [0.1, 100], [2, 2]


chart = Map(x="Courant number U dt / h", y="cell's Reynolds number U h / nu", value="growth", title="largest velocity / jet's", bound=1.5, log="xyv", lines=lines,
            stands=[(0.1 * 2e-4 / 4e-4, 0.1 * 4e-4 / 1e-6, "a jet of 0.1 m/s through sand, cells of 2 d", ALL)])


def points(quick):
    for name, more in series.items():
        for re in [1, 1e4] if quick else [1, 100, 1e4]:
            for c in [0.5, 10] if quick else [0.1, 0.5, 1, 10, 100]:
                dt = c * h / U
                yield Point(name, "%g, %g" % (c, re), {"Time/Time step": "%.10g" % dt, "Time/End time": "%.10g" % max(3 * length / U, 30 * dt),
                                                       "Fluid/Viscosity": "%.10g" % (rho * U * h / re), **more}, x=c, y=re)


def measure(run, point):
    speed = np.asarray(run.columns["largest_fluid_velocity_m_per_s"], float)
    speed = speed[np.isfinite(speed)]
    return {"growth": float(np.max(speed[-max(len(speed) // 3, 1):])) / fastest, "energy from nowhere": float(run.summary.get("energy", {}).get("unexplained_gain_over_exchanged", 0.0))}


def bad(r, name):
    return sum(not p.done or p.values["growth"] > chart.bound for p in r.some(name))


def claims(r):
    yield "with the default terms no point fails or grows", lambda: bad(r, ALL), "==", 0
    yield "without them some do", lambda: bad(r, FEW), ">", 0


def says(r):
    return ("The default is stable at every Courant number up to 100 and every Reynolds number of a cell up to 1e4: velocities stay within %.2g times the jet's. "
            "Without the terms of the open boundary %d of %d points fail or grow."
            % (max(p.values["growth"] for p in r.some(ALL)), bad(r, FEW), len(r.some(FEW))))
