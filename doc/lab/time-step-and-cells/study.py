"""Time schemes on coarse and fine cells.

The lattice of [the map of time schemes](../time-schemes/README.md) at a void fraction of 0.48, in cells from much finer than a disc to
much coarser. Each point is 30 steps of one length; growth is the mean factor from a change of the speed to the next. The line is
2 eps^2 (1 - r), theory of a homogeneous suspension for schemes whose continuity equation sees the discs' velocity of t^n: it knows no
cells. `Filter radius = grain` leaves fine cells nearly full of grain, with void fractions far below the mean.
"""
from laboratory.lattice import bound_of, disagree, files, growth, largest, settings
from laboratory.study import Map, Point

order = 11
scene = "../time-schemes/suspension.prm"
measure_failed = True

eps, n = 0.48, 8
FINE = "iterated, filter of a grain"
schemes = {"implicit drag": {}, "semi-implicit per piece": {}, "semi-implicit per grain": {}, "iterated": {}, FINE: {"Coupling/Filter radius": "grain"}}


def lines(series):
    if series == "implicit drag":
        yield "2 eps^2 (1 - r)", [bound_of(eps)] * 2, [0.1, 10]


chart = Map(x="time step / tau_p", y="cell size / d", value="growth", title="growth of a change, per step", bound=1.0, log="xyv", lines=lines,
            stands=[(1e-3 / 6e-4, 1.0, "sand of 0.22 mm, 1 ms, cells of 1 d", "iterated")])


def points(quick):
    for name, more in schemes.items():
        if quick and name not in ("implicit drag", "iterated"):
            continue
        for h in [1, 4] if quick else [0.25, 1, 4]:
            for x in [0.2, 0.4] if quick else [0.2, 0.4, 10]:
                yield Point(name, "%g, %g" % (x, h), {**settings(name.split(",")[0], eps, x, n), "Mesh refinement/Criteria: uniform/Cell size": h, **more},
                            files=files(eps, n), x=x, y=h)


def measure(run, point):
    return {"growth": growth(run)}


def wrong(r, series):
    return disagree(r, series, lambda p: p.x > bound_of(eps))


def claims(r):
    yield "'implicit drag' is unstable beyond the line, and nowhere else, on all cells", lambda: wrong(r, "implicit drag"), "==", 0
    for name in ("semi-implicit per piece", "semi-implicit per grain", "iterated"):
        yield "'%s' is stable on all cells" % name, lambda name=name: largest(r, name), "<", 1.0


def says(r):
    return ("The default, 'iterated', is stable on cells from 4 d to 0.25 d at every step tried, up to 10 tau_p (growth at most %.2g), and so are the semi-implicit schemes. "
            "The line of theory, which knows no cells, holds on all of them: 'implicit drag' disagrees with it at %d of %d points."
            % (largest(r, "iterated"), wrong(r, "implicit drag"), len(r.some("implicit drag"))))
