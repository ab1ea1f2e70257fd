"""A lattice of discs that begins to sink in a closed box: what the maps of time schemes have in common, and theory."""

import math

from .study import DIVERGED, Failed

# of a disc [m], of water; scene: doc/lab/time-schemes/suspension.prm
d, rho, eta = 5e-5, 1000.0, 1e-3
SAND = 2630.0
STEPS = 30


def tau(eps, rho_p=SAND):
    """Relaxation time of a disc by the law 'disc' in creeping flow [s]."""
    return rho_p / (2 / math.pi * eps**-2.8 * 4.8**2 * eta / d**2)


def bound_of(eps, rho_p=SAND):
    """Of dt/tau_p, where the discs' velocity of t^n goes into the continuity equation."""
    return 2 * eps**2 * max(1 - (1 - eps) / eps * rho / rho_p, 0)


def settings(scheme, eps, x, n, rho_p=SAND):
    """Of the scene, for steps of x relaxation times and n times n discs."""
    dt, a = x * tau(eps, rho_p), spacing(eps)
    found = {"Coupling/Time scheme": scheme, "Time/Time step": "%.10g" % dt, "Time/End time": "%.10g" % (STEPS * dt),
             "Domain/Upper right corner": "%.17g, %.17g" % (n * a, n * a), "Grains/Deposit: file/File": "{folder}/grains.csv"}
    return found if rho_p == SAND else {**found, "Grains/Density": repr(rho_p)}


def spacing(eps):
    return d * math.sqrt(math.pi / 4 / (1 - eps))


def files(eps, n):
    a = spacing(eps)
    return {"grains.csv": "x,y,radius\n" + "".join("%.17g,%.17g,%.17g\n" % ((i + 0.5) * a, (j + 0.5) * a, 0.5 * d) for j in range(n) for i in range(n))}


def growth(run):
    """Mean factor from a change of the discs' speed to the next, until changes are next to none."""
    speed = [float(v) for v in run.columns["settling_speed_m_per_s"] if math.isfinite(v)]
    change = [abs(b - a) for a, b in zip(speed, speed[1:])]
    if len(change) < 3 or not max(change) > 0:
        return math.inf
    above = 0  # changes until the first that is next to none
    while above < len(change) and change[above] > 1e-5 * max(change[: above + 1]):
        above += 1
    above = min(above, len(change) - 1)
    return (change[above] / change[0]) ** (1 / above) if change[above] > 0 else 1e-3


def largest(r, series):
    """Growth of a series; infinite if a point of it failed."""
    return max(p.values["growth"] if p.done else math.inf for p in r.some(series))


def grown(point):
    """Growth of a point; of a run that has diverged before there was one to measure, infinite."""
    if "growth" not in point.values and point.exit_code != DIVERGED:
        raise Failed("%s failed" % point.point.name)
    return point.values.get("growth", math.inf)


def disagree(r, series, is_unstable):
    """Points that do not grow where is_unstable(point) says so, or do where it does not."""
    return sum((grown(p) > 1) != is_unstable(p.point) for p in r.some(series))
