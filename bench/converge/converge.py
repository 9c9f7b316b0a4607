"""Time to an error, beside Mitsuba 3: `converge.py --kirkas BINARY [--quick] [--scene NAME,...] [--peer NAME,...] [--json FILE] [--folder DIR]`.

For each scene of `scenes.py`: a reference to which both renderers add half, and on whose means they must agree; then the error that the peer
reaches at a number of samples that keeps it busy for 10 s; then the time that Kirkas takes to that error, between two numbers of samples
measured. 8 seeds each, render times alone: start-up, loading and compilation are told apart. All pictures stay in the folder;
`errors.py` computes the errors from them."""

import argparse
import json
import subprocess
import sys
from math import exp, log
from pathlib import Path

import numpy as np

import errors
import scenes

HERE = Path(__file__).parent
KIRKAS = "kirkas"


def read(path):
    import mitsuba as mi

    if not mi.variant():
        mi.set_variant("scalar_rgb")
    return np.array(mi.Bitmap(str(path)))[..., :3].astype(np.float32)


def kirkas(binary, folder, name, spp, seeds, stem):
    seconds = []
    for seed in seeds:
        exr, stats = folder / "last.exr", folder / "last.stats"
        command = [binary, "render", folder / f"{name}.toml", "-o", exr, "--spp", spp, "--seed", seed, "--threads", 2, "--stats", stats, "--quiet"]
        subprocess.run([str(c) for c in command], check=True)
        seconds.append(json.loads(stats.read_text())["seconds"])
        np.save(folder / f"{stem}_{seed}.npy", read(exr))
    start = float(np.median([s["total"] - s["render"] for s in seconds]))
    return {"who": KIRKAS, "spp": spp, "start": start, "first": 0.0, "render": float(np.median([s["render"] for s in seconds]))}


def mitsuba(variant, folder, name, spp, seeds, stem):
    command = [sys.executable, HERE / "peer.py", variant, folder / f"{name}.xml", spp, ",".join(map(str, seeds)), folder / stem]
    done = subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True)
    told = json.loads(done.stdout.splitlines()[-1])
    return {"who": variant, "spp": spp, "start": told["start"], "first": told["first"], "render": float(np.median(told["render"]))}


def converge(args, name, folder):
    scene = scenes.SCENES[name]()
    scenes.kirkas(scene, folder, name)
    scenes.mitsuba(scene, folder, name)
    count = 3 if args.quick else 8
    seeds = list(range(1, count + 1))
    busy, reference_spp = (2.0, 512) if args.quick else (10.0, 4096)

    # The reference: as many samples of each, in parts with seeds of their own, so that agreement can be judged.
    parts = range(101, 101 + count)
    kirkas(args.kirkas, folder, name, reference_spp, parts, f"{name}.reference-kirkas")
    mitsuba("llvm_ad_rgb" if "llvm_ad_rgb" in args.peers else args.peers[0], folder, name, reference_spp, parts, f"{name}.reference-peer")
    ours, theirs = errors.seeds(folder, f"{name}.reference-kirkas"), errors.seeds(folder, f"{name}.reference-peer")
    means, outliers = errors.agreement(ours, theirs)
    reference = (np.mean(ours, axis=0) + np.mean(theirs, axis=0)) / 2
    np.save(folder / f"{name}.reference.npy", reference.astype(np.float32))
    print(f"{name}: means agree to {100 * means:.2f} %, {100 * outliers:.2f} % of blocks differ", flush=True)

    rows, runs = [], []
    mean_error = lambda stem: float(np.mean([errors.relative_mse(x, reference) for x in errors.seeds(folder, stem)]))
    for peer in args.peers:
        trial = mitsuba(peer, folder, name, 16, [99], f"{name}.trial")
        spp = max(16, int(16 * busy / trial["render"]))
        spp = (spp + 63) // 64 * 64 if peer.startswith("llvm") and spp > 64 else spp
        theirs = mitsuba(peer, folder, name, spp, seeds, f"{name}.{peer}.{spp}")
        error = mean_error(f"{name}.{peer}.{spp}")
        runs.append(theirs)
        # Ours: a first guess, then from its error (which falls as one over the samples) one on each side of the peer's.
        points = {}
        guess = max(4, spp // 2)
        for _ in range(4):
            run = kirkas(args.kirkas, folder, name, guess, seeds, f"{name}.{KIRKAS}.{guess}")
            runs.append(run)
            points[guess] = (mean_error(f"{name}.{KIRKAS}.{guess}"), run["render"])
            at = sorted(points.items())
            if at[0][1][0] >= error >= at[-1][1][0]:
                break
            nearest = at[-1] if at[-1][1][0] > error else at[0]
            want = nearest[0] * nearest[1][0] / error
            guess = int(want * 1.15 + 1) if want > nearest[0] else max(1, int(want / 1.15))
            if guess in points:
                break
        at = sorted(points.items())
        above = [p for p in at if p[1][0] >= error] or at[:1]
        below = [p for p in at if p[1][0] <= error] or at[-1:]
        (_, (e0, t0)), (_, (e1, t1)) = above[-1], below[0]
        part = 0.0 if e0 == e1 else (log(e0) - log(error)) / (log(e0) - log(e1))
        seconds = exp(log(t0) + part * (log(t1) - log(t0)))
        row = {"scene": name, "peer": peer, "kirkas_seconds": seconds, "peer_seconds": theirs["render"], "ratio": theirs["render"] / seconds, "error": error}
        row |= {"peer_spp": spp, "peer_start": theirs["start"], "peer_first": theirs["first"], "kirkas_start": runs[-1]["start"], "means": means, "outliers": outliers}
        rows.append(row)
        print(f"{name:12} {peer:12} {spp:6} spp {theirs['render']:7.2f} s  error {error:.2e}  kirkas {seconds:7.2f} s  x {row['ratio']:.2f}", flush=True)
    (folder / f"{name}.json").write_text(json.dumps(runs))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kirkas", required=True)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--scene", default=",".join(scenes.SCENES))
    parser.add_argument("--peer", default="llvm_ad_rgb,scalar_rgb")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--folder", type=Path, default=Path("target/bench/converge"))
    args = parser.parse_args()
    args.peers = args.peer.split(",")
    args.folder.mkdir(parents=True, exist_ok=True)
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    mi.Bitmap(scenes.sky_picture()).write(str(args.folder / "sky.exr"))
    rows = []
    for name in args.scene.split(","):
        rows += converge(args, name, args.folder)
    for peer in args.peers:
        ratios = [r["ratio"] for r in rows if r["peer"] == peer]
        print(f"{peer:12} geometric mean x {exp(sum(map(log, ratios)) / len(ratios)):.2f}, least x {min(ratios):.2f}")
    if args.json:
        args.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
