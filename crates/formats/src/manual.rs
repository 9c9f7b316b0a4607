//! The reference page of all types and parameters, cut from the catalogue's tables.

use kirkas_scene::{Catalog, Fallback, Kind, ParamSpec, ParamType};

/// What the tables cannot say.
const SCENES: &str = r##"
## A scene

A scene is a TOML file. Kinds of which there is one are written `[film]`, `[sampler]`, `[integrator]`, `[accelerator]`,
`[background]`; all others have names, and refer to each other by them.

```toml
title = "A red ball"            # optional, like `description` and `version = 1`
include = ["materials.toml"]    # optional; what stands here wins, single kinds key by key

[film]
width = 320
height = 240

[cameras.main]
type = "perspective"
position = [0, 1, 5]
look_at = [0, 0.5, 0]

[lights.lamp]
type = "point"
position = [2, 4, 3]
intensity = 20

[textures.squares]
type = "checker"
a = "#203040"
b = 0.8

[materials.tiles]
type = "lambert"
reflectance = "squares"         # a colour, or the name of a texture

[materials.red]
type = "lambert"
reflectance = [0.8, 0.2, 0.1]

[materials.panel]
type = "emitter"                # an area light is any shape that wears an emitter
radiance = [1, 0.9, 0.8]
intensity = 4

[objects.floor]
type = "plane"
material = "tiles"

[objects.ball]
type = "sphere"
center = [0, 0.5, 0]
radius = 0.5
material = "red"

[objects.lamp]
type = "rectangle"
center = [-2, 3, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, 1]
material = "panel"
```

Files (`file = "mesh.ply"`) are found beside the file that names them and may not lie outside the scene's folder; `--root DIR`
widens that. Any value can be set from the command line: `-D lights.lamp.intensity=2`, `-D film.width=80`,
`-D 'cameras.main.position=[0, 0, 5]'`; options such as `--size` have the last word.

## Transforms and motion

`transform` is a list of steps, applied to the object in written order, after its own parameters and before its parent's:

```toml
transform = [{ scale = 2 }, { rotate = [0, 1, 0, 45] }, { translate = [1, 0, 0] }]
```

Steps: `{ translate = [x, y, z] }`, `{ rotate = [ax, ay, az, degrees] }` about an axis through the origin, `{ scale = s }` or
`{ scale = [x, y, z] }`, `{ look_at = { from = [..], to = [..], up = [..] } }`, `{ matrix = [12 or 16 numbers by rows] }`.

`motion` is a list of key frames; between them translation and stretch go straight and rotation turns evenly. It needs a camera
whose `shutter` is open for a while, or `--time`, or `--frames`:

```toml
motion = [{ time = 0, transform = [] }, { time = 1, transform = [{ rotate = [0, 0, 1, 90] }] }]
```

## Make a film

`--frames A..B` renders the frames from A up to, not including, B. Frame n opens the shutter at n divided by
`film.frames_per_second`, for as long as the camera's `shutter` is open: a film camera's usual half of each frame is
`shutter = [0, 0.0208]` at 24 frames per second, and `shutter = [0, 0]` gives sharp moments. One second of the lecture's windmill:

```sh
kirkas render scenes/lecture/motion_blur.toml --frames 0..24 -D 'cameras.main.shutter=[0, 0.0208]' -o mill.png
ffmpeg -framerate 24 -i mill.%04d.png -pix_fmt yuv420p mill.mp4
```

Every file of a frame has its number before the extension, `mill.0007.png`, or in place of a run of `#` in its name:
`-o mill_##.exr` gives `mill_07.exr`. All frames of a run get as many digits as its last one needs. Pictures, their layers,
`--stats` and `--checkpoint` are numbered alike.

A frame is the same picture, bit for bit, whether it is rendered alone, in a film or on another machine, so a film can be cut
into pieces: `--frames 0..12` here and `--frames 12..24` there. The frame's number goes into the numbers of its samples: noise
does not stand still on the screen, and a scene without motion still has other noise in every frame (but the same as ever in
each). With `--resume` frames are left as they are whose pictures are there, finished, and made of the same scene with the same
settings; others are rendered. Ctrl-C ends the film after the running pass; that frame has fewer samples, says so in its header,
and is rendered again on `--resume`.

## Sample until it is good enough

`--error E` (or `sampler.error`) gives each part of the image as many samples as it needs, and at most `--spp`:

```sh
kirkas render scene.toml --error 0.02 --aov sample_count -o out.exr -o out.png
```

Decisions fall on blocks of 8x8 pixels when they have 64, 128, 256, ... samples (`sampler.min_samples` says where to begin). The
error of a block is the root mean square, over its pixels and channels, of the standard error of the pixel's mean, over the mean
value of the block, or over a sixteenth of the image's mean if that is greater. A block stops when it and its eight neighbours are
below E. So E = 0.02 means that the noise of a pixel is typically 2 % of the brightness around it; half of E takes four times as
many samples. The decisions are computed from the film's integers, so threads, `--checkpoint` and `--resume` change no bit; but they
look at the whole image and at all samples so far, so `--crop`, `--samples` and the adding of parts are refused. The layer
`sample_count` shows where the samples went. What did not reach E is said at the end and in `--stats`.

The samples that decide are also those that are shown, and that has a price: where none has found a light yet, nothing tells that
it is there. Measured with independent samples, with twice the standard error (`cargo xtask bias` measures it anew):

| light found by | where | E | `min_samples` | seeds | bias |
|---|---|---|---|---|---|
| 1 sample in 100 | one pixel | 0.05 | 64 | 1000 | -27.8 % +- 1.6 % |
| 1 sample in 500 | one pixel | 0.05 | 64 | 1000 | -43.7 % +- 1.2 % |
| 1 sample in 500 | one pixel | 0.05 | 1024 | 50 | -10 % +- 7 % |
| 1 sample in 500 | all pixels | 0.3 | 64 | 50 | -0.1 % +- 0.4 % |

The mean of a pixel is off by that much on the average. Smooth light, and rare light that falls on many pixels (caustics, small
lamps), are not touched; a single bright pixel in still surroundings is. Raise `min_samples` or give a plain `--spp` where that
matters. The bias vanishes as E goes to 0.

`film.clamp` cuts off what a single contribution brings (fireflies). It is off by default, darkens the picture, and says so on
stderr, in the file's header and in `--stats`.

## Mix lights after rendering

With `--light-groups` (or `film.light_groups`) an EXR keeps one layer for each light, or for those that share a `group`; the layers
add up to the picture. `relight` then changes their brightness and colour without a ray:

```sh
kirkas render scene.toml --light-groups --samples 0..256 -o lights.exr
kirkas relight lights.exr lamp=2 background=0.5 -o evening.png
kirkas relight lights.exr lamp=1,#ffb070 background=0 -o lamp_alone.exr
```

In the integers that `--samples` and `--checkpoint` keep, groups add up exactly, a factor of 1 changes no bit, and a factor that is
a power of two gives the picture that would have been rendered, to the bit, if the lights' brightness decides nothing in the
render (in `whitted`). From layers of floats each number is rounded to 32 bits before it is added: off by 2^-24 of each layer.

## Keep the spectrum

With `--color spectral --spectral-bins N` (or `film.spectral_bins`) an EXR also keeps the spectrum of every pixel, as N layers beside
the usual `R`, `G`, `B`:

```sh
kirkas render scene.toml --color spectral --spectral-bins 40 -o spectra.exr          # 380 to 780 nm, 10 nm each
kirkas render scene.toml --color spectral --spectral-bins 30:400..700 -o spectra.exr
```

The layers are those of Fichet, Pacanowski & Wilkie ("An OpenEXR Layout for Spectral Images", JCGT 10(3), 2021): `S0.585,00nm` is
the bin whose middle is 585 nm, `spectralLayoutVersion` is `1.0` and `emissiveUnits` is `W.m^-2.sr^-1`. Each number is the mean
spectral radiance over its bin, *per nm*: times the width of a bin it is the radiance in the bin. Bins times the CIE observer give
the colour of the pixel. Where lights are given in lm, cd, lux or nit the unit is W/(m2 sr nm). Otherwise it is that of the scene: a
film value of 1 stands for a luminance of 683 cd/m2, that is, for 1 W/(m2 sr) as y-bar weighs it.

Wavelengths are then drawn half evenly, so that faint ends of the spectrum are known, too: another picture than without bins, but for
noise the same. Each path carries four wavelengths, so a bin sees about 4 / N of the samples: narrow bins want many. Bins are integers
until they are written, like all light: threads, parts, checkpoints and resumes change no bit. They hold the light of all groups,
so `relight` leaves them out.

## Remove the noise

`--denoise` runs Open Image Denoise over PNG and HDR pictures, with the albedo and normals of the first hits as guides, if the
library is installed (or `KIRKAS_OIDN` names it). The noisy picture stays: `out.noisy.png` beside `out.png`; in an EXR `R`, `G`,
`B` are the noisy picture and the layer `denoised` is the other. A denoised picture is a good guess, not a measurement, and may differ
between processors and versions of the library.
"##;

/// The page as Markdown.
pub fn markdown(catalog: &Catalog) -> String {
    let mut out = String::from(
        "# Types and parameters\n\n\
         Cut from the tables in the program; do not edit. Colours are linear Rec.709 `[r, g, b]`, one number for grey, or\n\
         `\"#rrggbb\"` in sRGB. Angles are in degrees. Transforms apply in written order.\n",
    );
    out += SCENES;
    for kind in Kind::ALL {
        out += &format!("\n## {}\n\n{}\n", kind.section(), heading(kind));
        for spec in catalog.of_kind(kind) {
            out += &format!("\n### {} `{}`\n\n{}\n", kind.singular(), spec.name, spec.doc);
            table(&mut out, spec.params);
        }
        let common = catalog.common(kind);
        if !common.is_empty() {
            out += &format!("\n### Every {}\n", kind.singular());
            table(&mut out, common);
        }
    }
    out
}

fn heading(kind: Kind) -> String {
    let section = kind.section();
    match kind.default_type() {
        Some(default) => {
            format!("One for a scene, written `[{section}]`; where no `type` is written, it is `{default}`.")
        }
        None => format!("Written `[{section}.NAME]` with `type = \"...\"`."),
    }
}

fn table(out: &mut String, rows: &[ParamSpec]) {
    if rows.is_empty() {
        return;
    }
    *out += "\n| parameter | takes | default | |\n|---|---|---|---|\n";
    for row in rows {
        let unit = if row.unit.is_empty() { String::new() } else { format!(", {}", row.unit) };
        let cells = [
            format!("`{}`", row.name),
            format!("{}{unit}{}", takes(row.ty), range(row)),
            fallback(row),
            row.doc.into(),
        ];
        *out += &format!("| {} |\n", cells.map(|c| c.replace('|', "\\|")).join(" | "));
    }
}

fn takes(ty: ParamType) -> String {
    match ty {
        ParamType::Bool => "true or false".into(),
        ParamType::Integer => "whole number".into(),
        ParamType::Number => "number".into(),
        ParamType::Text => "text".into(),
        ParamType::Choice(words) => words.iter().map(|w| format!("`\"{w}\"`")).collect::<Vec<_>>().join(", "),
        ParamType::Vector2 => "`[x, y]`".into(),
        ParamType::Vector => "`[x, y, z]`".into(),
        ParamType::Color => "colour".into(),
        ParamType::Index => "number or table".into(),
        ParamType::ColorTexture => "colour or texture".into(),
        ParamType::NumberTexture => "number or texture".into(),
        ParamType::VectorTexture => "`[x, y, z]` or texture".into(),
        ParamType::Reference(kind) => format!("name of {}", article(kind.singular())),
        ParamType::References(kind) => format!("list of names of {}", kind.section()),
        ParamType::Path => "path".into(),
        ParamType::Transform => "transform".into(),
        ParamType::Motion => "key frames".into(),
        ParamType::Numbers => "list of numbers".into(),
        ParamType::Vectors => "list of `[x, y, z]`".into(),
        ParamType::Gradient => "list of `[position, colour]`".into(),
    }
}

fn article(noun: &str) -> String {
    let article = if noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} {noun}")
}

fn range(row: &ParamSpec) -> String {
    match row.range {
        (low, high) if low == f64::MIN_POSITIVE && high == f64::INFINITY => ", above 0".into(),
        (low, high) if low.is_finite() && high == f64::INFINITY => format!(", {low} or more"),
        (low, high) if low.is_finite() && high.is_finite() => format!(", {low} to {high}"),
        (_, high) if high.is_finite() => format!(", {high} or less"),
        _ => String::new(),
    }
}

fn fallback(row: &ParamSpec) -> String {
    match row.fallback {
        Fallback::Required => "required".into(),
        Fallback::Absent => "none".into(),
        Fallback::Bool(b) => format!("`{b}`"),
        Fallback::Number(n) => format!("`{n}`"),
        Fallback::Text(t) => format!("`\"{t}\"`"),
        Fallback::Vector2(v) => format!("`{}`", list(&v)),
        Fallback::Vector(v) => format!("`{}`", list(&v)),
    }
}

fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(f64::to_string).collect::<Vec<_>>().join(", "))
}
