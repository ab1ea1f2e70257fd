"""Random scenes far from what is usual: gas to mercury, dust to cobbles, steps much too long, cells much too fine."""
import math
import random

import draw as usual
from scene import Scene

G = 9.81
FLUIDS = (("water", 1000., 1e-3), ("water", 1000., 1e-3), ("gas", 1.2, 1.8e-5), ("gas", 1.2, 1.8e-5), ("oil", 900., 0.1), ("syrup", 1300., 10.),
          ("mercury", 13500., 1.5e-3), ("dense gas", 60., 1.6e-5))


def draw_scene(seed):
    """A Scene; besides what it has: fluid, deposit, size (of cells, in d), dt, dt_over_tau, automatic."""
    draw = random.Random(f"wild {seed}")
    scene = Scene()
    scene.seed, scene.kind = seed, []
    d = scene.d = 10**draw.uniform(-4.5, -1.7)
    scene.fluid, scene.rho, scene.eta = draw.choice(FLUIDS)
    scene.density = draw.choice((2650., 2650., 2650., 10**draw.uniform(1.5, 4.3), scene.rho, scene.rho * draw.uniform(0.3, 1.), scene.rho * draw.uniform(1., 1.2)))
    scene.dry = draw.random() < 0.08
    scene.deposit = draw.choice(("file", "file", "lattice", "random suspension", "random suspension", "settled bed"))
    nx, ny = (draw.randrange(6, 17), draw.randrange(8, 21)) if scene.deposit == "file" else (draw.randrange(8, 22), draw.randrange(12, 34))
    scene.lower, scene.upper = (0., 0.), (nx * d * draw.choice((1., 1.137)), ny * d)
    slope, strength = draw.choice((0., 0., 0., 0., draw.uniform(-1.5, 1.5))), G * draw.choice((1., 1., 1., 1., 0.01, 30., 0.))
    scene.gravity = (strength * math.sin(slope), -strength * math.cos(slope))
    usual.make_sides(scene, draw)
    if scene.mesh:
        scene.deposit = "file"
    change_driving(scene, draw)
    usual.make_walls(scene, draw)
    usual.make_grains(scene, draw)
    usual.make_settings(scene, draw)
    if not scene.dry:
        scene.kind.pop()  # criteria and size: others follow
    if scene.dry:
        scene.settings["Fluid/Model"] = "none"
    if scene.deposit != "file":
        scene.kind.pop(next(k for k, word in enumerate(scene.kind) if word.endswith(" grains")))
        make_deposit(scene, draw, nx, ny)
    change_settings(scene, draw)
    scene.kind = [scene.fluid if not scene.dry else "dry", "density %.3g" % scene.density, "d %.2g m" % d, *scene.kind]
    return scene


def change_driving(scene, draw):
    """Pressures and velocities of other sizes than those that a bed answers to."""
    factor, speed = 10**draw.uniform(-2, 2), 10**draw.uniform(-2, 1.5)
    heavy = max(abs(scene.density - scene.rho), 0.1 * scene.rho) / max(abs(scene.density - scene.rho), 1e-3 * scene.rho)

    def changed(condition):
        if condition and condition[0] == "pressure":
            return ("pressure", condition[1] * factor * heavy, condition[2] * factor * heavy, condition[3])
        if condition and condition[0] == "velocity":
            return ("velocity", tuple(speed * v for v in condition[1]), *condition[2:])
        return condition

    scene.sides = [changed(c) for c in scene.sides]
    scene.parts = [(*part[:4], changed(part[4])) for part in scene.parts]


def make_deposit(scene, draw, nx, ny):
    scene.grains = []
    put, section = scene.settings, f"Grains/Deposit: {scene.deposit}/"
    put["Grains/Deposit"] = scene.deposit
    put["Grains/Density"] = repr(scene.density)
    ratio = draw.choice((1., 1.3, 2.5))
    if scene.deposit == "lattice":
        put[section + "Diameter"] = repr(scene.d)
        put[section + "Area fraction"] = repr(draw.choice((0.05, 0.3, 0.6, 0.78)))
    else:
        put[section + "Smallest diameter"] = repr(scene.d * 2 / (1 + ratio))
        put[section + "Size ratio"] = repr(ratio)
        put[section + "Seed"] = repr(draw.randrange(1, 100))
    if scene.deposit == "random suspension":
        put[section + "Area fraction"] = repr(draw.choice((0.05, 0.2, 0.4, 0.49)))
    if scene.deposit == "settled bed":
        put[section + "Number of grains"] = repr(max(20, min(300, int(nx * ny * draw.choice((0.15, 0.3, 0.6))))))
        put[section + "Cache folder"] = ""
    scene.kind.append(scene.deposit)


def change_settings(scene, draw):
    put, d = scene.settings, scene.d
    for name in ("Fluid/Linear solver/Tolerance", "Contacts/Residual tolerance", "Contacts/Largest violation", "Contacts/Stagnation tolerance factor"):
        del put[name]
    put["Output/Observers"] += ", audit"
    if draw.random() < 0.5:
        put["Contacts/Contact solver"] = "accelerated Gauss-Seidel"
    put["Contacts/Friction coefficient"] = draw.choice(("0", "0.1", "0.4", "0.4", "1.5"))
    put["Contacts/Restitution"] = draw.choice(("0", "0", "0.5", "0.95"))
    unit = math.sqrt(d / G)
    scene.steps = draw.choice((20, 40, 40, 100))
    scene.automatic = draw.random() < 0.25
    scene.dt = unit * 10**draw.uniform(-2.5, 0.7)
    scene.dimensional["Time/Time step"] = (scene.dt, dict(time=1))
    scene.dimensional["Time/End time"] = (scene.steps * scene.dt, dict(time=1))
    if scene.automatic:
        del scene.dimensional["Time/Time step"]
        put["Time/Time step"] = "auto"
        scene.dimensional["Time/End time"] = (20 * unit * 10**draw.uniform(-2, 0), dict(time=1))
        scene.kind.append("auto")
    # of a lone grain, creeping
    scene.dt_over_tau = scene.dt * 2 / math.pi * 4.8**2 * scene.eta / (scene.density * d**2)
    scene.size = draw.choice((0.25, 0.5, 1., 2., 4., 8.))
    if scene.dry:
        return
    put["Coupling/Filter radius"] = draw.choice(("2 d", "2 d", "2 d", "1 d", "4 d", "grain"))
    cells = lambda: (scene.upper[0] - scene.lower[0]) * (scene.upper[1] - scene.lower[1]) / (scene.size * d)**2
    while cells() > 2500:
        scene.size *= 2
    if put["Mesh refinement/Criteria"] != "uniform":
        scene.size = max(scene.size, 0.5)
    put["Mesh refinement/Coarsest cell size"] = repr(max(4., scene.size))
    put["Mesh refinement/Finest cell size"] = repr(scene.size)
    put["Mesh refinement/Criteria: uniform/Cell size"] = repr(scene.size)
    scene.kind.append(f"{put['Mesh refinement/Criteria']} {scene.size:g} d")
