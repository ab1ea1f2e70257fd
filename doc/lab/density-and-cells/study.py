"""Time schemes with light and heavy grains.

The lattice of [the map of time schemes](../time-schemes/README.md) at a void fraction of 0.48, with discs of a tenth to a thousand times
the fluid's density, which rise or sink. 30 steps of a tenth of a relaxation time for schemes whose continuity equation sees the discs'
velocity of t^n, of ten for the others. The line is where 2 eps^2 (1 - r) is that step: below it, theory says, changes grow.
"""
from laboratory.lattice import bound_of, disagree, files, growth, largest, rho, settings
from laboratory.study import Map, Point

order = 12
scene = "../time-schemes/suspension.prm"
measure_failed = True

eps, n = 0.48, 8
schemes = {"implicit drag": 0.1, "semi-implicit per piece": 10, "semi-implicit per grain": 10, "iterated": 10}
series = {"%s, %g tau_p" % item: item for item in schemes.items()}


def lines(name):
    x = series[name][1]
    if x < 1:
        # of the density ratio: 2 eps^2 (1 - (1 - eps)/(eps s)) = x
        yield "2 eps^2 (1 - r) = dt / tau_p", [0.1, 10], [(1 - eps) / eps / (1 - x / (2 * eps**2))] * 2


chart = Map(x="cell size / d", y="density, grains / fluid", value="growth", title="growth of a change, per step", bound=1.0, log="xyv", lines=lines,
            stands=[(1.0, 2.63, "sand in water, cells of 1 d", "iterated, 10 tau_p")])


def points(quick):
    for name, (scheme, x) in series.items():
        if quick and scheme not in ("implicit drag", "iterated"):
            continue
        for s in [0.5, 10] if quick else [0.1, 0.5, 1.6, 10, 1000]:
            for h in [1] if quick else [0.5, 4]:
                yield Point(name, "%g, %g" % (h, s), {**settings(scheme, eps, x, n, s * rho), "Mesh refinement/Criteria: uniform/Cell size": h},
                            files=files(eps, n), x=h, y=s)


def measure(run, point):
    return {"growth": growth(run)}


def name_of(scheme):
    return "%s, %g tau_p" % (scheme, schemes[scheme])


def wrong(r, scheme):
    return disagree(r, name_of(scheme), lambda p: schemes[scheme] > bound_of(eps, p.y * rho))


def claims(r):
    yield "'implicit drag' is unstable beyond the line, and nowhere else, at all densities", lambda: wrong(r, "implicit drag"), "==", 0
    for name in ("semi-implicit per piece", "semi-implicit per grain", "iterated"):
        yield "'%s' is stable at all densities" % name, lambda name=name: largest(r, name_of(name)), "<", 1.0


def says(r):
    return ("The default, 'iterated', is stable for grains of a tenth to a thousand times the fluid's density, on cells from 4 d to 0.5 d, at ten relaxation times a step (growth at most %.2g). "
            "'implicit drag' is not where grains are light, at no step below 1.08 times the fluid's density: it disagrees with the line of theory at %d of %d points."
            % (largest(r, name_of("iterated")), wrong(r, "implicit drag"), len(r.some(name_of("implicit drag")))))
