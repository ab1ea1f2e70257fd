"""Suspensions of discs in water, as contrib/validate lets them sink, and how fast they should; lengths in d but for d itself."""
import math

d, rho, rho_p, eta, g, width, height = 2e-4, 1000.0, 2630.0, 1e-3, 9.81, 32, 64
area = math.pi / 4  # of a disc


def by_law(phi):
    """Speed of grains at no net flux and relaxation time of the slip: `disc` at void fraction 1 - phi."""
    eps, low, high = 1 - phi, 0.0, 1.0
    for _ in range(100):
        slip = 0.5 * (low + high)
        gamma = 2 / math.pi * eps ** -2.8 * (0.63 * math.sqrt(eps * rho * d * slip / eta) + 4.8) ** 2 * eta / d ** 2
        low, high = (slip, high) if gamma * slip < eps * (rho_p - rho) * g else (low, slip)
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
