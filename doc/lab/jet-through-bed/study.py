"""A jet through a bed and out of an open top.

Water enters by a slot of 2 mm in the floor at 0.05 m/s, breaks a channel through 1,000 discs of sand, and leaves by the open top; eddies
come back there. Swept: cells, even and finer where the flow shears or grains move; time steps; schemes; terms of the open boundary. Error
of the head: of the differential head over the bed, its mean from 0.02 to 0.06 s, while the channel opens; of the grains moved: of the mass
fraction that has moved by a diameter after 0.06 s. Reference: even cells of 0.5 d, steps of 0.5 ms.
"""
from laboratory.study import Chart, Point

order = 6
scene = "jet.prm"
limit = 400
chart = Chart()
floor = {"the head": 0.0075, "the grains moved": 0.022}  # what even cells of 1 d in chosen steps differ from the reference by, the most of two versions of the program


def cells(h):
    return {"Mesh refinement/Criteria: uniform/Cell size": h, "Mesh refinement/Coarsest cell size": max(8, h)}


def adaptive(criteria, h):
    return {"Mesh refinement/Criteria": criteria, "Mesh refinement/Interval": 10, "Mesh refinement/Finest cell size": h, "Mesh refinement/Coarsest cell size": 8,
            **{"Mesh refinement/Criteria: %s/Cell size" % name: h for name in ("moving grains", "drag work")},
            "Mesh refinement/Criteria: bed faces/Cell size at the bottom": h, "Mesh refinement/Criteria: bed faces/Cell size at the top": h}


def points(quick):
    yield Point("even cells, chosen steps", "1 d, 1 ms" if quick else "0.5 d, 0.5 ms", {"Time/Time step": 1e-3 if quick else 5e-4, **cells(1 if quick else 0.5)}, reference=True)
    for h in [8, 4] if quick else [8, 4, 2, 1]:
        yield Point("even cells, chosen steps", "%g d" % h, cells(h), default=h == (4 if quick else 2))
    for dt in [5e-3] if quick else [5e-4, 5e-3]:
        yield Point("fixed steps, cells of 2 d", "%g ms" % (1e3 * dt), {"Time/Time step": dt})
    for criteria, h in [("velocity jump", 2)] if quick else [("velocity jump", 2), ("bed faces, moving grains", 2)]:
        yield Point("adaptive cells, chosen steps", "%s, to %g d" % (criteria, h), adaptive(criteria, h))
    for scheme, word in [] if quick else [("explicit", "explicit"), ("semi-implicit per grain", "per grain"), ("semi-implicit per piece", "per piece")]:
        yield Point("time schemes, cells of 2 d, 1 ms", word, {"Time/Time step": 1e-3, "Coupling/Time scheme": scheme})
    for terms in [] if quick else ["none", "backflow"]:
        yield Point("open boundary terms, cells of 2 d", "terms: " + terms, {"Fluid/Open boundary terms": terms})


def measure(run, point):
    late = (run.time > 0.0195) & (run.time < 0.0605)
    return {"head [m]": run.columns["differential_head_m"][late].mean(), "moved": run.at(0.06, "moved_mass_fraction"), "steps": run.summary["run"]["steps"], "cells": run.summary["scene"]["cells"]}


def error(values, reference):
    return {"the head": abs(values["head [m]"] / reference["head [m]"] - 1), "the grains moved": abs(values["moved"] / reference["moved"] - 1)}


def claims(r):
    yield "cells of 4 d know the head within 10 %", lambda: r.error("even cells, chosen steps", "4 d", "the head"), "<", 0.1
    yield "and the grains moved within 10 %", lambda: r.error("even cells, chosen steps", "4 d", "the grains moved"), "<", 0.1
    yield "steps of 5 ms know the head within 10 %", lambda: r.error("fixed steps, cells of 2 d", "5 ms", "the head"), "<", 0.1


def says(r):
    best = r.cheapest("the head", 0.1)
    return ("The cheapest setting found that knows the head within 10 %% is %s, for %.1f s of CPU time; the default (%s) is %.1f %% off for %.1f s. "
            "Cells that only follow jumps of the velocity miss the bed's faces, and %.0f %% of the head; fewer terms on the open boundary change nothing here, but cost half as much again."
            % (best.point.name, best.cpu_s, r.default.point.label, 100 * r.default.errors["the head"], r.default.cpu_s,
               100 * r.error("adaptive cells, chosen steps", "velocity jump, to 2 d", "the head")))
