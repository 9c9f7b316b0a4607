"""After OpenPBR 1.1 with symmetric layering: skin over diffuser by C. Kelemen & L. Szirmay-Kalos 2001, coat and fuzz over the rest by
A. C. Estevez & C. Kulla 2017, equation 5. The albedos of coats are those of `rough_plastic`, that of fuzz is defined by the midpoints
of a grid over the hemisphere at 16 cosines and 8 roughnesses, linear in the cosine's root and the roughness. (What bounces among
metal facets is tabulated, and tested in the furnace; here metals are smooth enough to lose next to nothing.)"""

import numpy as np

import velvet
from common import column, dot, fresnel_dielectric, half, schlick, two_sided
from microfacets import alphas, d, g2
from oren_nayar import eon
from rough_plastic import row

SETS = [
    "base_color=0.6,0.3,0.1 roughness=0.3",
    "base_color=0.6,0.3,0.1 roughness=0.2 specular=0.5 specular_color=0.9,0.5,0.7 diffuse_roughness=0.8 ior=1.8",
    "base_color=0.8,0.5,0.2 coat=1 coat_roughness=0.2 coat_color=0.9,0.8,0.7 roughness=0.4",
    "base_color=0.2,0.3,0.4 fuzz=0.8 fuzz_color=0.9,0.6,0.7 fuzz_roughness=0.4 specular=0",
    "base_color=0.3,0.4,0.5 coat=0.5 fuzz=0.3 roughness=0.5 anisotropy=0 coat_roughness=0.1",
]


class Coat:
    def __init__(self, n, alpha):
        self.n, self.nodes = n, row(alpha, n)
        x = (np.arange(1000000) + 0.5) / 1000000
        self.mean = np.mean(np.interp(x * 15, np.arange(16), self.nodes) * 4 * x**3)

    def albedo(self, cos):
        return np.interp(np.sqrt(cos) * 15, np.arange(16), self.nodes)


def sheen(o, i, r):
    cos = half(o, i)[:, 2]
    value = (2 + 1 / r) * np.sqrt(1 - np.minimum(cos, 1) ** 2) ** (1 / r) / (2 * np.pi)
    return value / ((1 + velvet.masking(o[:, 2], r) + velvet.masking(i[:, 2], r)) * 4 * o[:, 2] * i[:, 2])


def sheen_albedo(cos, r):
    def node(mu, r):
        z, phi = np.meshgrid((np.arange(32) + 0.5) / 32, np.pi * (np.arange(16) + 0.5) / 16)
        z, phi = z.ravel(), phi.ravel()
        s = np.sqrt(1 - z * z)
        i = np.stack([s * np.cos(phi), s * np.sin(phi), z], 1)
        o = np.tile([np.sqrt(1 - mu * mu), 0, mu], (len(i), 1))
        return 2 * np.pi * np.mean(sheen(o, i, r) * z)

    y = (r - 0.07) / 0.93 * 7
    j = min(int(y), 6)
    mus = np.maximum((np.arange(16) / 15) ** 2, 1e-3)
    rows = [np.array([node(mu, 0.07 + 0.93 * k / 7) for mu in mus]) for k in (j, j + 1)]
    return np.interp(np.sqrt(cos) * 15, np.arange(16), rows[0] + (rows[1] - rows[0]) * (y - j))


@two_sided
def f(o, i, p):
    zo, zi, h = o[:, 2], i[:, 2], half(o, i)
    (ax, ay), color = alphas(p, 0.1), p.color("base_color", 0.8)
    skin, tint = Coat(p.get("ior", 1.5), ax), p.get("specular", 1) * p.color("specular_color", 1)
    facets = d(h, "ggx", ax, ay) * g2(o, i, "ggx", ax, ay) / (4 * zo * zi)
    highlight = tint * column(fresnel_dielectric(dot(o, h), 1.0, skin.n) * facets)
    balance = (1 - tint * column(skin.albedo(zo))) * (1 - tint * column(skin.albedo(zi))) / (1 - tint * skin.mean)
    r = p.get("diffuse_roughness", 0)
    out = highlight + (eon(o, i, color, r) if r > 0 else color / np.pi) * balance
    if (weight := p.get("coat", 0)) > 0:
        alpha = p.get("coat_roughness", 0.01)
        coat = Coat(p.get("coat_ior", 1.6), alpha)
        left = 1 - weight * np.maximum(coat.albedo(zo), coat.albedo(zi))
        facets = d(h, "ggx", alpha, alpha) * g2(o, i, "ggx", alpha, alpha) / (4 * zo * zi)
        passed = 1 - weight * (1 - p.color("coat_color", 1))
        out = out * column(left) * passed + weight * column(fresnel_dielectric(dot(o, h), 1.0, coat.n) * facets)
    if (weight := p.get("fuzz", 0)) > 0:
        r, fuzz = max(p.get("fuzz_roughness", 0.5), 0.07), weight * p.color("fuzz_color", 1)
        left = 1 - fuzz.max() * np.maximum(sheen_albedo(zo, r), sheen_albedo(zi, r))
        out = out * column(left) + fuzz * column(sheen(o, i, r))
    return out
