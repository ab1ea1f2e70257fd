"""The linear solver: cells, time step and void fraction.

Water through a fixed bed of 300 discs, 20 steps from rest, at a head that would lift it. What is drawn is the number of GMRES iterations a
solve; 200 stands for solves by the direct solver, which follows where GMRES has failed with both of its preconditioners. Swept: the
cells, the step, the void fraction of the bed and the filter. Without a filter cells finer than a grain are full of it; a filter of 2 d
smears it. The line is a step of one relaxation time of the drag: to its right the velocity is that of Darcy's law.
"""
import math

from laboratory.study import Map, Point

order = 15
scene = "bed.prm"
limit = 60
measure_failed = True

d, rho_p, eta = 2.2e-4, 2630.0, 1e-3
STEPS, DIRECT = 20, 200.0
series = {"void fraction 0.48": (0.48, "2 d"), "void fraction 0.48, filter of a grain": (0.48, "grain"),
          "void fraction 0.25": (0.25, "2 d"), "void fraction 0.25, filter of a grain": (0.25, "grain")}


def lines(name):
    eps = series[name][0]
    tau = rho_p / (2 / math.pi * eps**-2.8 * 4.8**2 * eta / d**2)
    yield "one relaxation time of the bed's drag", [tau, tau], [0.1, 10]


chart = Map(x="time step [s]", y="cell size / d", value="iterations", title="GMRES iterations a solve", bound=60, log="xyv", lines=lines,
            stands=[(1e-3, 1.0, "cells of 1 d, 1 ms", "void fraction 0.48")])


def points(quick):
    for name, (eps, filter_radius) in series.items():
        if quick and name != "void fraction 0.48":
            continue
        for h in [1, 4] if quick else [0.25, 0.5, 1, 2, 8]:
            for dt in [1e-3] if quick else [1e-5, 1e-3, 1]:
                yield Point(name, "%g, %g" % (dt, h), {"Time/Time step": dt, "Time/End time": STEPS * dt, "Mesh refinement/Criteria: uniform/Cell size": h,
                                                       "Grains/Fluid packing fraction": 1 - eps, "Coupling/Filter radius": filter_radius}, x=dt, y=h)


def measure(run, point):
    counts = run.summary["counts"]
    direct = counts.get("linear solves by the direct solver", 0)
    solves = max(run.summary["run"]["steps"] - counts.get("fluid steps like the last", 0), 1)
    return {"iterations": DIRECT if direct else max(counts["linear iterations"] / solves, 1), "direct solves": direct, "loose solves": counts.get("linear solves above the tolerance", 0)}


def most(r, name):
    return max(p.values["iterations"] if p.done else float("inf") for p in r.some(name))


def lost(r):
    """(failed, by the direct solver) of all."""
    return sum(not p.done for p in r), sum(p.done and p.values["iterations"] == DIRECT for p in r)


def claims(r):
    for name in series:
        if "filter" not in name:
            yield "%s: GMRES solves it on all cells and steps" % name, lambda name=name: most(r, name), "<=", chart.bound


def says(r):
    return ("With the default filter GMRES takes at most %.0f iterations a solve at a void fraction of 0.48 and %.0f at 0.25, on cells from 8 d to 0.25 d, for steps of 1e-5 to 1 s. "
            "Of all points, those without a filter included, %d failed and %d took the direct solver."
            % (most(r, "void fraction 0.48"), most(r, "void fraction 0.25"), *lost(r)))
