"""Pictures of studies: error against CPU time, and maps of what is stable. SVG and PNG of each."""

import math
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator
from matplotlib.transforms import Bbox

from alluvium.draw import use_style

from .study import number

# Okabe and Ito's colours, which the colour-blind can tell; yellow is left out: it is too light for lines
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", ">", "h"]
FRONT, FAILED = "0.55", "#000000"


def style():
    use_style()
    plt.rcParams.update({"font.size": 15, "axes.titlesize": 16, "axes.labelsize": 16, "legend.fontsize": 14, "svg.fonttype": "none", "svg.hashsalt": "laboratory",
                         "savefig.dpi": 100})


def save(figure, folder, name):
    """NAME.svg and NAME.png."""
    os.makedirs(folder, exist_ok=True)
    figure.savefig(os.path.join(folder, name + ".svg"), metadata={"Date": None, "Creator": None})
    figure.savefig(os.path.join(folder, name + ".png"), metadata={"Software": None})
    plt.close(figure)
    return [os.path.join(folder, name + end) for end in (".svg", ".png")]


def draw(study, results, folder):
    style()
    return {"map": draw_map, "curves": draw_curves, "work-precision": draw_work_precision}[study.chart.kind](study, results, folder)


def remove(study, folder):
    """Pictures of an earlier run, where there is nothing to draw now."""
    for end in (".svg", ".png"):
        if os.path.exists(os.path.join(folder, study.name + end)):
            os.remove(os.path.join(folder, study.name + end))


def panels(n, columns, size, legend_height):
    """Figure, n axes of this size in so many columns, and a strip below them for a legend [inches]."""
    rows = math.ceil(n / columns)
    free = columns == 2 and n % 2 == 1  # the place of one panel
    figure = plt.figure(figsize=(columns * size[0], rows * size[1] + (0 if free else legend_height)), layout="constrained")
    grid = figure.add_gridspec(rows + (not free), columns, height_ratios=[size[1]] * rows + [legend_height] * (not free))
    axes = [figure.add_subplot(grid[i // columns, i % columns]) for i in range(n)]
    place = figure.add_subplot(grid[rows - 1, 1] if free else grid[rows, :])
    place.axis("off")
    place.columns = 1 if free else columns
    return figure, axes, place


# --- error against CPU time

def draw_work_precision(study, results, folder):
    names = results.error_names()
    if not names:
        return []
    series = list(dict.fromkeys(r.point.series for r in results if not r.point.reference))
    looks = {s: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, s in enumerate(series)}
    columns = 1 if len(names) == 1 else 2
    figure, axes, place = panels(len(names), columns, (12, 7.6) if columns == 1 else (7.4, 6.4), 0.34 * math.ceil((len(series) + 4) / 2) + 0.1)
    handles = {}
    for axis, name in zip(axes, names):
        work_precision_panel(axis, results, name, looks, handles, study.chart.apart)
        axis.set_title("" if name == "error" else name)
        axis.set_xlabel(study.get("error_title", "error") if name == "error" else "error of " + name)
        axis.set_ylabel("CPU time [s]")
    place.legend(handles.values(), handles.keys(), loc="center", ncol=2 if columns == 1 or place.columns == 2 else 1, frameon=False)
    figure.canvas.draw()
    figure.set_layout_engine("none")  # labels must not push the axes
    for axis in axes:
        place_labels(figure, axis)
    return save(figure, folder, study.name)


def work_precision_panel(axis, results, name, looks, handles, apart=()):
    shown = results.compared(name)
    front = results.front(name)
    failed = [r for r in results if not r.done and not r.point.reference]
    errors = [r.errors[name] for r in shown if r.errors[name] > 0]
    smallest = min(errors, default=1e-6)
    place = lambda r: max(r.errors[name], smallest / 3)  # an error of zero has no place on this axis
    floor = results.floor(name)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.wanted = []
    handles["Pareto front: nothing is cheaper and more accurate"], = axis.plot([max(place(r), floor) for r in front], [r.cpu_s for r in front], "-", color=FRONT, lw=7, alpha=0.45, zorder=1, solid_capstyle="round", marker="o", ms=17, mec="none",
                                                                                drawstyle="steps-post")
    for s, (colour, marker) in looks.items():
        points = [r for r in shown if r.point.series == s]
        handles[s], = axis.plot([place(r) for r in points], [r.cpu_s for r in points], marker=marker, color=colour, ms=9, lw=1, ls="" if s in apart else ":", mec="white", mew=0.7, zorder=3)
        for r in points:
            axis.wanted.append((place(r), r.cpu_s, r.point.label if r.point.shown is None else r.point.shown, colour))
            if r.point.default:
                handles["default"], = axis.plot([place(r)], [r.cpu_s], "o", ms=19, mfc="none", mec="black", mew=1.6, ls="", zorder=4)
    if floor:
        left = min(min((place(r) for r in shown), default=floor), floor) / 1.6
        handles["less than the reference's own error"] = axis.axvspan(left / 10, floor, color="0.93", hatch="//", ec="0.8", lw=0, zorder=0)
        axis.set_xlim(left=left)
    if failed:
        # no error to show: a strip of their own at the right
        right = 3 * max([place(r) for r in shown], default=1)
        axis.axvspan(right / 1.5, right * 1.9, color="0.92", zorder=0)
        axis.text(right / 1.4, 1.0, " failed", transform=axis.get_xaxis_transform(), va="bottom", fontsize=13)
        for r in failed:
            colour, marker = looks[r.point.series]
            handles[r.point.series] = handles.get(r.point.series) or axis.plot([], [], marker=marker, color=colour, ls=":")[0]
            y = max(r.cpu_s, 0.05)
            handles["failed"], = axis.plot([right / 1.25], [y], "x", color=FAILED, ms=10, mew=2.5, zorder=4, ls="")
            axis.wanted.append((right / 1.25, y, r.point.label, colour))
        axis.set_xlim(right=right * 1.9)
    elif shown:
        axis.set_xlim(right=2 * max(place(r) for r in shown))
    axis.margins(x=0.1, y=0.12)
    axis.grid(alpha=0.3, which="major")
    ticks(axis)


def ticks(axis):
    """2 % and 50 s, not powers of ten; enough of them where the range is short."""
    plain = lambda x: number(x) if x >= 1e-4 else "%.0e" % x
    for side, text in ((axis.xaxis, lambda x, _: plain(100 * x) + " %"), (axis.yaxis, lambda y, _: plain(y))):
        low, high = side.get_view_interval()
        decades = math.log10(high / low) if low > 0 else 9
        subs = (1, 2, 5) if decades < 1.9 else (1, 3) if decades < 3.5 else (1,)
        side.set_major_locator(LogLocator(10 if decades < 6 else 100, subs=subs, numticks=20))
        side.set_major_formatter(FuncFormatter(text))
        side.set_minor_formatter(NullFormatter())


def plain(side):
    """0.01 and 10, not powers of ten."""
    side.set_major_formatter(FuncFormatter(lambda x, _: number(x) if x >= 1e-4 else "%.0e" % x))
    side.set_minor_formatter(NullFormatter())


def place_labels(figure, axis):
    """Labels beside their points, where they hide the least of points and other labels."""
    renderer = figure.canvas.get_renderer()
    inside = axis.get_window_extent(renderer)
    to_screen = lambda x, y: axis.transData.transform((x, y))
    scale = figure.dpi / 72
    points = [Bbox.from_bounds(*(to_screen(x, y) - 6 * scale), 12 * scale, 12 * scale) for x, y, _, _ in axis.wanted]
    # crowded ones last: they have leaders
    near = lambda a: sum(math.hypot(a.x0 - b.x0, a.y0 - b.y0) < 80 * scale for b in points)
    labels = []
    for (x, y, words, colour), own in sorted(zip(axis.wanted, points), key=lambda entry: near(entry[1])):
        best = None
        for distance in (9, 18, 30, 44, 60, 80, 105):
            for angle in range(0, 360, 15):
                dx, dy = distance * math.cos(math.radians(angle)), distance * math.sin(math.radians(angle))
                text = label(axis, x, y, words, colour, dx, dy)
                text.update_positions(renderer)
                box = matplotlib.text.Text.get_window_extent(text, renderer)
                text.remove()
                outside = box.width * box.height - overlap(box, inside)
                cost = sum(overlap(box, other) for other in points) + 3 * sum(overlap(box, other) for other in labels) + 8 * outside + 0.15 * distance * box.height
                if best is None or cost < best[0]:
                    best = (cost, dx, dy, box)
        _, dx, dy, box = best
        label(axis, x, y, words, colour, dx, dy)
        labels.append(box)


def label(axis, x, y, words, colour, dx, dy):
    """With a leader, if it is far from its point."""
    line = dict(arrowstyle="-", color=colour, lw=0.7, shrinkA=0, shrinkB=4) if math.hypot(dx, dy) > 20 else None
    return axis.annotate(words, (x, y), (dx, dy), textcoords="offset points", fontsize=13, color=dark(colour), zorder=5, arrowprops=line, annotation_clip=False,
                         ha="left" if dx > 3 else "right" if dx < -3 else "center", va="bottom" if dy > 3 else "top" if dy < -3 else "center")


def overlap(a, b):
    width = min(a.x1, b.x1) - max(a.x0, b.x0)
    height = min(a.y1, b.y1) - max(a.y0, b.y0)
    return width * height if width > 0 and height > 0 else 0.0


def dark(colour):
    """Text in a colour of COLOURS needs more contrast than a mark."""
    return tuple(0.72 * c for c in matplotlib.colors.to_rgb(colour))


# --- curves

def draw_curves(study, results, folder):
    """One panel a name; a colour a point, a line style a series; what is beside them in black and grey."""
    chart = study.chart
    points = [r for r in results if r.curves]
    series = list(dict.fromkeys(r.point.series for r in points))
    extra = {name: list(chart.beside(name, results)) if chart.beside else [] for name in chart.panels}
    names = [name for name in chart.panels if extra[name] or any(name in r.curves for r in points)]
    if not names:
        return []
    columns = min(chart.columns, len(names))
    labels = list(dict.fromkeys([r.point.name for r in points] + [label for name in names for label, *_ in extra[name] if label[0] != "_"]))
    figure, axes, place = panels(len(names), columns, (12, 6.4) if columns == 1 else (7.4, 5.6), 0.34 * math.ceil(len(labels) / 2) + 0.1)
    colours = {r.point.name: COLOURS[i % len(COLOURS)] for i, r in enumerate(points)}
    grey = {label: COLOURS[i % len(COLOURS)] if not points else ("black", "0.45", "0.7")[i % 3]
            for i, label in enumerate(dict.fromkeys(label for name in names for label, *_ in extra[name]))}
    handles = {}
    for axis, name in zip(axes, names):
        for r in points:
            if name in r.curves:
                style = ["-", "--", ":", "-."][series.index(r.point.series) % 4]
                handles[r.point.name if r.point.shown is None else r.point.shown], = axis.plot(*r.curves[name], style, color=colours[r.point.name], lw=2)
        for i, (label, xs, ys, way, *colour) in enumerate(extra[name]):
            look = {"line": dict(ls="--" if points or colour else "-", lw=2), "marks": dict(ls="", marker=MARKERS[i % len(MARKERS)], ms=10),
                    "both": dict(ls=":", lw=1.5, marker=MARKERS[i % len(MARKERS)], ms=9)}[way]
            handles[label], = axis.plot(xs, ys, color=COLOURS[colour[0]] if colour else grey[label], mec="white", mew=0.7, zorder=4 if way != "line" else 2, **look)
        for way, side, scale in (("x", axis.xaxis, axis.set_xscale), ("y", axis.yaxis, axis.set_yscale)):
            if way in chart.log.get(name, ""):
                scale("log")
                low, high = side.get_view_interval()
                side.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 1e3 * low else (1,)))
                plain(side)
        axis.set(title=name, xlabel=chart.panels[name][0], ylabel=chart.panels[name][1])
        axis.grid(alpha=0.3)
    handles = {label: handle for label, handle in handles.items() if label[0] != "_"}
    place.legend(handles.values(), handles.keys(), loc="center", ncol=max(1, place.columns), frameon=False)
    return save(figure, folder, study.name)


# --- maps

def draw_map(study, results, folder):
    chart = study.chart
    series = list(dict.fromkeys(r.point.series for r in results if r.point.x is not None))
    values = [r.values[chart.value] for r in results if r.point.x is not None and chart.value in r.values]
    if not series:
        return []
    columns = min(len(series), 3 if len(series) != 4 else 2)
    figure, axes, place = panels(len(series), columns, (5.2, 4.8), 0.9)
    finite = [v for v in values if math.isfinite(v) and (v > 0 or "v" not in chart.log)] or [1.0]
    norm = (LogNorm if "v" in chart.log else Normalize)(min(finite), max(max(finite), min(finite) * (1 + 1e-9)))
    handles, coloured = {}, None
    good, above = chart.good or "at most %s" % number(chart.bound), chart.above or "above %s" % number(chart.bound)
    if chart.words:
        norm = Normalize(min(chart.words), max(chart.words))
    for i, (axis, name) in enumerate(zip(axes, series)):
        points = results.of(name)
        for kind, marker, wanted in ((good, "o", lambda r: r.done and r.values.get(chart.value, math.inf) <= chart.bound),
                                     (above, "s", lambda r: r.done and r.values.get(chart.value, math.inf) > chart.bound),
                                     ("failed", "X", lambda r: not r.done)):
            chosen = [r for r in points if wanted(r)]
            if not chosen:
                continue
            at = [r.point.x for r in chosen], [r.point.y for r in chosen]
            if kind == "failed":
                axis.scatter(*at, marker=marker, s=110, c=FAILED, edgecolors="white", linewidths=0.6, zorder=3)
            else:
                coloured = axis.scatter(*at, marker=marker, s=120, c=[r.values[chart.value] for r in chosen], cmap="cividis", norm=norm, zorder=3,
                                    edgecolors="#0072B2" if kind == good else "#D55E00", linewidths=2)
            edge = {good: "#0072B2", "failed": FAILED}.get(kind, "#D55E00")
            handles[kind] = matplotlib.lines.Line2D([], [], ls="", marker=marker, ms=10, mfc=FAILED if kind == "failed" else "white", mec=edge, mew=2)
        for way, side, scale, swept in (("x", axis.xaxis, axis.set_xscale, [r.point.x for r in points]), ("y", axis.yaxis, axis.set_yscale, [r.point.y for r in points])):
            if way in chart.log:
                scale("log")
                if len(set(swept)) <= 8:
                    side.set_major_locator(FixedLocator(sorted(set(swept))))
                    side.set_minor_locator(NullLocator())
                plain(side)
        axis.margins(0.1)
        limits = axis.get_xlim(), axis.get_ylim()
        for k, (label, xs, ys) in enumerate(chart.lines(name) if chart.lines else []):
            handles[label], = axis.plot(xs, ys, color="black", lw=2, ls=["-", "--", ":", "-."][k % 4], zorder=2, label=label)
        for x, y, label, *where in chart.stands:
            if where and name not in where:
                continue
            handles[label], = axis.plot([x], [y], "*", ms=20, color="#CC79A7", mec="black", ls="", zorder=4)
        axis.set_xlim(limits[0])
        axis.set_ylim(limits[1])
        axis.set_title(name)
        axis.grid(alpha=0.25)
        if i + columns >= len(series):
            axis.set_xlabel(chart.x)
        if i % columns == 0:
            axis.set_ylabel(chart.y)
    if coloured is not None:
        bar = figure.colorbar(coloured, ax=axes, shrink=0.8, label=chart.title or chart.value)
        if "v" in chart.log:
            bar.ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            plain(bar.ax.yaxis)
        if chart.words:
            bar.set_ticks(list(chart.words), labels=list(chart.words.values()))
    place.legend(handles.values(), handles.keys(), loc="center", ncol=max(1, min(len(handles), place.columns + 1)), frameon=False)
    return save(figure, folder, study.name)
