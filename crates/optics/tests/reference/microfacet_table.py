"""M. Ashikhmin, S. Premože & P. Shirley, "A Microfacet-Based BRDF Generator", SIGGRAPH 2000, equation 9. The distribution is
defined by nodes at sqrt(1 - cos delta) = i / 64 and 64 longitudes, bilinear; its integrals by sums over the cells."""

import numpy as np

from common import column, dot, half, schlick, two_sided

SETS = [
    "diffuse=0.1,0.2,0.3 reflectance=0.9,0.7,0.3 spread=0.4",
    "shape=ring angle=0.5 spread=0.2 reflectance=0.8 fresnel=constant",
    "shape=grooves angle=0.6 spread=0.3 reflectance=0.5,0.6,0.7",
    "shape=cross spread=0.5 diffuse=0.2",
    "shape=table columns=4 table=1,1,1,1,3,0.5,3,0.5,0.1,2,0.1,2,0.2,0.2,0.2,0.2,0,0,0,0.1",
]
N, G = 64, 32


def distribution(p):
    spread, angle = p.get("spread", 0.2), p.get("angle", 0.4)
    bump = lambda x: np.exp(-((x / spread) ** 2))
    shape = p.get("shape", "gaussian")
    if shape == "table":
        rows = np.asarray(p["table"]).reshape(-1, int(p.get("columns", 1)))
        grid = np.hstack([rows, rows[:, :1]])

        def table(theta, phi):
            y, x = theta / (np.pi / 2) * (len(rows) - 1), phi / (2 * np.pi) * rows.shape[1]
            i, j = np.minimum(y.astype(int), len(rows) - 2), np.minimum(x.astype(int), rows.shape[1] - 1)
            a, b = y - i, x - j
            return (grid[i, j] * (1 - b) + grid[i, j + 1] * b) * (1 - a) + (grid[i + 1, j] * (1 - b) + grid[i + 1, j + 1] * b) * a

        return table
    if shape == "ring":
        return lambda theta, phi: bump(theta - angle)
    if shape == "cross":
        return lambda theta, phi: bump(theta) * np.cos(2 * phi) ** 2
    if shape == "grooves":

        def grooves(theta, phi):
            h = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
            tilts = [np.array([s * np.sin(angle), 0, np.cos(angle)]) for s in (1, -1)]
            return sum(bump(np.arccos(np.clip(h @ t, -1, 1))) for t in tilts)

        return grooves
    return lambda theta, phi: bump(theta)


def bilinear(grid, x, turn):
    """Rows as they are, columns around."""
    grid = np.hstack([grid, grid[:, :1]])
    y = turn * (grid.shape[1] - 1)
    i, j = np.minimum(x.astype(int), len(grid) - 2), np.minimum(y.astype(int), grid.shape[1] - 2)
    a, b = x - i, y - j
    return (grid[i, j] * (1 - b) + grid[i, j + 1] * b) * (1 - a) + (grid[i + 1, j] * (1 - b) + grid[i + 1, j + 1] * b) * a


def turn(w):
    return (np.arctan2(w[:, 1], w[:, 0]) / (2 * np.pi)) % 1


def spherical(z, phi):
    z, phi = np.meshgrid(z, phi, indexing="ij")
    r = np.sqrt(1 - z**2)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1)


@two_sided
def f(o, i, p):
    s, longitudes = np.arange(N + 1) / N, 2 * np.pi * np.arange(N) / N
    theta, phi = np.meshgrid(np.arccos(1 - s**2), longitudes, indexing="ij")
    nodes = np.maximum(distribution(p)(theta, phi), 0)
    around = np.roll(nodes, -1, axis=1)
    mean = (nodes[:-1] + nodes[1:] + around[:-1] + around[1:]) / 4
    facets = (mean * (2 * np.pi / N) * np.diff(s**2)[:, None]).ravel()
    centres = spherical(1 - (s[:-1] ** 2 + s[1:] ** 2) / 2, longitudes + np.pi / N).reshape(-1, 3)
    k = spherical(np.arange(G + 1) / G, 2 * np.pi * np.arange(G) / G).reshape(-1, 3)
    g = (np.maximum(k @ centres.T, 0) @ facets).reshape(G + 1, G)
    g_at = lambda w: bilinear(g, w[:, 2] * G, turn(w))
    h = half(o, i)
    ph = bilinear(nodes, np.sqrt(np.maximum(1 - h[:, 2], 0)) * N, turn(h))
    value = ph * (centres[:, 2] @ facets) / (4 * g_at(o) * g_at(i))
    r0 = p.color("reflectance", 0.8)
    fresnel = r0 if p.get("fresnel") == "constant" else schlick(r0, column(dot(o, h)))
    return p.color("diffuse", 0) / np.pi + fresnel * column(value)
