"""Errors of pictures, from the pictures alone: `errors.py FOLDER` prints the rows, as JSON, of all that `converge.py` left there.

The error is the relative mean squared error, mean((x - r)^2 / (r^2 + 0.01 m^2)) with m the mean of the reference, without the greatest
0.1 % of the terms; over all seeds its mean. Two renderers agree where their colours' means differ by less than 0.5 % and no more blocks of
8 x 8 pixels differ by 4 standard errors than 0.1 %."""

import json
import sys
from math import exp, log
from pathlib import Path

import numpy as np


def seeds(folder, stem):
    """The pictures `STEM_SEED.npy`."""
    return [np.load(p).astype(np.float64) for p in sorted(folder.glob(f"{stem}_[0-9]*.npy"))]


def relative_mse(image, reference):
    terms = ((image - reference) ** 2 / (reference**2 + 0.01 * reference.mean() ** 2)).mean(axis=-1).ravel()
    keep = np.sort(terms)[: int(np.ceil(0.999 * terms.size))]
    return float(keep.mean())


def error(folder, stem, reference):
    return float(np.mean([relative_mse(x, reference) for x in seeds(folder, stem)]))


def blocks(image, edge=8):
    h, w, c = image.shape
    return image.reshape(h // edge, edge, w // edge, edge, c).mean(axis=(1, 3))


def agreement(ours, theirs):
    """From pictures of several seeds: the greatest difference of a colour's mean, and the share of blocks that differ by 4 sigma."""
    a, b = np.stack([blocks(x) for x in ours]), np.stack([blocks(x) for x in theirs])
    means = np.abs(a.mean(axis=(0, 1, 2)) / b.mean(axis=(0, 1, 2)) - 1)
    # Variances of few seeds are rough, and those that come out small would make outliers: hence a floor.
    error = np.sqrt(a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b))
    error = np.maximum(error, np.median(error))
    z = np.abs(a.mean(axis=0) - b.mean(axis=0)) / error
    return float(means.max()), float((z > 4).mean())


def reference(folder, name):
    """The mean of what both renderers found."""
    ours, theirs = seeds(folder, f"{name}.reference-kirkas"), seeds(folder, f"{name}.reference-peer")
    return (np.mean(ours, axis=0) + np.mean(theirs, axis=0)) / 2


def bracket(error, points):
    """Of points (samples, error, seconds) the most samples that miss the error, and the fewest that reach it; None where there is none."""
    points = sorted(points)
    above, below = [p for p in points if p[1] >= error], [p for p in points if p[1] <= error]
    return above[-1] if above else None, below[0] if below else None


def between(error, points):
    """Samples and seconds to an error: on the line between two points in logarithms, beyond them as error falls with samples."""
    low, high = bracket(error, points)
    if low and high and low[1] != high[1]:
        part = log(low[1] / error) / log(low[1] / high[1])
        return tuple(exp(log(low[i]) + part * log(high[i] / low[i])) for i in (0, 2))
    one = low or high
    return one[0] * one[1] / error, one[2] * one[1] / error


def rows(folder, name):
    """What `NAME.json` tells of times, joined by the errors of the pictures beside it."""
    note = json.loads((folder / f"{name}.json").read_text())
    truth = reference(folder, name)
    ours = seeds(folder, f"{name}.reference-kirkas")
    means, outliers = agreement(ours, seeds(folder, f"{name}.reference-peer"))
    points = [(run["spp"], error(folder, run["stem"], truth), run["render"]) for run in note["kirkas"]]
    out = []
    for run in note["peers"]:
        reached = error(folder, run["stem"], truth)
        spp, seconds = between(reached, points)
        row = {"scene": name, "peer": run["who"], "kirkas_seconds": seconds, "peer_seconds": run["render"], "ratio": run["render"] / seconds}
        row |= {"error": reached, "sampler": run["sampler"], "peer_spp": run["spp"], "kirkas_spp": spp, "bracketed": None not in bracket(reached, points)}
        row |= {"peer_start": run["start"], "peer_first": run["first"], "kirkas_start": note["kirkas"][-1]["start"]}
        row |= dict(zip(("peer_means", "peer_blocks"), agreement(ours, seeds(folder, run["stem"]))))
        out.append(row | {"reference_means": means, "reference_blocks": outliers})
    return out


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    print(json.dumps([row for note in sorted(folder.glob("*.json")) for row in rows(folder, note.stem)], indent=1))
