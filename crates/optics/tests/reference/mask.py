"""Where it is there, it is its part."""

from parts import value

SETS = ["material=clay opacity=0.5", "material=frost", "material=both opacity=0"]


def f(o, i, p):
    return value(p["material"], o, i, p["outside"])
