import math
import re

import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

import steps

RHO, ETA, G, D = 1000.0, 1e-3, 9.81, 1e-3
LENGTH, AMPLITUDE, DEPTH, BED = 0.1, 2e-3, 0.04, 0.05


class Exact:
    """A rigid, even bed of the height BED under the wave: Darcy's law with the fluid's inertia; the pressure solves Laplace's equation."""

    def __init__(self, eps, constant=180.0):
        self.k = 2 * math.pi / LENGTH
        self.omega = math.sqrt(G * self.k * math.tanh(self.k * DEPTH))
        self.pressure = RHO * G * AMPLITUDE / math.cosh(self.k * DEPTH)
        self.permeability = eps**3 * D**2 / (constant * (1 - eps)**2)
        lag = self.omega * RHO * self.permeability / (ETA * eps)  # phase by inertia: omega times the time in which drag stops the fluid
        steady = self.permeability / ETA * self.k * math.tanh(self.k * BED) * self.pressure
        self.exchange = LENGTH / math.pi * steady / math.sqrt(1 + lag**2)
        self.power = 0.5 * LENGTH * self.pressure * steady / (1 + lag**2)
        self.lag = lag

    def drained(self, height, conductance):
        """The exchange of a bed of that height whose floor drains, over that of the same with an impermeable one."""
        still = math.tanh(self.k * height)
        beta = conductance * ETA / (self.permeability * self.k) * (1 - 1j * self.lag)  # flux by pressure at the floor, over that of an endless bed
        return abs((still + beta) / (1 + beta * still)) / still


def draw(step, run, exact):
    time, fluid = run.pictures("fluid")[-1]
    grains = run.pictures("grains")[-1][1]
    figure, (wave, bed) = steps.plt.subplots(2, 1, sharex=True, figsize=(6.4, 4.6), layout="constrained", height_ratios=(1, 2.6))
    x = np.linspace(0, LENGTH, 200)
    wave.plot(1e3 * x, exact.pressure * np.cos(exact.k * x - exact.omega * time))
    wave.axhline(0, color="0.7", lw=0.7)
    wave.set(ylabel="pressure on\nthe bed [Pa]")
    corners = [1e3 * fluid.points[cell, :2] for cell in fluid.cells]
    pressure = fluid.fields["pressure"] + RHO * G * (fluid.points[:, 1] - BED)  # above hydrostatic
    cells = PolyCollection(corners, array=np.array([pressure[cell].mean() for cell in fluid.cells]), cmap="coolwarm")
    cells.set_clim(-exact.pressure, exact.pressure)
    bed.add_collection(cells)
    size = 2e3 * grains.fields["radius"]
    bed.add_collection(EllipseCollection(size, size, np.zeros_like(size), units="xy", offsets=1e3 * grains.points[:, :2],
                                         offset_transform=bed.transData, facecolors="none", edgecolors="0.55", linewidths=0.25))
    _, once = np.unique(np.round(fluid.points[:, :2], 9), axis=0, return_index=True)
    ij = np.round(fluid.points[once, :2] / (2 * D)).astype(int)
    shown = once[(ij % 3 == 0).all(axis=1)]
    u = fluid.fields["velocity"]
    bed.quiver(1e3 * fluid.points[shown, 0], 1e3 * fluid.points[shown, 1], u[shown, 0], u[shown, 1], scale=0.015, width=0.004)
    bed.set(aspect="equal", xlim=(0, 1e3 * LENGTH), ylim=(0, 1e3 * BED), xlabel="x [mm]", ylabel="y [mm]")
    figure.colorbar(cells, ax=bed, label="pressure above\nhydrostatic [Pa]", shrink=0.9)
    step.picture(figure, "sea-bed.png")


def results(step):
    step.build_against_installed()
    sizes = (8,) if step.short else (8, 4, 2, 1)
    short = ["Time/End time=0.1", "Output/Observers: exchange/Mean from=0.05"]
    runs = {h: step.run("sea-bed.prm", name="cells-%d" % h, settings=["Mesh refinement/Criteria: uniform/Cell size=%d" % h], short=short) for h in sizes}
    run = runs[8] if step.short else runs[2]
    step.run("sea-bed.prm", name="check", arguments=["--check"])
    with open(step.scratch + "/check.printed") as file:
        printed = file.read()
    grains = int(re.search(r"grains +(\d+) discs", printed).group(1))
    eps = 1 - grains * math.pi * D**2 / 4 / (LENGTH * BED)
    exact = Exact(eps)
    step.number("grains", grains, 0.1, "grains")
    step.number("void_fraction", eps, 1e-4, "void fraction of the bed")
    step.number("period", 2 * math.pi / exact.omega, 1e-4, "period of the wave [s]")
    step.number("pressure", exact.pressure, 0.01, "amplitude of the pressure on the bed [Pa]")
    step.number("permeability", 1e9 * exact.permeability, 0.01, "of Kozeny and Carman [1e-9 m^2]")
    step.number("printed", float(re.search(r"permeability (\S+) m", printed).group(1)) / exact.permeability, 0.002, "permeability that --check prints over that")
    step.number("exact_exchange", 1e6 * exact.exchange, 0.05, "exchange of the exact solution [1e-6 m^2/s]")
    step.number("exact_power", 1e6 * exact.power, 0.5, "power of the exact solution [1e-6 W/m]")
    for h, one in runs.items():
        mean = one.summary["exchange"]
        step.number("exchange_%d" % h, mean["mean_m2_per_s"] / exact.exchange, 0.003, "exchange over the exact one, cells of %d d" % h)
        step.number("power_%d" % h, mean["mean_power_W_per_m"] / exact.power, 0.003, "power over the exact one, cells of %d d" % h)
    height, conductance = 0.0125, 2e-4
    shallow = ["Domain/Upper right corner=%g, %g" % (LENGTH, height)]
    drains = ["Boundary conditions/Slip walls=", "Boundary conditions/Drains=bottom: %g | rho*g*H" % conductance]
    exchange = [step.run("sea-bed.prm", name=name, settings=shallow + settings, short=short).summary["exchange"]["mean_m2_per_s"]
                for name, settings in (("shallow", []), ("drained", drains))]
    step.number("drained", exchange[1] / exchange[0], 0.003, "exchange of a shallow bed over drains, over that over a tight floor")
    step.number("exact_drained", exact.drained(height, conductance), 1e-3, "the same of the exact solution")
    end = 0.1 if step.short else 0.6
    step.run("sea-bed.prm", name="restarted", settings=["Mesh refinement/Criteria: uniform/Cell size=8", "Time/End time=%g" % (0.75 * end)],
             short=short[1:])
    again = step.run("sea-bed.prm", name="restarted", settings=["Mesh refinement/Criteria: uniform/Cell size=8", "Output/Restart=true"], short=short, keep=True)
    step.number("restarted", again.summary["exchange"]["mean_m2_per_s"] / runs[8].summary["exchange"]["mean_m2_per_s"] - 1, 1e-12,
                "mean exchange of a run that was interrupted, over that of one that was not, less 1")
    if step.short:
        return
    draw(step, run, exact)

    # what to try
    finer = step.run("sea-bed.prm", name="constant", settings=["Coupling/Drag law: kozeny/Constant=360"])
    step.number("constant", finer.summary["exchange"]["mean_m2_per_s"] / run.summary["exchange"]["mean_m2_per_s"], 0.003, "exchange with C = 360 over that with 180")
    halved = step.run("sea-bed.prm", name="time-step", settings=["Time/Time step=1.25e-3"])
    step.number("time_step", halved.summary["exchange"]["mean_m2_per_s"] / run.summary["exchange"]["mean_m2_per_s"], 0.003, "exchange with half the time step over that")
    ergun = step.run("sea-bed.prm", name="ergun", settings=["Coupling/Drag law=Ergun"])
    step.number("ergun", ergun.summary["exchange"]["mean_m2_per_s"] / run.summary["exchange"]["mean_m2_per_s"], 0.003, "exchange with Ergun's law over that")
    step.run("sea-bed.prm", name="steep", settings=["Boundary conditions/Plug-ins: linear wave/Amplitude=1e-2"], exit_code=1)
