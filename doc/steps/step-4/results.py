import numpy as np
from matplotlib.collections import EllipseCollection

import steps


def tolerances(tolerance):
    return ["Contacts/Residual tolerance=%g" % tolerance, "Contacts/Largest violation=%g" % (100 * tolerance)]


def runout(run):
    """Within what distance of the left side 95 % of the mass lies at the end [mm]."""
    grains = run.pictures("grains")[-1][1]
    order = np.argsort(grains.points[:, 0])
    mass = np.cumsum(grains.fields["radius"][order]**2)
    return 1e3 * grains.points[order, 0][np.searchsorted(mass, 0.95 * mass[-1])]


def at_rest(run, column):
    return run.columns[column][np.argmin(abs(run.columns["time_s"] - 0.016))]


def draw(step, runs):
    grains = runs[1e-6].pictures("grains")
    times = [0.02, 0.06, 0.1, 0.25]
    figure, axes = steps.plt.subplots(2, 2, figsize=(7.2, 2.5), sharex=True, sharey=True, layout="constrained")
    for axis, time in zip(axes.flat, times):
        found, discs = min(grains, key=lambda entry: abs(entry[0] - time))
        size = 2e3 * discs.fields["radius"]
        collection = EllipseCollection(size, size, 0 * size, units="xy", offsets=1e3 * discs.points[:, :2], offset_transform=axis.transData,
                                       cmap="viridis", linewidths=0)
        collection.set_array(np.linalg.norm(discs.fields["velocity"][:, :2], axis=1))
        collection.set_clim(0, 0.3)
        axis.add_collection(collection)
        axis.set(aspect="equal", xlim=(0, 40), ylim=(0, 8), title="t = %.2g s" % found)
    figure.colorbar(collection, ax=axes, label="speed [m/s]", shrink=0.8)
    figure.supxlabel("x [mm]", fontsize=9)
    figure.supylabel("y [mm]", fontsize=9)
    step.picture(figure, "column.png")

    figure, (left, right) = steps.plt.subplots(1, 2, figsize=(7.2, 2.6), layout="constrained")
    for tolerance, run in runs.items():
        moving = run.columns["time_s"] > 0
        label = "1e%d" % round(np.log10(tolerance))
        left.semilogy(run.columns["time_s"][moving], np.maximum(run.columns["mean_penetration_over_d"][moving], 1e-8), lw=1, label=label)
        right.plot(run.columns["time_s"], 1e3 * run.columns["kinetic_energy_J_per_m"], lw=1, label=label)
    left.set(xlabel="time [s]", ylabel="mean penetration [d]")
    right.set(xlabel="time [s]", ylabel="kinetic energy [mJ/m]")
    right.legend(title="tolerance")
    step.picture(figure, "tolerance.png")


def results(step):
    short = ["Time/End time=0.03"]
    runs = {tolerance: step.run("column.prm", name="tolerance-1e%d" % round(np.log10(tolerance)), settings=tolerances(tolerance), short=short)
            for tolerance in ((1e-5, 1e-6) if step.short else (1e-4, 1e-5, 1e-6, 1e-7))}
    for tolerance, run in runs.items():
        name = "_e%d" % -round(np.log10(tolerance))
        step.number("walls" + name, at_rest(run, "wall_force_over_weight"), 20 * tolerance, "share of the weight on floor, side and gate at rest, tolerance %g" % tolerance)
        step.number("rest" + name, 1e6 * at_rest(run, "mean_penetration_over_d"), 4e5 * at_rest(run, "mean_penetration_over_d"), "mean penetration at rest [1e-6 d]")
        step.number("moving" + name, 1e5 * np.nanmax(run.columns["mean_penetration_over_d"]), 4e4 * np.nanmax(run.columns["mean_penetration_over_d"]), "largest mean penetration [1e-5 d]")
        step.number("worst" + name, 1e4 * run.summary["audit"]["largest_penetration_over_d"], steps.FREE, "largest overlap of any two [1e-4 d]")
        step.number("sweeps" + name, run.summary["counts"]["contact sweeps"] / 1000, 0.3 * run.summary["counts"]["contact sweeps"] / 1000, "sweeps of the run [1000]")
        step.number("cpu" + name, run.cpu("contacts"), steps.FREE, "CPU seconds of the contacts")
        if not step.short:
            step.number("runout" + name, runout(run), 4, "95 % of the mass within [mm]")
    run = runs[1e-6]
    step.number("height", 1e3 * run.columns["bed_height_m"][0], 0.01, "height of the column [mm]")
    step.number("floor", at_rest(run, "floor_force_over_weight"), 1e-2, "share of the weight on the floor at rest")
    step.number("grains", run.summary["scene"]["grains"], 0.1, "discs")
    step.run("column.prm", name="tolerance-1e-2", settings=tolerances(1e-2), exit_code=3)
    if not step.short:
        mean = np.mean([runout(r) for r in runs.values()])
        step.number("mean_runout", mean, 1.5, "mean of the four [mm]")
        step.number("scaled", (mean - 6) / 6 / (step.numbers["height"][0] / 6), 0.3, "(run-out - width) / width over the aspect ratio")
        step.number("end_height", 1e3 * max(run.pictures("grains")[-1][1].points[:, 1]), 0.5, "height of the deposit at the left side [mm]")
        long_steps = step.run("column.prm", name="long-steps", settings=["Time/Time step=1e-3"])
        step.number("long_runout", runout(long_steps), 4, "run-out with steps of 1 ms [mm]")
        step.number("long_substeps", long_steps.summary["counts"]["contact sub-steps"], 100, "contact sub-steps then")
        step.number("substeps", run.summary["counts"]["contact sub-steps"], 100, "contact sub-steps with 0.5 ms")
        rough = step.run("column.prm", name="rolling", settings=["Contacts/Rolling friction coefficient=0.2"])
        step.number("rolling_runout", runout(rough), 3, "run-out with rolling friction 0.2 [mm]")
    draw(step, runs)
