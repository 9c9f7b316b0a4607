"""M. Ashikhmin & P. Shirley, "An Anisotropic Phong BRDF Model", JGT 5(2), 2000, equations 4 and 5."""

import numpy as np

from common import column, dot, half, schlick, two_sided

SETS = [
    "diffuse=0.3,0.5,0.2 specular=0.04,0.1,0.2 exponent_u=30 exponent_v=30",
    "diffuse=0 specular=0.9,0.8,0.7 exponent_u=200 exponent_v=10",
    "diffuse=0.8 specular=0.5 exponent_u=3 exponent_v=40",
]


@two_sided
def f(o, i, p):
    h = half(o, i)
    nu, nv = p.get("exponent_u", 100), p.get("exponent_v", 100)
    rd, rs = p.color("diffuse", 0.5), p.color("specular", 0.05)
    phi, hk = np.arctan2(h[:, 1], h[:, 0]), dot(h, o)
    lobe = h[:, 2] ** (nu * np.cos(phi) ** 2 + nv * np.sin(phi) ** 2)
    scale = np.sqrt((nu + 1) * (nv + 1)) / (8 * np.pi)
    specular = column(scale * lobe / (hk * np.maximum(o[:, 2], i[:, 2]))) * schlick(rs, column(hk))
    matte = (1 - (1 - o[:, 2] / 2) ** 5) * (1 - (1 - i[:, 2] / 2) ** 5)
    return specular + 28 * rd / (23 * np.pi) * (1 - rs) * column(matte)
