import math

import numpy as np

import steps

LIMIT_EPS, RHO, RHO_P, ETA, D = 0.48, 1000.0, 2630.0, 1e-3, 5e-5


def settings(scheme, dt):
    return ["Coupling/Time scheme=" + scheme, "Time/Time step=%g" % dt]


def tau_p():
    """Relaxation time of a disc in the lattice by the law `disc` in creeping flow [s]."""
    return RHO_P / (2 / math.pi * LIMIT_EPS**-2.8 * 4.8**2 * ETA / D**2)


def limit():
    """The longest stable step of `implicit drag` [s]: 2 eps^2 (1 - r) tau_p."""
    ratio = (1 - LIMIT_EPS) * RHO / (LIMIT_EPS * RHO_P)
    return 2 * LIMIT_EPS**2 * (1 - ratio) * tau_p()


def growth(run):
    """The mean factor from a change of the settling speed in one step to that in the next, until changes are next to none."""
    speed = run.columns["settling_speed_m_per_s"]
    change = np.abs(np.diff(speed[np.isfinite(speed)]))
    over = np.flatnonzero(change < 1e-4 * np.maximum.accumulate(change))
    end = over[0] if len(over) else len(change) - 1
    return (change[end] / change[0])**(1 / end)


def draw(step, runs, growths):
    figure, (left, right) = steps.plt.subplots(1, 2, figsize=(7.4, 2.8), layout="constrained")
    for label, (run, style) in runs.items():
        left.plot(1e6 * run.columns["time_s"], 1e6 * run.columns["settling_speed_m_per_s"], style, lw=1.1, ms=2.5, label=label)
    left.set(xlim=(0, 450), ylim=(-600, 900), xlabel="time [us]", ylabel="settling speed [um/s]")
    left.legend(fontsize=7, loc="upper left")
    for scheme, marker in (("implicit drag", "o-"), ("iterated", "s--")):
        x, y = zip(*growths[scheme])
        right.semilogx([dt / tau_p() for dt in x], y, marker, ms=4, lw=1, label=scheme)
    right.axvline(limit() / tau_p(), color="0.5", lw=0.9)
    right.axhline(1, color="0.8", lw=0.9, zorder=0)
    right.text(1.08 * limit() / tau_p(), 1.75, "2 eps^2 (1 - r)", color="0.4", fontsize=8)
    right.set(xlabel="time step / tau_p", ylabel="growth per step", ylim=(0, 2))
    right.legend(fontsize=8, loc="upper right")
    step.picture(figure, "growth.png")


def results(step):
    stable = step.run("sinking.prm", name="stable")
    step.number("tau", 1e6 * tau_p(), 0.5, "relaxation time of a disc in the lattice [us]")
    step.number("limit", 1e6 * limit(), 0.1, "longest stable step of 'implicit drag' by theory [us]")
    step.number("speed", 1e6 * stable.columns["settling_speed_m_per_s"][-1], 0.2, "settling speed at the end, steps of 10 us [um/s]")

    slow = step.run("sinking.prm", name="slowly-unstable", settings=["Time/Time step=1.7e-5"])
    diverged = step.run("sinking.prm", name="diverges", settings=["Time/Time step=2e-5"], exit_code=3)
    step.number("steps", len(diverged.columns["time_s"]), 2, "rows of statistics.csv of the run that diverged")
    step.number("largest", 1e3 * np.nanmax(np.abs(diverged.columns["settling_speed_m_per_s"])), 0.2, "largest settling speed in them [mm/s]")

    step.run("sinking.prm", name="resumed", settings=["Time/Time step=2e-5"], exit_code=3)
    resumed = step.run("sinking.prm", name="resumed", settings=[*settings("iterated", 2e-5), "Output/Restart=true"], keep=True)
    step.number("resumed", 1e6 * resumed.columns["settling_speed_m_per_s"][-1], 0.5, "settling speed at the end of the resumed run [um/s]")
    long_steps = step.run("sinking.prm", name="iterated", settings=settings("iterated", 1e-4))
    step.number("iterated", 1e6 * long_steps.columns["settling_speed_m_per_s"][-1], 0.5, "settling speed at the end, 'iterated', steps of 100 us [um/s]")

    growths = {"implicit drag": [], "iterated": []}
    for k, dt in enumerate([1e-5, 1.5e-5, 1.8e-5] if step.short else [2.5e-6, 5e-6, 8e-6, 1e-5, 1.2e-5, 1.4e-5, 1.5e-5, 1.6e-5, 1.8e-5, 2e-5]):
        run = step.run("sinking.prm", name="growth-%d" % k, settings=[*settings("implicit drag", dt), "Time/End time=%g" % (14 * dt)])
        growths["implicit drag"].append((dt, growth(run)))
    for k, dt in enumerate([1e-5, 1e-3] if step.short else [2.5e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3]):
        run = step.run("sinking.prm", name="iterated-%d" % k, settings=[*settings("iterated", dt), "Time/End time=%g" % (14 * dt)])
        growths["iterated"].append((dt, growth(run)))
    stable_steps = [dt for dt, g in growths["implicit drag"] if g < 1]
    unstable_steps = [dt for dt, g in growths["implicit drag"] if g > 1]
    step.number("last_stable", 1e6 * max(stable_steps), 0.01, "longest step tried that is stable [us]")
    step.number("first_unstable", 1e6 * min(unstable_steps), 0.01, "shortest step tried that is not [us]")
    step.number("iterated_growth", max(g for _, g in growths["iterated"]), 0.3, "largest growth of 'iterated'")
    for name, dt in (("long", 1e-4),) if step.short else (("long", 1e-4), ("middle", 1e-5), ("shortest", 1e-6)):
        run = step.run("sinking.prm", name="too-short-" + name, settings=[*settings("iterated", dt), "Time/End time=2e-3"])
        step.number("over_law_" + name, run.columns["settling_speed_over_drag_law"][-1], 0.01, "settling speed over the drag law's, 'iterated', steps of %g s" % dt)
    draw(step, {"1e-5 s: stable": (stable, "-"), "1.7e-5 s: grows": (slow, ".-"), "2e-5 s: diverges": (diverged, ".-"),
                "'iterated', 1e-4 s": (long_steps, "k--")}, growths)
