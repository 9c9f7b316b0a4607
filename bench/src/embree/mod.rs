//! Embree 3, loaded at run time where it is installed, behind the same questions as ours.

mod api;
mod layout;

use crate::clock::Clock;
use crate::scenes::Scene;
use crate::tracer::{Answer, Tracer, Way};
use api::{Api, Handle};
use core::ffi::{c_int, c_void};
use kirkas_geometry::Ray;
use layout::{RtcContext, RtcRay, RtcRayHit, RtcRayHit8};
use std::ffi::CString;
use std::sync::Arc;
use std::sync::atomic::{AtomicIsize, Ordering};

/// How a scene is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Its name in tables and rows.
    pub name: &'static str,
    /// `RTCBuildQuality`.
    level: c_int,
    /// `RTCSceneFlags`.
    flags: c_int,
}

impl Quality {
    /// Morton codes.
    pub const LOW: Quality = Quality { name: "low", level: 0, flags: 0 };
    /// Binned surface-area heuristic; what one gets without asking.
    pub const MEDIUM: Quality = Quality { name: "medium", level: 1, flags: 0 };
    /// With spatial splits.
    pub const HIGH: Quality = Quality { name: "high", level: 2, flags: 0 };
    /// The best that its watertight mode offers.
    pub const ROBUST: Quality = Quality { name: "high+robust", level: 2, flags: 4 };
    /// As little memory as it can.
    pub const COMPACT: Quality = Quality { name: "medium+compact", level: 1, flags: 2 };
}

/// The library.
pub struct Embree {
    api: Arc<Api>,
}

impl Embree {
    /// Load it; the error says how to install it.
    pub fn load() -> Result<Embree, String> {
        Api::load().map(|api| Embree { api: Arc::new(api) })
    }

    /// Like `3.13.5`.
    pub fn version(&self) -> String {
        let Ok(device) = Device::new(&self.api, 1, None) else { return "of unknown version".into() };
        // SAFETY: the device is alive; properties 1 to 3 are the parts of the version.
        let part = |k| unsafe { (self.api.device_property)(device.handle, k) };
        format!("{}.{}.{}", part(1), part(2), part(3))
    }

    /// Build over a scene with `threads` threads. `isa` limits the instructions, as Embree names them.
    pub fn prepare(&self, scene: &Scene, threads: usize, isa: Option<&str>) -> Result<Prepared, String> {
        let mut vertices: Vec<f32> = scene.positions.iter().flat_map(|p| p.to_array()).collect();
        // Embree reads 16 bytes at the last vertex.
        vertices.push(0.0);
        let device = Device::new(&self.api, threads, isa)?;
        Ok(Prepared { device, vertices, indices: Arc::clone(&scene.indices) })
    }
}

struct Device {
    api: Arc<Api>,
    handle: Handle,
    bytes: Box<AtomicIsize>,
}

impl Device {
    fn new(api: &Arc<Api>, threads: usize, isa: Option<&str>) -> Result<Device, String> {
        let isa = isa.map_or(String::new(), |i| format!(",isa={i}"));
        let settings = CString::new(format!("threads={threads}{isa}")).map_err(|e| e.to_string())?;
        let bytes = Box::new(AtomicIsize::new(0));
        // SAFETY: the settings are a C string; the counter lives on the heap as long as the device, see `drop`.
        let handle = unsafe {
            let handle = (api.new_device)(settings.as_ptr());
            if handle.is_null() {
                return Err(format!("Embree gives no device: error {}", (api.device_error)(handle)));
            }
            (api.set_memory_monitor)(handle, Some(count_bytes), (&raw const *bytes).cast_mut().cast());
            handle
        };
        Ok(Device { api: Arc::clone(api), handle, bytes })
    }

    fn check(&self) -> Result<(), String> {
        // SAFETY: the device is alive.
        match unsafe { (self.api.device_error)(self.handle) } {
            0 => Ok(()),
            code => Err(format!("Embree reports error {code}")),
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: ours, released once; the monitor is taken away before its counter goes.
        unsafe {
            (self.api.set_memory_monitor)(self.handle, None, core::ptr::null_mut());
            (self.api.release_device)(self.handle);
        }
    }
}

unsafe extern "C" fn count_bytes(counter: *mut c_void, bytes: isize, _: bool) -> bool {
    // SAFETY: `counter` is the one given with this function, alive until it is taken away.
    unsafe { &*counter.cast::<AtomicIsize>() }.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// A device, and the triangles in the form that Embree wants.
pub struct Prepared {
    device: Device,
    vertices: Vec<f32>,
    indices: Arc<Vec<[u32; 3]>>,
}

impl Prepared {
    /// Build.
    pub fn build(&self, quality: Quality) -> Result<Built<'_>, String> {
        const TRIANGLES: c_int = 0;
        const INDEX: c_int = 0;
        const VERTEX: c_int = 1;
        const UINT3: c_int = 0x5003;
        const FLOAT3: c_int = 0x9003;
        let (api, device) = (&*self.device.api, self.device.handle);
        let (vertices, indices) = (self.vertices.as_ptr().cast(), self.indices.as_ptr().cast());
        let before = self.device.bytes.load(Ordering::Relaxed);
        // SAFETY: buffers as the headers ask (strides 12, padding behind the last vertex), borrowed by what is returned.
        let scene = unsafe {
            let geometry = (api.new_geometry)(device, TRIANGLES);
            (api.set_shared_buffer)(geometry, VERTEX, 0, FLOAT3, vertices, 0, 12, self.vertices.len() / 3);
            (api.set_shared_buffer)(geometry, INDEX, 0, UINT3, indices, 0, 12, self.indices.len());
            (api.commit_geometry)(geometry);
            let scene = (api.new_scene)(device);
            (api.set_scene_flags)(scene, quality.flags);
            (api.set_scene_quality)(scene, quality.level);
            (api.attach_geometry)(scene, geometry);
            (api.release_geometry)(geometry);
            (api.commit_scene)(scene);
            scene
        };
        let bytes = self.device.bytes.load(Ordering::Relaxed) - before;
        let built = Built { prepared: self, scene, bytes };
        self.device.check()?;
        Ok(built)
    }
}

/// A scene that can be traced.
pub struct Built<'a> {
    prepared: &'a Prepared,
    scene: Handle,
    /// Memory that it holds, without the triangles given to it.
    pub bytes: isize,
}

impl Drop for Built<'_> {
    fn drop(&mut self) {
        // SAFETY: ours, released once.
        unsafe { (self.prepared.device.api.release_scene)(self.scene) }
    }
}

impl Tracer for Built<'_> {
    fn trace(&self, rays: &[Ray], any: bool, way: Way) -> (f64, Vec<Answer>) {
        // Written before the clock runs, so that the pages are there.
        let mut answers = vec![Answer { t: 0.0, primitive: 0 }; rays.len()];
        let seconds = match (way, any) {
            (Way::Packet, false) => {
                // A renderer that has packets makes its rays as packets: that is not timed, a copy of them is.
                let packets: Vec<RtcRayHit8> = rays.chunks(8).map(RtcRayHit8::new).collect();
                Clock::Thread.seconds(|| self.packets(&packets, &mut answers))
            }
            (_, true) => Clock::Thread.seconds(|| self.occluded(rays, &mut answers)),
            (_, false) => Clock::Thread.seconds(|| self.nearest(rays, &mut answers)),
        };
        (seconds, answers)
    }
}

impl Built<'_> {
    fn nearest(&self, rays: &[Ray], answers: &mut [Answer]) {
        let mut context = RtcContext::new(false);
        let intersect1 = self.prepared.device.api.intersect1;
        for (ray, answer) in rays.iter().zip(answers) {
            let mut both = RtcRayHit::new(ray);
            // SAFETY: scene and structures are alive and laid out as the headers say.
            unsafe { intersect1(self.scene, &mut context, &mut both) };
            *answer = both.answer();
        }
    }

    fn occluded(&self, rays: &[Ray], answers: &mut [Answer]) {
        let mut context = RtcContext::new(false);
        let occluded1 = self.prepared.device.api.occluded1;
        for (ray, answer) in rays.iter().zip(answers) {
            let mut ray = RtcRay::new(ray);
            // SAFETY: as above.
            unsafe { occluded1(self.scene, &mut context, &mut ray) };
            let is_hit = ray.t_far == f32::NEG_INFINITY;
            *answer = if is_hit { Answer { t: 0.0, primitive: 0 } } else { Answer::MISS };
        }
    }

    fn packets(&self, packets: &[RtcRayHit8], answers: &mut [Answer]) {
        let mut context = RtcContext::new(true);
        let intersect8 = self.prepared.device.api.intersect8;
        let valid = Valid([-1; 8]);
        for (packet, answers) in packets.iter().zip(answers.chunks_mut(8)) {
            let mut packet = *packet;
            // SAFETY: as above; `valid` holds eight numbers, aligned to 32 bytes.
            unsafe { intersect8(valid.0.as_ptr(), self.scene, &mut context, &mut packet) };
            for (i, answer) in answers.iter_mut().enumerate() {
                *answer = packet.answer(i);
            }
        }
    }
}

/// Which rays of a packet count: -1 each.
#[repr(align(32))]
struct Valid([c_int; 8]);
