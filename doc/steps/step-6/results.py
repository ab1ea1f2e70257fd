import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

import steps


def uniform(h):
    return ["Mesh refinement/Criteria=uniform", "Mesh refinement/Criteria: uniform/Cell size=%g" % h, "Mesh refinement/Interval=0"]


MESHES = {
    "fine": ("uniform, 0.5", uniform(0.5)),
    "coarse": ("uniform, 8", uniform(8)),
    "adaptive": ("adaptive, 8 to 0.5", []),
    "wide": ("adaptive, bands of 4 d", ["Mesh refinement/Criteria: bed faces/Half width=4", "Mesh refinement/Criteria: bed faces/Growth=0.5"]),
}


def draw(step, runs):
    run = runs["adaptive"]
    grains, fluid = run.pictures("grains"), run.pictures("fluid")
    chosen = [0, -1] if step.short else [0, len(fluid) // 2 + 2, len(fluid) - 2, len(fluid) - 1]
    figure, axes = steps.plt.subplots(1, len(chosen), figsize=(7.2, 4.9), sharey=True, layout="constrained")
    for axis, i in zip(axes, chosen):
        discs, mesh = grains[i][1], fluid[i][1]
        size = 2e3 * discs.fields["radius"]
        axis.add_collection(EllipseCollection(size, size, 0 * size, units="xy", offsets=1e3 * discs.points[:, :2], offset_transform=axis.transData,
                                              facecolors="#e3c690", linewidths=0))
        axis.add_collection(PolyCollection([1e3 * mesh.points[cell, :2] for cell in mesh.cells], facecolors="none", edgecolors="k", linewidths=0.3))
        axis.set(aspect="equal", xlim=(0, 6), ylim=(0, 14.4), title="t = %.2f s\n%d cells" % (fluid[i][0], len(mesh.cells)), xlabel="x [mm]")
    axes[0].set_ylabel("y [mm]")
    step.picture(figure, "meshes.png")

    figure, (left, right) = steps.plt.subplots(1, 2, figsize=(7.2, 2.7), layout="constrained")
    for name, run in runs.items():
        left.plot(run.columns["time_s"], 1e3 * run.columns["differential_head_m"], lw=1, label=MESHES[name][0])
        right.plot(run.columns["time_s"], run.columns["moved_mass_fraction"], lw=1, label=MESHES[name][0])
    left.set(xlabel="time [s]", ylabel="differential head [mm]", ylim=(8, 11.5))
    right.set(xlabel="time [s]", ylabel="mass fraction in motion")
    left.legend(fontsize=7)
    step.picture(figure, "curves.png")


def results(step):
    short = ["Time/End time=0.02", "Boundary conditions/Pressure=top: 103e3; bottom: 103e3 + rho*g*H*(1 + 0.69 + t)"]
    runs = {name: step.run("coarse-to-fine.prm", name=name, settings=settings, short=short)
            for name, (_, settings) in MESHES.items() if not step.short or name in ("coarse", "adaptive")}
    reference = runs.get("fine", runs["coarse"])
    for name, run in runs.items():
        n = [len(mesh.cells) for _, mesh in run.pictures("fluid")]
        onset = run.summary["onset by force balance"]
        step.number(name + "_cells", n[0], 0.1, "cells at the start, mesh: " + MESHES[name][0])
        step.number(name + "_last_cells", n[-1], 150, "cells at the end")
        step.number(name + "_onset", onset["over_exact"], 0.002, "head at which water carries the bed, over the exact one")
        if not step.short:
            at = np.argmin(abs(run.columns["time_s"] - 0.05))
            step.number(name + "_flux", run.columns["flux_top_m2_per_s"][at] / reference.columns["flux_top_m2_per_s"][at], 0.003, "flux at 0.05 s over that of the uniform fine mesh")
            step.number(name + "_heave", run.summary["total heave"]["differential_head_m"] / reference.summary["total heave"]["differential_head_m"], 0.02, "head of the total heave over that")
            step.number(name + "_fluid_cpu", run.cpu("fluid", "mesh adaptation"), steps.FREE, "CPU seconds of the fluid, adaptations included")
            step.number(name + "_all_cpu", run.cpu("fluid", "mesh adaptation", "contacts"), steps.FREE, "and contacts")
    run = runs["adaptive"]
    solid = [run.columns["mesh_change_solid_volume_m2_" + when] for when in ("before", "after")]
    if not np.all(np.isnan(solid[0])):
        step.number("solid", 1e12 * np.nanmax(abs(solid[1] / solid[0] - 1)), 1, "largest relative change of the solid's volume in a change of the mesh [1e-12]")
    if not step.short:
        step.number("adaptations", run.summary["counts"]["mesh adaptations"], 6, "changes of the mesh")
        step.number("adaptation_cpu", run.cpu("mesh adaptation"), steps.FREE, "CPU seconds of adaptations")
        step.number("ratio", runs["fine"].cpu("fluid") / run.cpu("fluid", "mesh adaptation"), steps.FREE, "CPU time of the fluid, uniform fine mesh over adaptive")
        share = run.columns["mesh_change_share"]
        step.number("share", 100 * np.nanmax(share), 40, "largest share of the area whose cells changed [%]")
        moving = step.run("coarse-to-fine.prm", name="moving", settings=["Mesh refinement/Criteria=bed faces, moving grains"])
        n = [len(mesh.cells) for _, mesh in moving.pictures("fluid")]
        step.number("moving_last_cells", n[-1], 1000, "cells at the end if moving grains are followed, too")
        step.number("moving_fluid_cpu", moving.cpu("fluid", "mesh adaptation"), steps.FREE, "CPU seconds of the fluid then")
        still = step.run("coarse-to-fine.prm", name="still", settings=["Mesh refinement/Interval=0"])
        step.number("still_heave", still.summary["total heave"]["differential_head_m"] / reference.summary["total heave"]["differential_head_m"], 0.02, "heave on the mesh of the start")
        at = -1
        step.number("still_flux", still.columns["flux_top_m2_per_s"][at] / run.columns["flux_top_m2_per_s"][at], 0.1, "its flux at the end over that of the mesh that follows")
    draw(step, runs)
