"""Cycles, as the Python module `bpy`: see `peer.py`. Diffuse surfaces and rectangular lamps alone."""

from math import pi, radians
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy  # before NumPy, which it brings
import numpy as np
from mathutils import Matrix, Vector

import peer
import scenes


class Cycles:
    def __init__(self, _, folder, scene, size, sampler):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        s, self.scene, self.size = scenes.SCENES[scene](), bpy.context.scene, size
        self.settings(s, size, sampler)
        self.camera(s)
        surfaces = {key: diffuse(key, m.color) for key, m in s.materials.items()}
        for shape in s.shapes:
            if getattr(shape, "radiance", None):
                self.link(lamp(shape))
                self.link(mesh([behind(shape)], diffuse("black", (0, 0, 0))))
            else:
                self.link(mesh(shape.corners, surfaces[shape.material]))

    def settings(self, s, size, sampler):
        render, cycles = self.scene.render, self.scene.cycles
        render.engine = "CYCLES"
        render.resolution_x = render.resolution_y = size
        render.resolution_percentage = 100
        render.threads_mode, render.threads = "FIXED", 2
        render.use_persistent_data = True
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        self.scene.view_settings.view_transform = "Raw"
        cycles.device, cycles.pixel_filter_type, cycles.sampling_pattern = "CPU", "BOX", sampler
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
        # Cycles counts neither the segment from the eye nor that to the lamp.
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = s.depth - 1
        self.scene.world = None

    def camera(self, s):
        camera = bpy.data.cameras.new("camera")
        camera.angle = radians(s.fov)
        placed = bpy.data.objects.new("camera", camera)
        way = Vector(s.look_at) - Vector(s.position)
        # Looks along -z with y up, as the scene's own axes are used here as they are.
        z = -way.normalized()
        x = Vector(s.up).cross(z).normalized()
        placed.matrix_world = Matrix.Translation(s.position) @ Matrix((x, z.cross(x), z)).transposed().to_4x4()
        self.link(placed)
        self.scene.camera = placed

    def link(self, placed):
        self.scene.collection.objects.link(placed)

    def warm(self, spp):
        self.picture(1, 0)

    def picture(self, spp, seed):
        self.scene.cycles.samples, self.scene.cycles.seed = spp, seed
        with TemporaryDirectory() as folder:
            self.scene.render.filepath = str(Path(folder) / "picture.exr")
            bpy.ops.render.render(write_still=True)
            image = bpy.data.images.load(self.scene.render.filepath)
            image.colorspace_settings.name = "Non-Color"
            pixels = np.array(image.pixels[:], dtype=np.float32).reshape(self.size, self.size, -1)[::-1]
            bpy.data.images.remove(image)
        return pixels, spp


def diffuse(name, color):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (*color, 1)
    links.new(surface.outputs["BSDF"], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def mesh(quads, material):
    data = bpy.data.meshes.new("mesh")
    data.from_pydata([p for quad in quads for p in quad], [], [tuple(range(4 * k, 4 * k + 4)) for k in range(len(quads))])
    data.materials.append(material)
    return bpy.data.objects.new("mesh", data)


def lamp(shape):
    """An area lamp, seen by the camera; it shines along its -z with a power of pi x area x radiance."""
    u, v = Vector(shape.u), Vector(shape.v)
    light = bpy.data.lights.new("lamp", "AREA")
    light.shape, light.size, light.size_y = "RECTANGLE", u.length, v.length
    strength = max(shape.radiance)
    light.color = [c / strength for c in shape.radiance]
    light.energy = pi * u.length * v.length * strength
    placed = bpy.data.objects.new("lamp", light)
    front = u.cross(v).normalized()
    axes = Matrix((u.normalized(), -v.normalized(), -front)).transposed().to_4x4()
    placed.matrix_world = Matrix.Translation(shape.center) @ axes
    placed.visible_camera = True
    return placed


def behind(shape):
    """A lamp lets rays through, as if it were not there: what stops them is a quad close behind it."""
    u, v = Vector(shape.u) / 2, Vector(shape.v) / 2
    center = Vector(shape.center) - 1e-4 * u.cross(v).normalized()
    return [center - u - v, center + u - v, center + u + v, center - u + v]


if __name__ == "__main__":
    peer.main(Cycles)
