"""Render a scene with Mitsuba 3 in this process: `peer.py VARIANT SCENE.xml SPP SEED,SEED... OUT` writes OUT_SEED.npy and prints JSON.
Start-up and compilation are told apart: a first render with one sample per pixel carries them."""

import json
import sys
import time

import numpy as np

variant, scene, spp, seeds, out = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4].split(","), sys.argv[5]
begin = time.perf_counter()
import mitsuba as mi

mi.set_variant(variant)
loaded = mi.load_file(scene)
ready = time.perf_counter()


def picture(spp, seed):
    # As the variants that compile want it: no more samples at once than memory holds.
    passes = max(1, spp // 64) if variant.startswith("llvm") else 1
    total = 0
    for i in range(passes):
        total = total + np.array(mi.render(loaded, spp=spp // passes, seed=seed * 1000003 + i))
    return total / passes


picture(min(64, spp) if variant.startswith("llvm") else 1, 0)
warm = time.perf_counter()
seconds = []
for seed in seeds:
    start = time.perf_counter()
    image = picture(spp, int(seed))
    seconds.append(time.perf_counter() - start)
    np.save(f"{out}_{seed}.npy", image[..., :3].astype(np.float32))
print(json.dumps({"start": ready - begin, "first": warm - ready, "render": seconds}))
