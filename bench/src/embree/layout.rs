//! Embree 3's structures and numbers, as its headers `rtcore_ray.h` and `rtcore_common.h` lay them out.

use super::Answer;
use core::ffi::c_void;
use kirkas_geometry::Ray;

/// `RTC_INVALID_GEOMETRY_ID`.
const NOTHING: u32 = u32::MAX;

/// `RTCRay`.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub struct RtcRay {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    /// Negative infinity once `rtcOccluded1` found a hit.
    pub t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// `RTCHit`.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct RtcHit {
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: u32,
    geometry: u32,
    instance: u32,
}

/// `RTCRayHit`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RtcRayHit {
    ray: RtcRay,
    hit: RtcHit,
}

/// `RTCRayHit8`.
#[repr(C, align(32))]
#[derive(Clone, Copy)]
pub struct RtcRayHit8 {
    origin: [[f32; 8]; 3],
    t_near: [f32; 8],
    direction: [[f32; 8]; 3],
    time: [f32; 8],
    t_far: [f32; 8],
    mask: [u32; 8],
    id: [u32; 8],
    flags: [u32; 8],
    normal: [[f32; 8]; 3],
    uv: [[f32; 8]; 2],
    primitive: [u32; 8],
    geometry: [u32; 8],
    instance: [u32; 8],
}

/// `RTCIntersectContext` of a build without nested instances; its last field is there or is padding.
#[repr(C)]
pub struct RtcContext {
    flags: u32,
    filter: *const c_void,
    instance: u32,
    min_width: f32,
}

const _: () = assert!(size_of::<RtcRay>() == 48 && size_of::<RtcRayHit>() == 80);
const _: () = assert!(size_of::<RtcRayHit8>() == 640 && size_of::<RtcContext>() == 24);

impl RtcContext {
    /// `RTC_INTERSECT_CONTEXT_FLAG_COHERENT` or its contrary.
    pub fn new(is_coherent: bool) -> Self {
        RtcContext { flags: is_coherent.into(), filter: core::ptr::null(), instance: NOTHING, min_width: 0.0 }
    }
}

impl RtcRay {
    /// Ours as theirs.
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        RtcRay {
            origin: ray.origin.to_array(),
            t_near: ray.t_min,
            direction: ray.direction.to_array(),
            time: ray.time,
            t_far: ray.t_max,
            mask: ray.mask,
            id: 0,
            flags: 0,
        }
    }
}

impl RtcRayHit {
    /// A ray that has hit nothing yet.
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let hit = RtcHit { normal: [0.0; 3], uv: [0.0; 2], primitive: NOTHING, geometry: NOTHING, instance: NOTHING };
        RtcRayHit { ray: RtcRay::new(ray), hit }
    }

    /// What it has hit.
    #[inline]
    pub fn answer(&self) -> Answer {
        if self.hit.geometry == NOTHING {
            return Answer::MISS;
        }
        Answer { t: self.ray.t_far, primitive: self.hit.primitive }
    }
}

impl RtcRayHit8 {
    /// At most eight rays that have hit nothing yet; those that lack are switched off by their interval.
    pub fn new(rays: &[Ray]) -> Self {
        let pick = |f: &dyn Fn(&Ray) -> f32, none: f32| core::array::from_fn(|i| rays.get(i).map_or(none, f));
        RtcRayHit8 {
            origin: core::array::from_fn(|k| pick(&|r| r.origin[k], 0.0)),
            t_near: pick(&|r| r.t_min, 0.0),
            direction: core::array::from_fn(|k| pick(&|r| r.direction[k], 1.0)),
            time: [0.0; 8],
            t_far: pick(&|r| r.t_max, f32::NEG_INFINITY),
            mask: [u32::MAX; 8],
            id: [0; 8],
            flags: [0; 8],
            normal: [[0.0; 8]; 3],
            uv: [[0.0; 8]; 2],
            primitive: [NOTHING; 8],
            geometry: [NOTHING; 8],
            instance: [NOTHING; 8],
        }
    }

    /// What ray `i` has hit.
    #[inline]
    pub fn answer(&self, i: usize) -> Answer {
        if self.geometry[i] == NOTHING {
            return Answer::MISS;
        }
        Answer { t: self.t_far[i], primitive: self.primitive[i] }
    }
}
