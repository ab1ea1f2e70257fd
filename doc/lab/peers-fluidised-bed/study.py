"""MigFlow on onset, first movement and heave of a fluidised bed.

2,000 discs of sand in water; the head rises by its water column's weight a second, from 0.7 of it, until the bed heaves. Both programs read the same table of grains,
which ours has settled; the fluid sees 0.8 of their radii, and they weigh as discs of their full radii. Pressures, slip walls, friction and the law of the ramp are the
same; drag, meshes and how grains are shared are those of the [study of the fixed bed](../peers-fixed-bed/README.md). The drag laws differ by more here than there, 2 % at the
onset, of which the head that lifts a bed knows nothing. Error of the onset: of the head at which the fluid carries the bed, over its closed form (s phi_m - phi_b) L. Errors of
first movement and heave (5 % and 95 % of the mass have moved by a diameter): of the head imposed at that instant, over that of our own finest run: cells of 0.5 d
at the bed's faces, steps of 0.2 ms, contacts to 1e-6. They hold differences of the models, too: how grains are spread, and the drag once the bed moves.
MigFlow wants contact forces to predict the grains' speeds in the fluid step, and its `contact_forces()` gives zeros. `as its API gives contacts` has these;
`true contacts` reads the array behind them, which `contact_forces()` takes for half as long as it is. Contacts are solved to 1e-8 m, MigFlow's default.
"""
from laboratory import peers
from laboratory.meshes import at_faces, cells
from laboratory.study import Chart

order = 16
scene = "ramp.prm"
bed = "../peers-dry-bed/bed.prm"
always = {"Grains/Deposit: file/File": "{bed}"}
chart = Chart()
limit = 400
jobs = 1
program, cpu_says = peers.program, peers.CPU_SAYS
floor = {"the first movement": 1e-3, "the heave": 2.5e-3}  # study fluidised-bed
FIRST, HEAVE = "the first movement", "the heave"
SCENE = {"--height": "0.02", "--bed-height": "0.0095", "--radius-factor": "0.8"}
NOT_SPREAD = {"Coupling/Filter radius": "grain"}


def points(quick):
    Point = peers.Point
    if quick:
        yield Point("Alluvium, steps of 1 ms", "0.5 ms", {"Time/Time step": 5e-4, "Contacts/Residual tolerance": 1e-6}, reference=True)
    else:
        yield Point("Alluvium, steps of 1 ms", "to 0.5 d, 0.2 ms", {"Time/Time step": 2e-4, "Contacts/Residual tolerance": 1e-6, **at_faces(0.5)}, reference=True)
    yield Point("Alluvium, as it is set", "chosen steps", {}, default=True)
    for h in [] if quick else [4, 2]:
        yield Point("Alluvium, even cells, chosen steps", "%g d" % h, cells(h))
    for h in [4] if quick else [4, 2]:
        yield Point("Alluvium, even cells, steps of 1 ms", "1 ms, %g d" % h, {"Time/Time step": 1e-3, **cells(h)}, shown="%g d" % h)
    for h in [] if quick else [4, 2]:
        yield Point("Alluvium, grains not spread, steps of 1 ms", "not spread, %g d" % h, {"Time/Time step": 1e-3, **NOT_SPREAD, **cells(h)}, shown="%g d" % h)
    for series, switch in (("MigFlow, true contacts", {"--true-contacts": ""}), ("MigFlow, as its API gives contacts", {})):
        word = "true, " if switch else "API, "
        for h in ([] if quick else [4]) if not switch else [8] if quick else [8, 4, 2]:
            yield peers.point(series, word + "%g d" % h, "migflow-fluidised-bed", {"--cells": h, **switch, **SCENE}, shown="%g d" % h)


def measure(run, point):
    if point.command:
        said = peers.said(run)
        return {"CPU [s]": said["cpu_s"], "onset over exact": said["onset_over_exact"], "first movement [H]": said["first_movement_H"], "heave [H]": said["heave_H"],
                "steps": said["steps"], "CPU of contacts [s]": said["contacts_cpu_s"]}
    imposed = lambda event: 0.7 + run.summary[event]["time_s"]  # over H
    return {"CPU [s]": peers.cpu_of_steps(run), "onset over exact": run.summary["onset by force balance"]["over_exact"], "first movement [H]": imposed("first movement"),
            "heave [H]": imposed("total heave"), "steps": run.summary["run"]["steps"], "CPU of contacts [s]": run.cpu("contacts")}


def error(values, reference):
    return {"the onset": abs(values["onset over exact"] - 1), FIRST: abs(values["first movement [H]"] / reference["first movement [H]"] - 1),
            HEAVE: abs(values["heave [H]"] / reference["heave [H]"] - 1)}


def claims(r):
    yield "as it is set, our program finds the onset within 0.1 %", lambda: r.error("Alluvium, as it is set", "chosen steps", "the onset"), "<", 1e-3
    yield "the first movement within 1 %", lambda: r.error("Alluvium, as it is set", "chosen steps", FIRST), "<", 1e-2
    yield "the heave within 1 %", lambda: r.error("Alluvium, as it is set", "chosen steps", HEAVE), "<", 1e-2
    yield "with true contacts MigFlow finds the onset within 1 % on triangles of 8 d", lambda: r.error(TRUE, "true, 8 d", "the onset"), "<", 1e-2
    yield "and the heave within 5 %", lambda: r.error(TRUE, "true, 8 d", HEAVE), "<", 0.05
    yield "the zeros of its API change the heave by less than 1 %", lambda: abs(r.value(API, "API, 4 d", "heave [H]") / r.value(TRUE, "true, 4 d", "heave [H]") - 1), "<", 1e-2
    yield "on triangles of 4 d MigFlow takes more than five times our CPU time in the same steps", lambda: r.cpu(TRUE, "true, 4 d") / r.cpu("Alluvium, even cells, steps of 1 ms", "1 ms, 4 d"), ">", 5


TRUE, API = "MigFlow, true contacts", "MigFlow, as its API gives contacts"


def says(r):
    true, ours = r.done(TRUE, "true, 4 d"), r.done("Alluvium, even cells, steps of 1 ms", "1 ms, 4 d")
    told = lambda x: "%.2g, %.2g and %.2g %%" % tuple(100 * x.errors[name] for name in ("the onset", FIRST, HEAVE))
    api = r.get(API, "API, 4 d")
    return ("On cells of 4 d and in steps of 1 ms MigFlow with true contacts misses onset, first movement and heave by %s for %.2g s of CPU time, of which %.0f %% are contacts; ours by %s for %.2g s. "
            "With the zeros that its API gives for contact forces MigFlow %s."
            % (told(true), true.cpu_s, 100 * true.values["CPU of contacts [s]"] / true.cpu_s, told(ours), ours.cpu_s,
               "misses them by " + told(api) if api.done else "fails: " + api.reason))
