"""A scene of two dimensions as numbers, which can be mirrored, shifted, turned, measured in other units and renumbered, and written.

Sides of a rectangle are 0 left, 1 right, 2 bottom, 3 top in the scene as drawn, and keep these numbers; `names` says what the program
calls them in the scene as it stands.
"""
import copy
import math
import os

SIDES = ("left", "right", "bottom", "top")


class Map:
    """x -> L (R x + shift), lengths L, times T, masses per depth and length M/L^3 * L^2..; R is orthogonal, rows are images of axes."""

    def __init__(self, a=(1., 0.), b=(0., 1.), shift=(0., 0.), L=1., T=1., M=1.):
        self.a, self.b, self.shift, self.L, self.T, self.M = a, b, shift, L, T, M  # R = [a; b]

    @property
    def sign(self):
        return self.a[0] * self.b[1] - self.a[1] * self.b[0]

    def rotate(self, v):
        return (self.a[0] * v[0] + self.a[1] * v[1], self.b[0] * v[0] + self.b[1] * v[1])

    def back(self, v):
        return (self.a[0] * v[0] + self.b[0] * v[1], self.a[1] * v[0] + self.b[1] * v[1])

    def point(self, x):
        r = self.rotate(x)
        return (self.L * (r[0] + self.shift[0]), self.L * (r[1] + self.shift[1]))

    def point_back(self, x):
        return self.back((x[0] / self.L - self.shift[0], x[1] / self.L - self.shift[1]))

    def unit(self, length=0, time=0, mass=0):
        return self.L**length * self.T**time * self.M**mass

    def vector(self, v, **powers):
        r, unit = self.rotate(v), self.unit(**powers)
        return (unit * r[0], unit * r[1])

    def axis(self, d):
        """The axis that axis d is turned into, if that is one."""
        return 0 if abs(self.rotate((1., 0.) if d == 0 else (0., 1.))[0]) > 0.5 else 1


def mirror():
    return Map(a=(-1., 0.))


def quarter_turns(n):
    c, s = ((1., 0.), (0., 1.), (-1., 0.), (0., -1.))[n % 4]
    return Map(a=(c, -s), b=(s, c))


def turn(angle):
    return Map(a=(math.cos(angle), -math.sin(angle)), b=(math.sin(angle), math.cos(angle)))


def side_name(map, side):
    normal = map.rotate(((-1., 0.), (1., 0.), (0., -1.), (0., 1.))[side])
    return SIDES[(0 if normal[0] < 0 else 1) if abs(normal[0]) > 0.5 else (2 if normal[1] < 0 else 3)]


def number(x):
    return repr(float(x) + 0.)  # no -0.0


def pair(v):
    return ", ".join(number(x) for x in v)


class Scene:
    """
    lower, upper       corners of the rectangle [m]
    mesh               None, or (nodes, cells, {side name: [(node, node), ...]})
    sides              for each side one of ("wall", "no-slip" | "slip"), ("pressure", p [Pa], dp/dt, hydrostatic?),
                       ("velocity", (u, v), low, high): even, or a parabola between low and high along the side; or None (periodic)
    parts              (name, side, low, high along the side, condition)
    grains             rows x, y, radius, density, vx, vy, omega
    walls              (name, (x, y), (x, y)); motion {name: ((vx, vy), spin, (x, y))}
    settings           {"Section/Name": value}: without units; lengths {...: m}, others with powers of L, T, M: {...: (value, powers)}
    """

    def __init__(self):
        self.map = Map()
        self.mesh = None
        self.periodic = []
        self.parts, self.walls, self.motion, self.grains = [], [], {}, []
        self.open_to_grains = []
        self.settings, self.dimensional = {}, {}
        self.gravity, self.force, self.gradient = (0., -9.81), (0., 0.), (0., 0.)
        self.order = None  # the file's row i is grain order[i]

    def seen(self, map):
        result = copy.copy(self)
        result.map = map
        return result

    def name(self, side):
        return (SIDES + ("block",))[side] if self.mesh else side_name(self.map, side)

    def write(self, folder, name="scene", **settings):
        """NAME.prm, NAME.csv and maybe NAME.msh in @p folder. Settings override."""
        m = self.map
        a, b = m.point(self.lower), m.point(self.upper)
        lower, upper = [min(p) for p in zip(a, b)], [max(p) for p in zip(a, b)]
        lists = {"No-slip walls": [], "Slip walls": [], "Pressure": [], "Velocity": [], "Add hydrostatic pressure": []}
        conditions = [(self.name(side), side, *c) for side, c in enumerate(self.sides) if c]
        conditions += [(part, side, *c) for part, side, _, _, c in self.parts]
        for where, side, kind, *rest in conditions:
            if kind == "wall":
                lists["No-slip walls" if rest[0] == "no-slip" else "Slip walls"].append(where)
            elif kind == "pressure":
                pa = m.unit(mass=1, length=-1, time=-2)
                lists["Pressure"].append(f"{where}: {number(rest[0] * pa)} + {number(rest[1] * pa / m.T)}*t")
                if rest[2]:
                    lists["Add hydrostatic pressure"].append(where)
            else:
                velocity, low, high = rest
                u = m.vector(velocity, length=1, time=-1)
                profile = ""
                if low is not None:
                    along, other = (1, 0) if side < 2 else (0, 1)
                    here = self.upper[other] if side % 2 else self.lower[other]
                    ends = [m.point((z, here) if along == 0 else (here, z)) for z in (low, high)]
                    # a linear coordinate that is 0 at one end and 1 at the other
                    step = (ends[1][0] - ends[0][0], ends[1][1] - ends[0][1])
                    if abs(step[0]) < 1e-9 * abs(step[1]):
                        s = f"(y - ({number(ends[0][1])}))/({number(step[1])})"
                    elif abs(step[1]) < 1e-9 * abs(step[0]):
                        s = f"(x - ({number(ends[0][0])}))/({number(step[0])})"
                    else:
                        square = step[0]**2 + step[1]**2
                        s = (f"((x - ({number(ends[0][0])}))*({number(step[0] / square)}) + "
                             f"(y - ({number(ends[0][1])}))*({number(step[1] / square)}))")
                    profile = f"*4*{s}*(1 - {s})"
                lists["Velocity"].append(f"{where}: " + " | ".join(f"({number(x)}){profile}" for x in u))
        values = {"Gravity": pair(m.vector(self.gravity, length=1, time=-2)),
                  "Grains/Deposit": "file", "Grains/Deposit: file/File": name + ".csv"}
        for key, vector in (("Body force", self.force), ("Mean pressure gradient", self.gradient)):
            if any(vector):
                values["Fluid/" + key] = " | ".join(number(x) for x in m.vector(vector, mass=1, length=-2, time=-2))
        if self.mesh:
            values["Domain/Mesh file"] = name + ".msh"
        else:
            values.update({"Domain/Lower left corner": pair(lower), "Domain/Upper right corner": pair(upper)})
        if self.periodic:
            values["Domain/Periodic directions"] = ", ".join(sorted("xy"[m.axis(d)] for d in self.periodic))
        for key, names in lists.items():
            values["Boundary conditions/" + key] = ("; " if key in ("Pressure", "Velocity") else ", ").join(names)
        if self.open_to_grains:
            values["Domain/Open to grains"] = ", ".join(self.name(side) if isinstance(side, int) else side for side in self.open_to_grains)
        parts = []
        for part, side, low, high, _ in self.parts:
            along, other = (1, 0) if side < 2 else (0, 1)
            here = self.upper[other] if side % 2 else self.lower[other]
            ends = sorted(m.point((z, here) if along == 0 else (here, z))[m.axis(along)] for z in (low, high))
            parts.append(f"{part} = {self.name(side)}: {number(ends[0])} < {'xy'[m.axis(along)]} < {number(ends[1])}")
        values["Domain/Named parts"] = "; ".join(parts)
        values["Grains/Extra walls"] = "; ".join(f"{w}: {pair(m.point(p))} -> {pair(m.point(q))}" for w, p, q in self.walls)
        motions = []
        for w, (velocity, spin, centre) in self.motion.items():
            text = f"{self.name(w) if isinstance(w, int) else w}: {pair(m.vector(velocity, length=1, time=-1))}"
            motions.append(text + (f", {number(spin * m.sign / m.T)}, {pair(m.point(centre))}" if spin else ""))
        values["Grains/Motion of walls"] = "; ".join(motions)
        if "support/floor" in self.settings:
            values["Output/Observers: support/Floor"] = self.name(self.settings["support/floor"])
        values.update({k: v for k, v in self.settings.items() if k != "support/floor"})
        for key, (value, powers) in self.dimensional.items():
            values[key] = number(value * m.unit(**powers))
        values.update(settings)

        with open(os.path.join(folder, name + ".prm"), "w") as file:
            for key, value in values.items():
                *sections, last = key.split("/")
                file.write("".join(f"subsection {s}\n" for s in sections) + f"set {last} = {value}\n" + "end\n" * len(sections))
        rows = []
        for x, y, radius, density, vx, vy, omega in self.grains:
            rows.append([*m.point((x, y)), radius * m.L, density * m.unit(mass=1, length=-3),
                         *m.vector((vx, vy), length=1, time=-1), omega * m.sign / m.T])
        if self.order:
            rows = [rows[i] for i in self.order]
        with open(os.path.join(folder, name + ".csv"), "w") as file:
            file.write("x,y,radius,density,vx,vy,omega\n")
            file.writelines(",".join(number(x) for x in row) + "\n" for row in rows)
        if self.mesh:
            self.write_mesh(os.path.join(folder, name + ".msh"))

    def write_mesh(self, file_name):
        nodes, cells, sides = self.mesh
        text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(sides) + 1)]
        text += [f'1 {k + 1} "{name}"' for k, name in enumerate(sides)] + [f'2 {len(sides) + 1} "fluid"', "$EndPhysicalNames"]
        text += ["$Nodes", str(len(nodes))]
        text += [f"{k + 1} {' '.join(number(z) for z in self.map.point(p))} 0" for k, p in enumerate(nodes)]
        elements = [f"1 2 {k + 1} {k + 1} {p + 1} {q + 1}" for k, lines in enumerate(sides.values()) for p, q in lines]
        for cell in cells:
            ordered = cell if self.map.sign > 0 else cell[::-1]
            elements.append(f"{len(cell) - 1} 2 {len(sides) + 1} 1 " + " ".join(str(v + 1) for v in ordered))
        text += ["$EndNodes", "$Elements", str(len(elements))] + [f"{k + 1} {e}" for k, e in enumerate(elements)] + ["$EndElements", ""]
        with open(file_name, "w") as file:
            file.write("\n".join(text))
