"""A manufactured solution: what the fluid's cells cost and give.

The volume-averaged equations in a unit square with a given smooth void fraction, drag and force, whose exact velocity and pressure are known (`tests/fluid/manufactured_solution.cc`).
Swept: quadrilaterals and triangles of as many nodes, weak and strong drag, drag lumped at the nodes or not. Errors are L2 norms against the exact
fields, of the velocity and of the pressure up to its mean; each point takes 25 steps from the exact fields.
The linear solver is asked for 1e-7; to a loose tolerance the steps would stay at their start, and show nothing.
"""
import math
import re

from laboratory.study import Chart, Point

order = 5
limit = 300
chart = Chart()
PROGRAM = "{build}/tests/test_fluid"


def points(quick):
    def point(series, label, name, **more):
        return Point(series, label, command=[PROGRAM, "--gtest_filter=Charts/ManufacturedSolutionValidation.Error/" + name], **more)

    sides = [8, 16, 32] if quick else [8, 16, 32, 64, 128]
    for n in sides:
        yield point("quadrilaterals, drag 1", "%d" % n, "quads_%d_drag_1" % n, default=n == 32)
    if quick:
        return
    for n in sides:
        yield point("quadrilaterals, drag 100", "%d, drag 100" % n, "quads_%d_drag_100" % n)
        yield point("the same, lumped", "%d, lumped" % n, "quads_%d_drag_100_lumped" % n)
    for n in sides[:-1]:
        yield point("triangles, drag 1", "%d, triangles" % (n / 2), "triangles_%d_drag_1" % (n / 2))


reference = {"exact": 0}  # a closed form


def measure(run, point):
    found = re.search(r"^errors (\S+) (\S+) (\S+)$", run.text, re.M)
    return {"L2 error of velocity": float(found[1]), "H1 error of velocity": float(found[2]), "L2 error of pressure": float(found[3])}


def error(values, reference):
    return {"velocity": values["L2 error of velocity"], "pressure": values["L2 error of pressure"]}


def ratio(r, series, coarse, fine, name):
    return r.error(series, coarse, name) / r.error(series, fine, name)


def claims(r):
    yield "half the cell size has a quarter of the velocity's error: at least 3.6 times less", lambda: ratio(r, "quadrilaterals, drag 1", "16", "32", "velocity"), ">=", 3.6
    yield "and at least 2.8 times less of the pressure's", lambda: ratio(r, "quadrilaterals, drag 1", "16", "32", "pressure"), ">=", 2.8
    yield "with a hundred times the drag the velocity is of second order, too", lambda: ratio(r, "quadrilaterals, drag 100", "32, drag 100", "64, drag 100", "velocity"), ">=", 3.6


def says(r):
    quads, triangles, lumped = r.done("quadrilaterals, drag 1", "64"), r.done("triangles, drag 1", "32, triangles"), r.done("the same, lumped", "64, lumped")
    return ("Velocity is of second order, pressure of %.1f; with 64 cells to a side the velocity is off by %.1e for %.1f s, triangles of as many nodes %.1e for %.1f s. Drag that is lumped at the nodes leaves %.1e where it is strong, %.1e if it is not lumped."
            % (math.log2(ratio(r, "quadrilaterals, drag 1", "32", "64", "pressure")), quads.errors["velocity"], quads.cpu_s, triangles.errors["velocity"], triangles.cpu_s,
               lumped.errors["velocity"], r.error("quadrilaterals, drag 100", "64, drag 100", "velocity")))
