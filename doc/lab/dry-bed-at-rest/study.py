"""Holding a settled dry bed.

4,000 discs, 85 layers, at rest between walls for 0.1 s; it starts without knowing a contact force. Swept: the contacts' tolerance at two time steps,
solvers, soft spheres by stiffness. A bed at rest is usually recognised and left alone (`Steps to rest`); here that is off but for the
default. Soft spheres take up the load by falling into one another, and bounce while they do. Both errors have closed forms: what the walls carry over the weight is 1 (root mean square of the deviation in the rows after the
first 0.01 s), and discs do not overlap (mean overlap over d in those rows).
"""
import numpy as np

from laboratory.study import Chart, Point

order = 4
scene = "bed.prm"
chart = Chart()
limit = 120
AWAKE = {"Contacts/Steps to rest": 0}
reference = {}  # closed forms


def tolerances(tolerance):
    return {"Contacts/Residual tolerance": tolerance, "Contacts/Largest violation": min(100 * tolerance, 0.5), **AWAKE}


def points(quick):
    for tolerance in [1e-2, 1e-4] if quick else [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]:
        yield Point("steps of 1 ms", "1 ms, %.0e" % tolerance, tolerances(tolerance))
    for tolerance in [1e-3] if quick else [1e-2, 1e-3, 1e-4, 1e-5]:
        yield Point("steps of 0.1 ms", "0.1 ms, %.0e" % tolerance, {"Time/Time step": 1e-4, **tolerances(tolerance)})
    for solver in [] if quick else ["Gauss-Seidel", "SOR", "accelerated Jacobi", "work queue"]:
        yield Point("other solvers, 1 ms, 4e-5", solver, {"Contacts/Contact solver": solver, **AWAKE})
    yield Point("accelerated Gauss-Seidel, 1 ms, 4e-5", "default", {}, default=True)
    yield Point("accelerated Gauss-Seidel, 1 ms, 4e-5", "kept awake", AWAKE)
    if not quick:
        yield Point("accelerated Gauss-Seidel, 1 ms, 4e-5", "no moment correction", {"Contacts/Moment correction": False, **AWAKE})
    for stiffness in [] if quick else [1e4, 1e5]:
        yield Point("soft spheres", "k %.0e" % stiffness, {"Contacts/Contact model": "soft-sphere", "Contacts/Soft spheres/Stiffness": stiffness, **AWAKE})


def measure(run, point):
    late = run.time > 0.01
    support = run.columns["wall_force_over_weight"][late]
    return {"walls over weight - 1, rms": float(np.sqrt(np.mean((support - 1) ** 2))), "mean overlap / d": float(np.mean(run.columns["mean_penetration_over_d"][late])),
            "sweeps": run.summary["counts"].get("contact sweeps", 0)}


def error(values, _):
    return {"what the walls carry": values["walls over weight - 1, rms"], "the places (mean overlap / d)": values["mean overlap / d"]}


def claims(r):
    yield "the default carries the weight within 0.1 %", lambda: r.error("accelerated Gauss-Seidel, 1 ms, 4e-5", "default", "what the walls carry"), "<", 1e-3
    yield "and leaves less than 1e-4 d of overlap", lambda: r.error("accelerated Gauss-Seidel, 1 ms, 4e-5", "default", "the places (mean overlap / d)"), "<", 1e-4
    yield "a tolerance of 1e-4 carries the weight within 0.5 %", lambda: r.error("steps of 1 ms", "1 ms, 1e-04", "what the walls carry"), "<", 5e-3
    yield "one of 1e-2 does not hold the bed", lambda: r.failed("steps of 1 ms", "1 ms, 1e-02"), "==", 1


def says(r):
    tight, loose = r.done("steps of 1 ms", "1 ms, 1e-05"), r.done("steps of 1 ms", "1 ms, 1e-03")
    return ("A tight tolerance is cheap: contacts to 1e-5 take %.2g times the CPU time of contacts to 1e-3 and carry the weight %.0f times as well, and with 1e-2 the bed does not hold. "
            "The default carries it within %.2g %% and leaves a mean overlap of %.1e d; about half of its %.1f s is the program's start."
            % (tight.cpu_s / loose.cpu_s, loose.errors["what the walls carry"] / tight.errors["what the walls carry"], 100 * r.default.errors["what the walls carry"],
               r.default.errors["the places (mean overlap / d)"], r.default.cpu_s))
