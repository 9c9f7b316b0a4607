"""Writes ../../src/microfacet/losses.rs: the part of the light that white facets lose because they scatter only once.

    python3 crates/optics/tests/reference/facet_losses.py
"""

import math
import pathlib

import numpy as np

N = 24
SAMPLES = 500
NODES = np.linspace(0, 6, 60001)
ERF = np.array([math.erf(x) for x in NODES])


def smith_lambda(z, alpha, kind):
    a = z / np.maximum(alpha * np.sqrt(np.maximum(1 - z * z, 0)), 1e-150)
    if kind == "ggx":
        return (np.sqrt(1 + np.minimum(1 / a, 1e150) ** 2) - 1) / 2
    return np.where(a > 20, 0, (np.interp(a, NODES, ERF) - 1) / 2 + np.exp(-np.minimum(a, 100) ** 2) / (2 * a * np.sqrt(np.pi)))


def albedo(mu, alpha, kind):
    """Of GGX by visible normals (J. Dupuy & A. Benyoub, 2023, spherical caps), of Beckmann by its slopes; midpoints."""
    u = (np.arange(SAMPLES) + 0.5) / SAMPLES
    u, v = (x.ravel() for x in np.meshgrid(u, u))
    phi = np.pi * v
    o = np.array([np.sqrt(1 - mu * mu), 0, mu])
    if kind == "ggx":
        s = o * [alpha, 1, 1]
        s /= np.linalg.norm(s)
        z = (1 - u) * (1 + s[2]) - s[2]
        r = np.sqrt(1 - z * z)
        h = (np.stack([r * np.cos(phi), r * np.sin(phi), z], 1) + s) * [alpha, alpha, 1]
    else:
        r = alpha * np.sqrt(-np.log(1 - u))
        h = np.stack([-r * np.cos(phi), -r * np.sin(phi), np.ones_like(r)], 1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    oh = h @ o
    iz = 2 * oh * h[:, 2] - mu
    lit = (oh > 0) & (iz > 1e-9)
    lo, li = smith_lambda(mu, alpha, kind), smith_lambda(np.maximum(iz, 1e-9), alpha, kind)
    if kind == "ggx":
        weight = (1 + lo) / (1 + lo + li)
    else:
        weight = oh / (mu * h[:, 2]) / (1 + lo + li)
    return np.sum(np.where(lit, weight, 0)) / len(u)


def rows(numbers):
    lines, line = [], "   "
    for x in numbers:
        word = f" {x:.5f},"
        if len(line) + len(word) > 120:
            lines.append(line)
            line = "   "
        line += word
    return "\n".join(lines + [line])


def main():
    t = np.arange(N) / (N - 1)
    with open(pathlib.Path(__file__).parent / "../../src/microfacet/losses.rs", "w") as out:
        out.write("//! Written by `tests/reference/facet_losses.py`: the part of the light that white facets lose, at roughness\n")
        out.write(f"//! `(row / {N - 1})^2` and cosine `(column / {N - 1})^2`; and the mean of each row over all directions.\n\n")
        out.write(f"/// Steps each way.\npub(super) const N: usize = {N};\n")
        for kind in ("ggx", "beckmann"):
            lost = np.array([[max(1 - albedo(max(m * m, 1e-4), max(a * a, 1e-3), kind), 0) for m in t] for a in t])
            lost[0] = 0
            # The mean of what lies on the lines between the nodes, weighted by the cosine: with mu = x^2 by 4 x^3 dx.
            x = (np.arange(100000) + 0.5) / 100000
            mean = [np.mean(np.interp(x, t, row) * 4 * x**3) for row in lost]
            out.write(f"\n/// {kind}\n#[rustfmt::skip]\npub(super) static {kind.upper()}: [f32; N * N] = [\n{rows(lost.ravel())}\n];\n")
            out.write(f"\n/// {kind}\n#[rustfmt::skip]\npub(super) static {kind.upper()}_MEAN: [f32; N] = [\n{rows(mean)}\n];\n")


if __name__ == "__main__":
    with np.errstate(all="ignore"):
        main()
