"""Suspensions of discs in water, as contrib/validate lets them sink, and how fast they should; lengths in d but for d itself."""
import cmath
import math

d, rho, rho_p, eta, g, width, height = 2e-4, 1000.0, 2630.0, 1e-3, 9.81, 32, 64
area = math.pi / 4  # of a disc


def slip_and_gamma(eps, force):
    """Slip at which the drag of the law `disc` per volume of grain is the force, and gamma then."""
    low, high = 0.0, 1.0
    for _ in range(60):
        slip = 0.5 * (low + high)
        gamma = 2 / math.pi * eps ** -2.8 * (0.63 * math.sqrt(eps * rho * d * slip / eta) + 4.8) ** 2 * eta / d ** 2
        low, high = (slip, high) if gamma * slip < force else (low, slip)
    return slip, gamma


def by_law(phi):
    """Speed of grains at no net flux and relaxation time of the slip: `disc` at void fraction 1 - phi."""
    eps = 1 - phi
    slip, gamma = slip_and_gamma(eps, eps * (rho_p - rho) * g)
    return eps * slip, eps * (phi * rho + eps * rho_p) / gamma


def one_in_each_square(phi, draw):
    """Each disc anywhere in its own square of a lattice, but where it could touch another. And the ends of whole rows."""
    spacing = math.sqrt(area / phi)
    nx, ny = round(width / spacing), round(height / spacing)
    a, b = width / nx, height / ny
    return ([((i + 0.5) * a + (a - 1) / 2 * draw.uniform(-1, 1), (j + 0.5) * b + (b - 1) / 2 * draw.uniform(-1, 1))
             for j in range(ny) for i in range(nx)], round(ny / 4) * b, round(3 * ny / 4) * b)


def anywhere(phi, draw):
    """Where there is room, one by one."""
    discs, at = [], {}
    while len(discs) < phi * width * height / area:
        x, y = draw.uniform(0, width), draw.uniform(0.5, height - 0.5)
        near = [disc for p in (-1, 0, 1) for q in (-1, 0, 1) for disc in at.get(((int(x) + p) % width, int(y) + q), [])]
        if all(min(abs(x - X), width - abs(x - X)) ** 2 + (y - Y) ** 2 > 1 for X, Y in near):
            at.setdefault((int(x), int(y)), []).append((x, y))
            discs.append((x, y))
    return discs, height / 4, 3 * height / 4


def left_of_wave(x, smooth):
    """What a disc of radius R leaves of a wave of wave number x / R: 2 J_1(x) / x if it is even, 8 J_2(x) / x^2 with the smooth filter."""
    if x == 0:
        return 1.0
    n, order = 100, 2 if smooth else 1
    bessel = sum(math.cos(order * t - x * math.sin(t)) for t in ((i + 0.5) * math.pi / n for i in range(n))) / n
    return bessel * (8 / x ** 2 if smooth else 2 / x)


def from_places(discs, bottom, top, tau_from, tau_to, smooth=False, radius=2.0, cutoff=2.6):
    """
    Speeds of the discs between bottom and top by linear theory, over the drag law's: mean from tau_from to tau_to relaxation times
    after the start from rest, part of it that is slip, root mean squares down and sideways at the end. No mesh: the packing as a sum
    of waves (shorter ones than 2 pi / cutoff left out; the discs spread over R = radius, evenly or smoothly, mirrored at floor and lid, which slip), each
    of which sets the mixture in motion as a body force does in unsteady Stokes flow; a disc moves with the mixture's mean over its own
    R, and slips by the drag law at the mean void fraction there. That motion starts later than the force, by the time in which the
    excess of momentum in the slip is made and by that in which a grain follows.
    """
    inner = [i for i, (_, y) in enumerate(discs) if bottom < y < top]
    phi, phi_all = len(inner) * area / (width * (top - bottom)), len(discs) * area / (width * height)
    law, tau = by_law(phi)
    _, gamma = slip_and_gamma(1 - phi, (1 - phi) * (rho_p - rho) * g)
    lag = ((1 - phi) ** 2 * (rho_p - rho) + rho_p) / gamma
    density, viscosity = phi_all * rho_p + (1 - phi_all) * rho, (1 - phi_all) * eta
    times = [(tau_from + (tau_to - tau_from) * (q + 0.5) / 7) * tau for q in range(7)] + [tau_to * tau]
    # of each disc: packing, part of it that the pressure carries, and mixture's velocity down (mean and final) and sideways (final)
    packing, carried, down, last, across = ([0.0] * len(inner) for _ in range(5))
    for n in range(int(cutoff * width / (2 * math.pi)) + 1):
        kx = 2 * math.pi * n / width
        phase = [cmath.exp(-1j * kx * x) for x, _ in discs]
        for m in range(int(cutoff * height / math.pi) + 1):
            ky = math.pi * m / height
            k = math.hypot(kx, ky)
            if k > cutoff:
                break
            disc = left_of_wave(k * radius, smooth)
            scale = (2 if n else 1) * (2 if m else 1) * area * disc / (width * height)
            even = scale * sum(e * math.cos(ky * y) for e, (_, y) in zip(phase, discs)) * disc
            force = scale * sum(e * math.sin(ky * y) for e, (_, y) in zip(phase, discs)) * disc if n and m else 0
            rate = viscosity * (k / d) ** 2
            grown = [1 - math.exp(-rate / density * max(0.0, t - lag)) for t in times] if n and m else [0.0] * len(times)
            drive = (rho_p - rho) * g * (kx / k) ** 2 / rate * force if n and m else 0
            for q, i in enumerate(inner):
                y, back = discs[i][1], phase[i].conjugate()
                packed = (even * back).real * math.cos(ky * y)
                packing[q] += packed
                if n and m:
                    wave = (drive * back).real * math.sin(ky * y)
                    down[q] += wave * sum(grown[:-1]) / (len(times) - 1)
                    last[q] += wave * grown[-1]
                    across[q] += (1j * ky / kx * drive * back).real * math.cos(ky * y) * grown[-1]
                if k > 0:
                    carried[q] += packed * (ky / k) ** 2
    slips = [(1 - p) * slip_and_gamma(1 - p, (1 - phi - c) * (rho_p - rho) * g)[0] for p, c in zip(packing, carried)]
    final = [a + b for a, b in zip(slips, last)]
    average = lambda numbers: sum(numbers) / len(numbers) / law
    rms = lambda numbers: math.sqrt(sum(v * v for v in numbers) / len(numbers)) / law
    return average(slips) + average(down), average(slips), rms([v - average(final) * law for v in final]), rms(across)
