"""Random scenes: small, quick, of every kind."""
import math
import random

from scene import SIDES, Scene

SPEED = dict(length=1, time=-1)


def draw_scene(seed):
    draw = random.Random(seed)
    scene = Scene()
    scene.seed = seed
    d = scene.d = draw.choice((2e-4, 5e-4, 2e-3))
    scene.rho, scene.eta = draw.choice(((1000., 1e-3), (1000., 1e-2), (1200., 0.1)))
    scene.density = draw.choice((2650., 1500., 4000.))
    dry = scene.dry = draw.random() < 0.25
    nx, ny = draw.randrange(6, 17), draw.randrange(8, 21)
    scene.lower = (draw.choice((0., 0., -0.37 * nx * d)), draw.choice((0., 0., 3.21 * d)))
    scene.upper = (scene.lower[0] + nx * d * draw.choice((1., 1.137)), scene.lower[1] + ny * d)
    g = 9.81
    slope = draw.choice((0., 0., 0., draw.uniform(-0.5, 0.5)))
    scene.gravity = (g * math.sin(slope), -g * math.cos(slope))
    if draw.random() < 0.05:
        scene.gravity = (0., 0.)
    scene.kind = []
    make_sides(scene, draw)
    make_walls(scene, draw)
    make_grains(scene, draw)
    make_settings(scene, draw)
    if dry:
        scene.settings["Fluid/Model"] = "none"
    return scene


def make_sides(scene, draw):
    """Boundary conditions, periodic sides, meshes."""
    rho, d = scene.rho, scene.d
    wall = lambda: ("wall", draw.choice(("no-slip", "slip")))
    height = scene.upper[1] - scene.lower[1]
    weight = (scene.density - rho) * 9.81 * d  # of a layer of grains
    speed = draw.choice((0.02, 0.2, 1.)) * math.sqrt(9.81 * d)
    scene.sides = [wall(), wall(), wall(), wall()]
    kind = draw.choice(("closed", "open top", "up", "inlet", "across", "periodic", "both periodic", "part", "mesh", "mesh"))
    if scene.dry:
        kind = draw.choice(("closed", "periodic", "mesh"))
    scene.kind.append(kind)
    pin = False
    if kind == "closed" or kind == "mesh" and draw.random() < 0.3:
        pin = True
    elif kind in ("open top", "mesh"):
        scene.sides[3] = ("pressure", 0., 0., False)
    elif kind == "up":
        scene.sides[0] = scene.sides[1] = ("wall", "slip")
        scene.sides[3] = ("pressure", 0., 0., True)
        scene.sides[2] = ("pressure", draw.uniform(0.3, 4) * weight, draw.choice((0., 50.)) * weight, True)
    elif kind == "inlet":
        scene.sides[3] = ("pressure", 0., 0., False)
        even = draw.random() < 0.5
        ends = (None, None) if even else (scene.lower[0], scene.upper[0])
        scene.sides[2] = ("velocity", (0., speed), *ends)
        if even:
            scene.sides[0] = scene.sides[1] = ("wall", "slip")
    elif kind == "across":
        scene.sides[0] = ("velocity", (speed, 0.), scene.lower[1], scene.upper[1])
        scene.sides[1] = ("pressure", 0., 0., True)
    elif kind == "part":
        third = (scene.upper[0] - scene.lower[0]) / draw.choice((3., 4.1))
        scene.parts = [("inlet", 2, scene.lower[0] + third, scene.lower[0] + 1.7 * third, ("velocity", (0., speed), None, None))]
        scene.sides[2] = ("wall", "no-slip")
        scene.sides[3] = ("pressure", 0., 0., False)
    elif kind == "periodic":
        scene.periodic, pin = [0], True
        scene.sides[0] = scene.sides[1] = None
        scene.sides[2] = ("wall", "no-slip")
        push = draw.choice((0., 0.2, 1.)) * rho * 9.81
        if draw.random() < 0.5:
            scene.gradient = (-push, 0.)
        else:
            scene.force = (push, 0.)
    elif kind == "both periodic":
        scene.periodic, pin = [0, 1], True
        scene.sides = [None] * 4
        scene.gradient = (0., 1.1 * rho * scene.gravity[1])
    if kind == "mesh":
        make_mesh(scene, draw)
    if scene.dry:
        scene.sides = [c and ("wall", "slip") for c in scene.sides]
        scene.parts = []
        scene.gradient = scene.force = (0., 0.)
    elif pin:
        scene.settings["Boundary conditions/Pin pressure"] = "true"
    if kind in ("open top", "inlet", "across") and draw.random() < 0.4:
        scene.open_to_grains = [1 if kind == "across" else 3]
        scene.kind.append("grains may leave")


def make_mesh(scene, draw):
    """Cells of a skewed grid, with a hole maybe; sides in the order of the rectangle's, the hole's is 'block'."""
    (x0, y0), (x1, y1), d = scene.lower, scene.upper, scene.d
    h = draw.choice((1., 2., 3.)) * d
    nx, ny = max(3, round((x1 - x0) / h)), max(4, round((y1 - y0) / h))
    lean, wave = draw.choice((0., 0., 0.3)), draw.choice((0., 0.15))
    triangles = draw.random() < 0.5
    hole = draw.random() < 0.4
    scene.kind.append(("triangles" if triangles else "quadrilaterals") + (" round a block" if hole else ""))

    def place(i, j):
        s, t = i / nx, j / ny
        s += wave * math.sin(math.pi * s) * math.sin(2 * math.pi * t) / nx
        t += wave * math.sin(2 * math.pi * s) * math.sin(math.pi * t) / ny
        return (x0 + (x1 - x0) * s + lean * (y1 - y0) * t, y0 + (y1 - y0) * t)

    blocked = lambda i, j: hole and nx // 3 <= i < max(nx // 3 + 1, 2 * nx // 3) and ny // 4 <= j < max(ny // 4 + 1, ny // 2)
    number = lambda i, j: i + j * (nx + 1)
    nodes = [place(i, j) for j in range(ny + 1) for i in range(nx + 1)]
    cells, sides = [], {name: [] for name in SIDES + (("block",) if hole else ())}
    for j in range(ny):
        for i in range(nx):
            if blocked(i, j):
                continue
            a, b, c, e = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
            cells += [(a, b, c), (a, c, e)] if triangles else [(a, b, c, e)]
            for line, (k, l), side in (((a, b), (i, j - 1), "bottom"), ((b, c), (i + 1, j), "right"), ((c, e), (i, j + 1), "top"),
                                       ((e, a), (i - 1, j), "left")):
                if not (0 <= k < nx and 0 <= l < ny):
                    sides[side].append(line)
                elif blocked(k, l):
                    sides["block"].append(line)
    used = sorted({v for cell in cells for v in cell})
    renumbered = {v: k for k, v in enumerate(used)}
    scene.mesh = ([nodes[v] for v in used], [tuple(renumbered[v] for v in cell) for cell in cells],
                  {name: [(renumbered[v], renumbered[w]) for v, w in lines] for name, lines in sides.items()})
    scene.outline = [(nodes[p], nodes[q]) for lines in sides.values() for p, q in lines]
    block = [(nodes[p], nodes[q]) for p, q in sides.get("block", [])]
    scene.inside = lambda x, y: (x0 < x - lean * (y - y0) < x1 and y0 < y < y1 and
                                 (not block or not _is_inside(block, x, y)))
    if hole:
        scene.sides.append(("wall", "no-slip"))


def _is_inside(lines, x, y):
    inside = False
    for (ax, ay), (bx, by) in lines:
        if (ay > y) != (by > y) and ax + (y - ay) / (by - ay) * (bx - ax) > x:
            inside = not inside
    return inside


def distance(p, q, x, y):
    ex, ey = q[0] - p[0], q[1] - p[1]
    t = max(0., min(1., ((x - p[0]) * ex + (y - p[1]) * ey) / (ex * ex + ey * ey)))
    return math.hypot(p[0] + t * ex - x, p[1] + t * ey - y)


def make_walls(scene, draw):
    """Walls that only grains see, and belts."""
    (x0, y0), (x1, y1), d = scene.lower, scene.upper, scene.d
    if draw.random() < 0.25:
        x, y = x0 + draw.uniform(0.3, 0.7) * (x1 - x0), y0 + draw.uniform(0.2, 0.5) * (y1 - y0)
        angle = draw.choice((0., math.pi / 2, draw.uniform(0, math.pi)))
        half = draw.uniform(1, 2.5) * d
        step = (half * math.cos(angle), half * math.sin(angle))
        scene.walls = [("pile", (x - step[0], y - step[1]), (x + step[0], y + step[1]))]
        scene.kind.append("wall")
        if not scene.periodic and draw.random() < 0.3:
            scene.motion["pile"] = ((0., 0.), draw.choice((-1., 1.)) * 20., (x, y))
            scene.kind.append("that turns")
    if scene.sides[2] and scene.sides[2][0] == "wall" and not scene.mesh and draw.random() < 0.15:
        scene.motion[2] = ((draw.choice((-0.5, 0.5)) * math.sqrt(9.81 * d), 0.), 0., (0., 0.))
        scene.kind.append("belt")


def make_grains(scene, draw):
    """Discs that do not touch, everywhere or piled up on the floor, or a layer that touches it."""
    (x0, y0), (x1, y1), d = scene.lower, scene.upper, scene.d
    ratio = scene.ratio = draw.choice((1., 1.3, 2.5))
    n = draw.choice((1, 2, 4, 8, 15, 30, 40))
    dense = draw.random() < 0.6
    top = y0 + (y1 - y0) * (0.45 if dense else 0.95)
    lines = [(p, q) for _, p, q in scene.walls]
    if scene.mesh:
        lines += scene.outline
    speed = draw.choice((0., 0., 1.)) * math.sqrt(9.81 * d)
    spins = draw.random() < 0.5
    tries = 0
    fits = lambda x, y, r: (
        (0 in scene.periodic or x0 + r < x < x1 - r or scene.mesh) and (1 in scene.periodic or y0 + r < y < y1 - r) and
        (not scene.mesh or scene.inside(x, y)) and all(distance(p, q, x, y) > r * 1.0001 for p, q in lines) and
        all(math.hypot(_near(x - other[0], x1 - x0, 0 in scene.periodic), _near(y - other[1], y1 - y0, 1 in scene.periodic)) >
            (r + other[2]) * 1.0001 for other in scene.grains))
    lean = (max(p[0] for p in scene.mesh[0]) - x1) if scene.mesh else 0.
    while len(scene.grains) < n and tries < 4000:
        tries += 1
        r = 0.5 * d * draw.uniform(1., ratio)
        x, y = draw.uniform(x0, x1 + lean), draw.uniform(y0, top)
        if not fits(x, y, r):
            continue
        if dense and 1 not in scene.periodic:  # lower it as long as it fits, with what is left over as a gap
            step = 0.3 * r
            while step > 1e-3 * r:
                if fits(x, y - step, r):
                    y -= step
                else:
                    step /= 2
        density = scene.density * (draw.choice((1., 1.2)) if ratio > 1 else 1.)
        scene.grains.append((x, y, r, density, speed * draw.uniform(-1, 1), speed * draw.uniform(-1, 1),
                             draw.uniform(-1, 1) * speed / r if spins else 0.))
    scene.kind.append(f"{len(scene.grains)} grains")


def _near(x, length, periodic):
    return x - length * round(x / length) if periodic else x


def make_settings(scene, draw):
    d, put = scene.d, scene.settings
    # tight tolerances: what is left of them is what may differ
    put.update({"Fluid/Linear solver/Tolerance": "1e-12", "Contacts/Residual tolerance": "1e-9", "Contacts/Largest violation": "1e-8",
                "Contacts/Stagnation tolerance factor": "1", "Output/Interval of statistics": "0", "Output/Interval of pictures": "0",
                "Output/Digits": "17", "Output/Progress": "silent",
                "Output/Observers": "head, motion, support, flux, bed, leavers, energy, stress"})
    dt = draw.choice((0.02, 0.05, 0.1)) * math.sqrt(d / 9.81)
    scene.steps = draw.choice((6, 8, 12))
    scene.dimensional.update({"Time/Time step": (dt, dict(time=1)), "Time/End time": (scene.steps * dt, dict(time=1))})
    floor = [side for side in (2, 0) if scene.sides[side] and not (scene.open_to_grains and side in scene.open_to_grains)]
    if floor:
        put["support/floor"] = floor[0]

    put["Contacts/Friction coefficient"] = draw.choice(("0", "0.3", "0.6"))
    put["Contacts/Wall friction coefficient"] = draw.choice(("0", "0.3", "0.6"))
    put["Contacts/Rolling friction coefficient"] = draw.choice(("0", "0", "0.1"))
    put["Contacts/Restitution"] = draw.choice(("0", "0", "0.5"))
    put["Contacts/Contact solver"] = draw.choice(3 * ["accelerated Gauss-Seidel"] + ["Gauss-Seidel", "SOR", "accelerated Jacobi", "work queue"])
    if put["Contacts/Contact solver"] == "accelerated Jacobi":  # knows none
        put["Contacts/Rolling friction coefficient"] = "0"
    put["Contacts/Contact law"] = draw.choice(("Coulomb", "Coulomb", "static-kinetic"))
    scene.dimensional["Contacts/Contact law: static-kinetic/Transition slip speed"] = (0.1 * math.sqrt(9.81 * d), SPEED)
    scene.dimensional["Contacts/Restitution threshold velocity"] = (0.1 * math.sqrt(9.81 * d), SPEED)
    weight = scene.density * 0.785 * d * d * 9.81
    cohesion = draw.choice(4 * ["none"] + ["constant force", "liquid bridge"])
    put["Contacts/Cohesion"] = cohesion
    if cohesion != "none":
        scene.dimensional[f"Contacts/Cohesion: {cohesion}/Force"] = (draw.choice((0.5, 3.)) * weight, dict(mass=1, time=-2))
        scene.kind.append(cohesion)
    if draw.random() < 0.1:
        put.update({"Contacts/Contact model": "soft-sphere", "Contacts/Cohesion": "none", "Contacts/Contact law": "Coulomb",
                    "Contacts/Rolling friction coefficient": "0"})
        put["Output/Observers"] = put["Output/Observers"].replace(", stress", "")
        scene.dimensional["Contacts/Soft spheres/Stiffness"] = (1e3 * weight / d, dict(mass=1, length=-1, time=-2))
        scene.kind.append("soft spheres")
    if draw.random() < 0.1:
        put["Contacts/Grains rotate"] = "false"
    if draw.random() < 0.1 and not scene.dry:
        put["Grains/Fixed"] = "true"
        scene.grains = [g[:4] + (0., 0., 0.) for g in scene.grains]
        scene.kind.append("fixed")
    put["Grains/Fluid radius factor"] = draw.choice(("1", "0.8"))
    put["Grains/Mass follows"] = draw.choice(("contact radius", "fluid radius"))
    if scene.dry:
        put["Output/Observers"] = "motion, support, bed, leavers" + (", stress" if "stress" in put["Output/Observers"] else "")
        return

    scene.dimensional["Fluid/Density"] = (scene.rho, dict(mass=1, length=-3))
    scene.dimensional["Fluid/Viscosity"] = (scene.eta, dict(mass=1, length=-1, time=-1))
    put["Fluid/Convection"] = draw.choice(("true", "true", "false"))
    put["Fluid/Lumped drag"] = draw.choice(("true", "true", "false"))
    put["Boundary conditions/Pressure on inflow"] = draw.choice(("static", "static", "total"))
    put["Boundary conditions/Given velocity"] = draw.choice(("superficial", "superficial", "interstitial"))
    put["Coupling/Filter radius"] = draw.choice(("2 d", "2 d", "1.5 d", "grain"))
    put["Coupling/Filter shape"] = draw.choice(("top-hat", "parabolic"))
    put["Coupling/Overlap rule"] = draw.choice(("moments", "moments", "centroid"))
    put["Coupling/Drag law"] = draw.choice(("disc", "disc", "sphere", "paper", "Ergun", "Koch-Hill", "Rong", "Tang", "Wen-Yu", "Beetstra", "Gidaspow"))
    put["Coupling/Drag regularisation"] = draw.choice(("floor", "floor", "cap", "penalisation"))
    scheme = draw.choice(("iterated", "iterated", "semi-implicit per grain", "semi-implicit per piece", "implicit drag", "explicit"))
    put["Coupling/Time scheme"] = scheme
    scene.kind.append(scheme)
    if scheme not in ("explicit", "implicit drag") and draw.random() < 0.2:
        put["Coupling/Added mass coefficient"] = "0.5"
    if draw.random() < 0.2:
        put["Coupling/Rotation"] = "true"
    size = draw.choice((0.5, 1, 2, 4))
    if scene.mesh:
        size = max(size, 1)
    put["Mesh refinement/Interval"] = draw.choice(("0", "3"))
    if scene.mesh and len(scene.mesh[1][0]) == 3:
        put["Mesh refinement/Interval"] = "0"
    criteria = draw.choice(("uniform", "uniform", "bed faces", "void fraction", "moving grains", "velocity jump", "drag work"))
    put["Mesh refinement/Criteria"] = criteria
    put["Mesh refinement/Coarsest cell size"] = "4"
    put["Mesh refinement/Finest cell size"] = repr(size / 2 if criteria == "uniform" else max(0.5, size / 2))
    put["Mesh refinement/Criteria: uniform/Cell size"] = repr(size)
    scene.kind.append(f"{criteria} {size:g} d")
