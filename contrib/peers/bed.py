"""A settled bed as the other programs get it, and the measures that all of them are judged by.

A bed is what `benchmark_settled_bed --make` writes: a table with a comment `# width = W` [m], floor y = 0, sides x = 0 and x = W.
SI units, per unit depth. Grains have density 2630 kg/m^3 and friction 0.4 with each other and the walls.
"""
import json
import sys

import numpy as np

GRAVITY, FRICTION = 9.81, 0.4
WINDOW = 1e-3   # [s] over which wall forces are averaged
WARM_UP = 0.01  # [s] that does not count


class Bed:
    def __init__(self, name):
        with open(name) as file:
            lines = file.read().splitlines()
        comments = [line[1:].split("=") for line in lines if line.startswith("#") and "=" in line]
        self.width = next(float(value) for key, value in comments if key.strip() == "width")
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
                      self.radius - y, self.radius - x, self.radius - (self.width - x)]
        depth = depth[depth > 0]
        return (depth.mean() / self.diameter, depth.max() / self.diameter) if len(depth) else (0.0, 0.0)


class Measures:
    """Collects what a program does to a bed, window by window, and prints it as one JSON object."""

    def __init__(self, bed, vy):
        self.bed, self.errors, self.depths, self.speeds = bed, [], [], []
        self.momentum = (bed.mass * vy).sum()

    def window(self, x, y, vx, vy):
        """State after another window. What the walls carried follows from the momentum, whatever a program reports."""
        bed = self.bed
        momentum = (bed.mass * vy).sum()
        self.errors.append((momentum - self.momentum) / (WINDOW * GRAVITY * bed.mass.sum()))
        self.momentum = momentum
        self.depths.append(bed.penetration(x, y))
        self.speeds.append(np.sqrt(np.mean(vx**2 + vy**2)))

    def report(self, cpu, **more):
        depths, time = np.array(self.depths), WINDOW * len(self.errors)
        print(json.dumps({"cpu_s_per_10_ms": cpu * 0.01 / time, "mean_penetration_d": depths[:, 0].mean(),
                          "max_penetration_d": depths[:, 1].max(), "support": 1 + np.mean(self.errors),
                          "support_error": np.sqrt(np.mean(np.square(self.errors))),
                          "speed_m_per_s": np.mean(self.speeds), **more}))


def missing(what, how):
    """End with the code that says: not installed."""
    print(f"{what} is not installed: {how}", file=sys.stderr)
    sys.exit(3)
