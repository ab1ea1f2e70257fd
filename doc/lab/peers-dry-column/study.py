"""Other programs on a dry bed that is sheared: a column collapses.

1,000 discs, piled up 0.009 m high and 0.006 m wide; the right wall goes, and they spread on a floor for 0.12 s, in our program and in four others. All read the same
table of grains, which our program has settled. Friction is 0.4; hard contacts do not bounce, soft spheres have a restitution of 0.2. Error of the
spreading: of the way that the discs' mean place has come to the side; of the fall: of its way down. Reference: our own steps of 0.1 ms, contacts to 1e-6. Single discs
go elsewhere in every one of these runs, and always will; the means know less of that, but something: hatched is by how much the reference in steps of
0.2 ms and with another contact solver differs. What the programs are, and what is done for peclet, which is three-dimensional, says the [study of the bed at
rest](../peers-dry-bed/README.md).
"""
import numpy as np

from laboratory import peers
from laboratory.study import Chart

order = 18
scene = "collapse.prm"
bed = "bed.prm"
always = {"Grains/Deposit: file/File": "{bed}", "Output/Interval of pictures": 0.12}
chart = Chart()
limit = 400
jobs = 1
program, cpu_says = peers.program, peers.CPU_SAYS
floor = {"the spreading": 0.042, "the fall": 0.013}  # what the reference with another contact solver differs by
TIGHT = {"Contacts/Residual tolerance": 1e-6}
SPREAD = "the spreading"


def points(quick):
    Point = peers.Point
    finest = 2e-4 if quick else 1e-4
    yield Point("Alluvium, contacts to 1e-6", "%g ms, 1e-6" % (1e3 * finest), {"Time/Time step": finest, **TIGHT}, reference=True)
    if not quick:
        yield Point("Alluvium, contacts to 1e-6", "0.2 ms, 1e-6", {"Time/Time step": 2e-4, **TIGHT}, shown="0.2 ms")
        yield Point("Alluvium, contacts to 1e-6", "0.1 ms, work queue", {"Time/Time step": 1e-4, "Contacts/Contact solver": "work queue", **TIGHT}, shown="work queue")
    for dt in [1e-3] if quick else [2e-4, 5e-4, 1e-3, 2e-3, 5e-3]:
        yield Point("Alluvium, fixed steps", "%g ms" % (1e3 * dt), {"Time/Time step": dt})
    yield Point("Alluvium, chosen steps", "auto", {"Time/Time step": "auto"}, default=True)
    for dt, tolerance in [("1e-3", "1e-8")] if quick else [("1e-4", "1e-8"), ("5e-4", "1e-8"), ("1e-3", "1e-8")]:
        yield peers.point("MigFlow", "MigFlow %g ms, %s" % (1e3 * float(dt), tolerance), "migflow", {"--dt": dt, "--tolerance": tolerance, **COLUMN}, shown="%g ms, %s" % (1e3 * float(dt), tolerance))
    for tolerance in [] if quick else ["1e-3"]:
        yield peers.point("Siconos, steps of 1 ms", "Siconos " + tolerance, "siconos", {"--dt": "1e-3", "--tolerance": tolerance, **COLUMN}, peers.SYSTEM, shown=tolerance)
    for overlap in ["1e-2"] if quick else ["1e-2", "1e-3"]:
        yield peers.point("LAMMPS, soft spheres", "LAMMPS " + overlap, "lammps", {"--overlap": overlap, **COLUMN}, peers.SYSTEM, shown=overlap)
    for overlap in [] if quick else ["1e-2", "1e-3"]:
        yield peers.point("peclet, Hertz", "Hertz " + overlap, "peclet", {"--engine": "hertz", "--overlap": overlap, **COLUMN}, shown=overlap)
    for dt in [] if quick else ["1e-4", "1e-3"]:
        yield peers.point("peclet, impulses, 50 sweeps", "impulses " + dt, "peclet", {"--engine": "impulse", "--dt": dt, "--sweeps": 50, **COLUMN}, shown="%g ms" % (1e3 * float(dt)))


COLUMN = {"--box-width": "0.03", "--time": "0.12"}


def measure(run, point):
    if point.command:
        said = peers.said(run)
        return {"CPU [s]": said["cpu_s"], "spreading [m]": said["spreading_m"], "fall [m]": said["fall_m"], "largest overlap / d": said["max_overlap_d"]}
    (_, first), (_, last) = run.picture("grains", 0), run.picture("grains", 0.12)
    mean = lambda grains, k: np.average(grains.points[:, k], weights=grains.fields["radius"] ** 2)
    return {"CPU [s]": peers.cpu_of_steps(run), "spreading [m]": mean(last, 0) - mean(first, 0), "fall [m]": mean(first, 1) - mean(last, 1),
            "largest overlap / d": run.summary["audit"]["largest_penetration_over_d"]}


def error(values, reference):
    return {SPREAD: abs(values["spreading [m]"] / reference["spreading [m]"] - 1), "the fall": abs(values["fall [m]"] / reference["fall [m]"] - 1)}


def claims(r):
    yield "chosen steps know the spreading within 10 %", lambda: r.error("Alluvium, chosen steps", "auto", SPREAD), "<", 0.1
    yield "MigFlow in steps of 0.1 ms agrees within 10 %", lambda: r.error("MigFlow", "MigFlow 0.1 ms, 1e-8", SPREAD), "<", 0.1
    yield "and takes more than five times the CPU time of our fixed steps of 0.2 ms", lambda: r.cpu("MigFlow", "MigFlow 0.1 ms, 1e-8") / r.cpu("Alluvium, fixed steps", "0.2 ms"), ">", 5
    yield "LAMMPS agrees within 10 %", lambda: peers.best(r, SPREAD, "LAMMPS").errors[SPREAD], "<", 0.1


def says(r):
    auto, migflow = r.default, r.done("MigFlow", "MigFlow 0.1 ms, 1e-8")
    told = lambda x: "%.1f %% off for %.2g s" % (100 * x.errors[SPREAD], x.cpu_s)
    best = lambda series: told(peers.best(r, SPREAD, series))
    return ("The spreading is not known better than within %.1f %%. Ours in chosen steps is %s of CPU time, MigFlow in steps of 0.1 ms %s, LAMMPS at best %s, peclet's soft spheres %s and its impulses %s. "
            "Siconos' solver to 1e-3, the only tolerance that was run, is %s."
            % (100 * r.floor(SPREAD), told(auto), told(migflow), best("LAMMPS"), best("peclet, Hertz"), best("peclet, impulses"), best("Siconos")))
