"""A smooth dielectric coat over a diffuser: Fresnel both ways, bounces between them as a geometric series."""

import numpy as np

from common import column, fresnel_dielectric, two_sided

SETS = [
    "reflectance=0.6,0.3,0.1",
    "reflectance=0.9,0.5,0.2 ior=1.9 outside=1.33",
    "reflectance=0.6,0.3,0.1 ior=1.3 saturates=false",
]


def internal(n):
    """Mean reflectance of the boundary for diffuse light from below: 2 int F(mu) mu dmu, mu = x^2."""
    x = (np.arange(400000) + 0.5) / 400000
    return np.mean(fresnel_dielectric(x * x, n, 1.0) * 4 * x**3)


@two_sided
def f(o, i, p):
    rho, n = p.color("reflectance", 0.5), p.get("ior", 1.5) / p["outside"]
    passes = lambda w: 1 - fresnel_dielectric(w[:, 2], 1.0, n)
    inside = internal(n) * (rho if p.get("saturates", True) else 1)
    return column(passes(o) * passes(i)) * rho / (np.pi * n**2 * (1 - inside))
