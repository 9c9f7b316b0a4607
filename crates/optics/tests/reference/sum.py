"""A weighted sum of parts; unless classic, weights of more than 1 together are divided by their sum."""

import numpy as np

from parts import value

SETS = [
    "materials=wall,metal weights=0.4,0.6",
    "materials=gloss weights=0.7",
    "materials=wall,clay,gloss",
    "materials=frost,silver weights=0.5,0.5",
    "materials=clay,gloss form=classic",
]


def f(o, i, p):
    names = p["materials"].split(",")
    weights = np.broadcast_to(p.get("weights", 1.0), len(names))
    over = 1.0 if p.get("form") == "classic" else max(1.0, np.sum(weights))
    return sum(w / over * value(name, o, i, p["outside"]) for w, name in zip(weights, names))
