import os
import shutil

import numpy as np
from matplotlib.collections import PolyCollection

import steps
import vtu

ADAPTIVE = ["Mesh refinement/Criteria=bed faces", "Mesh refinement/Interval=10"]


def parts(run):
    """The cells of every rank: deal.II writes a piece for each."""
    name = vtu.read_pvd(os.path.join(run.folder, "fluid.pvd"))[0][1][0]
    return vtu.read_pieces(name)


def draw(step, runs):
    figure, axes = steps.plt.subplots(len(runs), 1, figsize=(6.4, 3.4 * len(runs) / 1.5), sharex=True, layout="constrained")
    for axis, (title, run) in zip(np.atleast_1d(axes), runs):
        for rank, piece in enumerate(parts(run)):
            axis.add_collection(PolyCollection([1e3 * piece.points[cell, :2] for cell in piece.cells], facecolors="C%d" % rank, edgecolors="w", linewidths=0.15))
        axis.axhline(6.4, color="k", lw=0.8, ls=":")
        axis.set(aspect="equal", xlim=(0, 30), ylim=(0, 14.4), title=title, ylabel="y [mm]")
    axis.set_xlabel("x [mm]")
    step.picture(figure, "partition.png")


def same_rows(a, b):
    """Number of rows of statistics.csv that differ in any digit."""
    rows = [open(os.path.join(run.folder, "statistics.csv")).read().splitlines() for run in (a, b)]
    return abs(len(rows[0]) - len(rows[1])) + sum(x != y for x, y in zip(*rows))


def results(step):
    end = 0.004 if step.short else 0.02
    small = ["Grains/Deposit: settled bed/Number of grains=1000", "Domain/Upper right corner=0.0075,0.0144",
             "Contacts/Least grains a rank=400"] if step.short else []
    until = lambda t: small + ["Time/End time=%g" % t, "Output/Interval of checkpoints=%g" % (end / 2), "Output/Interval of pictures=%g" % end]
    one = step.run("wide-bed.prm", name="one-rank", settings=until(end))
    two = step.run("wide-bed.prm", name="two-ranks", settings=until(end), ranks=2)
    step.number("grains", one.summary["scene"]["grains"], 0.1, "discs")
    step.number("cells", one.summary["scene"]["cells"], 0.1, "cells")
    step.number("unknowns", one.summary["scene"]["unknowns"], 0.1, "unknowns")
    step.number("share", 100 * max(len(piece.cells) for piece in parts(two)) / one.summary["scene"]["cells"], 1, "cells of the rank that has more [%]")
    flux = [run.columns["flux_top_m2_per_s"] for run in (one, two)]
    # round-off, which differs from machine to machine: the exponent only
    step.number("difference", np.log10(max(np.nanmax(abs(flux[1] / flux[0] - 1)), 1e-16)), 3, "log10 of the largest relative difference of the flux, two ranks and one")
    force = [run.columns["fluid_force_over_weight"] for run in (one, two)]
    step.number("force_difference", np.log10(max(np.nanmax(abs(force[1][1:] / force[0][1:] - 1)), 1e-16)), 3, "log10 of that of the force on the grains")

    # half of the run, a checkpoint, and the rest from it
    step.run("wide-bed.prm", name="resumed", settings=until(end / 2), ranks=2)
    first_half = os.path.join(step.scratch, "resumed")
    shutil.rmtree(first_half + "-copy", ignore_errors=True)
    shutil.copytree(first_half, first_half + "-copy")
    resumed = step.run("wide-bed.prm", name="resumed", settings=until(end) + ["Output/Restart=true"], ranks=2, keep=True)
    step.number("rows", len(two.columns["time_s"]), 0.1, "rows of statistics.csv")
    step.number("differing_rows", same_rows(two, resumed), 0.1, "rows that differ in any of 17 digits after a restart on two ranks")
    shutil.rmtree(first_half, ignore_errors=True)
    shutil.move(first_half + "-copy", first_half)
    elsewhere = step.run("wide-bed.prm", name="resumed", settings=until(end) + ["Output/Restart=true"], ranks=1, keep=True)
    flux = [run.columns["flux_top_m2_per_s"] for run in (two, elsewhere)]
    step.number("elsewhere", np.log10(max(np.nanmax(abs(flux[1] / flux[0] - 1)), 1e-16)), 3, "log10 of the difference of the flux after a restart on one rank")
    step.number("checkpoint", sum(os.path.getsize(os.path.join(two.folder, "checkpoint", name)) for name in os.listdir(os.path.join(two.folder, "checkpoint"))) / 1e6,
                2, "size of a checkpoint [MB]")

    pictures = [("two ranks, uniform mesh: bisected", two)]
    if not step.short:
        four = step.run("wide-bed.prm", name="four-ranks", settings=["Time/End time=0.001"], ranks=4)
        step.number("four_share", 100 * max(len(piece.cells) for piece in parts(four)) / one.summary["scene"]["cells"], 1, "cells of the largest of four parts [%]")
        adaptive = step.run("wide-bed.prm", name="four-adaptive", settings=["Time/End time=0.001"] + ADAPTIVE, ranks=4)
        step.number("adaptive_share", 100 * max(len(piece.cells) for piece in parts(adaptive)) / adaptive.summary["scene"]["cells"], 3, "the same on the mesh that follows the bed [%]")
        pictures += [("four ranks, uniform mesh", four), ("four ranks, mesh that may change: along p4est's curve", adaptive)]
    if not step.short:
        for name, run in (("one", one), ("two", two)):
            step.number("overlap_" + name, run.cpu("fluid: overlap"), steps.FREE, "CPU seconds of the slowest rank, cutting")
            step.number("assembly_" + name, run.cpu("fluid: assembly"), steps.FREE, "assembly")
            step.number("contacts_" + name, run.cpu("contacts"), steps.FREE, "contacts")
            step.number("solver_" + name, run.cpu("fluid: linear solver"), steps.FREE, "linear solver")
    draw(step, pictures)
