"""The mean of two parts, weighted."""

from parts import value

SETS = [
    "first=wall second=metal amount=0.3",
    "first=frost second=clay amount=0.6",
    "first=both second=gloss amount=0.5",
]


def f(o, i, p):
    a = p.get("amount", 0.5)
    return (1 - a) * value(p["first"], o, i, p["outside"]) + a * value(p["second"], o, i, p["outside"])
