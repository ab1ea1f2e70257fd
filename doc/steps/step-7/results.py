import numpy as np

import steps

REFERENCE = "0.2 ms"
TIGHT = ["Contacts/Residual tolerance=1e-6"]
FLOOR = 1e-3  # error of the heave below which chance decides
FACES = "Mesh refinement/Criteria: bed faces/Cell size at the %s=%g"


def cells(h):
    return [FACES % (face, h) for face in ("bottom", "top")]


def fixed(milliseconds):
    return ["Time/Time step=%g" % (1e-3 * milliseconds)]


def chosen(tolerance):
    return ["Time/Automatic time step/Tolerance=%g" % tolerance]


def points(short):
    """(series, label, settings), the reference first."""
    yield "reference", REFERENCE, fixed(0.2) + TIGHT if not short else fixed(1) + TIGHT
    for dt in (5,) if short else (10, 5, 2, 1, 0.5):
        yield "fixed steps", "%g ms" % dt, fixed(dt)
    for tolerance in (0.05,) if short else (0.2, 0.05, 0.01):
        yield "chosen steps", "%g" % tolerance, chosen(tolerance)
    for h in (8,) if short else (8, 4, 2):
        yield "chosen steps, cells at the faces", "%g d" % h, cells(h)


def heave(run):
    return 0.65 + run.summary["total heave"]["time_s"]  # the imposed head then, over H: what the user asks for


def draw(step, found, reference):
    figure, (left, right) = steps.plt.subplots(1, 2, figsize=(7.6, 3.2), layout="constrained")
    markers = {"fixed steps": "o-", "chosen steps": "s-", "chosen steps, cells at the faces": "^--"}
    for axis, error, title in ((left, onset_error, "onset (closed form)"), (right, lambda run: heave_error(run, reference), "heave (reference)")):
        for series, marker in markers.items():
            mine = [(error(run), run.cpu(), label) for kind, label, run in found if kind == series]
            axis.loglog([max(e, 1e-5) for e, _, _ in mine], [c for _, c, _ in mine], marker, ms=4, lw=0.8, label=series)
            for e, c, label in mine:
                left_of_it = series == "fixed steps" and label != "10 ms"  # so that labels do not meet
                axis.annotate(label, (max(e, 1e-5), c), fontsize=7, xytext=(-4, -3) if left_of_it else (4, 2), textcoords="offset points",
                              ha="right" if left_of_it else "left")
        axis.set(xlabel="error of the " + title, xlim=(5e-6, 0.2))
        axis.set_yticks((3, 10, 30), ("3", "10", "30"))
        axis.minorticks_off()
    right.axvspan(5e-6, FLOOR, color="0.92", zorder=0)
    left.set_ylabel("CPU time [s]")
    left.legend(fontsize=7)
    step.picture(figure, "chart.png")


def onset_error(run):
    return abs(run.summary["onset by force balance"]["over_exact"] - 1)


def heave_error(run, reference):
    return abs(heave(run) / heave(reference) - 1)


def results(step):
    found = [(series, label, step.run("lift.prm", name=(series + " " + label).replace(" ", "-"), settings=settings)) for series, label, settings in points(step.short)]
    reference = found[0][2]
    step.number("reference_heave", heave(reference), 0.01, "head imposed at the heave, over H, in the reference")
    step.number("cpu_reference", reference.cpu(), steps.FREE, "CPU seconds of the reference")
    for series, label, run in found[1:]:
        name = {"fixed steps": "fixed_", "chosen steps": "chosen_", "chosen steps, cells at the faces": "cells_"}[series] + label.split()[0].replace(".", "")
        step.number("onset_" + name, 100 * onset_error(run), 0.2 if "cells" not in name else 1, "error of the onset [%%], %s %s" % (series, label))
        step.number("heave_" + name, 100 * heave_error(run, reference), 1, "error of the head at the heave [%%], %s %s" % (series, label))
        step.number("cpu_" + name, run.cpu(), steps.FREE, "CPU seconds")
        step.number("steps_" + name, run.summary["run"]["steps"], 60, "steps")
    if not step.short:
        draw(step, found, reference)
