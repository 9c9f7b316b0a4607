"""The scenes, once, for all renderers: `text_kirkas.py` and `text_mitsuba.py` write them down, `peer_cycles.py` and `peer_luxcore.py` build
them. Lengths in scene units, radiance in W/(m2 sr), media per scene unit."""

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np


@dataclass
class Material:
    """`kind`: diffuse, metal, rough_metal, glass, rough_glass, or hull: no surface, but filled with a grey medium that scatters evenly."""

    kind: str
    color: tuple = (0.5, 0.5, 0.5)
    roughness: float = 0.0
    ior: float = 1.5
    scattering: float = 0.0
    absorption: float = 0.0


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


def box(low, high, turn, place):
    """The sides of a block turned about y by `turn` degrees, the underside last."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    c, s = cos(turn * pi / 180), sin(turn * pi / 180)
    at = lambda x, y, z: (place[0] + c * x + s * z, place[1] + y, place[2] - s * x + c * z)
    sides = [
        [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
        [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
        [(x1, y0, z1), (x1, y1, z1), (x0, y1, z1), (x0, y0, z1)],
        [(x0, y0, z1), (x0, y1, z1), (x0, y1, z0), (x0, y0, z0)],
        [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
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
    blocks = box((-0.3, 0, -0.3), (0.3, 0.6, 0.3), -17, (0.33, 0, 0.37))[:5] + box((-0.3, 0, -0.3), (0.3, 1.2, 0.3), 17, (-0.33, 0, -0.29))[:5]
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
        fov=46,
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


def fog():
    """A block of fog about a lamp, balls and a post, seen from without."""
    return Scene(
        position=(0, 2.2, 9),
        look_at=(0, 1.5, 0),
        fov=36,
        materials={
            "floor": Material("diffuse", (0.5, 0.48, 0.45)),
            "wall": Material("diffuse", (0.3, 0.4, 0.6)),
            "clay": Material("diffuse", (0.7, 0.3, 0.2)),
            "metal": Material("rough_metal", (0.9, 0.7, 0.4), roughness=0.2),
            "fog": Material("hull", scattering=0.2, absorption=0.02),
        },
        shapes=[
            Quads(box((-2.5, 0.02, -2), (2.5, 3.6, 2), 0, (0, 0, 0)), "fog"),
            Sphere((-1.2, 0.8, 0.3), 0.7, "clay"),
            Sphere((1.1, 0.8, 0.6), 0.7, "metal"),
            Quads(box((-0.2, 0.1, -0.2), (0.2, 2.2, 0.2), 30, (0, 0, -0.9)), "clay"),
            Rectangle((0, 3.3, 0.2), (1.6, 0, 0), (0, 0, 1.6), "floor", (4, 3.6, 3)),
            Rectangle((0, 0, 0), (0, 0, 30), (30, 0, 0), "floor"),
            Rectangle((0, 5, -4), (30, 0, 0), (0, 10, 0), "wall"),
        ],
        sky=(0.1, 0.12, 0.15),
        depth=16,
    )


SCENES = {"cornell": cornell, "veach_mis": veach_mis, "environment": environment, "rough_glass": rough_glass, "fog": fog}


def sky_picture():
    """A clear sky over brown ground, with a sun of 8 degrees, latitude by longitude: rows from the zenith down. Large, since renderers
    differ by half a texel in where they put the texels' centres, which at 256 rows makes the sun 0.5 % larger or smaller."""
    height, width = 1024, 2048
    theta = (np.arange(height) + 0.5)[:, None] * pi / height
    phi = (np.arange(width) + 0.5)[None, :] * 2 * pi / width
    up = np.cos(theta) * np.ones_like(phi)
    sky = np.where(up[..., None] > 0, 0.4 + 0.6 * np.exp(-3 * np.maximum(up, 0))[..., None] * np.array([0.6, 0.8, 1.0]), [0.12, 0.1, 0.08])
    toward = (cos(0.9), 3.6)
    dot = np.cos(theta) * toward[0] + np.sin(theta) * sin(0.9) * np.cos(phi - toward[1])
    return np.where(dot[..., None] > cos(8 * pi / 180), [125.0, 111.0, 83.0], sky).astype(np.float32)
