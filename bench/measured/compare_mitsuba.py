"""Measured materials in Kirkas and in Mitsuba 3 (plugin `measured`): the greatest differences of reflectance and density at
random pairs of directions, for RGL files and for two that Kirkas writes (anisotropic; by wavelength).

    cargo build --release -p kirkas-optics --example measured_values
    python bench/measured/compare_mitsuba.py FOLDER_OF_BSDF_FILES [PAIRS]

Needs `pip install mitsuba`. Kirkas gives COSINE of its samples to the cosine, which is taken off before densities are compared.
"""

import math
import pathlib
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
COSINE = 1 / 16
NANOMETRES = 555.0


def tool():
    for base in (pathlib.Path(p) for p in (ROOT / "target", )):
        found = base / "release" / "examples" / "measured_values"
        if found.exists():
            return found
    raise SystemExit("build it first: cargo build --release -p kirkas-optics --example measured_values")


def pairs(count):
    """Half anywhere above, half near the mirrored direction; not below 2 degrees over the horizon."""
    random = np.random.default_rng(2018)
    lowest = math.sin(math.radians(2))
    unit = lambda v: v / np.linalg.norm(v, axis=1, keepdims=True)
    a, b = unit(random.normal(size=(count, 3))), unit(random.normal(size=(count, 3)))
    a[:, 2] = np.maximum(np.abs(a[:, 2]), lowest)
    near = a * [-1, -1, 1] + random.normal(size=(count, 3)) * 0.1
    b[: count // 2] = near[: count // 2]
    b[:, 2] = np.maximum(np.abs(b[:, 2]), lowest)
    return unit(a).astype(np.float32), unit(b).astype(np.float32)


def kirkas(file, wo, wi, *words):
    lines = "\n".join(" ".join(f"{x:.9g}" for x in row) for row in np.hstack([wo, wi]))
    done = subprocess.run([tool(), file, *words], input=lines, capture_output=True, text=True, check=True)
    table = np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])
    return table[:, :-1], table[:, -1]


def mitsuba(file, wo, wi, variant):
    mi.set_variant(variant)
    bsdf = mi.load_dict({"type": "measured", "filename": str(file)})
    context = mi.BSDFContext()
    values, densities = [], []
    for o, i in zip(wo, wi):
        si = mi.SurfaceInteraction3f()
        si.wi = [float(x) for x in o]
        if "spectral" in variant:
            si.wavelengths = [NANOMETRES] * 4
        there = mi.Vector3f([float(x) for x in i])
        value = np.array(bsdf.eval(context, si, there)).ravel()
        values.append((value[:1] if "spectral" in variant else value) / float(i[2]))
        densities.append(bsdf.pdf(context, si, there))
    return np.array(values), np.array(densities)


def compare(file, count, variant):
    wo, wi = pairs(count)
    words = [str(NANOMETRES)] if "spectral" in variant else []
    (f, pdf), (f_mi, pdf_mi) = kirkas(file, wo, wi, *words), mitsuba(file, wo, wi, variant)
    pdf = (pdf - COSINE * wi[:, 2] / math.pi) / (1 - COSINE)
    f_mi = np.maximum(f_mi, 0)
    # Relative to the value, or to a thousandth of the brightest where there is next to nothing.
    off = np.abs(f - f_mi) / np.maximum(np.abs(f_mi), 1e-3 * f_mi.max())
    off_pdf = np.abs(pdf - pdf_mi) / np.maximum(pdf_mi, 1e-3)
    print(f"{file.name:32} {variant:16} value {off.max():.1e} (median {np.median(off):.1e})  density {off_pdf.max():.1e} (median {np.median(off_pdf):.1e})")


def main(folder, count=2000):
    for file in sorted(pathlib.Path(folder).glob("*.bsdf")):
        compare(file, int(count), "scalar_rgb" if file.stem.endswith("_rgb") else "scalar_spectral")
    with tempfile.TemporaryDirectory() as made:
        for kind, variant in (("anisotropic", "scalar_rgb"), ("spectral", "scalar_spectral")):
            file = pathlib.Path(made) / f"{kind}.bsdf"
            subprocess.run([tool(), f"write_{kind}", file], check=True)
            compare(file, int(count), variant)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
