"""J. F. Blinn, SIGGRAPH 1978: the normal of a raised surface; here one that rises by 0.4 along x and falls by 0.2 along y."""

import numpy as np

from normal_map import tilt
from parts import value

SETS = ["material=gloss", "material=wall strength=2", "material=clay strength=-1"]


def f(o, i, p):
    s = p.get("strength", 1.0)
    normal = np.cross([1.0, 0, 0.4 * s], [0, 1.0, -0.2 * s])
    return tilt(lambda a, b: value(p["material"], a, b, p["outside"]), o, i, normal)
