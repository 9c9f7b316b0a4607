//! What is explained: a scene, or a picture whose header says how it was made.

use super::Explain;
use crate::header::Header;
use crate::input::read_file;
use crate::output::true_place;
use crate::parts::EXR;
use crate::problem::Problem;
use crate::report;
use crate::scene_file::SceneFile;
use crate::settings::Settings;
use kirkas_explain::Explanation;
use kirkas_images::{Image, decode, read_exr};
use kirkas_render::film::part::read_part;
use kirkas_render::{Film, Options, Prepared, prepare};
use kirkas_scene::{Diagnostic, Kind};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scene, ready, and the picture of it, if there is one.
pub struct Source {
    pub prepared: Prepared,
    /// How light is found, by name.
    pub integrator: String,
    /// The scene, as the user named it.
    pub name: String,
    scene: SceneFile,
    picture: Option<Picture>,
}

/// A picture that Kirkas made.
pub struct Picture {
    header: Header,
    /// Only of an EXR.
    image: Option<Image>,
    /// With its integers, if it has them.
    film: Option<Film>,
}

/// Whether the picture holds what was traced again.
pub enum Verdict {
    /// Exactly.
    Same,
    /// Not all samples were traced again.
    Part,
    /// That cannot be told, and why.
    Coarse(&'static str),
    /// There is no picture.
    Fresh,
    /// It holds this instead.
    Other([f32; 3]),
}

impl Source {
    /// Open what the arguments name.
    pub fn open(args: &Explain) -> Result<Self, Problem> {
        let is_picture =
            args.source.extension().is_some_and(|e| ["exr", "png", "hdr"].iter().any(|p| e.eq_ignore_ascii_case(p)));
        if is_picture { Self::of_picture(args) } else { Self::of_scene(args, &args.source, None) }
    }

    fn of_picture(args: &Explain) -> Result<Self, Problem> {
        if !args.set.is_empty() || args.spp.is_some() {
            let message = "a picture says itself how it was made: -D and --spp are for scenes";
            let help = "explain the scene instead, or render it anew";
            return Err(Problem::input(Diagnostic::error("not-a-scene", message).help(help)));
        }
        let picture = Picture::read(&args.source)?;
        let named = PathBuf::from(picture.header.get("scene"));
        if named.as_os_str().is_empty() {
            let message = format!("`{}` does not say of which scene it is", args.source.display());
            let help = "explain a picture that `kirkas render` wrote, or the scene itself";
            return Err(Problem::input(Diagnostic::error("not-ours", message).help(help)));
        }
        // Where the command was given, or else beside the picture.
        let beside = args.source.parent().unwrap_or(Path::new("")).join(named.file_name().unwrap_or_default());
        let place = if !named.exists() && beside.exists() { beside } else { named };
        Self::of_scene(args, &place, Some(picture))
    }

    fn of_scene(args: &Explain, path: &Path, picture: Option<Picture>) -> Result<Self, Problem> {
        let mut scene = SceneFile::open(path, args.root.as_deref())?;
        let mut set = Settings::new(&mut scene);
        match &picture {
            Some(p) => p.apply(&mut set),
            None => {
                set.overrides(&args.set);
                if let Some(n) = args.spp {
                    set.samples(i64::from(n));
                }
            }
        }
        set.finish()?;
        let frame = picture.as_ref().and_then(|p| p.header.get("frame").parse().ok());
        let options = Options { frame, ..Options::default() };
        let prepared = prepare(&scene.description, &scene.assets(), &options);
        let prepared = prepared.map_err(|d| Problem::from(scene.failure(d)))?;
        if let Some(p) = &picture {
            p.check_scene(args, &scene)?;
        } else if !args.quiet {
            let warnings = scene.failure([scene.warnings.clone(), prepared.warnings.clone()].concat());
            report::print(&warnings.sources, &warnings.diagnostics);
        }
        let integrator = scene.description.single(Kind::Integrator).map(|e| e.type_name.text.clone());
        let integrator = integrator.unwrap_or_else(|| "path".into());
        Ok(Source { prepared, integrator, name: path.display().to_string(), scene, picture })
    }

    /// The samples to trace again.
    pub fn samples(&self, args: &Explain, (x, y): (u32, u32)) -> Result<Range<u32>, Problem> {
        let (width, height) = self.prepared.film.size;
        if x >= width || y >= height {
            let message = format!("there is no pixel {x},{y} in an image of {width}x{height}");
            let help = format!("columns go from 0 to {}, rows from 0 to {}", width - 1, height - 1);
            return Err(Problem::input(Diagnostic::error("no-such-pixel", message).help(help)));
        }
        let all = match &self.picture {
            Some(p) => p.samples((x, y))?,
            None => 0..self.prepared.samples,
        };
        let asked = args.sample.map(|k| k..k.saturating_add(1)).or(args.samples.clone()).unwrap_or(all.clone());
        if asked.start < all.start || asked.end > all.end {
            let message = format!("samples {asked:?} were not taken: there are {all:?}");
            return Err(Problem::input(Diagnostic::error("no-such-sample", message).help("ask for some of these")));
        }
        Ok(asked)
    }

    /// Compare with the picture.
    pub fn verify(&self, e: &Explanation) -> Verdict {
        self.picture.as_ref().map_or(Verdict::Fresh, |p| p.verify(e))
    }

    /// Everything that was read.
    pub fn inputs(&self) -> Vec<PathBuf> {
        self.scene.files.record().keys().map(|k| true_place(&self.scene.root.join(k))).collect()
    }

    /// The picture's colours, if it keeps linear ones.
    pub fn image(&self) -> Option<&Image> {
        self.picture.as_ref().and_then(|p| p.image.as_ref())
    }
}

impl Picture {
    fn read(path: &Path) -> Result<Self, Problem> {
        let bytes = read_file(path)?;
        let bad = |e: kirkas_images::ImageError| {
            Problem::input(Diagnostic::error("bad-picture", format!("`{}`: {e}", path.display())))
        };
        if !bytes.starts_with(&EXR) {
            let texts = decode(&bytes, None).map_err(bad)?.texts;
            return Ok(Picture { header: Header::of_texts(&texts), image: None, film: None });
        }
        let image = read_exr(&bytes).map_err(bad)?;
        let film = read_part(&image).ok();
        Ok(Picture { header: Header::of_image(&image), image: Some(image), film })
    }

    /// Make the scene what it was.
    fn apply(&self, set: &mut Settings) {
        let lines: Vec<&str> = self.header.get("overrides").lines().collect();
        for line in lines {
            match line.split_once('=') {
                Some(("integrator.type", name)) => set.type_of("--integrator", Kind::Integrator, name),
                Some(("accelerator.type", name)) => set.type_of("--accel", Kind::Accelerator, name),
                Some(("time", t)) => set.time(t.parse().unwrap_or(0.0)),
                _ => set.overrides(&[line.to_string()]),
            }
        }
        set.flag("--seed", "sampler.seed", self.header.get("seed").parse::<i64>().unwrap_or(0));
        if let Ok(strata) = self.header.get("strata").parse::<i64>() {
            set.flag("--spp", "sampler.samples", strata);
        }
    }

    /// The scene must be the one that was rendered.
    fn check_scene(&self, args: &Explain, scene: &SceneFile) -> Result<(), Problem> {
        let (then, now) = (self.header.get("scene_hash"), scene.files.scene_hash());
        if then == now {
            return Ok(());
        }
        // Which of its files.
        let recorded: Vec<(&str, &str)> = self.header.get("files").lines().filter_map(|l| l.split_once("  ")).collect();
        let record = scene.files.record();
        let hex = |hash: &[u8; 32]| hash.iter().map(|b| format!("{b:02x}")).collect::<String>();
        let is_changed = |(hash, path): &&(&str, &str)| record.get(*path).is_none_or(|h| hex(h) != *hash);
        let changed: Vec<String> = recorded.iter().filter(is_changed).map(|(_, path)| format!("`{path}`")).collect();
        let what = if changed.is_empty() { "it reads other files".into() } else { changed.join(", ") };
        let message = format!("the scene is not the one of `{}` any more: {what}", args.source.display());
        let help = "render it anew, or bring the files back as they were";
        Err(Problem::input(Diagnostic::error("scene-changed", message).help(help)))
    }

    /// Which samples a pixel has.
    fn samples(&self, (x, y): (u32, u32)) -> Result<Range<u32>, Problem> {
        let unclear = |why: &str| {
            let help = "name the samples with --samples A..B, or render the picture to its end";
            Problem::input(Diagnostic::error("samples-unclear", why.to_string()).help(help))
        };
        let all = self.header.samples().and_then(|s| s.single());
        let all =
            all.ok_or_else(|| unclear("the picture does not say which samples it holds, or holds several ranges"))?;
        let taken =
            self.film.as_ref().and_then(|f| f.pixels().find(|p| (p.0, p.1) == (x, y)).map(|p| p.2.counts[p.3].taken));
        Ok(match taken.or_else(|| self.count((x, y))) {
            Some(n) => all.start..all.start + n,
            None => all,
        })
    }

    /// From the layer that keeps it.
    fn count(&self, place: (u32, u32)) -> Option<u32> {
        let image = self.image.as_ref()?;
        let value = image.channel("sample_count.Y").or_else(|| image.channel("sample_count"))?;
        match value {
            kirkas_images::ChannelData::U32(counts) => counts.get(index(image, place)?).copied(),
            _ => None,
        }
    }

    fn verify(&self, e: &Explanation) -> Verdict {
        let place = (e.pixel[0], e.pixel[1]);
        if !self.header.get("relight").is_empty() {
            return Verdict::Coarse("the picture's lights were mixed anew");
        }
        match self.samples(place) {
            Ok(all) if all != (e.samples[0]..e.samples[1]) => return Verdict::Part,
            Err(_) => return Verdict::Coarse("the picture does not say which samples it holds"),
            Ok(_) => {}
        }
        if let Some((_, _, tile, i)) = self.film.as_ref().and_then(|f| f.pixels().find(|p| (p.0, p.1) == place)) {
            let planes = tile.sums.len() / tile.counts.len();
            let sums = &tile.sums[i * planes..(i + 1) * planes];
            let total: [i128; 3] = std::array::from_fn(|c| sums.iter().map(|s| s[c]).sum());
            return if total == e.sums { Verdict::Same } else { Verdict::Other(tile.mean(i)) };
        }
        let Some(image) = &self.image else { return Verdict::Coarse("only an EXR keeps its light") };
        let Some(i) = index(image, place) else {
            return Verdict::Coarse("the pixel lies outside of the picture's crop");
        };
        let value = |name: &str| match image.channel(name)? {
            kirkas_images::ChannelData::F32(v) => v.get(i).copied(),
            _ => None,
        };
        match (value("R"), value("G"), value("B")) {
            (Some(r), Some(g), Some(b)) if [r, g, b].map(f32::to_bits) == e.value.map(f32::to_bits) => Verdict::Same,
            (Some(_), ..) if !self.header.get("unfinished").is_empty() => Verdict::Coarse(
                "the picture was stopped within a pass, and does not say how many samples this pixel has",
            ),
            (Some(_), ..) if !self.header.get("error").is_empty() && self.count(place).is_none() => {
                Verdict::Coarse("adaptive sampling may have stopped early here; render with --aov sample_count")
            }
            (Some(r), Some(g), Some(b)) => Verdict::Other([r, g, b]),
            _ => Verdict::Coarse("the picture keeps 16 bits only"),
        }
    }
}

/// Where a pixel of the whole image is in the planes of an EXR.
pub fn index(image: &Image, (x, y): (u32, u32)) -> Option<usize> {
    let w = &image.data;
    let (dx, dy) = (i64::from(x) - i64::from(w.x), i64::from(y) - i64::from(w.y));
    let is_inside = (0..i64::from(w.width)).contains(&dx) && (0..i64::from(w.height)).contains(&dy);
    is_inside.then(|| dy as usize * w.width as usize + dx as usize)
}
