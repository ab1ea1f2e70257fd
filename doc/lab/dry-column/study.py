"""A dry bed that is sheared: a column collapses.

1,000 discs, piled up 0.009 m high and 0.006 m wide, spread on a rough floor. Swept: time steps, fixed and chosen, the contacts' tolerance
and solver, soft spheres (which have to bounce: restitution 0.5, here 0). Error of the spreading: of the way that the discs' mean place has come to the side; of the fall: of its way down.
Reference: steps of 0.1 ms, contacts to 1e-6. Single discs go elsewhere in every one of these runs, and always will; the means know less
of that, but something: `floor` is by how much the reference in steps of 0.2 ms differs.
"""
import numpy as np

from laboratory.study import Chart, Point

order = 5
scene = "column.prm"
always = {"Output/Interval of pictures": 0.12}
chart = Chart()
floor = {"the spreading": 0.02, "the fall": 0.012}  # what the reference in steps of 0.2 ms differs by
limit = 120


def points(quick):
    finest = 2e-4 if quick else 1e-4
    yield Point("fixed steps", "%g ms, contacts 1e-6" % (1e3 * finest), {"Time/Time step": finest, "Contacts/Residual tolerance": 1e-6}, reference=True)
    if not quick:
        yield Point("fixed steps", "0.2 ms, contacts 1e-6", {"Time/Time step": 2e-4, "Contacts/Residual tolerance": 1e-6})
    for dt in [5e-4, 5e-3] if quick else [2e-4, 5e-4, 1e-3, 2e-3, 5e-3]:
        yield Point("fixed steps", "%g ms" % (1e3 * dt), {"Time/Time step": dt})
    for tolerance in [0.05] if quick else [0.01, 0.05, 0.2]:
        yield Point("chosen steps", "auto %g" % tolerance, {"Time/Time step": "auto", "Time/Automatic time step/Tolerance": tolerance}, default=tolerance == 0.05)
    for tolerance in [1e-2] if quick else [1e-1, 1e-2, 1e-3]:
        yield Point("contact tolerance, 0.5 ms", "contacts %.0e" % tolerance, {"Contacts/Residual tolerance": tolerance, "Contacts/Largest violation": min(0.5, 100 * tolerance)})
    for solver in [] if quick else ["Gauss-Seidel", "work queue"]:
        yield Point("contact solver, 0.5 ms", solver, {"Contacts/Contact solver": solver})
    for stiffness in [] if quick else [1e4, 1e5]:
        yield Point("soft spheres, 0.5 ms", "k %.0e" % stiffness, {"Contacts/Contact model": "soft-sphere", "Contacts/Soft spheres/Stiffness": stiffness})


def measure(run, point):
    (_, first), (_, last) = run.picture("grains", 0), run.picture("grains", 0.12)
    mean = lambda grains, k: np.average(grains.points[:, k], weights=grains.fields["radius"] ** 2)
    return {"spreading [m]": mean(last, 0) - mean(first, 0), "fall [m]": mean(first, 1) - mean(last, 1), "steps": run.summary["run"]["steps"],
            "largest overlap / d": run.summary["audit"]["largest_penetration_over_d"]}


def error(values, reference):
    return {"the spreading": abs(values["spreading [m]"] / reference["spreading [m]"] - 1), "the fall": abs(values["fall [m]"] / reference["fall [m]"] - 1)}


def claims(r):
    yield "chosen steps know the spreading within 10 %", lambda: r.error("chosen steps", "auto 0.05", "the spreading"), "<", 0.1
    yield "steps of 5 ms do, too", lambda: r.error("fixed steps", "5 ms", "the spreading"), "<", 0.1
    yield "contacts to 1e-2 do, too", lambda: r.error("contact tolerance, 0.5 ms", "contacts 1e-02", "the spreading"), "<", 0.1


def says(r):
    best = r.cheapest("the spreading", 0.021)
    return ("The reference itself knows the spreading no better than %.0f %%, and contacts to %s get there for %.1f s; finer steps and tolerances buy nothing that this scene can show. "
            "Chosen steps, the default, are %.1f %% off, for %.1f s; contacts solved to 1e-1 are %.1f %% off and overlap by up to %.0f %% of a diameter."
            % (100 * r.floor("the spreading"), best.point.label.replace("contacts ", ""), best.cpu_s, 100 * r.default.errors["the spreading"], r.default.cpu_s,
               100 * r.error("contact tolerance, 0.5 ms", "contacts 1e-01", "the spreading"), 100 * r.value("contact tolerance, 0.5 ms", "contacts 1e-01", "largest overlap / d")))
