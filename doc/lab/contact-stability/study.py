"""Contacts: time step, tolerance and depth.

A dry column of discs, ten wide and 10, 40 or 120 layers deep, is at rest between walls, and kept awake (`Steps to rest = 0`); it starts
without knowing a contact force. Each point is 50 steps. What is drawn is the largest overlap in them over d: an exact solve makes none,
so all of it is the solver's error, or a bed that comes down. The line is where an error of the tolerance, always of the same sign,
adds up to an overlap of 1e-3 d: 50 times tolerance g dt^2.
"""
from laboratory.study import Map, Point

order = 14
scene = "bed.prm"
limit = 60
measure_failed = True

d, g, STEPS = 2.2e-4, 9.81, 50
unit = (d / g) ** 0.5
depths = {"10 layers": 10, "40 layers": 40, "120 layers": 120}


def lines(name):
    xs = [0.02, 0.1, 0.5, 2]
    yield "50 tolerance g dt^2 = 1e-3 d", xs, [1e-3 / (STEPS * x * x) for x in xs]


chart = Map(x="time step / (d/g)^1/2", y="contacts' residual tolerance", value="largest overlap / d", bound=1e-3, log="xyv", lines=lines,
            stands=[(1e-3 / unit, 4e-5, "default tolerance, 1 ms")])


def points(quick):
    for name, layers in depths.items():
        if quick and layers != 40:
            continue
        for tolerance in [1e-1, 1e-4] if quick else [1e-1, 1e-2, 1e-3, 4e-5]:
            for x in [0.1, 0.5] if quick else [0.1, 0.5, 2]:
                dt = x * unit
                yield Point(name, "%g, %.0e" % (x, tolerance), {
                    "Time/Time step": "%.10g" % dt, "Time/End time": "%.10g" % (STEPS * dt), "Contacts/Residual tolerance": tolerance,
                    "Contacts/Largest violation": min(100 * tolerance, 0.5), "Grains/Deposit: settled bed/Number of grains": 10 * layers,
                    "Domain/Upper right corner": "%.6g, %.6g" % (10 * d, 1.2 * layers * d)}, x=x, y=tolerance)


def measure(run, point):
    support = [float(v) for v in run.columns["wall_force_over_weight"][-10:]]
    return {"largest overlap / d": max(run.summary["audit"]["largest_penetration_over_d"], 1e-9), "walls over weight": sum(support) / max(len(support), 1),
            "sweeps a step": run.summary["counts"]["contact sweeps"] / run.summary["run"]["steps"]}


def worst(r, most, name):
    """Of tolerances up to `most`."""
    return max(p.values.get("largest overlap / d", float("inf")) for p in r.some(name) if p.point.y <= most)


def claims(r):
    for name in depths:
        yield "%s: tolerances of 1e-4 and less leave less than 1e-2 d" % name, lambda name=name: worst(r, 1.1e-4, name), "<", 1e-2
    yield "40 layers: a tolerance of 1e-1 does not hold the bed", lambda: max(p.values.get("largest overlap / d", 1) for p in r.some("40 layers") if p.point.y > 0.05), ">", 1e-2


def says(r):
    return ("The default tolerance, 4e-5, leaves an overlap of at most %.1e d in 50 steps, for steps of 0.1 to 2 (d/g)^1/2 and beds of 10 to 120 layers. "
            "With 1e-2 it is up to %.1e d in 10 layers and %.1e d in 120: the deeper a bed, the tighter the tolerance has to be."
            % (max(worst(r, 4.1e-5, name) for name in depths), worst(r, 1.1e-2, "10 layers"), worst(r, 1.1e-2, "120 layers")))
