"""Overlap rules and filters: how smooth the force on a grain is.

A disc of 1 mm moves at 1 mm/s (Re = 1) along a line that slants across the cells of a closed box, for two diameters; it is so heavy
that nothing turns it aside. What is drawn is the largest |F(k+1) - 2 F(k) + F(k-1)| of the fluid's force F in the second diameter, over the mean force:
what a grain that crosses faces of cells makes of an even motion. Swept: cells, and the path in a time step. Theory has no line here, but
orders: with exact overlaps jumps fall with the path (`even`, whose edge passes lines of the mesh) or its square (`smooth`); a grain
that is wholly in the cell of its centre makes spikes that the time step divides.
"""
import math

import numpy as np

from laboratory.study import Map, Point

order = 16
scene = "grain.prm"
limit = 60

d, v = 1e-3, 1e-3
EVEN, SMOOTH, EXACT, CENTROID, CENTRE = ("exact, filter 2 d (default)", "exact, smooth filter 2 d", "exact, filter of a grain", "centroid, filter of a grain",
                                         "centre, filter of a grain")
series = {EVEN: ("moments", "2 d", "even"), SMOOTH: ("moments", "2 d", "smooth"), EXACT: ("moments", "grain", "even"), CENTROID: ("centroid", "grain", "even"),
          CENTRE: ("centre", "grain", "even")}


chart = Map(x="path a step / d", y="cell size / d", value="jump", title="largest jump of the force / mean", bound=1e-2, log="xyv",
            stands=[(0.02, 1.0, "cells of 1 d, d/50 a step", EVEN)])


def points(quick):
    slope = math.radians(25)
    row = "x,y,radius,density,vx,vy\n%.10g,%.10g,%.10g,1e9,%.10g,%.10g\n" % (3.1e-3, 3.3e-3, d / 2, v * math.cos(slope), v * math.sin(slope))
    for name, (rule, radius, shape) in series.items():
        if quick and name not in (EVEN, CENTRE):
            continue
        for h in [1] if quick else [0.25, 0.5, 1, 2]:
            for p in [0.04] if quick else [0.01, 0.02, 0.04, 0.1]:
                dt = p * d / v
                yield Point(name, "%g, %g" % (p, h), {
                    "Time/Time step": "%.10g" % dt, "Time/End time": "%.10g" % (2 * d / v), "Mesh refinement/Criteria: uniform/Cell size": h,
                    "Coupling/Overlap rule": rule, "Coupling/Filter radius": radius, "Coupling/Filter shape": shape, "Grains/Deposit: file/File": "{folder}/grain.csv"},
                    files={"grain.csv": row}, x=p, y=h)


def measure(run, point):
    force = np.asarray(run.columns["fluid_force_over_weight"], float)
    force = force[len(force) // 2:]
    return {"jump": float(np.max(np.abs(np.diff(force, 2))) / abs(np.mean(force)))}


def largest(r, name, most=1.0):
    """Of steps of up to `most` d."""
    return max(p.values.get("jump", float("inf")) for p in r.some(name) if p.point.x <= most)


def claims(r):
    jump = lambda name, path, h: r.value(name, "%g, %g" % (path, h), "jump")
    yield "with the default jumps stay below 0.1 % for paths of d/25 a step and less", lambda: largest(r, EVEN, 0.041), "<", 1e-3
    yield "so they do with the smooth filter", lambda: largest(r, SMOOTH, 0.041), "<", 1e-3
    yield "there they fall with the square of the path: half of it, on cells of 1 d", lambda: jump(SMOOTH, 0.02, 1) / jump(SMOOTH, 0.04, 1), "<", 0.3
    yield "a grain that is wholly in the cell of its centre makes jumps of more than 10 %", lambda: largest(r, CENTRE, 0.041), ">", 0.1
    yield "which grow as steps get shorter: a quarter of the path, on cells of 1 d", lambda: jump(CENTRE, 0.01, 1) / jump(CENTRE, 0.04, 1), ">", 1.5


def says(r):
    return ("With the default, exact overlaps and a filter of 2 d, a grain that crosses cells of 2 d to 0.25 d at d/25 a step or less makes its force jump by at most %.1g %%; with the smooth filter it is %.1g %%. "
            "Without a filter jumps reach %.2g %%, with centroids %.2g %%, and with a grain that is wholly in the cell of its centre %.2g %%."
            % tuple(100 * largest(r, name, 0.041) for name in (EVEN, SMOOTH, EXACT, CENTROID, CENTRE)))
