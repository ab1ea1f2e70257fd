"""A bed as the other programs get it, and the measures that all of them are judged by.

A bed is the table of grains that our program keeps of a settled one: x, y, radius, density, and in a comment `# x1 = W` how wide it is.
Floor y = 0, sides x = 0 and x = W. SI units, per unit depth; a grain's mass is density pi r^2. Friction is 0.4 between grains and with walls.
"""
import json
import sys

import numpy as np

GRAVITY, FRICTION = 9.81, 0.4
WINDOW = 1e-3   # [s] over which wall forces are averaged
SETTLED = 0.01  # [s] after which a bed at rest is looked at: none of the programs knows a contact force in the beginning


class Bed:
    """Grains and the box that they are put into. `box_width` [m]: a wider one, in which the bed collapses."""

    def __init__(self, name, box_width=None):
        with open(name) as file:
            lines = file.read().splitlines()
        comments = dict(line[1:].split("=", 1) for line in lines if line.startswith("#") and "=" in line)
        self.width = next(float.fromhex(value.strip()) for key, value in comments.items() if key.strip() == "x1")
        self.box_width = box_width or self.width
        rows = [line for line in lines if line and not line.startswith("#")]
        columns = rows[0].split(",")
        table = np.array([[float(x) for x in row.split(",")] for row in rows[1:]])
        column = lambda key: table[:, columns.index(key)].copy()
        self.x, self.y, self.radius, self.density = (column(key) for key in ("x", "y", "radius", "density"))
        self.mass = self.density * np.pi * self.radius**2
        self.diameter = 2 * self.radius.mean()
        self.n = len(self.x)

    def penetration(self, x, y):
        """Mean over the overlapping contacts, and largest, in mean diameters; walls included."""
        from scipy.spatial import cKDTree
        pairs = cKDTree(np.c_[x, y]).query_pairs(2 * self.radius.max(), output_type="ndarray")
        i, j = pairs[:, 0], pairs[:, 1]
        depth = np.r_[self.radius[i] + self.radius[j] - np.hypot(x[i] - x[j], y[i] - y[j]),
                      self.radius - y, self.radius - x, self.radius - (self.box_width - x)]
        depth = depth[depth > 0]
        return (depth.mean() / self.diameter, depth.max() / self.diameter) if len(depth) else (0.0, 0.0)


def dry_options(parser):
    """What all programs for dry beds are asked."""
    parser.add_argument("bed")
    parser.add_argument("--time", type=float, default=0.05, help="simulated time [s]")
    parser.add_argument("--box-width", type=float, metavar="W", help="take the right wall away to there, so that the bed collapses [m]")
    options = parser.parse_args()
    options.windows = round(options.time / WINDOW)
    return options, Bed(options.bed, options.box_width)


def report_dry(bed, states, program, **more):
    """Print what a program has made of a dry bed, as one JSON object.

    `states` yields (CPU seconds so far, x, y, vx, vy) at the start and after each window. What the walls carried follows from the momentum,
    whatever a program reports. `more` may be functions; they are called at the end.
    """
    momentum, depths, supports, cpu, started = None, [], [], 0.0, 0.0
    place = lambda z: np.average(z, weights=bed.mass)
    for window, (cpu, x, y, vx, vy) in enumerate(states):
        if not (np.isfinite(x).all() and np.isfinite(vy).all()):
            sys.exit(f"{program} has diverged at {window * WINDOW:g} s")
        if window == round(SETTLED / WINDOW):
            started = cpu
        last, momentum = momentum, (bed.mass * vy).sum()
        if window == 0:
            start = place(x), place(y)
            continue
        supports.append(1 + (momentum - last) / (WINDOW * GRAVITY * bed.mass.sum()))
        depths.append(bed.penetration(x, y))
    late = slice(round(SETTLED / WINDOW), None)
    depths, supports = np.array(depths), np.array(supports)
    print(json.dumps({"program": program, "cpu_s": cpu, "cpu_after_start_s": cpu - started, "mean_overlap_d": depths[late, 0].mean(), "max_overlap_d": depths[:, 1].max(),
                      "support_error": np.sqrt(np.mean((supports[late] - 1)**2)), "support": supports[late].mean(), "spreading_m": place(x) - start[0],
                      "fall_m": start[1] - place(y), **{name: value() if callable(value) else value for name, value in more.items()}}))


def missing(what, how):
    """End with the words that the laboratory looks for: it tries again next time."""
    print(f"{what} is not installed: {how}", file=sys.stderr)
    sys.exit(3)
