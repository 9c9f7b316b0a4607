"""A rough dielectric coat over a diffuser, balanced by the coat's albedo. The albedo is defined at nodes by the midpoints of a grid
of GGX's visible normals (E. Heitz, JCGT 7(4), 2018) and linear in the roots of roughness and cosine between them."""

import numpy as np

from common import column, dot, fresnel_dielectric, half, two_sided
from microfacets import alphas, d, g2, smith_lambda

SETS = [
    "reflectance=0.6,0.3,0.1 roughness=0.3",
    "reflectance=0.9,0.5,0.2 ior=1.9 roughness=0.1 specular=0.5,0.6,0.7",
    "reflectance=0.6,0.3,0.1 roughness=0.7 ior=1.3 saturates=false",
]
COSINES, ROUGHS, NORMALS = 16, 12, 24


def albedo(mu, alpha, n):
    if alpha < 1e-3:
        return fresnel_dielectric(np.array([mu]), 1.0, n)[0]
    u, v = (x.ravel() for x in np.meshgrid((np.arange(NORMALS) + 0.5) / NORMALS, (np.arange(NORMALS) + 0.5) / NORMALS))
    o = np.array([[np.sqrt(1 - mu * mu), 0, mu]])
    s = o * [alpha, alpha, 1]
    s = s / np.linalg.norm(s)
    t1 = np.array([[0.0, 1.0, 0.0]]) if s[0, 0] > 0 else np.array([[1.0, 0.0, 0.0]])
    t2 = np.cross(s, t1)
    a, b = np.sqrt(u) * np.cos(2 * np.pi * v), np.sqrt(u) * np.sin(2 * np.pi * v)
    w = (1 + s[0, 2]) / 2
    b = (1 - w) * np.sqrt(1 - a * a) + w * b
    h = (column(a) * t1 + column(b) * t2 + column(np.sqrt(np.maximum(1 - a * a - b * b, 0))) * s) * [alpha, alpha, 1]
    h = h / np.linalg.norm(h, axis=1, keepdims=True)
    oh = dot(h, o)
    i = 2 * column(oh) * h - o
    lo = smith_lambda(o, "ggx", alpha, alpha)
    with np.errstate(all="ignore"):
        weight = (1 + lo) / (1 + lo + smith_lambda(i, "ggx", alpha, alpha))
    return np.mean(np.where(i[:, 2] > 0, fresnel_dielectric(np.clip(oh, 0, 1), 1.0, n) * weight, 0))


def row(alpha, n):
    x = np.sqrt(alpha) * (ROUGHS - 1)
    k = min(int(x), ROUGHS - 2)
    mus = np.maximum((np.arange(COSINES) / (COSINES - 1)) ** 2, 1e-3)
    rows = [np.array([albedo(mu, (j / (ROUGHS - 1)) ** 2, n) for mu in mus]) for j in (k, k + 1)]
    return rows[0] + (rows[1] - rows[0]) * (x - k)


@two_sided
def f(o, i, p):
    n, (ax, ay), rho = p.get("ior", 1.5), alphas(p), p.color("reflectance", 0.5)
    h = half(o, i)
    highlight = fresnel_dielectric(dot(o, h), 1.0, n) * d(h, "ggx", ax, ay) * g2(o, i, "ggx", ax, ay) / (4 * o[:, 2] * i[:, 2])
    nodes, x = row(ax, n), (np.arange(1000000) + 0.5) / 1000000
    coat = lambda root: np.interp(root * (COSINES - 1), np.arange(COSINES), nodes)
    escape = (1 - np.mean(coat(x) * 4 * x**3)) / n**2
    inside = (1 - escape) * (rho if p.get("saturates", True) else 1)
    passes = (1 - coat(np.sqrt(o[:, 2]))) * (1 - coat(np.sqrt(i[:, 2])))
    return p.color("specular", 1) * column(highlight) + rho * column(passes) / (np.pi * n**2 * (1 - inside))
