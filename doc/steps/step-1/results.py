import math

import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

import steps


def drag_law_speed(packing, d, density=2630.0, water=1000.0, viscosity=1e-3, g=9.81):
    """Speed at which grains sink through a homogeneous suspension without net flux: gamma w = eps (rho_p - rho) g, grains move at eps w."""
    eps, slip = 1 - packing, 0.0
    for _ in range(200):
        reynolds = water * d * slip / viscosity
        gamma = 2 / math.pi * eps**-2.8 * (0.63 * math.sqrt(eps * reynolds) + 4.8)**2 * viscosity / d**2
        slip = eps * (density - water) * g / gamma
    return eps * slip


def draw(step, run):
    fluid, grains = run.pictures("fluid"), run.pictures("grains")
    chosen = [round(k * (len(grains) - 1)) for k in (0, 0.25, 0.5, 1)]
    figure, axes = steps.plt.subplots(1, len(chosen), figsize=(7.2, 4), sharey=True, layout="constrained")
    for axis, i in zip(axes, chosen):
        time, mesh = fluid[i]
        corners = [1e3 * mesh.points[cell, :2] for cell in mesh.cells]
        cells = PolyCollection(corners, array=np.array([mesh.fields["void_fraction"][cell].mean() for cell in mesh.cells]), cmap="Blues_r",
                               edgecolors="0.75", linewidths=0.2)
        cells.set_clim(0.45, 1.15)
        axis.add_collection(cells)
        discs = grains[i][1]
        size = 2e3 * discs.fields["radius"]
        axis.add_collection(EllipseCollection(size, size, 0 * size, units="xy", offsets=1e3 * discs.points[:, :2],
                                              offset_transform=axis.transData, facecolors="#c8963c", linewidths=0))
        axis.set(aspect="equal", xlim=(0, 6), ylim=(0, 12), title="t = %.2g s" % time, xlabel="x [mm]")
    axes[0].set_ylabel("y [mm]")
    step.picture(figure, "settling.png")

    columns = run.columns
    figure, (left, right) = steps.plt.subplots(1, 2, figsize=(7.2, 2.6), layout="constrained")
    left.plot(columns["time_s"], 1e3 * columns["settling_speed_m_per_s"], label="run, mean of all grains")
    left.axhline(1e3 * drag_law_speed(0.0639, 0.8 * 2.19e-4), color="0.5", ls="--", label="drag law, homogeneous")
    left.set(xlabel="time [s]", ylabel="sinking speed [mm/s]")
    left.legend(loc=(0.38, 0.62))
    right.plot(columns["time_s"], columns["fluid_force_over_weight"], label="water")
    right.plot(columns["time_s"], columns["floor_force_over_weight"], label="floor")
    right.set(xlabel="time [s]", ylabel="share of the submerged weight")
    right.legend()
    step.picture(figure, "curves.png")


def results(step):
    step.run("settling.prm", name="check", arguments=["--check"])
    run = step.run("settling.prm", short=["Time/End time=0.06", "Output/Interval of pictures=0.02"])
    columns = run.columns
    at = int(np.argmin(abs(columns["time_s"] - 0.04)))
    step.number("grains", run.summary["scene"]["grains"], 0.1, "discs")
    step.number("cells", run.summary["scene"]["cells"], 0.1, "cells of the mesh")
    step.number("speed", 1e3 * columns["settling_speed_m_per_s"][at], 0.03, "mean sinking speed at 0.04 s [mm/s]")
    step.number("speed_ratio", columns["settling_speed_over_drag_law"][at], 0.002, "over what the drag law gives for all of them")
    step.number("law", 1e3 * drag_law_speed(columns["settling_packing_fraction"][at], 0.8 * 2.191e-4), 0.05, "the drag law's speed, worked out here [mm/s]")
    step.number("third_law", 1e14 * np.nanmax(abs(columns["third_law_defect"])), 10, "largest defect of the third law [1e-14]")
    step.number("penetration", run.summary["audit"]["largest_penetration_over_d"], 1e-3, "largest overlap in any contact [d]")
    if not step.short:
        done = columns["time_s"][np.nonzero(columns["settling_speed_m_per_s"][1:] < 1e-4)[0][0] + 1]
        step.number("done", done, 0.05, "grains sink slower than 0.1 mm/s from here on [s]")
        step.number("floor", run.last("floor_force_over_weight"), 1e-3, "share of the submerged weight on the floor at the end")
        step.number("height", 1e3 * run.last("bed_height_m"), 0.05, "height of the deposit [mm]")
        step.number("void", run.last("smallest_void_fraction"), 0.02, "smallest void fraction at the end")
        step.number("main_cpu", run.cpu("fluid", "contacts", "pictures", "observers", "set-up", "checkpoints"), steps.FREE, "CPU seconds of the run")
        step.number("fluid_cpu", run.cpu("fluid"), steps.FREE, "CPU seconds of the fluid")
        step.number("contacts_cpu", run.cpu("contacts"), steps.FREE, "of the contacts")

    # what to try
    for name, setting in (("coarse", "Mesh refinement/Criteria: uniform/Cell size=4"), ("fine", "Mesh refinement/Criteria: uniform/Cell size=1"),
                          ("long_steps", "Time/Time step=4e-3")):
        other = step.run("settling.prm", name=name, settings=[setting, "Time/End time=0.05", "Output/Interval of pictures=0"])
        at = int(np.argmin(abs(other.columns["time_s"] - 0.04)))
        step.number(name + "_ratio", other.columns["settling_speed_over_drag_law"][at], 0.003, "speed over the drag law's with " + setting)
        step.number(name + "_cells", other.summary["scene"]["cells"], 0.1, "cells then")
    if not step.short:
        denser = step.run("settling.prm", name="without_factor", settings=["Grains/Fluid radius factor=1", "Output/Interval of pictures=0"])
        step.number("denser_floor", denser.last("floor_force_over_weight"), 0.15, "share of the floor at the end where water sees the discs as they are")
        step.number("denser_void", denser.last("smallest_void_fraction"), 0.02, "smallest void fraction then")
    step.run("settling.prm", name="misspelt", settings=["Grains/Densty=2500"], exit_code=1)
    draw(step, run)
