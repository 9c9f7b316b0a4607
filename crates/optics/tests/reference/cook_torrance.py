"""R. L. Cook & K. E. Torrance, "A Reflectance Model for Computer Graphics", SIGGRAPH 1981, with angles, as courses write it."""

import numpy as np

from common import column, dot, fresnel_dielectric, half, schlick, two_sided

SETS = [
    "diffuse=0.1,0.2,0.3 specular=0.5,0.6,0.7 roughness=0.3",
    "diffuse=0.2 specular=0.8 roughness=0.5 form=classic fresnel=schlick ior=1.8",
    "diffuse=0 specular=1 roughness=0.8 fresnel=constant",
]


@two_sided
def f(o, i, p):
    h = half(o, i)
    delta, m = np.arccos(np.minimum(h[:, 2], 1)), p.get("roughness", 0.2)
    d = np.exp(-((np.tan(delta) / m) ** 2)) / (m**2 * np.cos(delta) ** 4)
    vh = dot(o, h)
    g = np.minimum(1, np.minimum(2 * h[:, 2] * o[:, 2] / vh, 2 * h[:, 2] * i[:, 2] / vh))
    n = p.get("ior", 1.5) / p["outside"]
    kind = p.get("fresnel", "exact")
    fresnel = 1 if kind == "constant" else schlick(((n - 1) / (n + 1)) ** 2, vh) if kind == "schlick" else fresnel_dielectric(vh, 1, n)
    c = np.pi if p.get("form") == "classic" else 4 * np.pi
    return p.color("diffuse", 0.5) / np.pi + p.color("specular", 0.2) * column(d * g * fresnel / (c * o[:, 2] * i[:, 2]))
