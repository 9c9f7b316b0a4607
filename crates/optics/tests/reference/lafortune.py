"""E. P. F. Lafortune et al., "Non-Linear Approximation of Reflectance Functions", SIGGRAPH 1997, equation 6."""

import numpy as np

from common import two_sided

SETS = [
    "diffuse=0.1,0.2,0.3 lobes=-0.86,-0.86,0.9,16,0.3,0.25,0.2,0.71,0.71,0.69,15,0.05,0.06,0.1",
    "diffuse=0 lobes=-1,-1,1,40,6,5,4",
    "diffuse=0.3 lobes=-0.9,-0.6,0.8,5.5,0.3,0.2,0.1,-0.5,-0.5,1.05,30,0.3,0.3,0.3,0.6,0.5,0.4,3,0.1,0.1,0.2",
]


@two_sided
def f(o, i, p):
    out = np.tile(p.color("diffuse", 0.5) / np.pi, (len(o), 1))
    for cx, cy, cz, n, *color in np.reshape(p["lobes"], (-1, 7)):
        s = (o * i) @ np.array([cx, cy, cz])
        out = out + np.outer(np.where(s > 0, np.abs(s) ** n, 0), color)
    return out
