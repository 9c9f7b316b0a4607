"""W. Matusik et al., "A Data-Driven Reflectance Model", SIGGRAPH 2003: a MERL file of an ABC model (J. Loew et al., "BRDF Models
for Accurate and Efficient Rendering of Glossy Surfaces", TOG 2012), read between the middles of its cells. The files are those that
the Rust tests make in memory; here a cell is computed when it is asked for."""

import numpy as np

from common import dot, fresnel_dielectric, half, two_sided

SETS = ["file=paint.binary", "file=varnish.binary"]

# k_d, a, b, c, ior
ABC = {
    "paint.binary": ((0.3, 0.2, 0.05), (2.0, 1.8, 1.5), 60.0, 1.2, 1.5),
    "varnish.binary": ((0.2, 0.1, 0.02), (12.0, 12.0, 12.0), 400.0, 1.3, 1.6),
}


def abc(o, i, model):
    k_d, a, b, c, ior = model
    h = half(o, i)
    cos_d = dot(h, i)
    g = np.minimum(1, 2 * h[:, 2] * np.minimum(o[:, 2], i[:, 2]) / cos_d)
    d = (1 + b * (1 - h[:, 2])) ** -c
    s = fresnel_dielectric(cos_d, 1.0, ior) * d * g / (np.pi * o[:, 2] * i[:, 2])
    return np.array(k_d) / np.pi + s[:, None] * np.array(a)


def turn(v, axis, angle):
    """Rotate about a coordinate axis."""
    a, b = {"y": (2, 0), "z": (0, 1)}[axis]
    out = np.array(v)
    out[:, a] = v[:, a] * np.cos(angle) - v[:, b] * np.sin(angle)
    out[:, b] = v[:, a] * np.sin(angle) + v[:, b] * np.cos(angle)
    return out


def cell(h, d, p, model):
    """Value and validity in the middle of a cell."""
    theta_h, theta_d, phi_d = ((h + 0.5) / 90) ** 2 * np.pi / 2, (d + 0.5) * np.pi / 180, (p + 0.5) * np.pi / 180
    at = np.stack([np.sin(theta_d) * np.cos(phi_d), np.sin(theta_d) * np.sin(phi_d), np.cos(theta_d)], 1)
    i = turn(at, "y", theta_h)
    o = turn(at * [-1, -1, 1], "y", theta_h)
    valid = (o[:, 2] > 0) & (i[:, 2] > 0)
    value = abc(np.where(valid[:, None], o, [0, 0, 1]), np.where(valid[:, None], i, [0, 0, 1]), model)
    return value, valid


@two_sided
def f(o, i, p):
    model = ABC[p["file"]]
    h = half(o, i)
    theta_h, phi_h = np.arctan2(np.hypot(h[:, 0], h[:, 1]), h[:, 2]), np.arctan2(h[:, 1], h[:, 0])
    # Rusinkiewicz: turn the half vector onto the normal.
    d = turn(turn(i, "z", -phi_h), "y", -theta_h)
    theta_d, phi_d = np.arctan2(np.hypot(d[:, 0], d[:, 1]), d[:, 2]), np.arctan2(d[:, 1], d[:, 0])
    x = np.clip(90 * np.sqrt(theta_h / (np.pi / 2)) - 0.5, 0, 89)
    y = np.clip(theta_d * 180 / np.pi - 0.5, 0, 89)
    z = np.mod(phi_d * 180 / np.pi - 0.5, 180)
    total, weights = np.zeros((len(o), 3)), np.zeros(len(o))
    for a in (0, 1):
        for b in (0, 1):
            for c in (0, 1):
                at = [np.floor(v) + k for v, k in ((x, a), (y, b), (z, c))]
                w = np.prod([1 - np.abs(v - k) for v, k in zip((x, y, z), at)], axis=0)
                value, valid = cell(np.minimum(at[0], 89), np.minimum(at[1], 89), np.mod(at[2], 180), model)
                w = np.where(valid, w, 0)
                total += w[:, None] * value
                weights += w
    return np.where(weights[:, None] > 0, total / np.maximum(weights, 1e-300)[:, None], 0)
