"""M. Oren & S. K. Nayar, SIGGRAPH 1994, equations 27-30 (full) and the qualitative model after them; J. Portsmouth, P. Kutz &
S. Hill, "EON", 2024."""

import numpy as np

from common import column, two_sided

SETS = [
    "reflectance=0.9,0.5,0.1 roughness=0.6",
    "reflectance=1 roughness=1",
    "reflectance=0.8,0.6,0.4 roughness=0.5 form=full",
    "reflectance=0.9 roughness=1.2 form=full",
    "reflectance=0.8,0.6,0.4 roughness=0.5 form=qualitative",
]


def angles(o, i):
    phi = np.arctan2(o[:, 1], o[:, 0]) - np.arctan2(i[:, 1], i[:, 0])
    return np.arccos(o[:, 2]), np.arccos(i[:, 2]), np.cos(phi)


def full(o, i, rho, sigma):
    to, ti, cos_phi = angles(o, i)
    alpha, beta = np.maximum(to, ti), np.minimum(to, ti)
    s2 = sigma**2
    c1 = 1 - 0.5 * s2 / (s2 + 0.33)
    c2 = 0.45 * s2 / (s2 + 0.09) * np.where(cos_phi >= 0, np.sin(alpha), np.sin(alpha) - (2 * beta / np.pi) ** 3)
    c3 = 0.125 * s2 / (s2 + 0.09) * (4 * alpha * beta / np.pi**2) ** 2
    first = c1 + cos_phi * c2 * np.tan(beta) + (1 - np.abs(cos_phi)) * c3 * np.tan((alpha + beta) / 2)
    second = 0.17 * s2 / (s2 + 0.13) * (1 - cos_phi * (2 * beta / np.pi) ** 2)
    return rho / np.pi * np.maximum(column(first) + rho * column(second), 0)


def qualitative(o, i, rho, sigma):
    to, ti, cos_phi = angles(o, i)
    s2 = sigma**2
    a, b = 1 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09)
    bump = np.maximum(0, cos_phi) * np.sin(np.maximum(to, ti)) * np.tan(np.minimum(to, ti))
    return rho / np.pi * column(a + b * bump)


def eon(o, i, rho, r):
    """Single scattering by Fujii's model; the rest so that white is white, with the albedo by its closed form."""
    af = 1 / (1 + (0.5 - 2 / (3 * np.pi)) * r)
    bf = r * af

    def albedo(theta):
        s, c = np.sin(theta), np.cos(theta)
        g = s * (theta - s * c) + 2 / 3 * (s / c * (1 - s**3) - s)
        return af + bf / np.pi * g

    to, ti, cos_phi = angles(o, i)
    s = cos_phi * np.sin(to) * np.sin(ti)
    t = np.where(s > 0, np.maximum(np.cos(to), np.cos(ti)), 1)
    mean = af + bf * (2 / 3 - 28 / (15 * np.pi))
    multiple = rho**2 * mean / (1 - rho * (1 - mean))
    rest = (1 - albedo(to)) * (1 - albedo(ti)) / (1 - mean)
    return rho / np.pi * column(af + bf * s / t) + multiple / np.pi * column(rest)


@two_sided
def f(o, i, p):
    model = {"full": full, "qualitative": qualitative}.get(p.get("form"), eon)
    return model(o, i, p.color("reflectance", 0.5), p.get("roughness", 0.5))
