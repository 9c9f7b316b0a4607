//! The compiled scene: flat arrays, numbers instead of names, everything a ray may ask.

mod alpha;

pub use alpha::AlphaFilter;

use crate::background::Background;
use crate::camera::Camera;
use crate::integrators::{Blocker, MediumStack, ShadowRay};
use crate::lights::pick::LightPicker;
use crate::lights::pieces::Pieces;
use crate::lights::{Lamp, LightEntry, LightSample};
use crate::materials::Material;
use crate::media::{Volume, Way};
use crate::shapes::{Detail, Surface, SurfacePoint};
use crate::textures::{Patch, RayCone, TexturePoint, Textures};
use kirkas_accel::{Accel, Hit, NO_INSTANCE};
use kirkas_geometry::elementary::cbrt;
use kirkas_geometry::hash::combine;
use kirkas_geometry::rounding::{gamma, offset_origin};
use kirkas_geometry::transform::transform_normal;
use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Frame, Ray, Vec3};
use kirkas_optics::medium::transmittance;
use kirkas_optics::{Bsdf, ColorMode, Index, Interface, Lanes, Light, Medium, Spectrum};
use std::sync::Arc;

/// What is known of one geometry of the accelerator.
#[derive(Clone)]
pub struct PartInfo {
    /// Its shape, for shading.
    pub surface: Arc<dyn Surface>,
    /// Index into `Scene::materials`.
    pub material: u32,
    /// Index into `Scene::object_names`.
    pub object: u32,
    /// Light group of its emission.
    pub emission_group: u32,
    /// Index into `Scene::lights`, if it shines where it stands in the world; else [`NO_LIGHT`].
    pub light: u32,
}

/// The number of no light.
pub const NO_LIGHT: u32 = u32::MAX;

/// What is known of one instance.
#[derive(Clone)]
pub struct InstanceInfo {
    /// Index into `Scene::aggregates`.
    pub aggregate: usize,
    /// Where it stands.
    pub world_from_part: AnimatedTransform,
    /// The map and its inverse if it does not move.
    pub still: Option<(DAffine3, DAffine3)>,
    /// Stands in for the parts' object, if the instance is one of its own.
    pub object: Option<u32>,
    /// Stands in for the parts' material.
    pub material: Option<u32>,
    /// Camera rays see it.
    pub is_visible: bool,
    /// Per geometry of its aggregate an index into `Scene::lights`, or [`NO_LIGHT`]; empty if none of them shines.
    pub lights: Arc<[u32]>,
}

/// Mask of camera rays.
pub const PRIMARY: u32 = 1;
/// Mask of all other rays.
pub const SECONDARY: u32 = 2;

/// A scene, ready to be rendered.
pub struct Scene {
    /// How paths carry colour.
    pub color: ColorMode,
    /// Spectra are kept, so that all wavelengths matter.
    pub keeps_spectra: bool,
    /// True when some boundary refracts lanes differently.
    pub disperses: bool,
    /// Finds hits.
    pub accel: Accel,
    /// Per geometry of the world.
    pub world: Vec<PartInfo>,
    /// Per aggregate, per geometry.
    pub aggregates: Vec<Vec<PartInfo>>,
    /// Per instance.
    pub instances: Vec<InstanceInfo>,
    /// All materials.
    pub materials: Vec<Material>,
    /// All textures.
    pub textures: Textures,
    /// Width that textures are filtered over, in pixels; 0 where none is.
    pub texture_footprint: f32,
    /// Some texture looks at more of the surface than the point.
    pub needs_patches: bool,
    /// All lights but the ambient ones.
    pub lights: Vec<LightEntry>,
    /// Ambient lights and their groups.
    pub ambient: Vec<(Spectrum, u32)>,
    /// Chooses among `lights`, or their `pieces`.
    pub picker: LightPicker,
    /// Lights in pieces: what the picker chooses has a number of its own.
    pub pieces: Pieces,
    /// What is seen where nothing is hit.
    pub background: Arc<Background>,
    /// Its number among `lights`, if it shines.
    pub background_light: Option<u32>,
    /// Its light group.
    pub background_group: u32,
    /// The camera in use.
    pub camera: Camera,
    /// All media.
    pub volumes: Vec<Volume>,
    /// The one that fills all space which no body fills, by number.
    pub space: Option<u32>,
    /// Some surfaces are hulls, which rays pass.
    pub has_hulls: bool,
    /// Bodies that the camera is inside of.
    pub camera_media: MediumStack,
    /// Names of light groups.
    pub groups: Vec<String>,
    /// Names of objects.
    pub object_names: Vec<String>,
}

/// A surface where a ray hit it, in the world.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceHit {
    /// Ray parameter.
    pub t: f32,
    /// The point.
    pub position: DVec3,
    /// Absolute error bound of `position`, per axis.
    pub error: DVec3,
    /// Unit geometric normal, outward.
    pub normal: DVec3,
    /// Frame of the shading normal, on the side of `normal`, as fits who looks.
    pub frame: Frame,
    /// The shading normal whoever looks, on the side of `normal`.
    pub shading_normal: DVec3,
    /// True when the ray came from the side that `normal` points to.
    pub is_front: bool,
    /// Where textures look.
    pub texture: TexturePoint,
    /// Index into `Scene::materials`.
    pub material: u32,
    /// Index into `Scene::object_names`.
    pub object: u32,
    /// Light group of emission.
    pub emission_group: u32,
    /// The accelerator's hit.
    pub hit: Hit,
}

impl SurfaceHit {
    /// A ray from this point towards `direction`, clear of the surface, at the time of `like`.
    pub fn ray_towards(&self, direction: DVec3, like: &Ray) -> Ray {
        let origin = offset_origin(self.position, self.error, self.normal, direction);
        Ray { origin, direction: direction.as_vec3(), t_min: 0.0, t_max: f32::INFINITY, mask: SECONDARY, ..*like }
    }

    /// The shading frame as it is for one who looks from `direction` (away from the surface).
    pub fn frame_towards(&self, direction: DVec3) -> Frame {
        let z = shading_normal_towards(direction, self.normal, self.shading_normal).as_vec3().normalize();
        if z == self.frame.z { self.frame } else { Frame::from_z_and_tangent(z, self.frame.x) }
    }

    /// The ray that asks whether a light's sample reaches this point.
    pub fn shadow_ray(&self, s: &LightSample, like: &Ray) -> Ray {
        ray_to_light(offset_origin(self.position, self.error, self.normal, s.direction), s, like)
    }
}

/// A shading normal that turns away from the viewer while the surface does not says nothing useful: then it is the true one.
fn shading_normal_towards(viewer: DVec3, normal: DVec3, shading: DVec3) -> DVec3 {
    if (viewer.dot(shading) > 0.0) == (viewer.dot(normal) > 0.0) { shading } else { normal }
}

/// The ray from `origin` that asks whether a light's sample reaches it, at the time of `like`.
pub fn ray_to_light(origin: Vec3, s: &LightSample, like: &Ray) -> Ray {
    let Some(target) = &s.target else {
        return Ray {
            origin,
            direction: s.direction.as_vec3(),
            t_min: 0.0,
            t_max: f32::INFINITY,
            mask: SECONDARY,
            ..*like
        };
    };
    // End clear of the light's own surface, short of it by the rounding error of direction and parameter.
    let end = offset_origin(target.position, target.error, target.normal, -s.direction);
    let direction = (end.as_dvec3() - origin.as_dvec3()).as_vec3();
    Ray { origin, direction, t_min: 0.0, t_max: 1.0 - gamma(16), mask: SECONDARY, ..*like }
}

/// What textures may ask of the surface around `point`, in part space; `placement` maps to the world and back.
#[inline(never)]
fn patch_at(
    surface: &dyn Surface,
    hit: &Hit,
    point: &SurfacePoint,
    ray: &Ray,
    cone: RayCone,
    placement: Option<(&DAffine3, &DAffine3)>,
) -> Patch {
    let around = surface.patch(hit.primitive, hit.u, hit.v, point);
    let object_from_part = surface.object_from_part();
    let normal = placement.map_or(point.normal, |(_, to_part)| transform_normal(to_part, point.normal).normalize());
    let mut patch = Patch {
        object_normal: (object_from_part.inverse().transpose() * point.normal).as_vec3(),
        world_normal: normal.as_vec3(),
        color: around.color,
        ..Patch::POINT
    };
    if cone != RayCone::POINT {
        let distance = hit.t * ray.direction.length();
        let world = cone.after(distance).axes_on(ray.direction.as_dvec3(), normal);
        let part = world.map(|axis| placement.map_or(axis, |(_, to_part)| to_part.transform_vector3(axis)));
        patch.world_axes = world.map(|axis| axis.as_vec3());
        patch.object_axes = part.map(|axis| (object_from_part * axis).as_vec3());
        patch.uv_axes = part.map(|axis| around.uv_step(axis));
    }
    patch
}

impl Scene {
    /// What the accelerator's hit knows of its part.
    pub fn part(&self, hit: &Hit) -> &PartInfo {
        match hit.instance.outermost() {
            NO_INSTANCE => &self.world[hit.geometry as usize],
            i => &self.aggregates[self.instances[i as usize].aggregate][hit.geometry as usize],
        }
    }

    /// The lanes of the path that `u` gives a number in `[0, 1)` for.
    pub fn lanes(&self, u: impl FnOnce() -> f32) -> Lanes {
        match self.color {
            ColorMode::Rgb if !self.disperses => Lanes::RGB,
            ColorMode::Spectral if self.keeps_spectra => Lanes::of_spectrum(u()),
            mode => mode.lanes(u()),
        }
    }

    /// What camera rays start with: 1, or 1 / n^2 inside a body, where all radiance is n^2 times brighter.
    pub fn camera_gain(&self, lanes: &Lanes) -> Light {
        match self.ruling(&self.camera_media) {
            Some(body) => self.materials[body as usize].radiance_gain(lanes).map(|gain| 1.0 / gain),
            None => Light::splat(1.0),
        }
    }

    /// The boundary at a hit of a path that is inside of `media`.
    #[inline(always)]
    pub fn interface(&self, lanes: &Lanes, media: &MediumStack, hit: &SurfaceHit) -> Interface {
        let Some(inside) = &self.material(hit).medium else { return Interface::VACUUM };
        let others = if hit.is_front { *media } else { media.left(hit.material) };
        let outside = self.body_of(&others).map_or(&Index::Even(1.0), |m| &m.ior);
        // A body that was never entered (its boundary touches another's) is left without an event.
        let is_known = hit.is_front || media.materials().contains(&hit.material);
        Interface::between(lanes, outside, if is_known { &inside.ior } else { outside })
    }

    /// Everything shading needs at a hit, for a ray that stands for itself alone.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfaceHit {
        self.surface_seen(ray, hit, RayCone::POINT)
    }

    /// Everything shading needs at a hit of a ray in the middle of `cone`.
    pub fn surface_seen(&self, ray: &Ray, hit: &Hit, cone: RayCone) -> SurfaceHit {
        let part = self.part(hit);
        let (mut material, mut object) = (part.material, part.object);
        let mut point;
        let mut patch = Patch::POINT;
        if hit.instance.is_world() {
            let detail = self.materials[material as usize].detail;
            point = part.surface.point(hit.primitive, hit.u, hit.v, hit.t, ray, detail);
            if self.needs_patches && detail == Detail::Texture {
                patch = patch_at(&*part.surface, hit, &point, ray, cone, None);
            }
        } else {
            // Ask in the instance's space, and bring the answer back.
            let instance = &self.instances[hit.instance.outermost() as usize];
            let (to_world, to_part) = instance.still.unwrap_or_else(|| {
                let m = instance.world_from_part.at(f64::from(ray.time));
                (m, m.inverse())
            });
            let local = Ray {
                origin: to_part.transform_point3(ray.origin.as_dvec3()).as_vec3(),
                direction: to_part.transform_vector3(ray.direction.as_dvec3()).as_vec3(),
                ..*ray
            };
            material = instance.material.unwrap_or(material);
            object = instance.object.unwrap_or(object);
            let detail = self.materials[material as usize].detail;
            point = part.surface.point(hit.primitive, hit.u, hit.v, hit.t, &local, detail);
            if self.needs_patches && detail == Detail::Texture {
                patch = patch_at(&*part.surface, hit, &point, ray, cone, Some((&to_world, &to_part)));
            }
            // The ray that leaves is rounded once more on its way into the instance.
            let error = point.error + point.position.abs() * f64::from(gamma(2));
            let a = &to_world.matrix3;
            point.error = a.x_axis.abs() * error.x + a.y_axis.abs() * error.y + a.z_axis.abs() * error.z;
            point.position = to_world.transform_point3(point.position);
            point.normal = transform_normal(&to_part, point.normal).normalize();
            point.shading_normal = transform_normal(&to_part, point.shading_normal).normalize();
            point.tangent = to_world.transform_vector3(point.tangent);
        }
        // Half an ulp for rounding to f32, and one more for what the next intersection loses.
        point.error += point.position.abs() * f64::from(gamma(2));
        let is_front = ray.direction.as_dvec3().dot(point.normal) < 0.0;
        let mut shading = point.shading_normal;
        if !shading.is_finite() {
            shading = point.normal;
        }
        if shading.dot(point.normal) < 0.0 {
            shading = -shading;
        }
        let seen = shading_normal_towards(-ray.direction.as_dvec3(), point.normal, shading);
        SurfaceHit {
            t: hit.t,
            position: point.position,
            error: point.error,
            normal: point.normal,
            frame: Frame::from_z_and_tangent(seen.as_vec3().normalize(), point.tangent.as_vec3()),
            shading_normal: shading,
            is_front,
            texture: TexturePoint {
                uv: point.uv,
                object_position: point.object_position,
                world_position: point.position,
                patch,
            },
            material,
            object,
            emission_group: part.emission_group,
            hit: *hit,
        }
    }

    /// Mean curvature of the surface at a hit (1 / scene unit), positive where it bulges towards where the ray came from.
    pub fn curvature(&self, hit: &SurfaceHit) -> f32 {
        let h = &hit.hit;
        let in_part = self.part(h).surface.curvature(h.primitive, h.u, h.v);
        let scale = match h.instance.outermost() {
            NO_INSTANCE => 1.0,
            i => match &self.instances[i as usize].still {
                Some((_, to_part)) => cbrt(to_part.matrix3.determinant().abs()),
                None => 1.0,
            },
        };
        (in_part * scale * if hit.is_front { 1.0 } else { -1.0 }) as f32
    }

    /// Camera rays see what was hit.
    pub fn is_visible(&self, hit: &Hit) -> bool {
        let geometry = hit.geometry as usize;
        let all = self.accel.scene_geometry();
        let mask = match hit.instance.outermost() {
            NO_INSTANCE => all.world[geometry].mask,
            i => {
                all.instances[i as usize].mask
                    & all.aggregates[self.instances[i as usize].aggregate].geometries[geometry].mask
            }
        };
        mask & PRIMARY != 0
    }

    /// The material of a hit.
    pub fn material(&self, hit: &SurfaceHit) -> &Material {
        &self.materials[hit.material as usize]
    }

    /// The scattering at a hit.
    #[inline(always)]
    pub fn bsdf(&self, lanes: &Lanes, hit: &SurfaceHit, interface: Interface) -> Bsdf {
        self.material(hit).bsdf(lanes, &self.textures, &hit.texture, interface)
    }

    /// Radiance that the surface itself sends towards where the ray came from.
    #[inline]
    pub fn emitted(&self, lanes: &Lanes, hit: &SurfaceHit) -> Light {
        self.emitted_as(lanes, hit, &hit.texture)
    }

    /// The same by a lamp whose points are asked as well: its texture is as sharp here as there.
    #[inline]
    pub fn emitted_at_point(&self, lanes: &Lanes, hit: &SurfaceHit) -> Light {
        match self.texture_footprint {
            0.0 => self.emitted(lanes, hit),
            _ => self.emitted_as(lanes, hit, &hit.texture.alone()),
        }
    }

    #[inline]
    fn emitted_as(&self, lanes: &Lanes, hit: &SurfaceHit, at: &TexturePoint) -> Light {
        match &self.material(hit).emission {
            Some(e) if hit.is_front || e.two_sided => e.radiance(lanes, &self.textures, at, || self.area_scale(hit)),
            _ => Light::BLACK,
        }
    }

    /// The number of the light that a hit belongs to, if it can be sampled.
    pub fn light_of(&self, hit: &SurfaceHit) -> Option<u32> {
        let geometry = hit.hit.geometry as usize;
        let number = match hit.hit.instance.outermost() {
            NO_INSTANCE => self.world[geometry].light,
            i => self.instances[i as usize].lights.get(geometry).copied().unwrap_or(NO_LIGHT),
        };
        (number != NO_LIGHT).then_some(number)
    }

    /// The number by which the picker knows what was hit, if it can be picked.
    pub fn pickable_of(&self, hit: &SurfaceHit) -> Option<u32> {
        self.light_of(hit).map(|light| self.pieces.number(light, hit.hit.primitive))
    }

    /// True when there is something to choose from.
    pub fn has_choice(&self) -> bool {
        self.lights.len() > 1 || !self.pieces.is_empty()
    }

    /// The density per solid angle with which [`Scene::sample_picked`] of `number`, that of `hit`, would have found `hit` from
    /// `from`.
    pub fn light_pdf(&self, number: u32, hit: &SurfaceHit, from: DVec3, time: f64) -> f32 {
        match (&self.lights[self.pieces.light(number) as usize].lamp, self.pieces.area(number)) {
            (Lamp::Area(l), None) => l.pdf(from, hit.position, hit.normal, time),
            (Lamp::Area(l), Some(area)) => l.pdf_by_area(area, from, hit.position, hit.normal, time),
            _ => 0.0,
        }
    }

    /// For emission given as power: 1 / (pi area) of the shining part, as placed.
    fn area_scale(&self, hit: &SurfaceHit) -> f64 {
        match self.light_of(hit).map(|n| &self.lights[n as usize].lamp) {
            Some(Lamp::Area(l)) => l.per_power(),
            _ => std::f64::consts::FRAC_1_PI,
        }
    }

    /// A sample of what the picker knows by `number` as seen from `from`.
    pub fn sample_picked(
        &self,
        lanes: &Lanes,
        number: u32,
        from: DVec3,
        time: f64,
        u: (f32, f32),
    ) -> Option<LightSample> {
        let light = &self.lights[self.pieces.light(number) as usize];
        match (&light.lamp, self.pieces.is_empty()) {
            (Lamp::Area(l), false) => {
                match self.pieces.sample(number, l, u, self.materials[l.material as usize].detail) {
                    Some(s) => l.sample_at(s, lanes, (&self.materials, &self.textures), from, time),
                    None => self.sample_light(lanes, light, from, time, u),
                }
            }
            _ => self.sample_light(lanes, light, from, time, u),
        }
    }

    /// A sample of `light` as seen from `from`.
    pub fn sample_light(
        &self,
        lanes: &Lanes,
        light: &LightEntry,
        from: DVec3,
        time: f64,
        u: (f32, f32),
    ) -> Option<LightSample> {
        light.lamp.sample(lanes, &self.materials, &self.textures, from, time, u)
    }

    /// The body that fills the space at a path's end: the one of highest priority, the last entered among equals.
    pub fn body_of(&self, media: &MediumStack) -> Option<&Medium> {
        self.ruling(media).and_then(|m| self.materials[m as usize].medium.as_ref())
    }

    pub(crate) fn ruling(&self, media: &MediumStack) -> Option<u32> {
        let priority = |m: u32| self.materials[m as usize].medium.as_ref().map_or(i32::MIN, |x| x.priority);
        media.materials().iter().copied().reduce(|best, m| if priority(m) >= priority(best) { m } else { best })
    }

    /// How much brighter radiance is in the body that rules in `media`: its index squared, in green light.
    pub fn gain(&self, media: &MediumStack) -> f32 {
        self.ruling(media).map_or(1.0, |m| self.materials[m as usize].radiance_gain(&Lanes::RGB)[1])
    }

    /// True when the boundary of `material` lies inside a body of higher rank and is not there (Schmidt & Budge 2002).
    pub fn is_covered(&self, media: &MediumStack, material: u32, entering: bool) -> bool {
        let priority = |m: u32| self.materials[m as usize].medium.as_ref().map_or(i32::MIN, |x| x.priority);
        match self.ruling(media) {
            Some(ruler) if entering => priority(ruler) > priority(material),
            Some(ruler) => ruler != material && media.materials().contains(&material),
            None => false,
        }
    }

    /// What is left of light after `distance` through the body that rules in `media`.
    pub fn clearness(&self, lanes: &Lanes, media: &MediumStack, distance: f64) -> Light {
        match self.body_of(media) {
            Some(body) => transmittance(body.absorption.at(lanes), distance as f32),
            None => Light::splat(1.0),
        }
    }

    /// True when nothing fills the space at a path's end.
    pub fn is_empty(&self, media: &MediumStack) -> bool {
        media.materials().is_empty() && self.space.is_none()
    }

    /// Leave out all media, for integrators that would see them only in part.
    pub(crate) fn forget_media(&mut self) {
        self.volumes.clear();
        self.space = None;
        self.materials.iter_mut().for_each(|m| m.interior = None);
    }

    /// What scatters in the space at a path's end.
    pub fn volume_of(&self, media: &MediumStack) -> Option<&Volume> {
        let number = match self.ruling(media) {
            Some(body) => self.materials[body as usize].interior,
            None => self.space,
        };
        number.map(|n| &self.volumes[n as usize])
    }

    /// What is left of light on this way through the body that rules in `media`: exactly, or on average over `key`.
    pub fn transmittance(&self, lanes: &Lanes, media: &MediumStack, way: &Way, key: u64) -> Light {
        let clear = self.clearness(lanes, media, way.length);
        match self.volume_of(media) {
            Some(volume) => clear * volume.transmittance(lanes, way, key),
            None => clear,
        }
    }

    /// What is left of a shadow ray's light, weakened as it goes, on its last way, to the light. `key` names its random numbers.
    pub fn arrived(&self, shadow: &ShadowRay, key: u64) -> Light {
        let end = if shadow.ray.t_max.is_finite() { 1.0 } else { f32::INFINITY };
        shadow.light * self.left_of(shadow, end, key)
    }

    fn left_of(&self, shadow: &ShadowRay, t: f32, key: u64) -> Light {
        match shadow.blocked_by {
            Blocker::Anything => Light::splat(1.0),
            Blocker::Opaque => {
                self.clearness(&shadow.lanes, &shadow.media, f64::from(t * shadow.ray.direction.length()))
            }
            Blocker::AllButHulls => {
                let key = combine(key, u64::from(shadow.passed));
                self.transmittance(&shadow.lanes, &shadow.media, &Way::of_ray(&shadow.ray, t), key)
            }
        }
    }

    /// A shadow ray behind the surface it met, tinted by what that lets through; `None` if it lets nothing through.
    pub fn weakened(&self, shadow: &ShadowRay, hit: &Hit, key: u64) -> Option<ShadowRay> {
        const MOST: u32 = 256;
        let s = self.surface(&shadow.ray, hit);
        let material = self.material(&s);
        let tint = match shadow.blocked_by {
            Blocker::Opaque => material.straight_transmittance(&shadow.lanes, &self.textures, &s.texture)?,
            Blocker::AllButHulls if material.is_hull => Light::splat(1.0),
            _ => return None,
        };
        let mut light = shadow.light * self.left_of(shadow, hit.t, key);
        if !self.is_covered(&shadow.media, s.material, s.is_front) {
            light *= tint;
        }
        let media = if s.is_front { shadow.media.entered(s.material) } else { shadow.media.left(s.material) };
        if light.is_black() || shadow.passed >= MOST {
            return None;
        }
        // Go on to the same end, from the other side.
        let end = shadow.ray.at(1.0).as_dvec3();
        let direction = shadow.ray.direction.as_dvec3();
        let mut ray = s.ray_towards(direction, &shadow.ray);
        if shadow.ray.t_max.is_finite() {
            ray.direction = (end - ray.origin.as_dvec3()).as_vec3();
            ray.t_max = shadow.ray.t_max;
            if ray.direction.dot(shadow.ray.direction) <= 0.0 {
                ray.t_max = 0.0;
            }
        }
        Some(ShadowRay { ray, light, media, passed: shadow.passed + 1, ..*shadow })
    }

    /// Opacity of a hit on a surface with an alpha map.
    pub fn alpha(&self, ray: &Ray, hit: &Hit) -> f32 {
        let s = self.surface(ray, hit);
        self.material(&s).alpha(&self.textures, &s.texture)
    }
}
