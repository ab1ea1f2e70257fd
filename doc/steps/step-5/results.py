import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

import steps

H, RHO, G = 0.0144, 1000.0, 9.81
SIZES = (8, 4, 1, 0.5)
NAMES = {8: "8", 4: "4", 1: "1", 0.5: "05"}
RAMP = "Boundary conditions/Pressure=top: 103e3; bottom: 103e3 + rho*g*H*(1 + %s)"


def at_faces(h):
    return ["Mesh refinement/Criteria: bed faces/Cell size at the %s=%g" % (face, h) for face in ("bottom", "top")]


def lag(length, height=H, diameter=2.2e-4, packing=0.797, ramp=1.0):
    """How far the imposed head is beyond the onset when a rigid bed has moved by a diameter (doc/theory/equations.md)."""
    mass = (2630 * packing + RHO * 0.48) * length + RHO * (height - length)
    return height * (6 * diameter * mass / (RHO * G * height * ramp**2))**(1 / 3)


def draw(step, runs):
    figure, (top, bottom) = steps.plt.subplots(2, 1, figsize=(5, 4.4), sharex=True, layout="constrained")
    for h, run in runs.items():
        top.plot(run.columns["time_s"], run.columns["moved_mass_fraction"], lw=1.2, label="h/d %g" % h)
        bottom.plot(run.columns["time_s"], 1e3 * run.columns["differential_head_m"], lw=1.2)
    exact = 1e3 * runs[1].summary["onset by force balance"]["exact_head_m"]
    bottom.axhline(exact, color="0.5", ls="--", lw=0.9)
    bottom.text(0.02, exact + 0.2, "exact onset", color="0.4")
    top.set(ylabel="mass fraction in motion")
    bottom.set(xlabel="time [s]", ylabel="differential head [mm]")
    top.legend()
    step.picture(figure, "figure-3.png")

    grains, fluid = runs[1].pictures("grains"), runs[1].pictures("fluid")
    chosen = [0] + [int(np.argmin([abs(time - t) for time, _ in grains])) for t in (0.75, 0.8, 0.85)] if not step.short else [0, -1]
    figure, axes = steps.plt.subplots(1, len(chosen), figsize=(6.6, 3.8), sharey=True, layout="constrained")
    for axis, i in zip(axes, chosen):
        mesh = fluid[i][1]
        axis.add_collection(PolyCollection([1e3 * mesh.points[cell, :2] for cell in mesh.cells], facecolors="none", edgecolors="0.8", linewidths=0.3))
        discs = grains[i][1]
        size = 2e3 * discs.fields["radius"]
        collection = EllipseCollection(size, size, 0 * size, units="xy", offsets=1e3 * discs.points[:, :2], offset_transform=axis.transData,
                                       cmap="viridis", linewidths=0)
        collection.set_array(np.linalg.norm(discs.fields["displacement"][:, :2], axis=1) / 2.2e-4)
        collection.set_clim(0, 8)
        axis.add_collection(collection)
        axis.set(aspect="equal", xlim=(0, 6), ylim=(0, 14.4), title="t = %.2f s" % grains[i][0], xlabel="x [mm]")
    axes[0].set_ylabel("y [mm]")
    figure.colorbar(collection, ax=axes, label="displacement [d]", shrink=0.8)
    step.picture(figure, "bed.png")


def results(step):
    short = [RAMP % "0.68 + t", "Time/End time=0.03", "Output/Interval of pictures=0.03"]
    runs = {h: step.run("bed.prm", name="faces-%g" % h, settings=at_faces(h), short=short) for h in ((8, 1) if step.short else SIZES)}
    for h, run in runs.items():
        name, onset = NAMES[h], run.summary["onset by force balance"]
        step.number("onset_" + name, 100 * onset["over_exact"], 0.2, "head at which water carries the bed, over the exact one [%%], h/d %g" % h)
        step.number("cells_" + name, run.summary["scene"]["cells"], 0.1, "cells at the start")
        step.number("cpu_" + name, run.cpu("fluid", "contacts"), steps.FREE, "CPU seconds of fluid and contacts")
        if not step.short:
            movement, heave = run.summary["first movement"], run.summary["total heave"]
            step.number("movement_" + name, 1e3 * movement["differential_head_m"], 0.25, "first movement [mm]")
            step.number("heave_" + name, 1e3 * heave["differential_head_m"], 0.3, "total heave [mm]")
            step.number("movement_time_" + name, movement["time_s"], 0.02, "[s]")
            step.number("heave_time_" + name, heave["time_s"], 0.02, "[s]")
    run = runs[1]
    onset = run.summary["onset by force balance"]
    length = run.columns["bed_height_m"][0]
    step.number("exact", 1e3 * onset["exact_head_m"], 0.01, "exact head of onset [mm]")
    step.number("length", 1e3 * length, 0.01, "height of the bed [mm]")
    step.number("lag", 1e3 * lag(length), 0.02, "lag of the first movement by the formula of a rigid bed [mm of imposed head]")
    full = onset["exact_head_m"] / length * 0.13
    step.number("full_onset", full, 0.002, "exact onset of the paper's bed, 0.13 m [m]")
    step.number("full_onset_time", full / 0.3, 0.005, "[s]")
    step.number("full_imposed", full + lag(0.13, 0.3), 0.002, "imposed head when it has moved by a diameter, by the formula [m]")
    if not step.short:
        imposed = H * run.summary["first movement"]["time_s"]
        step.number("onset_time", onset["time_s"], 0.002, "onset [s]")
        step.number("lag_seen", 1e3 * (imposed - onset["exact_head_m"]), 0.2, "what it was [mm]")
        step.number("critical", onset["exact_head_m"] / length, 0.02, "critical gradient, over the height of the bed")
        step.number("heave_gradient", run.summary["total heave"]["differential_head_m"] / length, 0.05, "total heave over the height of the bed")
        slow = step.run("bed.prm", name="slow", settings=[RAMP % "0.62 + t/4", "Time/End time=0.72"])
        step.number("slow_lag", 1e3 * (H * (0.62 + slow.summary["first movement"]["time_s"] / 4) - onset["exact_head_m"]), 0.15, "lag with a quarter of the ramp [mm]")
        step.number("slow_formula", 1e3 * lag(length, ramp=4), 0.02, "by the formula [mm]")
        step.number("slow_onset", 100 * slow.summary["onset by force balance"]["over_exact"], 0.2, "onset then [%]")
        light = step.run("bed.prm", name="terzaghi", settings=["Grains/Mass follows=fluid radius", "Time/End time=0.45", "Output/Interval of pictures=0"])
        step.number("light", 1e3 * light.summary["onset by force balance"]["exact_head_m"], 0.01, "exact onset if mass follows the fluid radius [mm]")
        step.number("light_onset", 100 * light.summary["onset by force balance"]["over_exact"], 0.2, "onset then [%]")
    draw(step, runs)
