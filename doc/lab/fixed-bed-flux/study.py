"""Flux through a fixed bed.

2,000 discs that do not move, under half of the head that would lift them; the flux after 50 steps of 1 ms, when it is steady. The bed
has two faces, at which the void fraction jumps, and a random inside. Swept: cells, even and finer at the faces; how a grain is spread
(filter); how its pieces are integrated (rule); when the linear solver stops. Error: of the flux, over that of the reference: even cells
of 0.25 d and the smooth filter of 2.5 d, which is as wide as the default's even one of 2 d and whose flux has a limit
(doc/validation.md: an even disc has an edge, and the finer the mesh the more that costs).
"""
from laboratory.study import Chart, Point

order = 1
scene = "bed.prm"
chart = Chart()
error_title = "error of the flux"


def cells(h):
    return {"Mesh refinement/Criteria": "uniform", "Mesh refinement/Criteria: uniform/Cell size": h,
            "Mesh refinement/Coarsest cell size": max(8, h), "Mesh refinement/Interval": 0}


def at_faces(h):
    return {"Mesh refinement/Criteria: bed faces/Cell size at the bottom": h, "Mesh refinement/Criteria: bed faces/Cell size at the top": h}


SMOOTH = {"Coupling/Filter radius": "2.5 d", "Coupling/Filter shape": "smooth"}


def points(quick):
    finest = 0.5 if quick else 0.25
    yield Point("smooth filter, even cells", "smooth, %g d" % finest, {**SMOOTH, **cells(finest)}, reference=True)
    for h in [8, 2, 1] if quick else [8, 4, 2, 1, 0.5, 0.25]:
        yield Point("even cells", "%g d" % h, cells(h))
    for h in [1] if quick else [4, 2, 1, 0.5]:
        yield Point("8 d, finer at the faces", "to %g d" % h, at_faces(h), default=h == 1)
    for h in [2] if quick else [8, 4, 2, 1]:
        yield Point("the paper's choices, even cells", "paper, %g d" % h, {"Method": "paper", "Coupling/Drag law": "disc", **cells(h)})
    for h in [2] if quick else [4, 2, 1, 0.5]:
        yield Point("smooth filter, even cells", "smooth, %g d" % h, {**SMOOTH, **cells(h)})
    for radius in ["grain"] if quick else ["grain", "1 d", "1.5 d"]:
        yield Point("other filters, even cells of 1 d", "filter " + radius, {"Coupling/Filter radius": radius, **cells(1)})
    for rule in ["centroid"] if quick else ["centroid", "centre"]:
        yield Point("other rules, even cells of 2 d", rule, {"Coupling/Overlap rule": rule, **cells(2)})
    for tolerance in [1e-2] if quick else [1e-1, 1e-2, 1e-4]:
        yield Point("linear tolerance, even cells of 1 d", "tolerance %g" % tolerance, {"Fluid/Linear solver/Tolerance": tolerance, **cells(1)})


def measure(run, point):
    return {"flux [m2/s]": run.last("flux_top_m2_per_s"), "cells": run.summary["scene"]["cells"],
            "linear iterations": run.summary["counts"]["linear iterations"]}


def error(values, reference):
    return abs(values["flux [m2/s]"] / reference["flux [m2/s]"] - 1)


def says(r):
    return ("The cheapest setting within 1 % of the flux takes %.2g times the CPU time of even cells of 8 d, which are %.0f %% off."
            % (r.cheapest("error", 0.01).cpu_s / r.cpu("even cells", "8 d"), 100 * r.error("even cells", "8 d")))


def claims(r):
    yield "even cells of 2 d are within 2 % of the finest", lambda: r.error("even cells", "2 d"), "<", 0.02
    yield "cells of 8 d are wrong at the bed's faces", lambda: r.error("even cells", "8 d"), ">", 0.02
    yield "cells that are fine at the faces alone do as well as fine ones everywhere", lambda: r.error("8 d, finer at the faces", "to 1 d"), "<", 0.01
