"""Writes NAME.txt beside NAME.py for the models named (all, if none is): the values (1/sr, no cosine) of each of its parameter
sets at the pairs of directions of pairs.txt, computed in float64. Needs NumPy.

    python3 crates/optics/tests/reference/make.py [NAME ...]
    python3 crates/optics/tests/reference/make.py --check [NAME ...]    only tell whether the files hold what it would write
"""

import importlib
import pathlib
import sys

import numpy as np

from common import Set, parse, unit

HERE = pathlib.Path(__file__).parent
SHARED = ("common", "make", "microfacets", "facet_losses", "parts")


def make_pairs():
    """1000 pairs, rounded to float32: 400 anywhere on one side, 300 near the mirrored direction, 100 opposite, 200 near
    the continued one; half of each seen from below."""
    random = np.random.default_rng(6837)
    n = 1000
    o, i = unit(random.normal(size=(n, 3))), unit(random.normal(size=(n, 3)))
    o[:, 2], i[:, 2] = np.maximum(np.abs(o[:, 2]), 0.02), np.maximum(np.abs(i[:, 2]), 0.02)
    o, i = unit(o), unit(i)
    near = np.copy(o) * [-1, -1, 1] + random.normal(size=(n, 3)) * 0.15
    near[:, 2] = np.maximum(np.abs(near[:, 2]), 0.02)
    near = unit(near)
    i[400:700] = near[400:700]
    i[800:] = near[800:]
    i[700:, 2] *= -1
    below = np.where(np.arange(n) % 2 == 1, -1.0, 1.0)
    o[:, 2] *= below
    i[:, 2] *= below
    np.savetxt(HERE / "pairs.txt", np.hstack([o, i]).astype(np.float32), fmt="%.9g")


def compute(name, pairs):
    model = importlib.import_module(name)
    o, i = pairs[:, :3], pairs[:, 3:]
    lane = np.arange(len(pairs)) % 3
    columns = []
    for line in model.SETS:
        f = model.f(o, i, Set(parse(line)))
        if not np.isfinite(f).all():
            raise SystemExit(f"{name} {line}: {np.count_nonzero(~np.isfinite(f))} values are not finite")
        columns.append(np.take_along_axis(f, lane[:, None], 1)[:, 0])
    return model.SETS, np.array(columns).T


def check(name, pairs):
    sets, values = compute(name, pairs)
    path = HERE / f"{name}.txt"
    written = [line[6:] for line in path.read_text().splitlines() if line.startswith("# set ")]
    kept = np.loadtxt(path, ndmin=2)
    if written != sets or kept.shape != values.shape or not np.allclose(kept, values, rtol=1e-5, atol=1e-12):
        raise SystemExit(f"{path.name} is not what {name}.py says")


def write(name, pairs):
    sets, values = compute(name, pairs)
    with open(HERE / f"{name}.txt", "w") as out:
        out.write(f"# python3 crates/optics/tests/reference/make.py {name}\n")
        out.write("# One line per pair of pairs.txt, one column per set; the lane is the line's number modulo 3.\n")
        for line in sets:
            out.write(f"# set {line}\n")
        for row in values:
            out.write(" ".join("0" if x == 0 else f"{x:.6e}" for x in row) + "\n")


def main(names):
    if not (HERE / "pairs.txt").exists():
        make_pairs()
    pairs = np.loadtxt(HERE / "pairs.txt").astype(np.float32).astype(np.float64)
    act = check if "--check" in names else write
    names = [name for name in names if name != "--check"]
    for name in names or sorted(p.stem for p in HERE.glob("*.py") if p.stem not in SHARED):
        act(name, pairs)


if __name__ == "__main__":
    main(sys.argv[1:])
