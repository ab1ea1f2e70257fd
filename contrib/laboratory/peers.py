"""What studies with other programs share: the commands of contrib/peers, what these print, and the CPU time of our own steps."""

import glob
import json
import os

from . import ROOT
from .study import Missing, Point

CPU_SAYS = ("CPU times are user and system time of the time steps alone, as each program or its script counts them: no set-up, no meshing, no output. Points of a "
            "study ran one after the other on one machine, which others used heavily: trust ratios within a factor of two.")
DO_NOT_COUNT = ("set-up", "checkpoints", "pictures", "observers")
SYSTEM, PEERS = "/usr/bin/python3", "{peers}"


def point(series, label, script, options, python=PEERS, **more):
    """A point that runs contrib/peers/SCRIPT on the study's bed; `options`: {"--name": value}, value "" for a switch."""
    folder = os.path.join(ROOT, "contrib", "peers")
    reads = [os.path.join(folder, script)] + sorted(glob.glob(os.path.join(folder, "*.py")))
    words = [word for name, value in options.items() for word in ([name] if value == "" else [name, "%s" % value])]
    return Point(series, label, command=[python, "{root}/contrib/peers/" + script, "{bed}"] + words, reads=reads, **more)


def said(run):
    """The JSON object that a script of contrib/peers has printed."""
    return json.loads(next(line for line in run.text.splitlines() if line.startswith("{")))


def program(run, point):
    """Name and version of what has run, if it is not ours: a study's `program`."""
    return said(run)["program"] if point.command else None


def cpu_of_steps(run):
    """Of our own program [s]; phases with a colon are parts of others."""
    return run.cpu(*[phase for phase in run.summary["timing"] if ":" not in phase and phase not in DO_NOT_COUNT])


def cheapest(results, name, bound, series):
    """Of the series whose names begin so, the cheapest point with at most this error."""
    found = [r for r in results.compared(name) if r.point.series.startswith(series) and r.errors[name] <= bound]
    if not found:
        raise Missing("no point of %s has an error of at most %g" % (series, bound))
    return min(found, key=lambda r: r.cpu_s)


def best(results, name, series):
    """Of the series whose names begin so, the most accurate point."""
    found = [r for r in results.compared(name) if r.point.series.startswith(series)]
    if not found:
        raise Missing("%s was not run" % series)
    return min(found, key=lambda r: r.errors[name])
