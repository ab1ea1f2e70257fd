"""How a run ended, and whether that can be believed: a Verdict."""
import csv
import dataclasses
import json
import math
import os
import re
import resource
import signal
import subprocess

from run import Failed, read_grains

CPU, MEMORY = 60, 8 << 30  # [s], [bytes] of addresses
TOLD = ("this run will take", "times its limit of stability", "it is unstable at any time step", "keeps chosen time steps below")  # of long runs
# outcomes, from good to bad; those in BAD are findings
GOOD = ("finished", "with a warning", "refused", "diverged", "slow")
BAD = ("nonsense", "silent", "late", "words", "gave up", "crash", "hang")


@dataclasses.dataclass
class Verdict:
    outcome: str
    why: str
    code: int = 0
    cpu: float = 0.
    measures: dict = dataclasses.field(default_factory=dict)

    @property
    def is_finding(self):
        return self.outcome in BAD


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (CPU, CPU + 5))


def call(program, folder, *arguments):
    """(exit code, errors, CPU time [s])."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    with open(os.path.join(folder, "screen-output"), "w") as out, open(os.path.join(folder, "error-output"), "w") as err:
        process = subprocess.Popen([program, *arguments], stdout=out, stderr=err, stdin=subprocess.DEVNULL, cwd=folder, env=environment, preexec_fn=limits)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    with open(os.path.join(folder, "error-output"), errors="replace") as file:
        return process.returncode, file.read(), usage.ru_utime + usage.ru_stime


def parameter_names(program):
    text = subprocess.run([program, "--print-parameters"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^\s*set ([^=]*?)\s*=", text, flags=re.M))


def judge(program, names, scene, folder):
    """Run a scene in an empty folder, and look at all that it left."""
    scene.write(folder)
    code, errors, cpu = call(program, folder, "scene.prm", "--set", "Output/Output folder=output")
    messages = [line[len("alluvium: error: "):] for line in errors.split("\n") if line.startswith("alluvium: error: ")]
    said = " ".join(messages)
    if cpu >= CPU or code == -signal.SIGXCPU:
        warnings = [line for line in errors.split("\n") if any(word in line for word in TOLD)]
        if warnings:
            return Verdict("slow", warnings[0], code, cpu)
        return Verdict("hang", f"more than {CPU} s of CPU time", code, cpu)
    if code < 0 or code not in (0, 1, 2, 3):
        return Verdict("crash", errors.strip()[-300:], code, cpu)
    if code == 2:
        return Verdict("gave up", said, code, cpu)
    if code == 1:
        if len(messages) != 1 or not any(name in said for name in names):
            return Verdict("words", said or errors.strip()[-300:], code, cpu)
        if call(program, folder, "--check", "scene.prm", "--set", "Output/Output folder=none")[0] == 0:
            return Verdict("late", said, code, cpu)
        return Verdict("refused", said, code, cpu)
    return of_output(scene, folder, code, cpu, said)


def of_output(scene, folder, code, cpu, said=""):
    """The verdict on what a run with exit code 0 or 3 has left."""
    try:
        with open(os.path.join(folder, "output", "summary.json")) as file:
            summary = json.load(file)
        columns = read_columns(os.path.join(folder, "output", "statistics.csv"))
    except (OSError, ValueError, KeyError) as error:
        return Verdict("words", f"output cannot be read: {error}", code, cpu)
    if code == 3:
        known = "The run has diverged" in said and ("sign" in summary.get("divergence", {}) or "from t =" in said)
        return Verdict("diverged" if known else "words", said, code, cpu)
    warnings = [text if isinstance(text, str) else json.dumps(text) for text in summary.get("warnings", [])]
    try:
        wrong, doubts, measures = look(scene, columns, summary, read_grains(os.path.join(folder, "output", "checkpoint", "grains")))
    except Failed as error:  # no step was calm: the monitor's bound was half used up
        wrong, doubts, measures = [], [(str(error), "")], {}
    if wrong:
        return Verdict("nonsense", "; ".join(wrong), code, cpu, measures)
    unsaid = [doubt for doubt, word in doubts if not any(word in warning for warning in warnings)]
    if unsaid:
        return Verdict("silent", "; ".join(unsaid), code, cpu, measures)
    return Verdict("with a warning" if warnings else "finished", " | ".join(warnings), code, cpu, measures)


def read_columns(name):
    with open(name) as file:
        rows = list(csv.reader(file))
    columns = {}
    for k, column in enumerate(rows[0]):
        if column != "time_step_limit":
            columns[column] = [float(row[k]) if row[k] else None for row in rows[1:]]
    return columns


def numbers(column):
    return [x for x in column or [] if x is not None]


def look(scene, columns, summary, grains):
    """(what cannot be, [(what asks for a warning, a word of that)], {name: number})."""
    wrong, doubts, measures = [], [], {}

    def check(name, value, doubt, mistake, word=""):
        """Above `doubt` the run must have said something, above `mistake` it must not have ended well."""
        measures[name] = value
        if not value <= mistake:
            wrong.append(f"{name} {value:.3g}")
        elif value > doubt:
            doubts.append((f"{name} {value:.3g}", word))

    for name, column in columns.items():
        if any(not math.isfinite(x) for x in numbers(column)):
            wrong.append(f"{name} is not finite")
    if any(not math.isfinite(x) for grain in grains.values() for x in (*grain[:4], *grain[5:])):
        wrong.append("a grain is not finite")
    if wrong:
        return wrong, doubts, measures

    check("void fraction below 0", -min(numbers(columns.get("smallest_void_fraction")), default=1.), 1e-9, 1e-6)
    check("void fraction above 1", max(numbers(columns.get("largest_void_fraction")), default=0.) - 1., 1e-9, 1e-6)
    check("solid clipped over all", clipped(scene, columns, grains), 1e-3, 1e-2)
    check("penetration / d", penetration(scene, grains), 0.02, 0.11)
    check("third law", max(numbers(columns.get("third_law_defect")), default=0.), 1e-9, 1e-6)
    check("fluid's residual", max(numbers(columns.get("fluid_residual")), default=0.), 2e-6, 1e-4, "linear solves")
    check("flux imbalance", max(map(abs, numbers(columns.get("flux_imbalance"))), default=0.), 1e-4, 1e-2)
    lost_momentum = not_received(columns, summary)
    # what grains got and the fluid did not is told as a share of what was exchanged, which is no balance; nor is one with grains of another time
    balanced = lost_momentum <= 2e-2 and not summary.get("run", {}).get("checkpoint")
    check("momentum of grains", momentum(scene, columns, grains) if balanced else 0., 1e-3, 2e-2)
    check("momentum not received", lost_momentum, 2e-2, math.inf, "momentum")
    check("energy from nowhere", summary.get("energy", {}).get("unexplained_gain_over_exchanged", 0.) or 0., 0.5, math.inf, "unexplained")
    check("speed over what drives it", speed(scene, columns, grains), 3., 10.)
    check("grains outside", outside(scene, grains), 0, 0)
    check("grains lost", lost(scene, columns, grains), 0, 0)
    return wrong, doubts, measures


def clipped(scene, columns, grains):
    """Of the grains that are there at the end: while others leave, only their own."""
    solid, volumes = sum(math.pi * g[3]**2 for g in grains.values()), numbers(columns.get("clipped_solid_volume_m2"))
    return max(volumes[-1:] if scene.open_to_grains else volumes, default=0.) / solid if solid else 0.


def not_received(columns, summary):
    """The part of the exchanged momentum that did not reach the fluid; zero where the exchange is nothing beside the weight."""
    share = summary.get("audit", {}).get("momentum_not_received_over_impulse", 0.) or 0.
    forces = [abs(x) for x in numbers(columns.get("fluid_force_over_weight"))[1:]]
    return share if not forces or share * sum(forces) / len(forces) > 1e-5 else 0.


def near(x, length, periodic):
    return x - length * round(x / length) if periodic else x


def penetration(scene, grains):
    """The largest overlap of two grains, over the smaller one's diameter."""
    lengths = [b - a for a, b in zip(scene.lower, scene.upper)]
    worst, reach = 0., 2 * max((g[2] for g in grains.values()), default=0.)
    ordered = sorted(grains.values())
    for k, a in enumerate(ordered):
        for b in ordered[k + 1:] if 0 not in scene.periodic else ordered[k + 1:]:
            if 0 not in scene.periodic and b[0] - a[0] > reach:
                break
            apart = math.hypot(near(a[0] - b[0], lengths[0], 0 in scene.periodic), near(a[1] - b[1], lengths[1], 1 in scene.periodic))
            worst = max(worst, (a[2] + b[2] - apart) / (2 * min(a[2], b[2])))
    return worst


def moves(scene):
    return scene.settings.get("Grains/Fixed") != "true"


def momentum(scene, columns, grains):
    """Change of the grains' momentum along gravity, less the impulses of weight, walls and fluid, over what these are gross."""
    g = math.hypot(*scene.gravity)
    wall = columns.get("wall_force_over_weight")
    if not g or not wall or not moves(scene) or scene.open_to_grains or not grains:
        return 0.
    if scene.periodic and (1 in scene.periodic or scene.gravity[0] or any(scene.gradient)):  # weight that no pressure carries
        return 0.
    rho = 0. if scene.dry else scene.rho
    weight = sum(grain[4] - rho * math.pi * grain[3]**2 for grain in grains.values()) * g
    mass = sum(grain[4] for grain in grains.values())
    if abs(weight) < 1e-6 * mass * g:
        return 0.
    along = [x / g for x in scene.gravity]
    before = {k: row[4:6] for k, row in enumerate(scene.grains)}
    change = sum(grain[4] * sum(a * (grain[5 + k] - before.get(i, (0., 0.))[k]) for k, a in enumerate(along)) for i, grain in grains.items())
    none = [0.] * len(wall)
    time, fluid = columns["time_s"], columns.get("fluid_force_over_weight", none)
    missing = columns.get("momentum_not_received_over_force", none)  # what the grains got besides, and the run tells
    impulse = gross = known = 0.
    for k in range(1, len(time)):
        if wall[k] is None or fluid[k] is None:
            return 0.
        dt = time[k] - time[k - 1]
        impulse += dt * weight * (1 - wall[k] - fluid[k])
        gross += dt * abs(weight) * (1 + abs(wall[k]) + abs(fluid[k]))
        known += dt * abs(weight * fluid[k]) * (missing[k] or 0.)
    return max(0., abs(change - impulse) - 2 * known) / gross if gross else 0.


def speed(scene, columns, grains):
    """The fastest of fluid and grains, over the speed that pressures, weight, walls and what was there at first can give."""
    fastest = max([*numbers(columns.get("largest_fluid_velocity_m_per_s")), *numbers(columns.get("largest_grain_velocity_m_per_s"))], default=0.)
    duration = columns["time_s"][-1]
    size = sum(b - a for a, b in zip(scene.lower, scene.upper))
    given = [math.hypot(*row[4:6]) for row in scene.grains] + [math.hypot(*motion[0]) + abs(motion[1]) * size for motion in scene.motion.values()]
    pressures, outlet = [], False
    for condition in [*scene.sides, *(part[4] for part in scene.parts)]:
        if condition and condition[0] == "velocity":
            # through what the grains leave of the opening, as fast as continuity has it
            given.append(20 * math.hypot(*condition[1]))
        elif condition and condition[0] == "pressure":
            pressures.append(max(abs(condition[1]), abs(condition[1] + condition[2] * duration)))
    g = math.hypot(*scene.gravity)
    light = 1. if scene.dry else min(scene.rho, scene.density)
    if 0 in scene.periodic or 1 in scene.periodic:  # no wall ends a fall there
        given.append((g + (math.hypot(*scene.force) + math.hypot(*scene.gradient)) / light) * duration)
    pull = 2 * sum(pressures) + 2 * (scene.density + scene.rho) * g * size + (math.hypot(*scene.force) + math.hypot(*scene.gradient)) * size
    kinetic = max([scene.density * v**2 for v in given], default=0.)
    bonds = 0.
    for name, (value, _) in scene.dimensional.items():  # what cohesion can pull together
        if "Cohesion" in name and name.endswith("Force"):
            bonds = 2 * value * scene.d / (math.pi * (scene.d / 2)**2)
    return fastest / (math.sqrt((pull + kinetic + bonds) / light) + 1e-30) if not scene.dry else fastest / (math.sqrt(2 * g * size + kinetic / light + bonds / scene.density) + 1e-30)


def outside(scene, grains):
    if scene.mesh or not moves(scene):
        return 0
    slack = 0.12 * scene.d
    low = [-math.inf if k in scene.periodic else scene.lower[k] - slack for k in range(2)]
    high = [math.inf if k in scene.periodic else scene.upper[k] + slack for k in range(2)]
    closed = [2 * k + e not in (scene.open_to_grains or []) for k in range(2) for e in range(2)]
    return sum(any((closed[2 * k] and grain[k] - grain[2] < low[k] - 0.1 * scene.d) or (closed[2 * k + 1] and grain[k] + grain[2] > high[k] + 0.1 * scene.d) for k in range(2))
               for grain in grains.values())


def lost(scene, columns, grains):
    """Grains that were in the scene's file, and neither are there nor have left."""
    if not scene.grains or scene.open_to_grains:
        return 0
    return len(scene.grains) - len(grains)
