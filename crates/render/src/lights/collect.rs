//! Gathers what shines besides the lights that are written as such: parts with an emitter material, and the background.

use super::emit::BoundingSphere;
use super::{AreaLight, Lamp, LightEntry, area_growth};
use crate::materials::Material;
use crate::placement::PlacedPart;
use crate::scene::{InstanceInfo, NO_LIGHT, PartInfo, Scene};
use kirkas_geometry::{Bounds3, DVec3};
use kirkas_scene::Diagnostic;
use std::collections::BTreeMap;

/// Every shining part becomes a light, once for each place where it stands; parts and instances learn its number.
pub(crate) fn add_area_lights(
    world: &mut [PlacedPart],
    aggregates: &[Vec<PlacedPart>],
    instances: &mut [InstanceInfo],
    materials: &[Material],
    object_names: &[String],
    lights: &mut Vec<LightEntry>,
    warnings: &mut Vec<Diagnostic>,
) {
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    let mut add = |part: &PlacedPart, instance: Option<&InstanceInfo>| -> u32 {
        let material = instance.and_then(|i| i.material).unwrap_or(part.info.material);
        let Some(emission) = &materials[material as usize].emission else { return NO_LIGHT };
        let object = instance.and_then(|i| i.object).unwrap_or(part.info.object);
        let mut name = object_names[object as usize].clone();
        let same = counts.entry(object).or_default();
        *same += 1;
        if *same > 1 {
            name = format!("{name}#{same}");
        }
        let Some(area) = part.info.surface.area() else {
            warnings.push(
                Diagnostic::warning(
                    "unsampled-light",
                    format!("`{name}` shines, but lights nothing: its shape cannot be sampled"),
                )
                .help("use a rectangle, disk, sphere or mesh, not stretched, as the lamp"),
            );
            return NO_LIGHT;
        };
        let growth = instance.map_or(1.0, |i| area_growth(&i.world_from_part.at(0.0)));
        let lamp = AreaLight {
            surface: part.info.surface.clone(),
            placement: instance.map(|i| i.world_from_part.clone()),
            material,
            area: area * growth,
        };
        lights.push(LightEntry::new(&name, part.info.emission_group, emission.samples, Lamp::Area(Box::new(lamp))));
        lights.len() as u32 - 1
    };
    for part in world {
        part.info.light = add(part, None);
    }
    for instance in instances {
        let numbers: Vec<u32> = aggregates[instance.aggregate].iter().map(|part| add(part, Some(&*instance))).collect();
        if numbers.iter().any(|&n| n != NO_LIGHT) {
            instance.lights = numbers.into();
        }
    }
}

/// Half the diagonal of what is bounded in the scene, scene units: how wide a beam from far away must be to meet all of it.
pub(crate) fn scene_radius(world: &[PlacedPart], aggregates: &[Vec<PlacedPart>], instances: &[InstanceInfo]) -> f64 {
    let around = |parts: &[PlacedPart]| {
        let bounds = parts.iter().map(|p| p.info.surface.bounds()).filter(Bounds3::is_finite);
        bounds.fold(Bounds3::EMPTY, |all, b| all.union(b))
    };
    let local: Vec<Bounds3> = aggregates.iter().map(|a| around(a)).collect();
    let placed = instances.iter().map(|i| local[i.aggregate].transformed(&i.world_from_part.at(0.0)));
    let all = placed.filter(Bounds3::is_finite).fold(around(world), |all, b| all.union(b));
    if all.is_empty() { 1.0 } else { 0.5 * (all.max.as_dvec3() - all.min.as_dvec3()).length() }
}

impl Scene {
    /// Around everything bounded, wherever it is from time `open` to time `close`.
    pub(crate) fn bounding_sphere(&self, (open, close): (f64, f64)) -> BoundingSphere {
        let around = |parts: &[PartInfo]| {
            let bounds = parts.iter().map(|p| p.surface.bounds()).filter(Bounds3::is_finite);
            bounds.fold(Bounds3::EMPTY, |all, b| all.union(b))
        };
        let local: Vec<Bounds3> = self.aggregates.iter().map(|a| around(a)).collect();
        let placed = self.instances.iter().map(|i| i.world_from_part.swept_bounds(&local[i.aggregate], open, close));
        let space = self.space.and_then(|n| self.volumes[n as usize].bounds());
        let others = placed.chain(space).filter(Bounds3::is_finite);
        let all = others.fold(around(&self.world), |all, b| all.union(b));
        if all.is_empty() {
            return BoundingSphere { center: DVec3::ZERO, radius: 1.0 };
        }
        let (min, max) = (all.min.as_dvec3(), all.max.as_dvec3());
        BoundingSphere { center: 0.5 * (min + max), radius: 0.5 * (max - min).length() }
    }
}
