"""One part in front, another behind, each as seen from above."""

import numpy as np

from common import two_sided
from parts import value

SETS = ["front=wall back=metal", "front=gloss", "front=frost back=silver"]


def f(o, i, p):
    def upper(name):
        return two_sided(lambda a, b, _: value(name, a, b, p["outside"]))(o, i, p)

    return np.where(o[:, 2:] > 0, upper(p["front"]), upper(p.get("back", p["front"])))
