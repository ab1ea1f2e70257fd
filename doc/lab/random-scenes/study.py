"""Random scenes: each must end well or say why.

Scenes far from what is usual, drawn at random by `contrib/failures`, from the first 500 of seed 1: gas, water, oil, syrup and mercury, or no fluid;
discs of 0.03 to 20 mm, lighter and heavier than the fluid; all boundary conditions, drag laws, time schemes, filters, deposits and
cells of 0.25 d to 8 d; steps from a hundredth of a grain's fall by its diameter to several, or chosen. A run has ended well if its exit
code is 0 and its numbers are sane: void fractions, overlaps, momentum, fluxes, energy, speeds. What is doubtful needs a warning, what
is refused a message that names a parameter, what diverges its sign, and what takes more than a minute must have told why.
All else is a finding, and shown as failed.

The search has had findings. Each is a test now, in `ctest -R failures.mended` where not said otherwise:

- Grains so fast that they could reach half of a periodic domain in a step were called a mistake in `Domain/Periodic directions`, which
  `--check` had passed. They are a divergence, with the step as what to change.
- `flux_imbalance` was 1 or -1 in boxes with one opening, where fluxes are what the linear solver leaves. It is 0.
- More than half of the energy that a fluid exchanged came from nowhere in its balance, without a word (coarse cells in very viscous fluids). There is a warning.
- A step that stopped a grain was taken for rest: its forces, 1.14 of the weight, stood in the table as long as nothing moved (scene 181; unit test `Rest`).
- Soft spheres overlapped by 5 % of a diameter without a word. Above a fifth of `Divergence/Largest penetration` there is a warning (scene 104).
- A grain that jumped out of the domain was called the user's mistake. It is a divergence (scene 170).
- The last steps were in doubt, and the checkpoint was that of an earlier one, without a warning (scene 287).
- A fluid without a solution, since the void fraction was 0 inside grains, ended with exit code 2. It is a divergence (scene 142).
- Balances of forces and fluxes were measured where all of them were round-off (scenes 180, 196, 396).
- Steps of 5e-10 s, chosen since `explicit` is not stable with longer ones in syrup, would have gone on for hours, where the report had expected
  a millisecond. The expected number of steps obeys the limit, there is a warning, and a run that falls far behind its report says so and
  what it spends its time with (scenes 113, 147, 302; unit test `Pace`).
"""
import json
import os
import sys

from laboratory import ROOT
from laboratory.lattice import bound_of
from laboratory.study import Map, Missing, Point

sys.path[:0] = [os.path.join(ROOT, "tests", "failures"), os.path.join(ROOT, "tests", "consistency")]
import wild  # noqa: E402

order = 17
limit = 150
OUTCOMES = ["finished", "with a warning", "refused", "diverged", "slow"]
FROZEN = "explicit, implicit drag"


def lines(name):
    if name == FROZEN:
        # tau_p of the map of time schemes is that in the bed: eps^2.8 of a lone grain's
        yield "limit of sand in water at a void fraction of 0.48", [bound_of(0.48) * 0.48**2.8] * 2, [0.01, 100]


chart = Map(x="time step / tau_p of a lone grain", y="cell size / d", value="outcome", title="outcome", bound=1.5, log="xy", good="ended well", above="refused, diverged or slow",
            words=dict(enumerate(OUTCOMES)), lines=lines)


def points(quick):
    for seed in range(1, 25 if quick else 501):
        scene = wild.draw_scene(seed)
        scheme = scene.settings.get("Coupling/Time scheme", "")
        name = "no fluid" if scene.dry else "chosen steps" if scene.automatic else FROZEN if scheme in FROZEN else "semi-implicit" if "semi" in scheme else "iterated (default)"
        yield Point(name, str(seed), command=["{root}/contrib/failures", "--build", "{build}", "--scenes", "1", "--seed", str(seed), "--json"],
                    x=scene.dt_over_tau if not scene.dry else scene.dt / (scene.d / 9.81) ** 0.5, y=scene.size)


def measure(run, point):
    found = json.loads(run.text.splitlines()[0])
    return {"outcome": OUTCOMES.index(found["outcome"]), "cpu_s": found["cpu"]}


def count(r, outcome):
    return sum(p.done and p.values["outcome"] == OUTCOMES.index(outcome) for p in r)


def claims(r):
    yield "no scene ends without a word, with nonsense, or not at all", lambda: sum(not p.done for p in r), "==", 0
    yield "more than half finish", lambda: (count(r, "finished") + count(r, "with a warning")) / max(len(r.all), 1), ">", 0.5


def says(r):
    if not r.all:
        raise Missing("nothing was run")
    known = [p for p in r.of("iterated (default)") + r.of("chosen steps") if p.done]
    return ("Of the %d scenes that were run %d finished, %d of them with a warning, %d were refused with a message, %d diverged with a sign, %d took more than a minute "
            "and had told why, and %d did none of these. "
            "With the default time scheme, or steps that the program chose, %d of %d diverged."
            % (len(r.all), count(r, "finished") + count(r, "with a warning"), count(r, "with a warning"), count(r, "refused"), count(r, "diverged"), count(r, "slow"), sum(not p.done for p in r),
               sum(p.values["outcome"] == OUTCOMES.index("diverged") for p in known), len(known)))
