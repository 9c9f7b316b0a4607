"""Errors of pictures, from the pictures alone: `errors.py FOLDER` prints JSON for everything that `converge.py` left there.

The error is the relative mean squared error, mean((x - r)^2 / (r^2 + 0.01 m^2)) with m the mean of the reference, without the greatest
0.1 % of the terms; over 8 seeds its mean. Two renderers agree where their colours' means differ by less than 0.5 % and no more blocks of
8 x 8 pixels differ by 4 standard errors than 0.1 %."""

import json
import sys
from pathlib import Path

import numpy as np


def load(path):
    return np.load(path).astype(np.float64)


def relative_mse(image, reference):
    terms = ((image - reference) ** 2 / (reference**2 + 0.01 * reference.mean() ** 2)).mean(axis=-1).ravel()
    keep = np.sort(terms)[: int(np.ceil(0.999 * terms.size))]
    return float(keep.mean())


def blocks(image, edge=8):
    h, w, c = image.shape
    return image.reshape(h // edge, edge, w // edge, edge, c).mean(axis=(1, 3))


def agreement(ours, theirs):
    """From pictures of several seeds: the greatest difference of a colour's mean, and the share of blocks that differ by 4 sigma."""
    a, b = np.stack([blocks(x) for x in ours]), np.stack([blocks(x) for x in theirs])
    means = np.abs(a.mean(axis=(0, 1, 2)) / b.mean(axis=(0, 1, 2)) - 1)
    # Variances of few seeds are rough: each is joined by that of its neighbours in brightness through a floor.
    error = np.sqrt(a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b))
    error = np.maximum(error, np.median(error))
    z = np.abs(a.mean(axis=0) - b.mean(axis=0)) / error
    return float(means.max()), float((z > 4).mean())


def seeds(folder, stem):
    return [load(p) for p in sorted(folder.glob(f"{stem}_[0-9]*.npy"))]


def report(folder):
    rows = {}
    for note in sorted(folder.glob("*.json")):
        name = note.stem
        runs = json.loads(note.read_text())
        reference = load(folder / f"{name}.reference.npy")
        rows[name] = {}
        for run in runs:
            images = seeds(folder, f"{name}.{run['who']}.{run['spp']}")
            run["error"] = float(np.mean([relative_mse(x, reference) for x in images]))
            rows[name].setdefault(run["who"], []).append(run)
    return rows


if __name__ == "__main__":
    print(json.dumps(report(Path(sys.argv[1])), indent=1))
