"""Mitsuba 3, by variant: see `peer.py`."""

import peer


class Mitsuba:
    def __init__(self, variant, folder, scene, size, sampler):
        import drjit
        import mitsuba

        mitsuba.set_variant(variant)
        mitsuba.set_log_level(mitsuba.LogLevel.Error)
        drjit.set_thread_count(2)
        self.mitsuba = mitsuba
        self.scene = mitsuba.load_file(str(folder / f"{scene}.xml"), sampler=sampler)
        # Compiling variants take all samples of a pass at once: no more than memory holds.
        self.most = max(1, 2**24 // size**2) if variant.startswith("llvm") else 2**30

    def pass_of(self, spp):
        """How many passes, and the samples of each; samplers round to counts that they can arrange."""
        passes = -(-spp // self.most)
        sampler = self.scene.sensors()[0].sampler()
        sampler.set_sample_count(-(-spp // passes))
        return passes, sampler.sample_count()

    def render(self, spp, seed):
        import numpy as np

        return np.array(self.mitsuba.render(self.scene, spp=spp, seed=seed))

    def warm(self, spp):
        self.render(self.pass_of(spp)[1] if self.most < 2**30 else 1, 0)

    def picture(self, spp, seed):
        passes, each = self.pass_of(spp)
        return sum(self.render(each, seed * 1000003 + i) for i in range(passes)) / passes, passes * each


if __name__ == "__main__":
    peer.main(Mitsuba)
