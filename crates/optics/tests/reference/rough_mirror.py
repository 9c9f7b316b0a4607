"""R. L. Cook & K. E. Torrance, SIGGRAPH 1981, with the distributions of `microfacets`."""

import numpy as np

from common import column, dot, half, schlick, two_sided
from microfacets import alphas, d, g2

SETS = [
    "reflectance=1 roughness=0.5",
    "reflectance=0.9,0.2,0 roughness=0.15 fresnel=schlick",
    "roughness=1",
    "roughness=0.5 anisotropy=0.7",
    "roughness=0.3 distribution=beckmann fresnel=schlick reflectance=0.2,0.5,0.9",
]


@two_sided
def f(o, i, p):
    h, (ax, ay), kind = half(o, i), alphas(p), p.get("distribution", "ggx")
    r0 = p.color("reflectance", 1)
    if p.get("fresnel") == "schlick":
        fresnel = np.where(r0 > 0, schlick(r0, column(dot(o, h))), 0)
    else:
        fresnel = r0 * np.ones((len(o), 1))
    return fresnel * column(d(h, kind, ax, ay) * g2(o, i, kind, ax, ay) / (4 * o[:, 2] * i[:, 2]))
