"""Other programs on a settled dry bed.

2,000 discs in 43 layers, at rest between walls for 0.05 s, in our program and in four others. All read the same table of grains, which our
program has settled. Friction is 0.4, and no program knows a contact force at first; nobody may put grains to sleep, except where it says so. Both errors have
closed forms. What the walls carry over the weight is 1: root mean square of the deviation over windows of 1 ms, after the first 10 ms; it follows from the
momentum of the grains, whatever a program reports. Discs do not overlap: mean overlap over d. CPU times of the others leave out
the first 10 ms, too, in which they find the contact forces; ours do not. What is swept is what each program calls accuracy:

- Alluvium: tolerance of the contacts, in two time steps; without its dead zone of gaps that count as closed; its other solvers.
- MigFlow: the same kind of model, and the code of the paper; tolerance in steps of 0.1 ms. It steps as its `time_integration.iterate` does, which halves a step
  whose sweeps do not converge. Its `contact_forces()` gives zeros; the array behind that has them. The table has the sums of both over the weight.
- Siconos: its Gauss-Seidel for the same contact problem, which is put together in Python; only the solver's own time counts.
- LAMMPS: soft spheres that are by so much squeezed at the floor. Their overlap is their model and no error. They get 0.04 s to sink into their springs
  that do not count.
- peclet is three-dimensional, in single precision. Its spheres are in one plane, with the discs' masses and moments of inertia, and are put back into the
  plane every ten steps, or the layer buckles. So far it can be compared: the grains, walls and laws are the same, its broad phase searches in three dimensions. `impulses` is its default engine
  for hard contacts, at the time step and sweeps that are said; `Hertz` its soft spheres, with LAMMPS' warm-up. Its fluid solver resolves grains in
  three dimensions, so that it has no place in the studies of beds in water.
"""
import numpy as np

from laboratory import peers
from laboratory.study import Chart

order = 17
scene = "hold.prm"
bed = "bed.prm"
always = {"Grains/Deposit: file/File": "{bed}"}
chart = Chart()
limit = 400
jobs = 1
reference = {}  # closed forms
program, cpu_says = peers.program, peers.CPU_SAYS
AWAKE = {"Contacts/Steps to rest": 0}
CARRIED, PLACES = "what the walls carry", "the places (mean overlap / d)"
WARM_UP = {"--warm-up": "0.02"}


def points(quick):
    Point = peers.Point
    tight = lambda tolerance: {"Contacts/Residual tolerance": tolerance, "Contacts/Largest violation": min(100 * tolerance, 0.5), **AWAKE}
    for tolerance in [1e-4] if quick else [1e-3, 1e-4, 1e-5, 1e-6]:
        yield Point("Alluvium, steps of 1 ms", "1 ms, %.0e" % tolerance, tight(tolerance), shown="%.0e" % tolerance)
    for tolerance in [] if quick else [1e-3, 1e-4, 1e-5, 1e-6]:
        yield Point("Alluvium, steps of 0.1 ms", "0.1 ms, %.0e" % tolerance, {"Time/Time step": 1e-4, **tight(tolerance)}, shown="%.0e" % tolerance)
    for tolerance in [] if quick else [1e-4, 1e-5, 1e-6]:
        yield Point("Alluvium, no dead zone, steps of 0.1 ms", "no dead zone, %.0e" % tolerance, {"Time/Time step": 1e-4, "Contacts/Dead zone": 0, **tight(tolerance)}, shown="%.0e" % tolerance)
    for solver, short in [] if quick else [("Gauss-Seidel", "GS"), ("SOR", "SOR"), ("accelerated Jacobi", "Jacobi"), ("work queue", "queue")]:
        yield Point("Alluvium, other solvers, 1 ms, 1e-5", solver, {"Contacts/Contact solver": solver, **tight(1e-5)}, shown=short)
    yield Point("Alluvium, as it is set", "asleep when at rest", {}, default=True, shown="asleep")
    yield Point("Alluvium, as it is set", "awake", AWAKE)
    for tolerance in ["1e-8"] if quick else ["1e-7", "1e-8", "1e-9", "1e-10"]:
        yield peers.point("MigFlow, steps of 0.1 ms", "MigFlow " + tolerance, "migflow", {"--dt": "1e-4", "--tolerance": tolerance}, shown=tolerance)
    for tolerance in [] if quick else ["1e-3", "1e-4", "1e-5"]:
        yield peers.point("Siconos, steps of 1 ms", "Siconos " + tolerance, "siconos", {"--dt": "1e-3", "--tolerance": tolerance}, peers.SYSTEM, shown=tolerance)
    for overlap in ["1e-2"] if quick else ["1e-2", "3e-3", "1e-3", "3e-4", "1e-4"]:
        yield peers.point("LAMMPS, soft spheres", "LAMMPS " + overlap, "lammps", {"--overlap": overlap, **WARM_UP}, peers.SYSTEM, shown=overlap)
    for overlap in [] if quick else ["1e-2", "3e-3", "1e-3"]:
        yield peers.point("peclet, Hertz", "Hertz " + overlap, "peclet", {"--engine": "hertz", "--overlap": overlap, "--call": 10, **WARM_UP}, shown=overlap)
    for dt, sweeps in [] if quick else [("1e-4", 50)]:
        yield peers.point("peclet, impulses", "impulses %s, %d" % (dt, sweeps), "peclet", {"--engine": "impulse", "--dt": dt, "--sweeps": sweeps}, shown="%s, %d" % (dt, sweeps))


def measure(run, point):
    if point.command:
        said = peers.said(run)
        values = {"CPU [s]": said["cpu_after_start_s"], "walls over weight - 1, rms": said["support_error"], "mean overlap / d": said["mean_overlap_d"], "largest overlap / d": said["max_overlap_d"],
                  "walls over weight": said["support"]}
        for ours, theirs in (("contact_forces() over weight", "api_contacts_over_weight"), ("the array behind it over weight", "true_contacts_over_weight")):
            if theirs in said:
                values[ours] = said[theirs]
        return values
    # rows of every step; windows of 1 ms as the others have them
    per_window = max(1, round(1e-3 / float(run.parameter("Time/Time step"))))
    windows = lambda name: run.columns[name][1:].reshape(-1, per_window)
    supports, overlaps = windows("wall_force_over_weight").mean(axis=1)[10:], windows("mean_penetration_over_d")[10:, -1]
    return {"CPU [s]": peers.cpu_of_steps(run), "walls over weight - 1, rms": float(np.sqrt(np.mean((supports - 1) ** 2))), "mean overlap / d": float(overlaps.mean()),
            "largest overlap / d": run.summary["audit"]["largest_penetration_over_d"], "walls over weight": float(supports.mean())}


def error(values, _):
    return {CARRIED: values["walls over weight - 1, rms"], PLACES: values["mean overlap / d"]}


def claims(r):
    cheapest = lambda series: peers.cheapest(r, PLACES, 1e-4, series).cpu_s
    yield "contacts to 1e-4 carry the weight within 2 %", lambda: r.error("Alluvium, steps of 1 ms", "1 ms, 1e-04", CARRIED), "<", 0.02
    yield "as it is set, the program carries it within 0.1 %", lambda: r.error("Alluvium, as it is set", "awake", CARRIED), "<", 1e-3
    yield "and leaves less than 1e-4 d of overlap", lambda: r.error("Alluvium, as it is set", "awake", PLACES), "<", 1e-4
    yield "a tolerance of 1e-5 in steps of 0.1 ms is cheaper than one of 1e-3", lambda: r.cpu("Alluvium, steps of 0.1 ms", "0.1 ms, 1e-05") / r.cpu("Alluvium, steps of 0.1 ms", "0.1 ms, 1e-03"), "<", 1
    yield "without the dead zone it is dearer", lambda: r.cpu("Alluvium, no dead zone, steps of 0.1 ms", "no dead zone, 1e-05") / r.cpu("Alluvium, steps of 0.1 ms", "0.1 ms, 1e-05"), ">", 1.5
    for peer in ("MigFlow", "Siconos", "LAMMPS"):
        yield "for 1e-4 d of overlap %s takes more than ten times our CPU time" % peer, lambda peer=peer: cheapest(peer) / cheapest("Alluvium, steps"), ">", 10
    yield "MigFlow's contact_forces() are zero on a bed at rest", lambda: r.value("MigFlow, steps of 0.1 ms", "MigFlow 1e-8", "contact_forces() over weight"), "==", 0
    yield "the array behind them has the weight within 10 %", lambda: abs(r.value("MigFlow, steps of 0.1 ms", "MigFlow 1e-8", "the array behind it over weight") - 1), "<", 0.1
    yield "springs at rest carry the weight within 1e-5", lambda: r.error("LAMMPS, soft spheres", "LAMMPS 1e-4", CARRIED), "<", 1e-5
    yield "under peclet's impulses grains overlap by more than 0.1 d on the average", lambda: r.error("peclet, impulses", "impulses 1e-4, 50", PLACES), ">", 0.1


def says(r):
    cheapest = lambda series: peers.cheapest(r, PLACES, 1e-4, series).cpu_s
    return ("With an overlap of at most 1e-4 d our program holds the bed for %.2g s of CPU time, MigFlow for %.2g s (%.2g s in the same steps of 0.1 ms are ours), Siconos' solver for %.2g s and LAMMPS for %.2g s. "
            "What the walls carry is right within %.0e at best with ours and %.0e with LAMMPS, since springs at rest stay at rest. peclet's soft spheres carry it within %.1g %%; its impulses, with 50 sweeps in steps of 0.1 ms, do not hold "
            "43 layers: grains overlap by %.2g d on the average."
            % (cheapest("Alluvium, steps"), cheapest("MigFlow"), cheapest("Alluvium, steps of 0.1 ms"), cheapest("Siconos"), cheapest("LAMMPS"), peers.best(r, CARRIED, "Alluvium").errors[CARRIED],
               peers.best(r, CARRIED, "LAMMPS").errors[CARRIED], 100 * peers.best(r, CARRIED, "peclet, Hertz").errors[CARRIED],
               r.error("peclet, impulses", "impulses 1e-4, 50", PLACES)))
