"""Time to an error, beside Mitsuba 3, Cycles and LuxCore.

For each scene of `scenes.py`: a reference to which Kirkas and Mitsuba add half, and on whose means they must agree; of each peer the
sampler that does best in a short trial; the error that the peer reaches at a number of samples that keeps it busy for 10 s; then the
time that Kirkas takes to that error, between two numbers of samples measured. 8 seeds each, two threads, render times alone: start-up,
loading and compilation are told apart. All pictures stay in the folder; `errors.py` computes the rows from them."""

import argparse
import json
import os
import subprocess
import sys
import time
from math import exp, log
from pathlib import Path

import numpy as np

import errors
import scenes
import text_kirkas
import text_mitsuba

HERE = Path(__file__).parent
MITSUBA = ("independent", "stratified", "multijitter", "orthogonal", "ldsampler")
# Program, the variable that names its Python, samplers to try, and scenes (all where None).
PEERS = {
    "llvm_ad_rgb": ("peer_mitsuba.py", None, MITSUBA, None),
    "scalar_rgb": ("peer_mitsuba.py", None, MITSUBA, None),
    "cycles": ("peer_cycles.py", "KIRKAS_CYCLES_PYTHON", ("TABULATED_SOBOL", "BLUE_NOISE"), ["cornell"]),
    "luxcore": ("peer_luxcore.py", "KIRKAS_LUXCORE_PYTHON", ("SOBOL", "RANDOM", "METROPOLIS"), ["cornell"]),
}


def say(text):
    print(text, flush=True)


class Bench:
    """One scene: its files, its reference, its runs."""

    def __init__(self, args, name):
        self.args, self.name, self.folder = args, name, args.folder
        scene = scenes.SCENES[name]()
        scene.size = args.size
        for old in [*self.folder.glob(f"{name}.*.npy"), *self.folder.glob(f"{name}.json")]:
            old.unlink()
        text_kirkas.write(scene, self.folder, name)
        text_mitsuba.write(scene, self.folder, name)
        self.truth, self.points, self.runs = None, [], {"kirkas": [], "peers": []}

    def kirkas(self, spp, seeds, stem):
        seconds = []
        for seed in seeds:
            exr, stats = self.folder / "last.exr", self.folder / "last.stats"
            command = [self.args.kirkas, "render", self.folder / f"{self.name}.toml", "-o", exr, "--spp", spp, "--seed", seed]
            subprocess.run([str(c) for c in [*command, "--threads", 2, "--stats", stats, "--quiet"]], check=True)
            seconds.append(json.loads(stats.read_text())["seconds"])
            np.save(self.folder / f"{stem}_{seed}.npy", read(exr))
        start = float(np.median([s["total"] - s["render"] for s in seconds]))
        return {"who": "kirkas", "stem": stem, "spp": spp, "start": start, "render": float(np.median([s["render"] for s in seconds]))}

    def peer(self, who, sampler, spp, seeds, stem):
        program, variable, _, _ = PEERS[who]
        python = os.environ[variable] if variable else sys.executable
        command = [python, HERE / program, who, self.folder, self.name, self.args.size, sampler, spp, ",".join(map(str, seeds)), self.folder / stem]
        begin = time.perf_counter()
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
        wall = time.perf_counter() - begin
        if done.returncode:
            sys.exit(f"{who}: {program} failed\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
        told = json.loads(done.stdout.splitlines()[-1])
        told["start"] = wall - told["first"] - sum(told["render"])
        told["render"] = float(np.median(told["render"]))
        return {"who": who, "stem": stem, "sampler": sampler} | told

    def reference(self):
        """As many samples of each, in parts with seeds of their own, so that agreement can be judged."""
        parts = range(101, 101 + 2 * self.args.seeds)
        self.kirkas(self.args.reference, parts, f"{self.name}.reference-kirkas")
        self.peer("llvm_ad_rgb", "independent", self.args.reference, parts, f"{self.name}.reference-peer")
        ours, theirs = (errors.seeds(self.folder, f"{self.name}.reference-{who}") for who in ("kirkas", "peer"))
        means, outliers = errors.agreement(ours, theirs)
        self.truth = errors.reference(self.folder, self.name)
        say(f"{self.name}: means agree to {100 * means:.2f} %, {100 * outliers:.2f} % of blocks differ")

    def best_sampler(self, who):
        """The sampler with the least error x time at a fifth of the work, and its samples per second."""
        samplers = PEERS[who][2]
        spp, stem = 16, f"{self.name}.trial"
        while (run := self.peer(who, samplers[0], spp, [99], stem))["render"] < 0.05 * self.args.busy and spp < 2**20:
            spp *= 4
        spp = max(1, int(0.2 * self.args.busy * run["spp"] / run["render"]))
        costs = {}
        for sampler in samplers:
            stem = f"{self.name}.trial-{who}-{sampler}"
            run = self.peer(who, sampler, spp, [98, 99], stem)
            cost = errors.error(self.folder, stem, self.truth) * run["render"]
            costs[sampler] = (cost, run["spp"] / run["render"])
        say(f"{self.name:12} {who:12} error x time: " + ", ".join(f"{s} {c:.2e}" for s, (c, _) in costs.items()))
        best = min(costs, key=lambda s: costs[s][0])
        return best, costs[best][1]

    def ours(self, spp, seeds):
        run = self.kirkas(spp, seeds, f"{self.name}.kirkas.{spp}")
        self.runs["kirkas"].append(run)
        self.points.append((spp, errors.error(self.folder, run["stem"], self.truth), run["render"]))

    def race(self, who):
        """A peer's error after so long, and Kirkas on both sides of it."""
        seeds = range(1, 1 + self.args.seeds)
        sampler, rate = self.best_sampler(who)
        spp = int(rate * self.args.busy * 1.1) + 1
        while (run := self.peer(who, sampler, spp, seeds, f"{self.name}.{who}"))["render"] < self.args.busy:
            spp = int(1.1 * run["spp"] * self.args.busy / run["render"]) + 1
        self.runs["peers"].append(run)
        error = errors.error(self.folder, run["stem"], self.truth)
        if not self.points:
            self.ours(max(4, run["spp"] // 2), seeds)
        for _ in range(8):
            want, _ = errors.between(error, self.points)
            low, high = errors.bracket(error, self.points)
            below, above = max(1, int(want / 1.12)), int(want * 1.12) + 1
            if not low or low[0] < below / 1.1:
                guess = below
            elif not high or high[0] > above * 1.1:
                guess = above
            else:
                break
            if any(guess == p[0] for p in self.points):
                break
            self.ours(guess, seeds)
        (self.folder / f"{self.name}.json").write_text(json.dumps(self.runs, indent=1))
        _, seconds = errors.between(error, self.points)
        told = f"{self.name:12} {who:12} {sampler:11} {run['spp']:6} spp {run['render']:7.2f} s  error {error:.2e}"
        say(f"{told}  kirkas {seconds:7.2f} s  x {run['render'] / seconds:.2f}")


def read(path):
    import mitsuba as mi

    return np.array(mi.Bitmap(str(path)))[..., :3].astype(np.float32)


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kirkas", required=True, help="the program")
    parser.add_argument("--quick", action="store_true", help="3 seeds, 2 s, a coarse reference")
    parser.add_argument("--scene", default=",".join(scenes.SCENES), help="scenes, by commas [all]")
    parser.add_argument("--peer", default=",".join(PEERS), help="peers, by commas [all]")
    parser.add_argument("--size", type=int, default=256, help="pixels a side, a multiple of 8 [256]")
    parser.add_argument("--busy", type=float, help="seconds that keep a peer busy [10]")
    parser.add_argument("--seeds", type=int, help="pictures to each error [8]")
    parser.add_argument("--reference", type=int, help="samples of each part of the reference, two parts to a seed and renderer [512]")
    parser.add_argument("--json", type=Path, help="write the rows there")
    parser.add_argument("--folder", type=Path, default=Path("target/bench/converge"), help="keeps the pictures")
    args = parser.parse_args()
    args.busy = args.busy or (2.0 if args.quick else 10.0)
    args.seeds = args.seeds or (3 if args.quick else 8)
    args.reference = args.reference or (128 if args.quick else 512)
    args.peers = []
    for who in args.peer.split(","):
        variable = PEERS[who][1]
        if variable and variable not in os.environ:
            say(f"{who} is left out: {variable} does not name a Python that has it")
        else:
            args.peers.append(who)
    return args


def main():
    args = options()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])
    args.folder.mkdir(parents=True, exist_ok=True)
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    mi.Bitmap(scenes.sky_picture()).write(str(args.folder / "sky.exr"))
    for name in args.scene.split(","):
        bench = Bench(args, name)
        bench.reference()
        for who in args.peers:
            if name in (PEERS[who][3] or scenes.SCENES):
                bench.race(who)
    # The rows come from the pictures alone, by a program of its own.
    done = subprocess.run([sys.executable, HERE / "errors.py", args.folder], check=True, capture_output=True, text=True)
    rows = [row for row in json.loads(done.stdout) if row["scene"] in args.scene.split(",")]
    for who in args.peers:
        ratios = [r["ratio"] for r in rows if r["peer"] == who]
        if ratios:
            say(f"{who:12} geometric mean x {exp(sum(map(log, ratios)) / len(ratios)):.2f}, least x {min(ratios):.2f}")
    if args.json:
        args.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
