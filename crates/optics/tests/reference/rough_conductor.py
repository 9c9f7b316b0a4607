"""As `rough_mirror`, with Fresnel's equations for a complex index (M. Born & E. Wolf, section 14.2)."""

import numpy as np

from common import column, dot, fresnel_conductor, half, two_sided
from microfacets import alphas, d, g2

SETS = [
    "ior=0.2 k=3.5,2.5,1.9 roughness=0.5",
    "ior=1.5 k=4 roughness=0.15 outside=1.33",
    "ior=2.5 k=0.5 reflectance=0.5,0.6,0.7 roughness=1",
    "ior=0.2 k=3 roughness=0.6 anisotropy=-0.5 distribution=beckmann",
]


def reflectance(cos, p):
    n, k = p.color("ior", 0) / p["outside"], p.color("k", 0) / p["outside"]
    return fresnel_conductor(column(cos), n, k) * p.color("reflectance", 1)


@two_sided
def f(o, i, p):
    h, (ax, ay), kind = half(o, i), alphas(p), p.get("distribution", "ggx")
    return reflectance(dot(o, h), p) * column(d(h, kind, ax, ay) * g2(o, i, kind, ax, ay) / (4 * o[:, 2] * i[:, 2]))
