import csv
import os

import numpy as np
from matplotlib.collections import PolyCollection

import steps


def read(name):
    with open(name, newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def draw_pieces(step, pieces):
    figure, axis = steps.plt.subplots(figsize=(4.6, 4), layout="constrained")
    corners = [[(pieces["x%d" % v][i], pieces["y%d" % v][i]) for v in range(4)] for i in range(len(pieces["area"]))]
    cells = PolyCollection(corners, array=pieces["area"] / pieces["cell_area"], cmap="Blues", edgecolors="0.4", linewidths=0.7)
    axis.add_collection(cells)
    angle = np.linspace(0, 2 * np.pi, 200)
    axis.plot(0.47 + 0.31 * np.cos(angle), 0.54 + 0.31 * np.sin(angle), color="#c8963c", lw=2)
    cut = pieces["area"] > 0
    axis.plot(pieces["cx"][cut], pieces["cy"][cut], "k.", ms=4)
    axis.set(aspect="equal", xlim=(0, 1), ylim=(0, 1))
    figure.colorbar(cells, ax=axis, label="share of the cell that the disc takes", shrink=0.8)
    step.picture(figure, "pieces.png")


def draw_crossing(step, crossing):
    figure, axis = steps.plt.subplots(figsize=(5, 2.6), layout="constrained")
    axis.plot(crossing["x"], crossing["centre"], color="0.5", label="cell of the centre")
    axis.plot(crossing["x"], crossing["exact"], label="exact pieces")
    axis.set(xlabel="position of the centre, from the side [d]", ylabel="void fraction of the cell")
    axis.legend(loc="upper right")
    step.picture(figure, "crossing.png")


def results(step):
    files = [os.path.join(step.scratch, name) for name in ("pieces.csv", "crossing.csv")]
    lines = step.program("step-2", *files).splitlines()
    table = [list(map(float, line.split())) for line in lines[1:6]]
    step.number("area_error", 1e15 * max(row[2] for row in table), 2, "largest error of the area [1e-15]")
    step.number("linear_error", 1e15 * max(row[3] for row in table), 2, "of x [1e-15]")
    step.number("moments_error", 1e15 * max(row[5] for row in table), 2, "of x y with moments [1e-15]")
    step.number("quadratic_error", 1e3 * table[0][6], 0.01, "of x^2 at h/d = 1 [1e-3]")
    step.number("order", np.log2(table[2][6] / table[4][6]) / 2, 0.05, "order of the error of x^2, from h/d = 0.25 to 0.06")
    step.number("steepest_percent", 100 * float(lines[-1].split()[-1]), 0.01, "largest change of the void fraction in a move of d/100, over the whole [%]")
    pieces, crossing = map(read, files)
    step.number("pieces", np.sum(pieces["area"] > 0), 0.1, "pieces in the picture")
    step.number("jump", max(-np.diff(crossing["centre"])), 1e-4, "jump of the void fraction if a disc is in the cell of its centre")
    step.number("smooth", max(-np.diff(crossing["exact"])), 1e-4, "largest change with exact pieces in the same move")
    draw_pieces(step, pieces)
    draw_crossing(step, crossing)
