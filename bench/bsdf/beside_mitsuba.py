"""Compares Mitsuba's `eval` with the reference values of crates/optics/tests/reference (which the tests hold Kirkas to within 1e-4),
for the models that both have, at their 1000 pairs of directions. Needs Mitsuba 3 and NumPy.

    python3 bench/bsdf/beside_mitsuba.py

Three things differ by design. Mitsuba masks facets for reflection by G1(v) G1(l), Kirkas by the height-correlated G2; so Mitsuba's
reflection is multiplied by G2 / (G1 G1) first. Mitsuba has an approximation (Walter et al. 2007, section 5.2) for Beckmann's G1, Kirkas
the error function. Mitsuba fits the diffuse reflectance of a coat, Kirkas has Duntley's closed form.
"""

import pathlib
import sys

import numpy as np
import mitsuba as mi

mi.set_variant("scalar_rgb")
REFERENCE = pathlib.Path(__file__).resolve().parents[2] / "crates/optics/tests/reference"
sys.path.insert(0, str(REFERENCE))
sys.dont_write_bytecode = True
from common import Set, parse  # noqa: E402
from microfacets import alphas, g1, g2  # noqa: E402


def rgb(x):
    return {"type": "rgb", "value": [float(v) for v in x]}


def facets(p):
    u, v = alphas(p)
    return {"distribution": p.get("distribution", "ggx"), "alpha_u": u, "alpha_v": v}


def rough_conductor(p):
    eta, k = p.color("ior", 0) / p["outside"], p.color("k", 0) / p["outside"]
    tint = {"specular_reflectance": rgb(p.color("reflectance", 1))}
    return {"type": "roughconductor", "eta": rgb(eta), "k": rgb(k), **facets(p), **tint}, True


def rough_dielectric(p):
    if p.get("fresnel", "exact") != "exact":
        return None
    tint = {"specular_reflectance": rgb(p.color("reflectance", 1)), "specular_transmittance": rgb(p.color("transmittance", 1))}
    ior = {"int_ior": p.get("ior", 1.5), "ext_ior": p["outside"]}
    return {"type": "roughdielectric", **ior, **facets(p), **tint}, False


def plastic(p):
    ior = {"int_ior": p.get("ior", 1.5), "ext_ior": p["outside"]}
    base = {"diffuse_reflectance": rgb(p.color("reflectance", 0.5)), "nonlinear": bool(p.get("saturates", True))}
    return {"type": "plastic", **ior, **base}, True



def lambert(p):
    return {"type": "diffuse", "reflectance": rgb(p.color("reflectance", 0.5))}, True


def evaluate(bsdf, o, i):
    si = mi.SurfaceInteraction3f()
    out = np.zeros((len(o), 3))
    for n, (a, b) in enumerate(zip(o, i)):
        si.wi = mi.Vector3f(*map(float, a))
        out[n] = np.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*map(float, b)))) / abs(b[2])
    return out


def correlated(o, i, p):
    """What turns separable masking into correlated masking, for reflection."""
    kind, (ax, ay) = p.get("distribution", "ggx"), alphas(p)
    ratio = g2(o, i, kind, ax, ay) / (g1(o, kind, ax, ay) * g1(i, kind, ax, ay))
    return np.where(o[:, 2] * i[:, 2] > 0, ratio, 1)


def compare(name, describe):
    pairs = np.loadtxt(REFERENCE / "pairs.txt")
    o, i = pairs[:, :3], pairs[:, 3:]
    lines = (REFERENCE / f"{name}.txt").read_text().splitlines()
    sets = [line[6:] for line in lines if line.startswith("# set ")]
    values = np.loadtxt(REFERENCE / f"{name}.txt", ndmin=2)
    for column, line in enumerate(sets):
        described = describe(Set(parse(line)))
        if described is None:
            print(f"{name:18} {line}: no such thing in Mitsuba")
            continue
        plugin, is_opaque = described
        bsdf = mi.load_dict({"type": "twosided", "nested": plugin} if is_opaque else plugin)
        theirs = evaluate(bsdf, o, i)[np.arange(len(o)), np.arange(len(o)) % 3]
        ours = values[:, column]
        if name.startswith("rough"):
            theirs = theirs * correlated(o, i, Set(parse(line)))
        for side, among in (("reflected", o[:, 2] * i[:, 2] > 0), ("transmitted", o[:, 2] * i[:, 2] < 0)):
            lit = among & (np.maximum(ours, theirs) > 1e-4)
            if lit.any():
                off = np.abs(theirs - ours)[lit] / np.maximum(ours, theirs)[lit]
                share = f"largest relative difference {off.max():.1e}, median {np.median(off):.1e}, of {lit.sum()} pairs"
                print(f"{name:18} {line}: {side}: {share}")


if __name__ == "__main__":
    for name, describe in (
        ("lambert", lambert),
        ("rough_conductor", rough_conductor),
        ("rough_dielectric", rough_dielectric),
        ("plastic", plastic),
    ):
        compare(name, describe)
