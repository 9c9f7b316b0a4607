"""A scene as Mitsuba 3 reads it."""

from pathlib import Path

import numpy as np

from scenes import Rectangle, Scene, Sphere


def write(s: Scene, folder: Path, name: str):
    """Write `name.xml`, and the meshes that it names."""
    rgb = lambda c: ", ".join(repr(float(x)) for x in c)
    # Mitsuba counts the segments of a path, Kirkas its bounces; neither counts the passing of a hull.
    integrator = "volpath" if any(m.kind == "hull" for m in s.materials.values()) else "path"
    out = ['<scene version="3.0.0">', '<default name="sampler" value="independent"/>']
    out.append(f'<integrator type="{integrator}"><integer name="max_depth" value="{s.depth + 1}"/></integrator>')
    look = f'<lookat origin="{rgb(s.position)}" target="{rgb(s.look_at)}" up="{rgb(s.up)}"/>'
    film = f'<film type="hdrfilm"><integer name="width" value="{s.size}"/><integer name="height" value="{s.size}"/><rfilter type="box"/></film>'
    sensor = f'<transform name="to_world">{look}</transform><float name="fov" value="{s.fov}"/>{film}'
    out.append(f'<sensor type="perspective">{sensor}<sampler type="$sampler"/></sensor>')
    if s.sky:
        out.append(f'<emitter type="constant"><rgb name="radiance" value="{rgb(s.sky)}"/></emitter>')
    if s.picture:
        out.append(f'<emitter type="envmap"><string name="filename" value="{s.picture}"/></emitter>')
    for key, m in s.materials.items():
        if m.kind == "hull":
            total = m.scattering + m.absorption
            out.append(f'<bsdf type="null" id="{key}"/><medium type="homogeneous" id="{key}_medium">')
            out.append(f'<rgb name="sigma_t" value="{total}"/><rgb name="albedo" value="{m.scattering / total}"/></medium>')
            continue
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
        if s.materials[shape.material].kind == "hull":
            inner += f'<ref name="interior" id="{shape.material}_medium"/>'
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
