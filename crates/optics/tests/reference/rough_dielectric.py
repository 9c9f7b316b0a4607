"""B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, equations 16, 20 and 21; radiance, so
divided by the square of the indices' ratio."""

import numpy as np

from common import column, dot, fresnel_dielectric, half, schlick, unit
from microfacets import alphas, d, g1, g2

SETS = [
    "roughness=0.3",
    "ior=1.1 roughness=0.5 fresnel=schlick transmittance=0.3,0.2,0.9 outside=1.33",
    "ior=2.4 roughness=0.15 reflectance=0.5",
    "reflectance=0.25 transmittance=0.5 roughness=0.8 fresnel=constant",
    "roughness=0.4 anisotropy=0.5 distribution=beckmann",
]


def power(cos, eta_o, eta_i, kind):
    """Reflected and transmitted part at a facet."""
    if kind == "constant":
        passes = (eta_o / eta_i) ** 2 * (1 - cos**2) < 1
        return np.ones_like(cos), np.where(passes, 1.0, 0.0)
    if kind == "schlick":
        r0 = ((eta_o - eta_i) / (eta_o + eta_i)) ** 2
        sin2 = (eta_o / eta_i) ** 2 * (1 - cos**2)
        thin = np.where(eta_o > eta_i, np.sqrt(np.maximum(1 - sin2, 0)), cos)
        r = np.where(sin2 < 1, schlick(r0, thin), 1.0)
    else:
        r = fresnel_dielectric(cos, eta_o, eta_i)
    return r, 1 - r


def f(o, i, p):
    (ax, ay), kind = alphas(p), p.get("distribution", "ggx")
    below = o[:, 2] < 0
    eta_o = np.where(below, p.get("ior", 1.5), p["outside"])
    eta_i = np.where(below, p["outside"], p.get("ior", 1.5))
    flip = np.where(column(below), np.array([1.0, 1.0, -1.0]), 1.0)
    o, i = o * flip, i * flip
    out = np.zeros((len(o), 3))
    fresnel = p.get("fresnel", "exact")

    up = i[:, 2] > 0
    a, b = o[up], i[up]
    h = half(a, b)
    r, _ = power(dot(a, h), eta_o[up], eta_i[up], fresnel)
    value = r * d(h, kind, ax, ay) * g2(a, b, kind, ax, ay) / (4 * a[:, 2] * b[:, 2])
    out[up] = p.color("reflectance", 1) * column(value)

    a, b, no, ni = o[~up], i[~up], eta_o[~up], eta_i[~up]
    h = unit(column(no) * a + column(ni) * b)
    h = h * np.where(h[:, 2:] < 0, -1, 1)
    oh, ih = dot(a, h), dot(b, h)
    seen = (oh > 0) & (ih < 0)
    _, t = power(np.clip(oh, 0, 1), no, ni, fresnel)
    g = g1(a, kind, ax, ay) * g1(b, kind, ax, ay)
    value = np.abs(oh * ih / (a[:, 2] * b[:, 2])) * ni**2 * t * g * d(h, kind, ax, ay) / (no * oh + ni * ih) ** 2
    scale = 1.0 if fresnel == "constant" else (no / ni) ** 2
    out[~up] = p.color("transmittance", 1) * column(np.where(seen, value * scale, 0))
    return out
