"""V. Schuessler et al., "Microfacet-Based Normal Mapping", SIGGRAPH Asia 2017, equations 5-13: probabilities of the facets, masking, and
paths of one facet, facet and tangent facet, tangent facet and facet. Light below is treated as light above a surface turned over."""

import numpy as np

from common import column, dot, unit
from parts import value

SETS = [
    "material=wall normals=0.8,0.4,0.9",
    "material=metal normals=0.6,0.65,0.95",
    "material=frost normals=0.35,0.6,0.9",
    "material=both normals=0.2,0.2,0.7 strength=2",
    "material=clay",
]


def tilt(f_p, o, i, normal):
    normal = unit(normal)
    if np.hypot(normal[0], normal[1]) < 1e-4:
        return f_p(o, i)
    g = np.array([0.0, 0.0, 1.0])
    t = -unit(normal - dot(normal, g) * g)
    sin = np.sqrt(1 - normal[2] ** 2)
    # Tangents: x, made square to the normal.
    x = unit(np.array([1.0, 0, 0]) - normal[0] * normal)
    basis = np.array([x, np.cross(normal, x), normal])

    def side(w):
        return np.where(w[:, 2] < 0, -1.0, 1.0)

    def clamped(w, n):
        return np.maximum(side(w) * (w @ n), 0)

    def facet_share(w):
        a, b = clamped(w, normal), clamped(w, t) * sin
        return a / (a + b)

    def g1(w):
        return np.minimum(1, np.abs(w[:, 2]) * normal[2] / (clamped(w, normal) + clamped(w, t) * sin))

    def mirror(w):
        return w - 2 * column(w @ t) * t

    def at_facet(a, b):
        # Value and cosine on the facet.
        seen = (clamped(a, normal) > 0) & (clamped(b, normal) > 0)
        out = np.zeros((len(a), 3))
        out[seen] = f_p(unit(a[seen] @ basis.T), unit(b[seen] @ basis.T)) * column(clamped(b, normal)[seen])
        return out

    with np.errstate(all="ignore"):
        straight = column(facet_share(o) * g1(i)) * at_facet(o, i)
        mi = mirror(i)
        after = np.where(
            column(clamped(i, t) > 0), column(facet_share(o) * (1 - g1(mi)) * g1(i)) * at_facet(o, mi), 0
        )
        before = column((1 - facet_share(o)) * g1(i)) * at_facet(mirror(o), i)
        before = np.where(column(clamped(o, t) > 0), before, 0)
    return (straight + after + before) / column(np.abs(i[:, 2]))


def f(o, i, p):
    strength = p.get("strength", 1.0)
    n = 2 * np.asarray(p.get("normals", np.array([0.5, 0.5, 1.0]))) - 1
    return tilt(lambda a, b: value(p["material"], a, b, p["outside"]), o, i, n * [strength, strength, 1])
