"""A. C. Estevez & C. Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017 courses, equations 2-4 and table 1."""

import numpy as np

from common import column, half, two_sided

SETS = [
    "diffuse=0.1,0.2,0.3 sheen=0.5,0.4,0.6 roughness=0.3",
    "diffuse=0 sheen=1 roughness=0.1",
    "diffuse=0.2 sheen=0.7 roughness=1",
]

TABLE = np.array([[25.3245, 3.32435, 0.16801, -1.27393, -4.85967], [21.5473, 3.82987, 0.19823, -1.97760, -4.32054]])


def masking(cos, r):
    weight = (1 - r) ** 2
    a, b, c, d, e = weight * TABLE[0] + (1 - weight) * TABLE[1]
    fit = lambda x: a / (1 + b * x**c) + d * x + e
    return np.where(cos < 0.5, np.exp(fit(cos)), np.exp(2 * fit(0.5) - fit(1 - cos)))


@two_sided
def f(o, i, p):
    r = max(p.get("roughness", 0.3), 0.07)
    sin = np.sin(np.arccos(np.minimum(half(o, i)[:, 2], 1)))
    d = (2 + 1 / r) * sin ** (1 / r) / (2 * np.pi)
    g = 1 / (1 + masking(o[:, 2], r) + masking(i[:, 2], r))
    value = d * g / (4 * o[:, 2] * i[:, 2])
    return p.color("diffuse", 0.3) / np.pi + p.color("sheen", 0.5) * column(value)
