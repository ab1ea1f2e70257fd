import csv
import os

import numpy as np
from matplotlib.collections import EllipseCollection

import steps

WIDTH, HEIGHT, TURNS = 0.01, 0.02, 0.25
COLUMNS = ("kinetic_energy_J_per_m", "largest_fluid_velocity_m_per_s")


def read(name):
    with open(name, newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def draw(step, names, turned, sliding):
    figure, axes = steps.plt.subplots(1, len(names), figsize=(8, 2), layout="constrained")
    for i, (axis, name) in enumerate(zip(axes, names)):
        angle = 2 * np.pi * TURNS * i * 2.0 / (len(names) - 1)
        c, s = np.cos(angle), np.sin(angle)

        def seen(x, y):
            """From outside: up is up, the box has turned anticlockwise."""
            x, y = x - 0.5 * WIDTH, y - 0.5 * HEIGHT
            return 1e3 * np.stack([c * x - s * y, s * x + c * y], axis=-1)

        grains = read(name)
        colour = read(names[0])["y"]
        discs = EllipseCollection(*[2e3 * grains["radius"]] * 2, np.zeros(len(colour)), units="xy", offsets=seen(grains["x"], grains["y"]),
                                  offset_transform=axis.transData, cmap="viridis", linewidths=0.2, edgecolors="k")
        discs.set_array(colour)
        axis.add_collection(discs)
        corners = seen(np.array([0, WIDTH, WIDTH, 0, 0]), np.array([0, 0, HEIGHT, HEIGHT, 0]))
        axis.plot(*corners.T, "k", lw=1)
        axis.set(aspect="equal", xlim=(-11.5, 11.5), ylim=(-11.5, 11.5))
        axis.set_title("%g s" % (0.5 * i), fontsize=9)
        axis.axis("off")
    step.picture(figure, "turned.png")

    figure, axis = steps.plt.subplots(figsize=(5.4, 2.6), layout="constrained")
    axis.plot(360 * TURNS * turned["time_s"], 1e3 * turned["height_m"])
    axis.axvline(sliding, color="0.6", ls=":", lw=1)
    axis.set(xlabel="angle [degrees]", ylabel="centre of mass of\nthe grains [mm]")
    axis.set_xticks(range(0, 181, 30))
    step.picture(figure, "height.png")


def results(step):
    # the box stands still: the same as the program's
    end = "0.1" if step.short else "0.4"
    files = [os.path.join(step.scratch, name) for name in ("grains.csv", "still.csv")]
    step.program("step-10", *files, "0", end)
    still = read(files[1])
    run = step.run("box.prm", settings=["Grains/Deposit: file/File=" + files[0], "Time/End time=" + end])
    for until, name in ((0.02, "20"), (0.1, "100")):
        rows = slice(0, int(round(until / 1e-3)))
        difference = max(np.max(np.abs(still[c][rows] - run.columns[c][1:][rows])) / np.max(np.abs(run.columns[c])) for c in COLUMNS)
        step.number("difference_" + name, 1e9 * difference if name == "20" else 100 * difference, 1 if name == "20" else 0.5,
                    "largest difference from the program in the first %s steps, over the largest value [%s]" % (name, "1e-9" if name == "20" else "%"))
    step.number("grains", len(read(files[0])["x"]), 0.1, "grains")
    with open(os.path.join(step.folder, "step-10.cc")) as file:
        lines = [line.strip() for line in file]
    step.number("lines", sum(1 for line in lines if line and not line.startswith("//")), 20, "lines of the program without comments and empty ones")
    if step.short:
        return
    rest = run.columns["bed_height_m"][-1]
    step.number("at_rest", 1e6 * still["kinetic_energy_J_per_m"][-1], 1e-3, "kinetic energy in the end [1e-6 J/m]")
    step.number("bed", 1e3 * rest, 0.05, "height of the bed at rest [mm]")

    # it turns
    files = [os.path.join(step.scratch, name) for name in ("grains.csv", "turned.csv")]
    step.program("step-10", *files, str(TURNS), "2")
    turned = read(files[1])
    moving = turned["kinetic_energy_J_per_m"] > 2e-5
    sliding = 360 * TURNS * turned["time_s"][np.argmax(moving)]
    step.number("sliding", sliding, 8, "angle at which the bed starts to slide [degrees]")
    step.number("highest", 360 * TURNS * turned["time_s"][np.argmax(turned["height_m"])], 8, "angle at which the grains are highest [degrees]")
    step.number("backflow", 1e3 * np.max(turned["largest_fluid_velocity_m_per_s"]), 40, "largest velocity of the water at a node [mm/s]")
    draw(step, [files[0]] + [files[1] + "-%d" % i for i in range(1, 5)], turned, sliding)

    # what to try
    step.program("step-10", files[0], os.path.join(step.scratch, "slow.csv"), str(0.5 * TURNS), "4")
    slow = read(os.path.join(step.scratch, "slow.csv"))
    step.number("sliding_slow", 180 * TURNS * slow["time_s"][np.argmax(slow["kinetic_energy_J_per_m"] > 2e-5)], 8, "the same at half the rate")
