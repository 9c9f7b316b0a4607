//! `kirkas relight`: other brightness and colours for the lights of a picture, without a ray.

use crate::header::{Header, command_line};
use crate::input::read_file;
use crate::light_mix::{LightMix, parse};
use crate::output::{PictureFile, PictureFormat, check_no_loss, check_writable, true_place, write_atomically};
use crate::parts::EXR;
use crate::pictures::codes;
use crate::problem::{Outcome, Problem};
use crate::report;
use kirkas_images::{ChannelData, ExrCompression, Image, ImageError, read_exr, write_exr, write_hdr, write_png8};
use kirkas_render::film::image::{Depth, layer_names};
use kirkas_render::film::part::{PartError, read_part};
use kirkas_render::film::spectral::is_bin_layer;
use kirkas_scene::Diagnostic;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Examples:
  kirkas render scene.toml --light-groups --samples 0..256 -o lights.exr
  kirkas relight lights.exr lamp=2 sky=0.5 -o evening.png
  kirkas relight lights.exr lamp=1,#ffb070 sky=0 -o lamp_alone.exr -o lamp_alone.png
  kirkas relight lights.exr key=1.5,1,0.9,0.8 -o warmer.exr

Groups that are not named stay as they are. A colour multiplies the light: R,G,B (linear) or #RRGGBB (sRGB).
Where the EXR keeps its integers (render --samples or --checkpoint, merge), each group's sum is multiplied in them and
rounded once, to 2^-64; otherwise the 32-bit layers are added, and each is off by its own rounding, 2^-24 of it.";

/// Mix the lights of a picture anew, without tracing a ray
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Relight {
    /// EXR with a layer for each light, as `render --light-groups` writes it
    #[arg(value_name = "IN.exr")]
    input: PathBuf,
    /// Light, or group of lights, what its brightness is multiplied by, and a colour
    #[arg(required = true, value_name = "NAME=SCALE[,COLOUR]")]
    mix: Vec<String>,
    /// Picture to write: .exr, .png or .hdr; may be given several times
    #[arg(short, long, required = true, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// EXR in 16 bits instead of 32
    #[arg(long)]
    half: bool,
    /// Brightness of PNG pictures in stops [default: the picture's own]
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true)]
    exposure: Option<f32>,
}

/// Do it.
pub fn run(args: &Relight) -> Result<Outcome, Problem> {
    // What can be refused before any work.
    let files = args.output.iter().map(|p| PictureFile::new(p)).collect::<Result<Vec<_>, _>>()?;
    files.iter().try_for_each(|f| check_writable(&f.path))?;
    check_no_loss(files.iter().map(|f| f.path.as_path()), &[true_place(&args.input)])?;

    // Mix.
    let image = read_image(&args.input)?;
    let groups = groups_of(&image);
    if groups.is_empty() {
        let message = format!("`{}` has no light groups", args.input.display());
        let help = "render it again with --light-groups";
        return Err(Problem::input(Diagnostic::error("no-light-groups", message).help(help)));
    }
    let mix = parse(&args.mix, &groups)?;
    let mut header = Header::of_image(&image);
    if !header.get("clamp").is_empty() {
        report::note("kirkas: the picture was clamped, and what was cut off does not come back with less light");
    }
    let depth = if args.half { Depth::Half } else { Depth::Float };
    let mut mixed = relit(image, &mix, depth)
        .map_err(|e| Problem::input(Diagnostic::error("not-a-part", format!("`{}`: {e}", args.input.display()))))?;

    // Write.
    let before = header.get("relight").to_string();
    header.set("relight", [before, args.mix.join(" ")].join("\n").trim());
    header.set("argv", command_line());
    if let Some(stops) = args.exposure {
        header.set("exposure", stops.to_string());
    }
    mixed.attributes.clear();
    header.write_to(&mut mixed);
    for file in &files {
        let fail = |e: ImageError| {
            Problem::failed(Diagnostic::error("cannot-write", format!("`{}`: {e}", file.path.display())))
        };
        let rgb = mixed.rgb().unwrap_or_default();
        let exposure = header.get("exposure").parse().unwrap_or(0.0);
        let bytes = match file.format {
            PictureFormat::Png => {
                write_png8(rgb.width, rgb.height, &codes(&rgb, header.get("tone"), exposure), &header.texts())
            }
            PictureFormat::Hdr => write_hdr(&rgb, &header.texts()),
            PictureFormat::Exr => write_exr(&mixed, ExrCompression::Zip),
        };
        write_atomically(&file.path, &bytes.map_err(fail)?)?;
    }
    Ok(Outcome::Done)
}

fn read_image(path: &Path) -> Result<Image, Problem> {
    let bytes = read_file(path)?;
    let bad = |why: String| {
        let help = "give an EXR that `kirkas render --light-groups` wrote";
        Problem::input(Diagnostic::error("not-a-picture", format!("`{}`: {why}", path.display())).help(help))
    };
    if !bytes.starts_with(&EXR) {
        return Err(bad("it is not an EXR picture, and no other keeps light groups".into()));
    }
    read_exr(&bytes).map_err(|e| bad(e.to_string()))
}

/// Names of the layers of light, in the order of the file.
fn groups_of(image: &Image) -> Vec<String> {
    let name = |c: &kirkas_images::Channel| Some(c.name.strip_prefix("group.")?.strip_suffix(".R")?.to_string());
    image.channels.iter().filter_map(name).collect()
}

/// The picture, its groups multiplied; from the integers where they are kept.
fn relit(image: Image, mix: &LightMix, depth: Depth) -> Result<Image, PartError> {
    if image.channel("kirkas.count.taken").is_none() {
        return Ok(mixed_layers(image, mix, depth));
    }
    let film = read_part(&image)?;
    let scales: Vec<[f64; 3]> = layer_names(&film.layout.groups).iter().map(|g| mix.of(g)).collect();
    let mut film = film.relit(&scales);
    film.layout.aovs = film.layout.aovs.without("variance");
    Ok(film.to_image(depth))
}

/// The same from layers of floats: each is multiplied in 64 bits, all are added, and the sum is rounded.
fn mixed_layers(mut image: Image, mix: &LightMix, depth: Depth) -> Image {
    let keep = |values: Vec<f32>| match depth {
        Depth::Half => ChannelData::F16(values),
        Depth::Float => ChannelData::F32(values),
    };
    let pixels = image.data.width as usize * image.data.height as usize;
    // The groups know nothing of noise nor of wavelengths, and a denoised picture is none of them.
    let is_of_groups =
        |name: &str| !name.starts_with("variance.") && !name.starts_with("denoised.") && !is_bin_layer(name);
    image.channels.retain(|c| is_of_groups(&c.name));
    for (lane, channel) in ["R", "G", "B"].into_iter().enumerate() {
        let mut sum = vec![0.0; pixels];
        for c in &mut image.channels {
            let Some(group) = c.name.strip_prefix("group.").and_then(|n| n.strip_suffix(&format!(".{channel}"))) else {
                continue;
            };
            let scale = mix.of(group)[lane];
            let scaled: Vec<f64> = c.data.floats().unwrap_or_default().iter().map(|v| f64::from(*v) * scale).collect();
            sum.iter_mut().zip(&scaled).for_each(|(s, v)| *s += v);
            c.data = keep(scaled.into_iter().map(|v| v as f32).collect());
        }
        if let Some(beauty) = image.channels.iter_mut().find(|c| c.name == channel) {
            beauty.data = keep(sum.into_iter().map(|v| v as f32).collect());
        }
    }
    image
}
