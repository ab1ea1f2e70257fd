"""Run a scene as it is seen through a map, and see how far the answers are from the scene's own."""
import csv
import json
import math
import os
import re
import shutil
import struct
import subprocess

from scene import SIDES, side_name


class Failed(Exception):
    pass


class Program:
    def __init__(self, build, folder):
        self.program, self.folder, self.count = os.path.join(build, "alluvium"), folder, 0
        self.environment = dict(os.environ, OMP_NUM_THREADS="1")

    def alluvium(self, folder, name, output, ranks=1, **settings):
        command = (["mpirun", "-np", str(ranks)] if ranks > 1 else []) + [self.program, name + ".prm"]
        for key, value in {**settings, "Output/Output folder": output}.items():
            command += ["--set", f"{key}={value}"]
        try:
            result = subprocess.run(command, capture_output=True, text=True, errors="replace", cwd=folder, env=self.environment, timeout=900)
        except subprocess.TimeoutExpired:
            raise Failed("takes more than 900 s")
        if result.returncode != 0:
            errors = [line for line in result.stderr.split("\n") if "alluvium: error" in line]
            raise Failed(f"exit code {result.returncode}: {' '.join(errors)[:300] or result.stderr[-300:]}")
        return result

    def answers(self, scene, name="scene", ranks=1, restart=False, **settings):
        """Columns of statistics.csv and grains at the end, as the scene was drawn."""
        folder = os.path.join(self.folder, name)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        scene.write(folder, **settings)
        if restart:
            dt = scene.dimensional["Time/Time step"][0] * scene.map.T
            half = scene.steps // 2
            self.alluvium(folder, "scene", "output", ranks, **{"Time/End time": repr(half * dt)})
            result = self.alluvium(folder, "scene", "output", ranks, **{"Output/Restart": "true"})
        else:
            result = self.alluvium(folder, "scene", "output", ranks)
        answers = Answers(scene, os.path.join(folder, "output"))
        answers.warnings = sorted({line[18:60] for line in result.stderr.split("\n") if line.startswith("alluvium: warning")})
        return answers


def read_grains(file_name):
    """{id: (x, y, radius, fluid radius, mass, vx, vy, omega)} of a checkpoint."""
    if not os.path.exists(file_name):
        raise Failed("no checkpoint: energy that nothing explains is above half of its bound")
    with open(file_name, "rb") as file:
        file.readline()
        data = file.read()
    n, = struct.unpack_from("<Q", data)
    ids = struct.unpack_from(f"<{n}I", data, 8)
    at, columns = 8 + 4 * n, []
    for _ in range(8):
        columns.append(struct.unpack_from(f"<{n}d", data, at + 8))
        at += 8 + 8 * n
    return dict(zip(ids, zip(*columns)))


class Answers:
    def __init__(self, scene, folder):
        m = scene.map
        with open(os.path.join(folder, "statistics.csv")) as file:
            rows = list(csv.reader(file))
        values = {name: [float(row[k]) if row[k] else math.nan for row in rows[1:]] for k, name in enumerate(rows[0])}
        self.columns = {}
        for name, column in values.items():
            new, factor = self.seen_back(scene, name)
            self.columns[new] = [factor * x for x in column]
        self.turn_stress(m)
        self.turn_momentum(m)
        with open(os.path.join(folder, "summary.json")) as file:
            self.summary = json.load(file)
        self.grains = {}
        for i, (x, y, r, fluid_r, mass, vx, vy, omega) in read_grains(os.path.join(folder, "checkpoint", "grains")).items():
            key = scene.order[i] if scene.order else i
            speed = m.T / m.L
            self.grains[key] = (*m.point_back((x, y)), *(speed * v for v in m.back((vx, vy))), m.sign * omega * m.T)

    @staticmethod
    def seen_back(scene, name):
        """The column's name in the scene as drawn, and what its values are to be multiplied with."""
        m = scene.map
        units = [("_m2_per_s", 2, -1, 0), ("_m_per_s", 1, -1, 0), ("_J_per_m", 2, -2, 1), ("_W_per_m", 2, -3, 1), ("_kg_per_m", -1, 0, 1),
                 ("_N_s_per_m", 0, -1, 1), ("_Pa", -1, -2, 1), ("_s", 0, 1, 0), ("_m", 1, 0, 0)]
        factor = 1.
        for end, length, time, mass in units:
            if name.endswith(end):
                if end in ("_J_per_m", "_W_per_m"):  # masses are per depth
                    length -= 1
                factor = 1. / m.unit(length=length, time=time, mass=mass)
                break
        new = name
        for side in range(4):
            if not scene.mesh and f"flux_{scene.name(side)}_" in name:
                return f"flux_{SIDES[side]}_" + name.split("_", 2)[2], factor
        for d in range(2):
            if name == f"flux_along_{'xy'[d]}_m2_per_s":  # of a rectangle: an axis is an axis
                back = next(k for k in range(2) if m.axis(k) == d)
                return f"flux_along_{'xy'[back]}_m2_per_s", factor * m.rotate((1., 0.) if back == 0 else (0., 1.))[d]
        return new, factor

    def turn_momentum(self, m):
        names = [f"momentum_left_{c}_N_s_per_m" for c in "xy"]
        if names[0] in self.columns:
            turned = [m.back(v) for v in zip(*(self.columns[name] for name in names))]
            for k, name in enumerate(names):
                self.columns[name] = [v[k] for v in turned]

    def turn_stress(self, m):
        names = [f"grain_stress_{c}_Pa" for c in ("xx", "xy", "yy")]
        if names[0] not in self.columns:
            return
        (a, b), (c, e) = m.a, m.b
        turned = []
        for xx, xy, yy in zip(*(self.columns[name] for name in names)):  # R^T s R
            turned.append((a * a * xx + 2 * a * c * xy + c * c * yy, a * b * xx + (a * e + b * c) * xy + c * e * yy,
                           b * b * xx + 2 * b * e * xy + e * e * yy))
        for k, name in enumerate(names):
            self.columns[name] = [row[k] for row in turned]


# what is round-off or a tolerance itself, or has no meaning in a turned scene
NOISE = {"flux_imbalance", "contact_residual", "mean_penetration_over_d", "power_unexplained_W_per_m"}


def differences(scene, one, other, ignored=()):
    """[(relative difference, what, step)], largest first."""
    result = []
    d, g = scene.d, 9.81
    speeds = [math.hypot(grain[2], grain[3]) for grain in one.grains.values()]
    fastest = max([*speeds, *one.columns.get("largest_fluid_velocity_m_per_s", [0.]), 0.01 * math.sqrt(g * d)])
    mass = sum(grain[3] * math.pi * grain[2]**2 for grain in scene.grains)
    scales = {"_m2_per_s": fastest * d, "_m_per_s": fastest, "_J_per_m": mass * fastest**2, "_W_per_m": mass * g * fastest, "_kg_per_m": mass,
              "_N_s_per_m": mass * fastest, "_Pa": scene.density * g * d, "_m": d, "_s": scene.dimensional["Time/Time step"][0]}
    for name in sorted((set(one.columns) ^ set(other.columns)) - set(ignored)):
        result.append((math.inf, f"column {name} is in one only", 0))
    for name, column in one.columns.items():
        if name in NOISE or name in ignored or name not in other.columns:
            continue
        scale = max((abs(x) for x in column if x == x), default=0.)
        least = next((value for end, value in scales.items() if name.endswith(end)), 0.1)
        scale = max(scale, 1e-2 * least)
        if len(column) != len(other.columns[name]):
            result.append((math.inf, f"rows: {len(column)} and {len(other.columns[name])}", 0))
            continue
        for step, (x, y) in enumerate(zip(column, other.columns[name])):
            if x != x and y != y:
                continue
            result.append((math.inf if (x != x) != (y != y) else abs(x - y) / scale, name, step))
    if set(one.grains) != set(other.grains):
        result.append((math.inf, "other grains have left", -1))
    length = [b - a for a, b in zip(scene.lower, scene.upper)]
    for i in set(one.grains) & set(other.grains):
        a, b = one.grains[i], other.grains[i]
        apart = [a[k] - b[k] for k in range(2)]
        for k in scene.periodic:
            apart[k] -= length[k] * round(apart[k] / length[k])
        result.append((math.hypot(*apart) / d, f"place of grain {i} / d", -1))
        result.append((math.hypot(a[2] - b[2], a[3] - b[3]) / fastest, f"velocity of grain {i}", -1))
        result.append((abs(a[4] - b[4]) * d / fastest, f"spin of grain {i}", -1))
    return sorted(result, key=lambda item: -item[0])
