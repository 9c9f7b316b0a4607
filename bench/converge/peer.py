"""What the peers' programs share: `peer_X.py VARIANT FOLDER SCENE SIZE SAMPLER SPP SEED,SEED... OUT` renders a scene with two threads,
once for each seed, writes OUT_SEED.npy (linear RGB) and prints JSON: the samples truly taken, and the seconds of a first short render that
carries compilation and the like (`first`) and of each picture (`render`)."""

import json
import sys
import time
from pathlib import Path

import numpy as np


def main(load):
    """`load(variant, folder, scene, size, sampler)` gives an object with `warm(spp)` and `picture(spp, seed) -> (image, samples)`."""
    variant, folder, scene, size, sampler, spp, seeds, out = sys.argv[1:]
    spp = int(spp)
    peer = load(variant, Path(folder), scene, int(size), sampler)
    ready = time.perf_counter()
    peer.warm(spp)
    warm = time.perf_counter()
    seconds = []
    for seed in seeds.split(","):
        start = time.perf_counter()
        image, samples = peer.picture(spp, int(seed))
        seconds.append(time.perf_counter() - start)
        np.save(f"{out}_{seed}.npy", image[..., :3].astype(np.float32))
    print("\n" + json.dumps({"spp": samples, "first": warm - ready, "render": seconds}))
