//! From a description to a [`Scene`]: names become numbers, groups and instances become placements, shapes become geometry.
//!
//! Objects that stand still are put into the world itself. What moves, and what is instanced, becomes an *aggregate* in a
//! space of its own; instances of instances are placed one by one, each with one composed transform.

use crate::background::Background;
use crate::camera::Camera;
use crate::catalog::{ACCELERATORS, catalog};
use crate::film::adaptive::ErrorTarget;
use crate::film::filter::Filter;
use crate::film::{AovSet, FilmLayout, Rect, SpectralBins};
use crate::frames::{bad_geometry, frame_time, is_moving};
use crate::integrators::{INTEGRATORS, Integrator, MediumStack};
use crate::lights::collect::{add_area_lights, scene_radius};
use crate::lights::pick::LightPicker;
use crate::lights::{Lamp, LightEntry, ambient_radiance};
use crate::materials;
use crate::media::Volume;
use crate::placement::{PlacedPart, Placement, place_objects};
use crate::sampler::{SamplerKind, frame_seed};
use crate::scene::{PRIMARY, PartInfo, Scene};
use crate::textures::Textures;
use crate::wave_files::palette;
use kirkas_accel::{Accel, AccelKind, Executor, Geometry, Instance, SceneGeometry};
use kirkas_optics::ColorMode;
use kirkas_scene::validate::validate;
use kirkas_scene::{Assets, Catalog, Description, Diagnostic, Entity, Kind, Map, Params};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What the caller decides besides the description.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Part of the image to render; `None` = all.
    pub crop: Option<Rect>,
    /// AOVs to keep.
    pub aovs: AovSet,
    /// The frame of a film; `None` = one picture, at the time that the camera says.
    pub frame: Option<u32>,
}

/// A scene and all that its description says of the picture.
pub struct Prepared {
    /// The scene.
    pub scene: Scene,
    /// How light is found.
    pub integrator: Box<dyn Integrator>,
    /// Pixel filter.
    pub filter: Filter,
    /// Moves every sample on the film, in pixels.
    pub shift: [f64; 2],
    /// Which sample points.
    pub sampler: SamplerKind,
    /// Samples per pixel; with a target, at most.
    pub samples: u32,
    /// When blocks of pixels have samples enough; `None` = never.
    pub target: Option<ErrorTarget>,
    /// The most that a channel of one contribution brings; 0 = no clamp.
    pub clamp: f32,
    /// Which of all pictures.
    pub seed: u64,
    /// The frame of a film, if it is one.
    pub frame: Option<u32>,
    /// Frame n opens the shutter at n over this, in seconds.
    pub frames_per_second: f64,
    /// What the film holds.
    pub film: FilmLayout,
    /// Display exposure in stops.
    pub exposure: f32,
    /// Display tone curve, by name.
    pub tone: String,
    /// What is suspicious.
    pub warnings: Vec<Diagnostic>,
}

/// Runs halves of work in parallel where threads exist.
pub struct Threads;

impl Executor for Threads {
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        rayon::join(a, b);
    }
}

impl Prepared {
    /// The renderer of this scene with flocks of `flock` rays.
    pub fn renderer(&self, flock: usize) -> crate::Renderer<'_> {
        crate::Renderer {
            scene: &self.scene,
            integrator: &*self.integrator,
            filter: &self.filter,
            shift: self.shift,
            sampler: self.sampler,
            seed: frame_seed(self.seed, self.frame),
            target: self.target,
            clamp: self.clamp,
            resolution: self.film.size,
            planes: self.film.planes(),
            bins: self.film.bins,
            keeps_aovs: !self.film.aovs.is_empty(),
            flock,
        }
    }
}

/// Compile everything, or say all that is wrong.
pub fn prepare(description: &Description, assets: &dyn Assets, options: &Options) -> Result<Prepared, Vec<Diagnostic>> {
    let catalog = catalog();
    let (errors, mut warnings): (Vec<_>, Vec<_>) =
        validate(description, &catalog).into_iter().partition(Diagnostic::is_error);
    if !errors.is_empty() {
        return Err(errors);
    }
    let singles = Singles::new(description, &catalog);
    let film = film_layout(&singles.params(Kind::Film), options).map_err(|d| vec![d])?;
    let frames_per_second = singles.params(Kind::Film).number("frames_per_second");
    let time = options.frame.map(|n| frame_time(n, frames_per_second));
    let mut scene = compile(description, &catalog, assets, &singles, (film.size, time), &mut warnings)?;
    let (p, s) = (singles.params(Kind::Film), singles.params(Kind::Sampler));
    let filter =
        Filter::new(p.text("filter").unwrap_or("gaussian"), p.optional_number("filter_radius").map(|r| r as f32));
    let target = ErrorTarget::new(&s);
    if target.is_some() && film.crop.area() != film.size.0 as usize * film.size.1 as usize {
        return Err(vec![adaptive_crop(&s)]);
    }
    let clamp = p.f32("clamp");
    if clamp > 0.0 {
        warnings.push(clamp_warning(&p));
    }
    let chosen = singles.params(Kind::Integrator).spec().name;
    let integrator = INTEGRATORS.iter().find(|i| i.spec.name == chosen).expect("the description was validated");
    if film.bins.is_some() && !integrator.knows_bins {
        let message = format!("`{chosen}` keeps no spectral bins: its particles have wavelengths of their own");
        return Err(vec![
            Diagnostic::error("no-bins", message)
                .at(p.span("spectral_bins"), "bins of wavelength")
                .help("choose `[integrator] type = \"photon\"`, or leave the bins out"),
        ]);
    }
    if !scene.ambient.is_empty() && !integrator.knows_ambient {
        warnings.push(
            Diagnostic::warning(
                "no-ambient",
                format!("`{chosen}` ignores ambient lights: it finds indirect light itself"),
            )
            .help("remove them, or choose `[integrator] type = \"whitted\"`"),
        );
    }
    if !scene.volumes.is_empty() && !integrator.knows_media {
        scene.forget_media();
        warnings.push(
            Diagnostic::warning("no-media", format!("`{chosen}` sees no media: light goes straight through them"))
                .help("choose `[integrator] type = \"path\"`"),
        );
    }
    let integrator = (integrator.build)(&singles.params(Kind::Integrator));
    warnings.extend(integrator.warnings(&scene));
    let groups = if p.bool("light_groups") { scene.groups.clone() } else { Vec::new() };
    Ok(Prepared {
        integrator,
        filter: filter.ok_or_else(|| vec![bad_filter(&p)])?,
        shift: p.vector2("shift"),
        sampler: SamplerKind::new(&s),
        samples: s.integer(if target.is_some() { "max_samples" } else { "samples" }) as u32,
        target,
        clamp,
        seed: s.integer("seed") as u64,
        frame: options.frame,
        frames_per_second,
        film: FilmLayout { groups, ..film },
        exposure: p.f32("exposure"),
        tone: p.text("tone").unwrap_or("linear").to_string(),
        scene,
        warnings,
    })
}

/// The entities of single kinds, made of defaults where nothing is written.
struct Singles<'a> {
    catalog: &'a Catalog,
    entities: Vec<(Kind, Entity)>,
}

impl<'a> Singles<'a> {
    fn new(description: &Description, catalog: &'a Catalog) -> Self {
        let one = |kind: Kind| {
            let default = || Entity::new("", kind.default_type().unwrap_or_default(), Map::default());
            (kind, description.single(kind).cloned().unwrap_or_else(default))
        };
        Singles { catalog, entities: Kind::ALL.into_iter().filter(|k| k.is_single()).map(one).collect() }
    }

    fn params(&self, kind: Kind) -> Params<'_> {
        let entity = &self.entities.iter().find(|e| e.0 == kind).expect("every single kind is there").1;
        Params::new(entity, kind, self.catalog).expect("the description was validated")
    }
}

fn bad_filter(p: &Params) -> Diagnostic {
    Diagnostic::error("bad-filter", "this filter cannot have this radius")
        .at(p.span("filter_radius"), "here")
        .help("leave `filter_radius` out for the filter's own")
}

fn adaptive_crop(p: &Params) -> Diagnostic {
    Diagnostic::error("adaptive-crop", "adaptive sampling looks at the whole image, so it cannot render a crop of it")
        .at(p.span("error"), "adaptive")
        .help("render the whole image, or give a number of samples instead (`--spp N -D sampler.error=0`)")
}

fn clamp_warning(p: &Params) -> Diagnostic {
    let message = format!("contributions are clamped at {}: the image is darker than the truth", p.number("clamp"));
    Diagnostic::warning("firefly-clamp", message)
        .at(p.span("clamp"), "clamped")
        .help("leave `clamp` out, and take more samples instead, for an image without bias")
}

fn film_layout(p: &Params, options: &Options) -> Result<FilmLayout, Diagnostic> {
    let size = (p.integer("width") as u32, p.integer("height") as u32);
    let whole = Rect { x0: 0, y0: 0, x1: size.0, y1: size.1 };
    let crop = options.crop.unwrap_or(whole);
    let fits = crop.x0 < crop.x1 && crop.y0 < crop.y1 && crop.x1 <= size.0 && crop.y1 <= size.1;
    if !fits {
        return Err(Diagnostic::error("bad-crop", "the crop window is empty or not inside the image")
            .help(format!("give X0,Y0,X1,Y1 with 0 <= X0 < X1 <= {} and 0 <= Y0 < Y1 <= {}", size.0, size.1)));
    }
    const MOST_PIXELS: usize = 1 << 28;
    if crop.area() > MOST_PIXELS {
        let message = format!("{} x {} pixels are too many for one film", crop.width(), crop.height());
        return Err(Diagnostic::error("too-large", message)
            .at(p.span("width"), "times `height`")
            .help(format!("stay below {MOST_PIXELS} pixels, or render parts with --crop")));
    }
    Ok(FilmLayout { size, crop, groups: Vec::new(), aovs: options.aovs, bins: spectral_bins(p, crop)? })
}

fn spectral_bins(p: &Params, crop: Rect) -> Result<Option<SpectralBins>, Diagnostic> {
    let count = p.integer("spectral_bins") as u32;
    if count == 0 {
        return Ok(None);
    }
    if p.text("color") != Some(ColorMode::Spectral.name()) {
        let message = "spectral bins need wavelengths, and this render carries light as red, green and blue";
        return Err(Diagnostic::error("no-wavelengths", message)
            .at(p.span("spectral_bins"), "bins of wavelength")
            .help("add `--color spectral`, or `color = \"spectral\"` under `[film]`; or leave the bins out"));
    }
    let bins = SpectralBins::new(count, p.vector2("spectral_range")).ok_or_else(|| {
        Diagnostic::error("bad-range", "the spectral range ends before it begins")
            .at(p.span("spectral_range"), "here")
            .help("write the lower wavelength first, in nm, such as [400, 700]")
    })?;
    const MOST_SUMS: usize = 1 << 28;
    if crop.area() * count as usize > MOST_SUMS {
        let message = format!("{count} bins for each of {} x {} pixels are too many", crop.width(), crop.height());
        return Err(Diagnostic::error("too-large", message)
            .at(p.span("spectral_bins"), "times the pixels")
            .help(format!("stay below {MOST_SUMS} together, or render parts with --crop")));
    }
    Ok(Some(bins))
}

/// Names of light groups become numbers.
#[derive(Default)]
pub(crate) struct Groups {
    pub names: Vec<String>,
    numbers: BTreeMap<String, u32>,
}

impl Groups {
    pub(crate) fn number(&mut self, name: &str) -> u32 {
        if let Some(known) = self.numbers.get(name) {
            return *known;
        }
        let number = self.names.len() as u32;
        self.names.push(name.into());
        self.numbers.insert(name.into(), number);
        number
    }
}

fn compile(
    d: &Description,
    catalog: &Catalog,
    assets: &dyn Assets,
    singles: &Singles,
    (resolution, time): ((u32, u32), Option<f64>),
    warnings: &mut Vec<Diagnostic>,
) -> Result<Scene, Vec<Diagnostic>> {
    let color = singles.params(Kind::Film).text("color").and_then(ColorMode::from_name).unwrap_or_default();
    let palette = palette(d, catalog, assets, color)?;

    // Media, textures and materials, by name.
    let medium_number = |name: &str| d.all(Kind::Medium).iter().position(|e| e.name.text == name).map(|n| n as u32);
    let mut volumes = Volume::compile_all(d, catalog, &palette, assets).map_err(|d| vec![d])?;
    let textures = Textures::compile(d, catalog, assets)?;
    let params = |kind, entity| Params::new(entity, kind, catalog).expect("the description was validated");
    let interior = |e: &Entity| e.params.get("interior").and_then(|n| n.text()).and_then(medium_number);
    let materials = materials::compile_all(d, catalog, textures.names(), &palette, &interior)?;

    // The camera.
    let camera = compile_camera(d, catalog, singles)?;
    let camera = time.map_or(camera.clone(), |t| camera.opened_at(t));

    // Objects: parts in the world, aggregates, and where they are placed.
    let mut groups = Groups::default();
    let background_group = groups.number("background");
    for (volume, entity) in volumes.iter_mut().zip(d.all(Kind::Medium)) {
        if volume.shines() {
            volume.group = groups.number(&entity.name.text);
        }
    }
    let placement = place_objects(d, catalog, assets, &palette, textures, materials, &mut groups)?;
    let Placement { mut world, aggregates, mut instances, materials, textures, object_names } = placement;

    // Lights.
    let (mut lights, mut ambient) = (Vec::new(), Vec::new());
    for entity in d.all(Kind::Light) {
        let p = params(Kind::Light, entity);
        let group = groups.number(p.text("group").unwrap_or(&entity.name.text));
        match Lamp::new(&p, &palette) {
            Some(lamp) => lights.push(LightEntry::new(&entity.name.text, group, 1, lamp)),
            None => ambient.push((ambient_radiance(&p, &palette), group)),
        }
    }
    add_area_lights(&mut world, &aggregates, &mut instances, &materials, &object_names, &mut lights, warnings);
    let background =
        Arc::new(Background::new(&singles.params(Kind::Background), &palette, assets).map_err(|d| vec![d])?);
    let background_light = (!background.is_black()).then(|| {
        lights.push(LightEntry::new("background", background_group, 1, Lamp::Background(background.clone())));
        lights.len() as u32 - 1
    });
    let radius = scene_radius(&world, &aggregates, &instances);
    let powers: Vec<f64> = lights.iter().map(|l| l.lamp.power(&materials, &textures, radius)).collect();
    let (picker, pieces) =
        LightPicker::new(&singles.params(Kind::Integrator), &lights, (&materials, &textures), &powers);

    // What rays search.
    let geometry = |parts: &[PlacedPart], overrides: &[u32]| -> Vec<Geometry> {
        let is_opaque = |m: u32| materials[m as usize].is_opaque();
        parts
            .iter()
            .map(|p| Geometry {
                shape: p.shape.clone(),
                opaque: is_opaque(p.info.material) && overrides.iter().all(|&m| is_opaque(m)),
                mask: if p.is_visible { u32::MAX } else { !PRIMARY },
            })
            .collect()
    };
    let mut overrides = vec![Vec::new(); aggregates.len()];
    for i in &instances {
        overrides[i.aggregate].extend(i.material);
    }
    overrides.iter_mut().for_each(|o| {
        o.sort_unstable();
        o.dedup();
    });
    let (open, close) = camera.shutter();
    let scene_geometry = SceneGeometry {
        world: geometry(&world, &[]),
        aggregates: aggregates.iter().zip(&overrides).map(|(a, o)| geometry(a, o).into()).collect(),
        instances: instances
            .iter()
            .map(|i| Instance {
                aggregate: i.aggregate,
                outer_from_object: i.world_from_part.clone(),
                mask: if i.is_visible { u32::MAX } else { !PRIMARY },
            })
            .collect(),
        shutter: (open, close),
    };
    let is_built_anew = time.is_some() && is_moving(&scene_geometry);
    let kind = match d.single(Kind::Accelerator) {
        // Whoever builds for every frame builds quickly; the hits are the same.
        None if is_built_anew => AccelKind::Bvh8Fast,
        _ => {
            let name = singles.params(Kind::Accelerator).spec().name;
            ACCELERATORS.iter().find(|a| a.0.name == name).map_or(AccelKind::default(), |a| a.1)
        }
    };
    let accel = Accel::build(kind, scene_geometry, &Threads).map_err(bad_geometry)?;

    if lights.is_empty()
        && ambient.is_empty()
        && !volumes.iter().any(Volume::shines)
        && !materials.iter().any(|m| m.emission.is_some())
    {
        warnings.push(
            Diagnostic::warning("no-light", "nothing in the scene shines, so the picture is black")
                .help("add `[lights.NAME]`, an object with an `emitter` material, or a `[background]` with a colour"),
        );
    }
    if open == close
        && time.is_none()
        && let Some(moving) =
            d.all(Kind::Object).iter().chain(d.all(Kind::Camera)).find(|e| e.params.get("motion").is_some())
    {
        warnings.push(
            Diagnostic::warning(
                "no-shutter",
                format!("`{}` moves, but the shutter is open for no time", moving.name.text),
            )
            .at(moving.name.span, "moves")
            .help("give the camera `shutter = [0, 1]` for motion blur, or render moments with --time and --frames"),
        );
    }

    let infos = |parts: Vec<PlacedPart>| -> Vec<PartInfo> { parts.into_iter().map(|p| p.info).collect() };
    let has_hulls = materials.iter().any(|m| m.is_hull);
    // A width that nothing is filtered over would only cost time.
    let texture_footprint =
        if textures.filters() { singles.params(Kind::Film).number("texture_footprint") as f32 } else { 0.0 };
    let scene = Scene {
        color,
        texture_footprint,
        needs_patches: texture_footprint > 0.0 || textures.looks_around(),
        keeps_spectra: singles.params(Kind::Film).integer("spectral_bins") > 0,
        disperses: materials.iter().any(|m| m.medium.as_ref().is_some_and(|x| x.ior.is_dispersive())),
        accel,
        world: infos(world),
        aggregates: aggregates.into_iter().map(infos).collect(),
        instances,
        materials,
        textures,
        picker,
        pieces,
        lights,
        ambient,
        background,
        background_light,
        background_group,
        camera,
        space: singles.params(Kind::Background).text("medium").and_then(medium_number),
        has_hulls,
        volumes,
        camera_media: MediumStack::EMPTY,
        groups: groups.names,
        object_names,
    };
    Ok(scene.with_camera_media(resolution))
}

fn compile_camera(d: &Description, catalog: &Catalog, singles: &Singles) -> Result<Camera, Vec<Diagnostic>> {
    let film = singles.params(Kind::Film);
    let named = film.text("camera").and_then(|n| d.find(Kind::Camera, n));
    let Some(entity) = named.or_else(|| d.all(Kind::Camera).first()) else {
        return Err(vec![
            Diagnostic::error("no-camera", "the scene has no camera")
                .help("add `[cameras.main]` with `type = \"perspective\"`, `position` and `look_at`"),
        ]);
    };
    let p = Params::new(entity, Kind::Camera, catalog).expect("the description was validated");
    Camera::compile(&p).map_err(|d| vec![d])
}
