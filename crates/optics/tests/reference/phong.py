"""B. T. Phong, CACM 18(6), 1975; E. P. Lafortune & Y. D. Willems, "Using the Modified Phong Reflectance Model for Physically
Based Rendering", CW197, 1994, equation 4."""

import numpy as np

from common import column, dot, two_sided

SETS = [
    "diffuse=0.5,0.4,0.1 specular=0.3 exponent=20",
    "diffuse=0 specular=0.9,0.7,0.1 exponent=200",
    "diffuse=0.4 specular=0.5 exponent=8.5 form=classic",
]


def lobe(o, i, n):
    mirrored = 2 * o[:, 2:] * [0, 0, 1] - o
    return np.maximum(dot(mirrored, i), 0) ** n


def norm(n):
    return (n + 2) / (2 * np.pi)


def highlight(lobe, norm):
    @two_sided
    def f(o, i, p):
        n = p.get("exponent", 32)
        if p.get("form") == "classic":
            scale = 1 / (np.pi * i[:, 2])
        else:
            scale = norm(n)
        return p.color("diffuse", 0.5) / np.pi + p.color("specular", 0) * column(lobe(o, i, n) * scale)

    return f


f = highlight(lobe, norm)
