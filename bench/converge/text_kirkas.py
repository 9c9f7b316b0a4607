"""A scene as Kirkas reads it."""

from pathlib import Path

from scenes import Rectangle, Scene, Sphere


def write(s: Scene, folder: Path, name: str):
    """Write `name.toml`."""
    rgb = lambda c: "[" + ", ".join(repr(float(x)) for x in c) + "]"
    out = [f'[film]\nwidth = {s.size}\nheight = {s.size}\nfilter = "box"\n', f'[integrator]\ntype = "path"\nmax_depth = {s.depth}\n']
    out.append(f'[cameras.main]\ntype = "perspective"\nposition = {rgb(s.position)}\nlook_at = {rgb(s.look_at)}\nfov = {s.fov}\n')
    if s.sky:
        out.append(f'[background]\ntype = "constant"\ncolor = {rgb(s.sky)}\n')
    if s.picture:
        out.append(f'[background]\ntype = "image"\nfile = "{s.picture}"\n')
    words = {"diffuse": "lambert", "metal": "mirror", "rough_metal": "rough_mirror", "glass": "dielectric", "rough_glass": "rough_dielectric", "hull": "hull"}
    for key, m in s.materials.items():
        out.append(f'[materials.{key}]\ntype = "{words[m.kind]}"')
        if m.kind in ("diffuse", "metal", "rough_metal"):
            out.append(f"reflectance = {rgb(m.color)}")
        if m.roughness:
            out.append(f"roughness = {m.roughness}")
        if "glass" in m.kind:
            out.append(f"ior = {m.ior}")
        if m.kind == "hull":
            out.append(f'interior = "{key}"\n\n[media.{key}]\ntype = "homogeneous"')
            out.append(f"scattering = {m.scattering}\nabsorption = {m.absorption}")
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
