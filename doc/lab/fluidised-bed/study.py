"""Onset, first movement and heave of a fluidised bed.

2,000 discs of sand; the head rises by its water column's weight a second, from 0.7 of it, until the bed heaves. Swept: fixed time steps and
chosen ones with their tolerance, time schemes, tolerance and solver of the contacts, cells. Error of the onset: of the head at which the
fluid carries the bed, over its closed form (s phi_m - phi_b) L. Errors of first movement and heave (5 % and 95 % of the mass have moved by
a diameter): of the head imposed at that instant, over the reference's: cells of 0.5 d at
the bed's faces, steps of 0.1 ms, contacts to 1e-6.
Movement grows out of contacts that slip, so settings that should not matter (another contact solver, a tighter tolerance) shift it, too. What
is hatched is what steps of 0.3 ms differ from the reference by: 0.1 % of the head at the first movement, 0.25 % at the heave.
"""
from laboratory.meshes import at_faces, cells
from laboratory.study import Chart, Point

order = 2
scene = "ramp.prm"
limit = 400
chart = Chart()
floor = {"the first movement": 1e-3, "the heave": 2.5e-3}

TIGHT = {"Contacts/Residual tolerance": 1e-6}


def points(quick):
    if quick:
        yield Point("fixed steps", "0.5 ms", {"Time/Time step": 5e-4, **TIGHT}, reference=True)
    else:
        yield Point("8 d, finer at the faces, steps chosen", "to 0.5 d, 0.1 ms", {"Time/Time step": 1e-4, **at_faces(0.5), **TIGHT}, reference=True)
    for dt in [1e-3, 5e-3] if quick else [3e-4, 1e-3, 2e-3, 5e-3, 1e-2]:
        yield Point("fixed steps", "%g ms" % (1e3 * dt), {"Time/Time step": dt})
    for tolerance in [0.05] if quick else [0.01, 0.05, 0.2]:
        yield Point("chosen steps", "auto %g" % tolerance, {"Time/Automatic time step/Tolerance": tolerance}, default=tolerance == 0.05)
    for scheme, word in [("explicit", "explicit")] if quick else [("explicit", "explicit"), ("implicit drag", "implicit drag"), ("semi-implicit per grain", "per grain"),
                                                                  ("semi-implicit per piece", "per piece")]:
        yield Point("time schemes, steps of 1 ms", word, {"Time/Time step": 1e-3, "Coupling/Time scheme": scheme})
    for tolerance in [] if quick else [1e-3, 1e-5]:
        yield Point("contact tolerance, steps chosen", "contacts %.0e" % tolerance, {"Contacts/Residual tolerance": tolerance})
    for solver in [] if quick else ["Gauss-Seidel"]:
        yield Point("contact solver, steps chosen", solver, {"Contacts/Contact solver": solver})
    for h in [8] if quick else [8, 4, 2]:
        yield Point("even cells, steps chosen", "%g d" % h, cells(h))
    for h in [] if quick else [4]:
        yield Point("8 d, finer at the faces, steps chosen", "to %g d" % h, at_faces(h))


def measure(run, point):
    imposed = lambda event: 0.7 + run.summary[event]["time_s"]  # over H
    return {"onset over exact": run.summary["onset by force balance"]["over_exact"], "first movement [H]": imposed("first movement"),
            "heave [H]": imposed("total heave"), "steps": run.summary["run"]["steps"]}


def error(values, reference):
    return {"the onset": abs(values["onset over exact"] - 1),
            "the first movement": abs(values["first movement [H]"] / reference["first movement [H]"] - 1),
            "the heave": abs(values["heave [H]"] / reference["heave [H]"] - 1)}


def claims(r):
    yield "chosen steps, the default, find the onset within 0.1 %", lambda: r.error("chosen steps", "auto 0.05", "the onset"), "<", 1e-3
    yield "the first movement within 1 %", lambda: r.error("chosen steps", "auto 0.05", "the first movement"), "<", 1e-2
    yield "the heave within 1 %", lambda: r.error("chosen steps", "auto 0.05", "the heave"), "<", 1e-2
    yield "cells of 8 d find the onset within 1 %", lambda: r.error("even cells, steps chosen", "8 d", "the onset"), "<", 1e-2
    yield "but movement they find wrong by more", lambda: r.error("even cells, steps chosen", "8 d", "the first movement"), ">", 1e-2
    yield "the explicit scheme fails in steps of 1 ms", lambda: r.failed("time schemes, steps of 1 ms", "explicit"), "==", 1


def says(r):
    auto, coarse = r.default, r.done("even cells, steps chosen", "8 d")
    fixed = r.done("fixed steps", "5 ms")
    return ("Chosen steps, the default, find the onset within %.2g %%, the first movement within %.2g %% and the heave within %.2g %%; fixed steps of 5 ms take %.2g times their CPU time, for %.2g, %.2g and %.2g %%%s. "
            "Cells of 8 d take %.2g times it, and are %.2g, %.2g and %.2g %% off."
            % (*(100 * e for e in auto.errors.values()), fixed.cpu_s / auto.cpu_s, *(100 * e for e in fixed.errors.values()),
               ": the default is not on the front" if all(auto not in r.front(name) for name in r.error_names()) else "", coarse.cpu_s / auto.cpu_s, *(100 * e for e in coarse.errors.values())))
