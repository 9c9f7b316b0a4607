"""J. H. Lambert, "Photometria", 1760."""

import numpy as np

from common import two_sided

SETS = ["reflectance=0.9,0.2,0.05"]


@two_sided
def f(o, i, p):
    return np.tile(p.color("reflectance", 0.5) / np.pi, (len(o), 1))
