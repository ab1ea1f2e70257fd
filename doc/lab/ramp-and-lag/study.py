"""The slower the ramp, the less late a moving grain is noticed.

First movement and heave are seen when grains have moved by a diameter. A bed that moves as one piece, pushed by what the pressure exceeds the onset, has done that when the
imposed head is beyond the onset by

    H (6 d M / (rho g H t_r^2))^(1/3),        M = (rho_p phi_m + rho eps) L + rho (H - L)

with t_r the time in which the pressure rises by rho g H (the paper: 1 s). So the lag goes with t_r^(-2/3). 2,000 discs, the bed of `ramp.prm`, in the time steps that the program
chooses; the imposed head is counted from the bed's onset by the closed form. Error: of the measured lag over the formula's.
"""
import math

from laboratory.study import Curves, Point

order = 41
scene = "../fluidised-bed/ramp.prm"
limit = 1500
always = {"Output/Observers": "bed, head, motion, support, time step"}
LAG = "imposed head beyond the onset"
H, G, RHO, RHO_P, PHI_B, D_MAX = 0.02, 9.81, 1000.0, 2630.0, 0.52, 2.4e-4
TIMES = [1, 2, 5, 10, 30]  # [s]


def formula(ramp, head, length):
    """Lag [m] of a rigid bed of this length [m] whose exact head of the onset is `head` [m]."""
    phi_m = (head / length + PHI_B) * RHO / RHO_P
    mass = (RHO_P * phi_m + RHO * (1 - PHI_B)) * length + RHO * (H - length)
    return H * (6 * D_MAX * mass / (RHO * G * H * ramp**2)) ** (1 / 3)


def lags(results, name):
    found = sorted((float(r.point.label.split()[0]), r.values[name]) for r in results if r.done)
    return [t for t, _ in found], [1e3 * lag for _, lag in found]


def beside(panel, results):
    yield "first movement (5 %)", *lags(results, "lag of the first movement [m]"), "both"
    yield "heave (95 %)", *lags(results, "lag of the heave [m]"), "both"
    yield "formula for a rigid bed", *lags(results, "formula [m]"), "line"


chart = Curves(panels={LAG: ("time of the ramp [s]", "lag [mm]")}, log={LAG: "xy"}, beside=beside, columns=1)


def points(quick):
    for t in [1, 5] if quick else TIMES:
        lag = 0.16 * t ** (1 / 3)
        yield Point("ramp", "%g s" % t, {"Boundary conditions/Pressure": "top: 0; bottom: rho*g*H*(1 + 0.75 + t/%g)" % t, "Time/End time": round(1.6 * lag, 3) + 0.02 * t,
                                         "Output/Interval of statistics": round(0.002 * t ** (1 / 3), 4)}, default=t == 1)


def measure(run, point):
    ramp = float(point.label.split()[0])
    onset = run.summary["onset by force balance"]
    imposed = lambda event: (0.75 + run.summary[event]["time_s"] / ramp) * H
    lag = formula(ramp, onset["exact_head_m"], run.columns["bed_height_m"][0])
    first, heave = (imposed(event) - onset["exact_head_m"] for event in ("first movement", "total heave"))
    return {"onset over exact": onset["over_exact"], "formula [m]": lag, "lag of the first movement [m]": first, "lag of the heave [m]": heave,
            "over the formula": first / lag, "heave over the formula": heave / lag}


def slope(r):
    """Exponent of the first movement's lag over the time of the ramp, least squares."""
    ts, lag = lags([x for x in r], "lag of the first movement [m]")
    x, y = [math.log(t) for t in ts], [math.log(v) for v in lag]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def claims(r):
    yield "in a ramp of 1 s the first movement lags by the formula within a quarter", lambda: abs(r.value("ramp", "1 s", "over the formula") - 1), "<", 0.25
    yield "the lag shrinks with the ramp's time: the exponent is -2/3 within 0.2", lambda: abs(slope(r) + 2 / 3), "<", 0.2
    yield "the onset does not feel the ramp: 1 s", lambda: abs(r.value("ramp", "1 s", "onset over exact") - 1), "<", 1e-3
    yield "the onset does not feel the ramp: 5 s", lambda: abs(r.value("ramp", "5 s", "onset over exact") - 1), "<", 1e-3


def says(r):
    one = r.done("ramp", "1 s").values
    last = max((x for x in r if x.done), key=lambda x: float(x.point.label.split()[0]))
    return ("In a ramp of 1 s the first movement is seen %.2f mm beyond the onset, the heave %.2f mm; the formula for a rigid bed gives %.2f mm. In a ramp of %s it is %.2f and %.2f mm (%.2f): the lag goes with the ramp's time to the power %.2f, "
            "the formula's to -0.67. What does not depend on the ramp is the onset; report that."
            % (1e3 * one["lag of the first movement [m]"], 1e3 * one["lag of the heave [m]"], 1e3 * one["formula [m]"], last.point.label, 1e3 * last.values["lag of the first movement [m]"],
               1e3 * last.values["lag of the heave [m]"], 1e3 * last.values["formula [m]"], slope(r)))
