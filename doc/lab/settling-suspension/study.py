"""A settling suspension.

526 discs at random places, a tenth of the area, sink from rest in a box that is periodic in x. Swept: cells, time steps, time schemes, how a
grain is spread. Error of the fall: of the discs' mean way down after 0.05 s; of the fluctuations: of the root mean square of their
speed about its mean then. Reference: even cells of 0.5 d, steps of 0.5 ms, else the default. Discs that fall farther meet, and part from
any reference: this is about the first four diameters.
"""
import numpy as np

from laboratory.study import Chart, Point

order = 3
scene = "suspension.prm"
limit = 400
chart = Chart()
floor = {"the fall": 1e-3, "the fluctuations": 0.03}  # what cells of 1 d and steps of 1 ms differ from the reference by


def cells(h):
    return {"Mesh refinement/Criteria: uniform/Cell size": h, "Mesh refinement/Coarsest cell size": max(8, h)}


def points(quick):
    yield Point("cells, steps of 1 ms", "1 d, 0.5 ms" if quick else "0.5 d, 0.5 ms", {**cells(1 if quick else 0.5), "Time/Time step": 5e-4}, reference=True)
    for h in [8, 2] if quick else [8, 4, 2, 1]:
        yield Point("cells, steps of 1 ms", "%g d" % h, cells(h), default=h == 2)
    for dt in [1e-2] if quick else [3e-4, 5e-3, 1e-2]:
        yield Point("steps, cells of 2 d", "%g ms" % (1e3 * dt), {"Time/Time step": dt})
    for dt in [] if quick else [1e-2]:
        yield Point("steps, cells of 1 d", "%g ms, 1 d" % (1e3 * dt), {"Time/Time step": dt, **cells(1)})
    for tolerance in [0.05] if quick else [0.01, 0.05, 0.2]:
        yield Point("chosen steps, cells of 2 d", "auto %g" % tolerance, {"Time/Time step": "auto", "Time/Automatic time step/Tolerance": tolerance})
    for scheme, word in [("explicit", "explicit")] if quick else [("explicit", "explicit"), ("implicit drag", "implicit drag"), ("semi-implicit per grain", "per grain"),
                                                                  ("semi-implicit per piece", "per piece")]:
        yield Point("time schemes, cells of 2 d, 1 ms", word, {"Coupling/Time scheme": scheme})
    for name, radius, shape, h in [("filter grain, 2 d", "grain", "even", 2)] if quick else [
            ("filter grain, 2 d", "grain", "even", 2), ("filter grain, 1 d", "grain", "even", 1),
            ("smooth, 2 d", "2.5 d", "smooth", 2), ("smooth, 1 d", "2.5 d", "smooth", 1)]:
        yield Point("other filters, 1 ms", name, {"Coupling/Filter radius": radius, "Coupling/Filter shape": shape, **cells(h)})


def measure(run, point):
    speed = run.columns["settling_speed_m_per_s"]
    return {"fall [m]": np.trapz(speed, run.time), "fluctuations [m/s]": run.last("settling_speed_rms_m_per_s"), "steps": run.summary["run"]["steps"]}


def error(values, reference):
    return {"the fall": abs(values["fall [m]"] / reference["fall [m]"] - 1),
            "the fluctuations": abs(values["fluctuations [m/s]"] / reference["fluctuations [m/s]"] - 1)}


def claims(r):
    yield "cells of 2 d know the mean fall within 5 %", lambda: r.error("cells, steps of 1 ms", "2 d", "the fall"), "<", 0.05
    yield "cells of 8 d lose a third of the fluctuations", lambda: r.error("cells, steps of 1 ms", "8 d", "the fluctuations"), ">", 0.33
    yield "steps of 10 ms, three relaxation times, know the fall within 10 %", lambda: r.error("steps, cells of 2 d", "10 ms", "the fall"), "<", 0.1


def says(r):
    return ("The mean fall is right within %.2g %% even on cells of 8 d, but these miss %.0f %% of the fluctuations, those of 2 d %.0f %%; it is cells that decide on these, not steps: on cells of 2 d steps of 10 ms instead of 1 ms change the two errors to %.2g and %.0f %%. "
            "Chosen steps cost %.2g times those of 1 ms and are hardly more accurate. "
            "Where a longer step does better (5 ms), or another scheme (per piece), errors of cells and steps have cancelled: luck, that another suspension need not have."
            % (100 * r.error("cells, steps of 1 ms", "8 d", "the fall"), *(100 * r.error("cells, steps of 1 ms", h, "the fluctuations") for h in ("8 d", "2 d")),
               *(100 * r.error("steps, cells of 2 d", "10 ms", name) for name in ("the fall", "the fluctuations")), r.cpu("chosen steps, cells of 2 d", "auto 0.05") / r.default.cpu_s))
