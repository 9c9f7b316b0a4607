"""LuxCore by its Python module, `PATHCPU`: see `peer.py`. Diffuse surfaces and rectangular lamps alone."""

import os
import sys
import time

import numpy as np  # before LuxCore
import pyluxcore

import peer
import scenes


class LuxCore:
    def __init__(self, _, folder, scene, size, sampler):
        pyluxcore.Init(lambda _: None)
        s, self.size, self.scene = scenes.SCENES[scene](), size, pyluxcore.Scene()
        # LuxCore shows everything one pixel too high: the window of the camera makes up for it.
        shift = 2 / size
        camera = {"lookat.orig": list(s.position), "lookat.target": list(s.look_at), "up": list(s.up), "fieldofview": s.fov}
        camera |= {"autofocus.enable": False, "screenwindow": [-1.0, 1.0, -1.0 - shift, 1.0 - shift]}
        self.scene.Parse(properties({f"scene.camera.{key}": value for key, value in camera.items()}))
        for key, m in s.materials.items():
            self.scene.Parse(properties({f"scene.materials.{key}.type": "matte", f"scene.materials.{key}.kd": list(m.color)}))
        for i, shape in enumerate(s.shapes):
            self.shape(f"shape_{i}", shape)
        self.config = {
            "renderengine.type": "PATHCPU",
            "native.threads.count": 2,
            "sampler.type": sampler,
            f"sampler.{sampler.lower()}.adaptive.strength": 0.0,
            "film.width": size,
            "film.height": size,
            "film.filter.type": "BOX",
            "film.filter.width": 0.5,
            "film.imagepipelines.0.0.type": "NOP",
            "film.outputs.0.type": "RGB",
            "film.outputs.0.filename": "unused.exr",
            # LuxCore counts the segments of a path, as Mitsuba does.
            "path.pathdepth.total": s.depth + 1,
            "path.pathdepth.diffuse": s.depth + 1,
            "path.clamping.variance.maxvalue": 0.0,
            "path.hybridbackward.enable": False,
        }

    def shape(self, name, shape):
        material = shape.material
        if getattr(shape, "radiance", None):
            material = f"{name}_lamp"
            lamp = {"type": "matte", "kd": [0.0, 0.0, 0.0], "emission": list(shape.radiance), "emission.theta": 90.0}
            self.scene.Parse(properties({f"scene.materials.{material}.{key}": value for key, value in lamp.items()}))
            c, u, v = (np.array(x) for x in (shape.center, shape.u, shape.v))
            quads = [[tuple(c - u / 2 - v / 2), tuple(c + u / 2 - v / 2), tuple(c + u / 2 + v / 2), tuple(c - u / 2 + v / 2)]]
        else:
            quads = shape.corners
        points = [tuple(map(float, p)) for quad in quads for p in quad]
        faces = [t for k in range(0, len(points), 4) for t in ((k, k + 1, k + 2), (k, k + 2, k + 3))]
        self.scene.DefineMesh(f"{name}_mesh", points, faces, None, None, None, None)
        self.scene.Parse(properties({f"scene.objects.{name}.shape": f"{name}_mesh", f"scene.objects.{name}.material": material}))

    def warm(self, spp):
        self.picture(1, 1)

    def picture(self, spp, seed):
        config = pyluxcore.RenderConfig(properties(self.config | {"batch.haltspp": spp, "renderengine.seed": seed}), self.scene)
        session = pyluxcore.RenderSession(config)
        session.Start()
        while not session.HasDone():
            time.sleep(0.01)
            session.UpdateStats()
        session.Stop()
        pixels = np.zeros((self.size, self.size, 3), dtype=np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0, True)
        samples = session.GetStats().Get("stats.renderengine.pass").GetInt()
        return pixels[::-1], samples


def properties(values):
    out = pyluxcore.Properties()
    for key, value in values.items():
        out.Set(pyluxcore.Property(key, value))
    return out


if __name__ == "__main__":
    peer.main(LuxCore)
    # LuxCore may crash as it unloads.
    sys.stdout.flush()
    os._exit(0)
