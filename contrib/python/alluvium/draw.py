"""Draw what a run has written (doc/guide/output-format.md says what that is).

  motion-and-head.png  mass fraction in motion and differential head over time; several runs in one picture
  bed.png              the grains, coloured by how far they have moved, at a few times
  mesh.png             the fluid's mesh

A picture whose data are not there is left out.
"""

from __future__ import annotations

import argparse
import os
import sys
from typing import Any, Optional, Sequence

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, PolyCollection

from . import vtu
from .run import read_statistics, read_summary

STYLE: dict[str, Any] = {"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "savefig.dpi": 200}


def use_style() -> None:
    """Pictures to come look as those of contrib/plot."""
    plt.rcParams.update(STYLE)


def events(summary: dict[str, Any]) -> list[tuple[str, float]]:
    """(name, time) of first movement and total heave, as far as they happened."""
    found = []
    for name in ("first movement", "total heave"):
        time = (summary.get(name) or {}).get("time_s")
        if time is not None:
            found.append((name, time))
    return found


def plot_motion_and_head(folders: Sequence[str], target: str) -> Optional[str]:
    """Mass fraction in motion and differential head of runs over time; the picture's name, or None if they have neither."""
    runs = [(folder, read_statistics(folder), read_summary(folder)) for folder in folders]
    wanted = ("time_s", "moved_mass_fraction", "differential_head_m")
    runs = [run for run in runs if all(name in run[1] and len(run[1][name]) > 0 for name in wanted)]
    if not runs:
        return None

    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(5.2, 4.8), layout="constrained")
    for number, (folder, columns, summary) in enumerate(runs):
        label = summary.get("label") or os.path.basename(os.path.abspath(folder))
        color = "C%d" % (number % 10)
        top.plot(columns["time_s"], columns["moved_mass_fraction"], color=color, lw=1.4, label=label)
        bottom.plot(columns["time_s"], 100 * columns["differential_head_m"], color=color, lw=1.4, label=label)
        for name, time in events(summary):
            for axes in (top, bottom):
                axes.axvline(time, color="0.35" if len(runs) == 1 else color, lw=0.9,
                             ls=":" if name == "first movement" else "--")

    # One entry a kind of line, not one a run; what the values were stands there for a single run.
    for name, style in (("first movement", ":"), ("total heave", "--")):
        of_runs = [summary[name] for _, _, summary in runs if name in dict(events(summary))]
        if of_runs:
            text = name
            if len(runs) == 1:
                text += ", %.3g s" % of_runs[0]["time_s"]
                if of_runs[0].get("differential_head_m") is not None:
                    text += ", %.3g cm" % (100 * of_runs[0]["differential_head_m"])
            bottom.plot([], [], color="0.35", lw=0.9, ls=style, label=text)
    top.set_ylabel("mass fraction in motion")
    top.set_ylim(-0.03, 1.03)
    bottom.set_ylabel("differential head [cm]")
    bottom.set_xlabel("time [s]")
    bottom.margins(x=0.01)
    handles, labels = bottom.get_legend_handles_labels()
    if len(runs) == 1:
        handles, labels = handles[1:], labels[1:]
    if handles:
        top.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1.02), ncol=2, frameon=False, borderaxespad=0)
    return save(figure, target, "motion-and-head.png")


def length_unit(length: float) -> tuple[float, str]:
    """A unit that gives lengths of this size few digits: (factor, name)."""
    return (1e3, "mm") if length < 0.02 else (1e2, "cm") if length < 2 else (1.0, "m")


def snapshots(times: list, summary: dict[str, Any], n: int) -> list:
    """n of the times: the first, the ones at the events, the last, and more where the gaps are widest once it moves."""
    all_times = np.array([time for time, _ in times])
    chosen = {0, len(times) - 1}
    for _, time in events(summary):
        if len(chosen) < n:
            chosen.add(int(np.argmin(abs(all_times - time))))
    start = min((time for _, time in events(summary)), default=all_times[0])
    while len(chosen) < min(n, len(times)):
        order = sorted(chosen)
        gaps = [(all_times[b] > start and all_times[a] >= 0.9 * start, all_times[b] - all_times[a], a, b)
                for a, b in zip(order, order[1:]) if b > a + 1]
        _, _, a, b = max(gaps)
        chosen.add(a + 1 + int(np.argmin(abs(all_times[a + 1:b] - 0.5 * (all_times[a] + all_times[b])))))
    return [times[i] for i in sorted(chosen)]


def frame(axes: Any, lower: np.ndarray, upper: np.ndarray, factor: float, unit: str) -> None:
    axes.set_aspect("equal")
    axes.set_xlim(factor * lower[0], factor * upper[0])
    axes.set_ylim(factor * lower[1], factor * upper[1])
    axes.spines[["top", "right"]].set_visible(True)
    axes.locator_params(axis="x", nbins=3 if upper[0] - lower[0] < 1.5 * (upper[1] - lower[1]) else 8)


def label_axes(axes: Any, unit: str) -> None:
    """Of the outer panels of the grid only."""
    for axis in axes[-1]:
        axis.set_xlabel("x [%s]" % unit)
    for row in axes:
        row[0].set_ylabel("y [%s]" % unit)


def panels(n: int, width: float, height: float) -> tuple[Any, Any]:
    """Figure and axes for n pictures of this aspect side by side, in rows if they are wide."""
    columns = n if width < 1.5 * height else 1 if width > 3 * height else 2
    rows = -(-n // columns)
    panel_width = min(3.2, 7.5 / columns) if columns > 1 else 6.5
    panel_height = panel_width * height / width
    if panel_height > 5.5:
        panel_width, panel_height = 5.5 * width / height, 5.5
    figure, axes = plt.subplots(rows, columns, squeeze=False, layout="constrained", sharex=True, sharey=True,
                                figsize=(max(columns * max(panel_width, 1.1) + 1.3, 3.), rows * (panel_height + 0.75) + 0.5))
    for axis in axes.flat[n:]:
        axis.set_visible(False)
    return figure, axes


def plot_bed(folder: str, target: str, n_snapshots: int = 4) -> Optional[str]:
    """The grains at some times, coloured by how far they have moved; None if there are no pictures of grains."""
    name = os.path.join(folder, "grains.pvd")
    if not os.path.exists(name):
        return None
    summary = read_summary(folder)
    chosen = [(time, vtu.read_vtu(files)) for time, files in snapshots(vtu.read_pvd(name), summary, n_snapshots)]
    chosen = [(time, grains) for time, grains in chosen if len(grains.points) > 0]
    if not chosen:
        return None

    # The room that the grains take at any of the times; the domain, if the run says how large it is.
    lower = np.min([np.min(g.points[:, :2] - g.fields["radius"][:, None], axis=0) for _, g in chosen], axis=0)
    upper = np.max([np.max(g.points[:, :2] + g.fields["radius"][:, None], axis=0) for _, g in chosen], axis=0)
    domain = summary.get("domain") or {}
    if "lower_m" in domain and "upper_m" in domain:
        lower[:], upper[0] = np.minimum(lower, domain["lower_m"][:2]), max(upper[0], domain["upper_m"][0])
        upper[1] = min(upper[1] + 0.1 * (upper[1] - lower[1]), max(upper[1], domain["upper_m"][1]))
    factor, unit = length_unit(max(upper - lower))

    moved = [np.linalg.norm(grains.fields["displacement"][:, :2], axis=1) for _, grains in chosen]
    largest = max(m.max() for m in moved)
    diameter = 2 * max(grains.fields["radius"].max() for _, grains in chosen)
    figure, axes = panels(len(chosen), *(upper - lower))
    for axis, (time, grains), distance in zip(axes.flat, chosen, moved):
        size = 2 * factor * grains.fields["radius"]
        discs = EllipseCollection(size, size, np.zeros_like(size), units="xy", offsets=factor * grains.points[:, :2],
                                  offset_transform=axis.transData, cmap="viridis", linewidths=0)
        discs.set_array(distance / diameter)
        discs.set_clim(0, max(largest / diameter, 1e-12))
        axis.add_collection(discs)
        frame(axis, lower, upper, factor, unit)
        labels = [name for name, event in events(summary) if abs(time - event) < 1e-9 + 0.005 * (chosen[-1][0] - chosen[0][0])]
        axis.set_title("t = %.3g s" % time + ("".join("\n" + label for label in labels[:1])), fontsize=9)
    label_axes(axes, unit)
    bar = figure.colorbar(discs, ax=axes, shrink=0.8, pad=0.02)
    bar.set_label("displacement / largest diameter")
    return save(figure, target, "bed.png")


def plot_mesh(folder: str, target: str) -> Optional[str]:
    """The fluid's mesh at the beginning and, if it changes, at the end; None if there are no pictures of the fluid."""
    name = os.path.join(folder, "fluid.pvd")
    if not os.path.exists(name):
        return None
    times = vtu.read_pvd(name)
    shown: list[tuple[float, vtu.Grid]] = []
    for time, files in ([times[0], times[-1]] if len(times) > 1 else times):
        fluid = vtu.read_vtu(files)
        if not shown or len(fluid.cells) != len(shown[0][1].cells):  # a mesh that is not adapted is shown once
            shown.append((time, fluid))
    shown = [entry for entry in shown if len(entry[1].cells) > 0]
    if not shown:
        return None

    lower, upper = shown[0][1].points[:, :2].min(axis=0), shown[0][1].points[:, :2].max(axis=0)
    factor, unit = length_unit(max(upper - lower))
    figure, axes = panels(len(shown), *(upper - lower))
    for axis, (time, fluid) in zip(axes.flat, shown):
        n_cells = len(fluid.cells)
        cells = [factor * fluid.points[cell, :2] for cell in fluid.cells]
        axis.add_collection(PolyCollection(cells, facecolors="none", edgecolors="k", linewidths=min(0.5, 15 / n_cells**0.5)))
        frame(axis, lower, upper, factor, unit)
        axis.set_title("t = %.3g s\n%s cells" % (time, format(n_cells, ",")), fontsize=9)
    label_axes(axes, unit)
    return save(figure, target, "mesh.png")


def save(figure: Any, target: str, name: str) -> str:
    name = os.path.join(target, name)
    figure.savefig(name)
    plt.close(figure)
    return name


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="OUTPUT_FOLDER",
                        help="of a run; curves of further ones are drawn into the first one's picture")
    parser.add_argument("--to", metavar="FOLDER", help="where to put the pictures (default: the first output folder)")
    parser.add_argument("--snapshots", type=int, default=4, metavar="N", help="of the bed (default: 4)")
    arguments = parser.parse_args()
    matplotlib.use("Agg")
    use_style()

    for folder in arguments.folders:
        if not os.path.isdir(folder):
            sys.exit("plot: there is no folder '%s'." % folder)
    target = arguments.to or arguments.folders[0]
    os.makedirs(target, exist_ok=True)

    pictures = [plot_motion_and_head(arguments.folders, target),
                plot_bed(arguments.folders[0], target, max(arguments.snapshots, 2)),
                plot_mesh(arguments.folders[0], target)]
    for picture in pictures:
        if picture:
            print(picture)
    if not any(pictures):
        sys.exit("plot: '%s' has no statistics.csv, grains.pvd or fluid.pvd with anything to draw." % target)


if __name__ == "__main__":
    main()
