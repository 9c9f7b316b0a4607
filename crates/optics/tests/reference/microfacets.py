"""Distributions of microfacets and their masking (B. Walter et al., EGSR 2007; E. Heitz, JCGT 3(2), 2014)."""

import math

import numpy as np

erf = np.vectorize(math.erf)


def alphas(p, default=0.2):
    roughness, anisotropy = p.get("roughness", default), p.get("anisotropy", 0.0)
    return max(roughness * (1 + anisotropy), 1e-3), max(roughness * (1 - anisotropy), 1e-3)


def d(h, kind, ax, ay):
    """Heitz 2014, equations 79 (Beckmann, anisotropic) and 85 (GGX, anisotropic)."""
    x, y, z = h[:, 0], h[:, 1], h[:, 2]
    slopes = (x / (ax * z)) ** 2 + (y / (ay * z)) ** 2
    if kind == "beckmann":
        return np.exp(-slopes) / (np.pi * ax * ay * z**4)
    return 1 / (np.pi * ax * ay * z**4 * (1 + slopes) ** 2)


def smith_lambda(w, kind, ax, ay):
    """Heitz 2014, equations 66 and 72, with the roughness along the direction (equation 80)."""
    x, y, z = w[:, 0], w[:, 1], np.abs(w[:, 2])
    projected = np.sqrt((x * ax) ** 2 + (y * ay) ** 2)
    a = z / np.maximum(projected, 1e-300)
    if kind == "beckmann":
        return (erf(a) - 1) / 2 + np.exp(-(a**2)) / (2 * a * np.sqrt(np.pi))
    return (np.sqrt(1 + 1 / a**2) - 1) / 2


def g2(o, i, kind, ax, ay):
    """Height-correlated masking and shadowing on one side (Heitz 2014, equation 99)."""
    return 1 / (1 + smith_lambda(o, kind, ax, ay) + smith_lambda(i, kind, ax, ay))


def g1(w, kind, ax, ay):
    return 1 / (1 + smith_lambda(w, kind, ax, ay))
