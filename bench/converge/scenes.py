"""The scenes, once, and their text for Kirkas (TOML) and for Mitsuba 3 (XML). Lengths in scene units, light in W/(m2 sr)."""

from dataclasses import dataclass, field
from math import cos, pi, sin
from pathlib import Path

import numpy as np


@dataclass
class Material:
    """`kind`: diffuse, metal, rough_metal, glass, rough_glass."""

    kind: str
    color: tuple = (0.5, 0.5, 0.5)
    roughness: float = 0.0
    ior: float = 1.5


@dataclass
class Sphere:
    center: tuple
    radius: float
    material: str
    radiance: tuple = None


@dataclass
class Rectangle:
    """Edges in full; the front is where u x v points."""

    center: tuple
    u: tuple
    v: tuple
    material: str
    radiance: tuple = None


@dataclass
class Quads:
    """Four corners each, counter-clockwise as seen from the front."""

    corners: list
    material: str


@dataclass
class Scene:
    position: tuple
    look_at: tuple
    fov: float
    materials: dict
    shapes: list
    depth: int = 8
    sky: tuple = None
    picture: str = None
    up: tuple = (0, 1, 0)
    size: int = 256
    extra: dict = field(default_factory=dict)


def box(low, high, turn, place):
    """The five visible sides of a block that stands on the floor, turned about y by `turn` degrees."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    c, s = cos(turn * pi / 180), sin(turn * pi / 180)
    at = lambda x, y, z: (place[0] + c * x + s * z, place[1] + y, place[2] - s * x + c * z)
    sides = [
        [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
        [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
        [(x1, y0, z1), (x1, y1, z1), (x0, y1, z1), (x0, y0, z1)],
        [(x0, y0, z1), (x0, y1, z1), (x0, y1, z0), (x0, y0, z0)],
    ]
    return [[at(*p) for p in side] for side in sides]


def cornell():
    """A room 2 units wide, after the Cornell box."""
    white, red, green = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)
    walls = [
        [(-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 0, -1)],
        [(-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)],
        [(-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)],
    ]
    left = [[(-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1)]]
    right = [[(1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)]]
    blocks = box((-0.3, 0, -0.3), (0.3, 0.6, 0.3), -17, (0.33, 0, 0.37)) + box((-0.3, 0, -0.3), (0.3, 1.2, 0.3), 17, (-0.33, 0, -0.29))
    return Scene(
        position=(0, 1, 3.9),
        look_at=(0, 1, 0),
        fov=39.3,
        materials={"white": Material("diffuse", white), "red": Material("diffuse", red), "green": Material("diffuse", green)},
        shapes=[
            Quads(walls + blocks, "white"),
            Quads(left, "red"),
            Quads(right, "green"),
            Rectangle((0, 1.99, 0), (0.5, 0, 0), (0, 0, 0.4), "white", (17, 12, 4)),
        ],
    )


def veach_mis():
    """Four plates from polished to dull mirror four balls of equal power from small to large (after Veach & Guibas 1995)."""
    materials = {"floor": Material("diffuse", (0.4, 0.4, 0.4))}
    shapes = [Rectangle((0, -4.2, 0), (0, 0, 60), (60, 0, 0), "floor"), Rectangle((0, 10, -12), (60, 0, 0), (0, 60, 0), "floor")]
    for i, (alpha, y, z, tilt) in enumerate([(0.01, 0.4, -6.0, 50), (0.03, -1.1, -3.2, 33), (0.08, -2.3, 0.2, 22), (0.18, -3.1, 4.0, 13)]):
        name = f"plate_{i}"
        materials[name] = Material("rough_metal", (0.8, 0.8, 0.8), roughness=alpha)
        c, s = cos(tilt * pi / 180), sin(tilt * pi / 180)
        shapes.append(Rectangle((0, y, z), (9, 0, 0), (0, 2.6 * s, -2.6 * c), name))
    for x, radius, radiance in [(-3.75, 0.05, 900.0), (-1.25, 0.15, 100.0), (1.25, 0.45, 11.1), (3.75, 1.0, 2.25)]:
        shapes.append(Sphere((x, 4.2, -4.5), radius, "floor", (radiance,) * 3))
    return Scene(position=(0, 2.2, 15), look_at=(0, -0.6, 0), fov=40, materials=materials, shapes=shapes)


def environment():
    """Balls of many kinds under a sky with a small sun."""
    kinds = {
        "floor": Material("diffuse", (0.45, 0.42, 0.4)),
        "clay": Material("diffuse", (0.7, 0.3, 0.2)),
        "metal": Material("rough_metal", (0.9, 0.7, 0.4), roughness=0.15),
        "glass": Material("glass"),
        "mirror": Material("metal", (0.9, 0.9, 0.9)),
    }
    balls = [Sphere((2.2 * i - 3.3, 1, 0), 1, name) for i, name in enumerate(["clay", "metal", "glass", "mirror"])]
    return Scene(
        position=(0, 3, 11),
        look_at=(0, 0.9, 0),
        fov=40,
        materials=kinds,
        shapes=balls + [Rectangle((0, 0, 0), (0, 0, 40), (40, 0, 0), "floor")],
        picture="sky.exr",
    )


def rough_glass():
    """Frosted balls before a coloured wall, under a lamp."""
    balls = [Sphere((-1.15, 1, 0), 1, "fine"), Sphere((1.15, 1, 0), 1, "coarse")]
    return Scene(
        position=(0, 2.2, 8),
        look_at=(0, 1, 0),
        fov=34,
        materials={
            "floor": Material("diffuse", (0.6, 0.6, 0.6)),
            "wall": Material("diffuse", (0.2, 0.35, 0.6)),
            "fine": Material("rough_glass", roughness=0.1),
            "coarse": Material("rough_glass", roughness=0.3),
        },
        shapes=balls
        + [
            Rectangle((0, 0, 0), (0, 0, 30), (30, 0, 0), "floor"),
            Rectangle((0, 5, -4), (30, 0, 0), (0, 10, 0), "wall"),
            Rectangle((0, 6, 1), (3, 0, 0), (0, 0, 3), "floor", (8, 8, 8)),
        ],
        sky=(0.2, 0.2, 0.2),
        depth=16,
    )


SCENES = {"cornell": cornell, "veach_mis": veach_mis, "environment": environment, "rough_glass": rough_glass}


def sky_picture():
    """A clear sky over brown ground, with a sun of 3 degrees, latitude by longitude: rows from the zenith down. Large, since renderers
    differ by half a texel in where they put the texels' centres, which at 256 rows makes the sun 0.5 % larger or smaller."""
    height, width = 1024, 2048
    theta = (np.arange(height) + 0.5)[:, None] * pi / height
    phi = (np.arange(width) + 0.5)[None, :] * 2 * pi / width
    up = np.cos(theta) * np.ones_like(phi)
    sky = np.where(up[..., None] > 0, 0.4 + 0.6 * np.exp(-3 * np.maximum(up, 0))[..., None] * np.array([0.6, 0.8, 1.0]), [0.12, 0.1, 0.08])
    toward = (cos(0.9), 3.6)
    dot = np.cos(theta) * toward[0] + np.sin(theta) * sin(0.9) * np.cos(phi - toward[1])
    return np.where(dot[..., None] > cos(3 * pi / 180), [900.0, 800.0, 600.0], sky).astype(np.float32)


def kirkas(s: Scene, folder: Path, name: str):
    """Write `name.toml`."""
    rgb = lambda c: "[" + ", ".join(repr(float(x)) for x in c) + "]"
    out = [f'[film]\nwidth = {s.size}\nheight = {s.size}\nfilter = "box"\n', f'[integrator]\ntype = "path"\nmax_depth = {s.depth}\n']
    out.append(f'[cameras.main]\ntype = "perspective"\nposition = {rgb(s.position)}\nlook_at = {rgb(s.look_at)}\nfov = {s.fov}\n')
    if s.sky:
        out.append(f'[background]\ntype = "constant"\ncolor = {rgb(s.sky)}\n')
    if s.picture:
        out.append(f'[background]\ntype = "image"\nfile = "{s.picture}"\n')
    words = {"diffuse": "lambert", "metal": "mirror", "rough_metal": "rough_mirror", "glass": "dielectric", "rough_glass": "rough_dielectric"}
    for key, m in s.materials.items():
        out.append(f'[materials.{key}]\ntype = "{words[m.kind]}"')
        if m.kind in ("diffuse", "metal", "rough_metal"):
            out.append(f"reflectance = {rgb(m.color)}")
        if m.roughness:
            out.append(f"roughness = {m.roughness}")
        if "glass" in m.kind:
            out.append(f"ior = {m.ior}")
        out.append("")
    for i, shape in enumerate(s.shapes):
        material = shape.material
        if getattr(shape, "radiance", None):
            material = f"lamp_{i}"
            out.append(f'[materials.{material}]\ntype = "emitter"\nradiance = {rgb(shape.radiance)}\n')
        out.append(f'[objects.shape_{i}]\nmaterial = "{material}"')
        if isinstance(shape, Sphere):
            out.append(f'type = "sphere"\ncenter = {rgb(shape.center)}\nradius = {shape.radius}\n')
        elif isinstance(shape, Rectangle):
            out.append(f'type = "rectangle"\ncenter = {rgb(shape.center)}\nedge_u = {rgb(shape.u)}\nedge_v = {rgb(shape.v)}\n')
        else:
            points = ", ".join(rgb(p) for quad in shape.corners for p in quad)
            faces = ", ".join(f"{4*k}, {4*k+1}, {4*k+2}, {4*k}, {4*k+2}, {4*k+3}" for k in range(len(shape.corners)))
            out.append(f'type = "mesh"\nvertices = [{points}]\nfaces = [{faces}]\n')
    (folder / f"{name}.toml").write_text("\n".join(out))


def mitsuba(s: Scene, folder: Path, name: str):
    """Write `name.xml`, and the meshes that it names."""
    rgb = lambda c: ", ".join(repr(float(x)) for x in c)
    out = ['<scene version="3.0.0">', f'<integrator type="path"><integer name="max_depth" value="{s.depth + 1}"/></integrator>']
    look = f'<lookat origin="{rgb(s.position)}" target="{rgb(s.look_at)}" up="{rgb(s.up)}"/>'
    film = f'<film type="hdrfilm"><integer name="width" value="{s.size}"/><integer name="height" value="{s.size}"/><rfilter type="box"/></film>'
    sensor = f'<transform name="to_world">{look}</transform><float name="fov" value="{s.fov}"/>{film}'
    out.append(f'<sensor type="perspective">{sensor}<sampler type="independent"/></sensor>')
    if s.sky:
        out.append(f'<emitter type="constant"><rgb name="radiance" value="{rgb(s.sky)}"/></emitter>')
    if s.picture:
        out.append(f'<emitter type="envmap"><string name="filename" value="{s.picture}"/></emitter>')
    for key, m in s.materials.items():
        alpha = f'<float name="alpha" value="{m.roughness}"/><string name="distribution" value="ggx"/>'
        ior = f'<float name="int_ior" value="{m.ior}"/><float name="ext_ior" value="1"/>'
        metal = f'<string name="material" value="none"/><rgb name="specular_reflectance" value="{rgb(m.color)}"/>'
        inner = {
            "diffuse": f'<bsdf type="diffuse"><rgb name="reflectance" value="{rgb(m.color)}"/></bsdf>',
            "metal": f'<bsdf type="conductor">{metal}</bsdf>',
            "rough_metal": f'<bsdf type="roughconductor">{metal}{alpha}</bsdf>',
        }
        glass = {"glass": f'<bsdf type="dielectric" id="{key}">{ior}</bsdf>', "rough_glass": f'<bsdf type="roughdielectric" id="{key}">{ior}{alpha}</bsdf>'}
        out.append(glass.get(m.kind) or f'<bsdf type="twosided" id="{key}">{inner[m.kind]}</bsdf>')
    for i, shape in enumerate(s.shapes):
        inner = f'<ref id="{shape.material}"/>'
        if getattr(shape, "radiance", None):
            inner = f'<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf><emitter type="area"><rgb name="radiance" value="{rgb(shape.radiance)}"/></emitter>'
        if isinstance(shape, Sphere):
            out.append(f'<shape type="sphere"><point name="center" value="{rgb(shape.center)}"/><float name="radius" value="{shape.radius}"/>{inner}</shape>')
        elif isinstance(shape, Rectangle):
            u, v = np.array(shape.u) / 2, np.array(shape.v) / 2
            n = np.cross(u, v)
            n = n / np.linalg.norm(n)
            m = np.vstack([np.column_stack([u, v, n, shape.center]), [0, 0, 0, 1]])
            matrix = " ".join(repr(float(x)) for x in m.flatten())
            out.append(f'<shape type="rectangle"><transform name="to_world"><matrix value="{matrix}"/></transform>{inner}</shape>')
        else:
            file = f"{name}_{i}.obj"
            lines = [f"v {' '.join(map(repr, map(float, p)))}" for quad in shape.corners for p in quad]
            for k in range(len(shape.corners)):
                lines += [f"f {4*k+1} {4*k+2} {4*k+3}", f"f {4*k+1} {4*k+3} {4*k+4}"]
            (folder / file).write_text("\n".join(lines) + "\n")
            out.append(f'<shape type="obj"><string name="filename" value="{file}"/><boolean name="face_normals" value="true"/>{inner}</shape>')
    out.append("</scene>")
    (folder / f"{name}.xml").write_text("\n".join(out))
