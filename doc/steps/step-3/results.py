import math
import re

import numpy as np
from matplotlib.collections import PolyCollection

import steps

RHO, ETA, G, WIDTH = 1000.0, 1e-3, 9.81, 0.005
SIZES = (8, 4, 2, 1, 0.5)


def gamma(eps, d):
    """Of the law `disc` in creeping flow [N s/m^4]."""
    return 2 / math.pi * 4.8**2 * eps**-2.8 * ETA / d**2


def permeability(eps, d):
    return eps**2 * ETA / ((1 - eps) * gamma(eps, d))


def uniform(h):
    return ["Mesh refinement/Criteria=uniform", "Mesh refinement/Criteria: uniform/Cell size=%g" % h]


def profile(run):
    """Heights and the horizontal mean of the void fraction at the mesh's nodes."""
    fluid = run.pictures("fluid")[-1][1]
    y = np.round(fluid.points[:, 1], 9)
    heights = np.unique(y)
    return heights, np.array([fluid.fields["void_fraction"][y == height].mean() for height in heights])


def draw(step, run, sizes, flux, expected):
    fluid, grains = run.pictures("fluid")[-1][1], run.pictures("grains")[-1][1]
    figure, (bed, middle, right) = steps.plt.subplots(1, 3, figsize=(7.4, 3.4), layout="constrained", width_ratios=(1, 0.9, 1.6))
    corners = [1e3 * fluid.points[cell, :2] for cell in fluid.cells]
    cells = PolyCollection(corners, array=np.array([fluid.fields["void_fraction"][cell].mean() for cell in fluid.cells]), cmap="Blues_r",
                           edgecolors="0.5", linewidths=0.3)
    bed.add_collection(cells)
    bed.set(aspect="equal", xlim=(0, 5), ylim=(0, 10), xlabel="x [mm]", ylabel="y [mm]")
    figure.colorbar(cells, ax=bed, location="top", label="void fraction", shrink=0.9)
    for h in (8, 1):
        heights, eps = profile(run if h == 1 else step.coarse)
        middle.plot(eps, 1e3 * heights, label="h/d %s" % ("1 at faces" if h == 1 else "8"))
    middle.set(xlabel="void fraction", ylabel="y [mm]", ylim=(0, 10))
    middle.legend(loc="upper left", fontsize=7)
    for radius, label in (("grain", "filter R = grain (the paper)"), ("2 d", "R = 2 d (default)")):
        right.semilogx(sizes, [f / expected for f in flux[radius]], "o-", label=label)
    right.axhline(1, color="0.5", lw=0.8, ls="--")
    right.set(xlabel="cell size h/d", ylabel="flux over that at h/d 0.5, R = 2 d")
    right.set_xticks(SIZES, [str(h) for h in SIZES])
    right.minorticks_off()
    right.legend(fontsize=8)
    step.picture(figure, "darcy.png")


def results(step):
    flux = {}
    for radius in ("grain", "2 d"):
        sizes = (8, 0.5) if step.short else SIZES
        runs = [step.run("darcy.prm", name="filter-%s-%g" % (radius.replace(" ", ""), h), settings=uniform(h) + ["Coupling/Filter radius=" + radius])
                for h in sizes]
        flux[radius] = [run.last("flux_top_m2_per_s") for run in runs]
    step.coarse = runs[0]
    run = step.run("darcy.prm")
    grains = run.pictures("grains")[-1][1]
    with open(step.scratch + "/darcy.printed") as file:
        factor = float(re.search(r"fluid radius (\S+) of", file.read()).group(1))
    d = 2 * factor * math.sqrt(np.mean(grains.fields["radius"]**2))  # the drag law sees what the water sees
    head = run.last("differential_head_m")
    length = head / 0.02

    # one bed of the mean void fraction, and layers of the void fraction that the finest mesh has
    homogeneous = WIDTH * permeability(0.48, d) / ETA * RHO * G * 0.02
    heights, eps = profile(runs[-1])
    resistance = np.trapezoid((1 - eps) * gamma(eps, d) / eps**2, heights) if hasattr(np, "trapezoid") else np.trapz((1 - eps) * gamma(eps, d) / eps**2, heights)
    layered = WIDTH * RHO * G * head / resistance

    step.number("permeability", 1e10 * permeability(0.48, d), 0.005, "permeability of the law at the bed's mean void fraction [1e-10 m^2]")
    step.number("length", 1e3 * length, 0.01, "height of the bed [mm]")
    step.number("flux", 1e7 * run.last("flux_top_m2_per_s"), 0.003, "flux of the scene as it is [1e-7 m^2/s]")
    step.number("darcy", 1e7 * homogeneous, 0.003, "Darcy's with the mean void fraction [1e-7 m^2/s]")
    step.number("ratio", run.last("flux_top_m2_per_s") / homogeneous, 0.003, "flux over that")
    step.number("layered", flux["2 d"][-1] / layered, 0.003, "flux at h/d 0.5 over that through layers of the void fraction's profile")
    step.number("graded", run.last("flux_top_m2_per_s") / flux["2 d"][-1], 0.003, "flux of the scene as it is over that at h/d 0.5")
    step.number("fine_cells", runs[-1].summary["scene"]["cells"], 0.1, "cells of 0.5 d")
    step.number("imbalance", abs(run.last("flux_imbalance")), 1e-6, "flux in less flux out, over the larger")
    step.number("cells", run.summary["scene"]["cells"], 0.1, "cells")
    step.number("reynolds", 1e3 * RHO * run.last("flux_top_m2_per_s") / WIDTH * d / ETA, 0.1, "Reynolds number of the superficial velocity [1e-3]")
    for radius, name in (("grain", "grain"), ("2 d", "two")):
        for h, value in zip(sizes, flux[radius]):
            step.number("%s_%s" % (name, str(h).replace(".", "")), value / flux["2 d"][-1], 0.005, "flux over that of h/d 0.5, R = 2 d: h/d %g, R = %s" % (h, radius))
    for law in ("paper",) if step.short else ("sphere", "paper", "Ergun"):
        other = step.run("darcy.prm", name="law-" + law, settings=["Coupling/Drag law=" + law])
        step.number("law_" + law, other.last("flux_top_m2_per_s") / run.last("flux_top_m2_per_s"), 0.003, "flux of law %s over that of disc" % law)
    draw(step, run, sizes, flux, flux["2 d"][-1])
    if step.short:
        return

    inside = step.run("darcy.prm", name="inside", settings=["Mesh refinement/Criteria: bed faces/Cell size far away=2"])
    step.number("inside", inside.last("flux_top_m2_per_s") / flux["2 d"][-1], 0.003, "flux with no cell larger than 2 d, over that at h/d 0.5")
    step.number("inside_cells", inside.summary["scene"]["cells"], 0.1, "cells then")

    # what to try
    fast = step.run("darcy.prm", name="fast", settings=["Boundary conditions/Pressure=top: 0; bottom: rho*g*H + 0.8*rho*g*L"])
    step.number("fast", fast.last("flux_top_m2_per_s") / 40 / run.last("flux_top_m2_per_s"), 0.005, "flux over head at 40 times the head, over that of the scene")
    smooth = step.run("darcy.prm", name="smooth", settings=uniform(0.5) + ["Coupling/Filter shape=parabolic", "Coupling/Filter radius=2.5 d"])
    step.number("smooth", smooth.last("flux_top_m2_per_s") / flux["2 d"][-1], 0.005, "flux with the smooth filter, R = 2.5 d, over that with the even one at h/d 0.5")
    short_step = step.run("darcy.prm", name="short-step", settings=uniform(0.5) + ["Coupling/Filter radius=grain", "Time/Time step=5e-4"])
    step.number("grain_dt", short_step.last("flux_top_m2_per_s") / flux["2 d"][-1], 0.005, "R = grain, h/d 0.5 with a tenth of the time step")
