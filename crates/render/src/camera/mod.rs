//! Cameras: from a place on the film to a ray into the scene.
//!
//! Camera space: the camera stands at the origin and looks along -z, y is up, x is right. All arithmetic is f64; only the
//! finished ray is rounded to f32.

mod orthographic;
mod perspective;
mod thin_lens;

use crate::textures::RayCone;
use kirkas_geometry::transform::look_at;
use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Ray};
use kirkas_scene::spec::ANY;
use kirkas_scene::transforms::{read_motion, read_transform};
use kirkas_scene::{Diagnostic, Fallback, ParamSpec, ParamType, Params, TypeSpec};
use orthographic::Orthographic;
use perspective::Perspective;
use thin_lens::ThinLens;

/// What a camera needs for one ray.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// Place on the film in pixels from the top left of the whole image, x right, y down.
    pub film: (f64, f64),
    /// Place on the lens, unit square.
    pub lens: (f32, f32),
    /// Time in seconds, within the shutter interval.
    pub time: f64,
}

/// Every type of camera.
pub const CAMERAS: &[&TypeSpec] = &[&perspective::SPEC, &orthographic::SPEC, &thin_lens::SPEC];

/// Rows that every camera takes.
pub const COMMON: &[ParamSpec] = &[
    ParamSpec::vector("position", [0.0, 0.0, 5.0], "where the camera stands").unit("scene units"),
    ParamSpec::vector("look_at", [0.0, 0.0, 0.0], "the point in the middle of the picture").unit("scene units"),
    ParamSpec::vector("up", [0.0, 1.0, 0.0], "the direction that is up in the picture"),
    ParamSpec::new("transform", ParamType::Transform, Fallback::Absent, "steps applied to the placed camera"),
    ParamSpec::new(
        "motion",
        ParamType::Motion,
        Fallback::Absent,
        "key frames that move the placed camera; absent: it stands still",
    ),
    ParamSpec::new(
        "shutter",
        ParamType::Vector2,
        Fallback::Vector2([0.0, 0.0]),
        "times at which the shutter opens and closes; equal: no motion blur",
    )
    .unit("s")
    .range(ANY),
];

/// A camera, ready for rays.
#[derive(Clone, Debug)]
pub struct Camera {
    projection: Projection,
    world_from_camera: DAffine3,
    motion: Option<AnimatedTransform>,
    shutter: (f64, f64),
    /// How long the shutter is open, in seconds, whenever it opens.
    exposure: f64,
}

/// How one point of the lens sees a point of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Where the camera's ray starts.
    pub origin: DVec3,
    /// Where on the film the point is seen, in pixels, which may lie outside the image.
    pub film: (f64, f64),
    /// What a surface at the point, facing the camera, covers of the film: pixels squared per scene unit squared.
    pub density: f64,
}

/// A ray in camera space; the direction need not be unit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CameraRay {
    origin: DVec3,
    direction: DVec3,
}

/// A [`Sight`] in camera space, with film from -1 to 1 along each axis.
#[derive(Clone, Copy, Debug)]
struct CameraSight {
    from: DVec3,
    place: (f64, f64),
    density: f64,
}

#[derive(Clone, Debug)]
enum Projection {
    Perspective(Perspective),
    Orthographic(Orthographic),
    ThinLens(ThinLens),
}

impl Camera {
    /// From its parameters, which have been validated.
    pub fn compile(params: &Params) -> Result<Camera, Diagnostic> {
        let [open, close] = params.vector2("shutter");
        if close < open {
            return Err(Diagnostic::error(
                "bad-shutter",
                format!("the shutter closes at {close} s, before it opens at {open} s"),
            )
            .at(params.span("shutter"), "closes before it opens")
            .help(format!("write `shutter = [{close}, {open}]`")));
        }
        let placed = placement(params)?;
        let node = |name: &str| params.entity.params.get(name);
        let transform = node("transform").map_or(Ok(DAffine3::IDENTITY), read_transform)?;
        let motion = node("motion").map(read_motion).transpose()?;
        let projection = match params.spec().name {
            "orthographic" => Projection::Orthographic(Orthographic::compile(params)),
            "thin_lens" => Projection::ThinLens(ThinLens::compile(params)?),
            _ => Projection::Perspective(Perspective::compile(params)),
        };
        let mut camera = Camera {
            projection,
            world_from_camera: transform * placed,
            motion: None,
            shutter: (open, close),
            exposure: close - open,
        };
        match motion {
            Some(m) if m.is_moving() => camera.motion = Some(m),
            Some(m) => camera.world_from_camera = m.at(open) * camera.world_from_camera,
            None => {}
        }
        Ok(camera)
    }

    /// The ray through a place on the film of `resolution` (width, height) pixels. Its direction is unit: `t` is distance.
    pub fn ray(&self, sample: &CameraSample, resolution: (u32, u32)) -> Ray {
        let film = FilmPlace::new(sample.film, resolution);
        let local = match &self.projection {
            Projection::Perspective(p) => p.ray(&film),
            Projection::Orthographic(p) => p.ray(&film),
            Projection::ThinLens(p) => p.ray(&film, sample.lens),
        };
        let world_from_camera = self.world_from_camera(sample.time);
        let origin = world_from_camera.transform_point3(local.origin);
        let direction = world_from_camera.transform_vector3(local.direction).normalize();
        Ray::new(origin.as_vec3(), direction.as_vec3()).at_time(sample.time as f32)
    }

    /// The width and spread of a ray of [`Camera::ray`]: what one pixel covers.
    pub fn cone(&self, sample: &CameraSample, resolution: (u32, u32)) -> RayCone {
        let film = FilmPlace::new(sample.film, resolution);
        match &self.projection {
            Projection::Perspective(p) => RayCone { width: 0.0, spread: p.pixel_angle(&film) as f32 },
            Projection::ThinLens(p) => RayCone { width: 0.0, spread: p.pixel_angle(&film) as f32 },
            Projection::Orthographic(p) => {
                let scale = self.world_from_camera.matrix3.x_axis.length();
                RayCone { width: (p.pixel_size(&film) * scale) as f32, spread: 0.0 }
            }
        }
    }

    /// The same camera with its shutter opened at `time`, in seconds, for as long as ever.
    pub fn opened_at(&self, time: f64) -> Camera {
        Camera { shutter: (time, time + self.exposure), ..self.clone() }
    }

    /// When the shutter opens and closes, in seconds.
    pub fn shutter(&self) -> (f64, f64) {
        self.shutter
    }

    /// The time of a moment of the exposure: 0 = the shutter opens, 1 = it closes.
    pub fn time_at(&self, moment: f32) -> f64 {
        let (open, close) = self.shutter;
        open + (close - open) * f64::from(moment)
    }

    /// True when rays depend on [`CameraSample::lens`].
    pub fn uses_lens(&self) -> bool {
        matches!(&self.projection, Projection::ThinLens(p) if p.uses_lens())
    }

    /// Where the camera stands at `time`.
    pub fn position(&self, time: f64) -> DVec3 {
        self.world_from_camera(time).translation
    }

    /// The place on the film where `point` is seen (through the middle of a lens), in pixels, which may lie outside the
    /// image. `None` for points behind the camera; an orthographic camera sees those too.
    pub fn project(&self, point: DVec3, time: f64, resolution: (u32, u32)) -> Option<(f64, f64)> {
        let local = self.world_from_camera(time).inverse().transform_point3(point);
        let film = FilmPlace::new((0.0, 0.0), resolution);
        let (x, y) = match &self.projection {
            Projection::Perspective(p) => p.project(local, &film)?,
            Projection::Orthographic(p) => p.project(local, &film),
            Projection::ThinLens(p) => p.project(local, &film)?,
        };
        Some(((x + 1.0) * 0.5 * film.width, (1.0 - y) * 0.5 * film.height))
    }

    /// How the point `lens` (unit square) of the lens sees `point`: the adjoint of [`Camera::ray`]. `None` for what it does not see
    /// from there, wherever the image ends.
    pub fn see(&self, point: DVec3, lens: (f32, f32), time: f64, resolution: (u32, u32)) -> Option<Sight> {
        let world_from_camera = self.world_from_camera(time);
        let local = world_from_camera.inverse().transform_point3(point);
        let film = FilmPlace::new((0.0, 0.0), resolution);
        let seen = match &self.projection {
            Projection::Perspective(p) => p.see(local, DVec3::ZERO, &film),
            Projection::Orthographic(p) => p.see(local, &film),
            Projection::ThinLens(p) => p.see(local, &film, lens),
        }?;
        // From areas and distances of camera space to those of the world.
        let origin = world_from_camera.transform_point3(seen.from);
        let stretch = (point - origin).length() / (local - seen.from).length();
        let shrinking = 1.0 / world_from_camera.matrix3.determinant().abs();
        let (x, y) = seen.place;
        let density = seen.density * 0.25 * film.width * film.height * shrinking * stretch;
        let place = ((x + 1.0) * 0.5 * film.width, (1.0 - y) * 0.5 * film.height);
        (density > 0.0 && density.is_finite()).then_some(Sight { origin, film: place, density })
    }

    fn world_from_camera(&self, time: f64) -> DAffine3 {
        match &self.motion {
            Some(m) => m.at(time) * self.world_from_camera,
            None => self.world_from_camera,
        }
    }
}

/// A place on the film, from -1 to 1 along each axis, x right, y up.
#[derive(Clone, Copy, Debug)]
struct FilmPlace {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl FilmPlace {
    fn new((x, y): (f64, f64), (width, height): (u32, u32)) -> Self {
        let (width, height) = (f64::from(width.max(1)), f64::from(height.max(1)));
        FilmPlace { x: 2.0 * x / width - 1.0, y: 1.0 - 2.0 * y / height, width, height }
    }

    fn aspect(&self) -> f64 {
        self.width / self.height
    }
}

/// `position`, `look_at` and `up`, or what is wrong with them.
fn placement(params: &Params) -> Result<DAffine3, Diagnostic> {
    let [from, to, up] = ["position", "look_at", "up"].map(|name| DVec3::from_array(params.vector(name)));
    let backward = from - to;
    if backward.try_normalize().is_none() {
        return Err(Diagnostic::error("bad-camera", "the camera stands at the point it looks at")
            .at(params.span("position"), "the camera is here")
            .at(params.span("look_at"), "and looks here")
            .help("move `position` or `look_at`, so that there is a direction to look in"));
    }
    let Some(up) = up.try_normalize() else {
        return Err(Diagnostic::error("bad-camera", "`up` is zero and so gives no direction")
            .at(params.span("up"), "no direction")
            .help("write `up = [0, 1, 0]`, or leave it out"));
    };
    let backward = backward.normalize();
    let is_parallel = up.cross(backward).length() < 1e-9;
    if is_parallel && params.has("up") {
        return Err(Diagnostic::error(
            "bad-camera",
            "`up` points along the line of sight and so leaves the camera free to roll",
        )
        .at(params.span("up"), "parallel to the view")
        .help("choose an `up` across the view, for example `[0, 0, -1]` for a camera that looks straight down"));
    }
    // Straight down or up with the `up` that nobody wrote: as on a map, and its mirror.
    let up = if is_parallel { DVec3::Z * -backward.y.signum() } else { up };
    look_at(from, to, up).ok_or_else(|| {
        Diagnostic::error("bad-camera", "the camera's place and direction cannot be computed")
            .at(params.span("position"), "here")
            .help("use smaller numbers")
    })
}
