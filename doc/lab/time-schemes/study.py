"""Stability of the time schemes.

A lattice of discs, 2.63 times as dense as water, begins to sink in a closed box; the exact motion tends to a constant speed. Each
point is 30 steps of one length: growth is the mean factor from a change of the speed to the next, until changes are below 1e-5 of the
largest. Swept: the step over the relaxation time tau_p of a disc, and the void fraction. The line is 2 eps^2 (1 - r), with
r = (1 - eps) rho / (eps rho_p): theory for schemes whose continuity equation sees the discs' velocity of t^n.
"""
from laboratory.lattice import bound_of, files, grown, growth, largest, settings
from laboratory.study import Map, Point

order = 10
scene = "suspension.prm"
measure_failed = True

schemes = ["explicit", "implicit drag", "semi-implicit per piece", "semi-implicit per grain", "iterated"]


def lines(series):
    if series in ("explicit", "implicit drag"):
        eps = [0.28 + 0.01 * k for k in range(72)]
        yield "2 eps^2 (1 - r)", [bound_of(e) for e in eps], eps


chart = Map(x="time step / tau_p", y="void fraction", value="growth", title="growth of a change, per step", bound=1.0, log="xv", lines=lines,
            stands=[(1e-3 / 6e-4, 0.48, "sand of 0.22 mm, 1 ms")])


def label(x, eps):
    return "%g, %g" % (x, eps)


def points(quick):
    n = 8
    for name in schemes[1::3] if quick else schemes:
        for eps in [0.3, 0.48, 0.8] if quick else [0.25, 0.3, 0.4, 0.48, 0.65, 0.8, 0.95]:
            for x in [0.1, 0.4, 3] if quick else [0.01, 0.03, 0.1, 0.2, 0.4, 0.8, 1.5, 3, 10, 100]:
                yield Point(name, label(x, eps), settings(name, eps, x, n), files=files(eps, n), x=x, y=eps)


def measure(run, point):
    return {"growth": growth(run)}


def wrong(r, series):
    """Points, away from the line by more than a tenth, on which growth and theory disagree."""
    return sum((grown(p) > 1) != (p.point.x > bound_of(p.point.y)) for p in r.some(series)
               if not 0.9 < p.point.x / max(bound_of(p.point.y), 1e-9) < 1.1)


def claims(r):
    yield "'implicit drag' is unstable beyond the line, and nowhere else", lambda: wrong(r, "implicit drag"), "==", 0
    yield "'explicit' is unstable from 3 tau_p on", lambda: min(grown(p) for p in r.some("explicit") if p.point.x >= 3), ">", 1.0
    for name in ("semi-implicit per grain", "semi-implicit per piece", "iterated"):
        yield "'%s' is stable everywhere" % name, lambda name=name: largest(r, name), "<", 1.0


def beyond(r, series):
    """Points beyond the line that are stable all the same."""
    return sum(grown(p) < 1 for p in r.of(series) if p.point.x > 1.1 * bound_of(p.point.y))


def says(r):
    return ("The default, 'iterated', and both semi-implicit schemes are stable at every step and void fraction, up to 100 tau_p; "
            "'implicit drag' follows the line of theory at every point (%d disagree), and below a void fraction of 0.275 it is stable at no step. "
            "'explicit' bears longer steps than the line at %d points, but none from 3 tau_p on."
            % (wrong(r, "implicit drag"), beyond(r, "explicit")))
