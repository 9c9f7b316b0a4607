//! The functions of Embree 3 that we call, found in its library while we run.

use super::layout::{RtcContext, RtcRay, RtcRayHit, RtcRayHit8};
use core::ffi::{c_char, c_int, c_void};
use libloading::{Library, Symbol};

/// A device, scene or geometry of theirs.
pub type Handle = *mut c_void;
/// Told of every piece of memory: user pointer, bytes more or (negative) less, whether it has happened.
pub type MemoryMonitor = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// What the library is called, most particular first.
const NAMES: [&str; 4] = ["libembree3.so.3", "libembree3.so", "libembree3.dylib", "embree3.dll"];

macro_rules! api {
    ($($field:ident = $symbol:literal: fn($($arg:ty),*) $(-> $out:ty)?;)*) => {
        /// Every function, by what it does.
        pub struct Api {
            $(#[doc = $symbol] pub $field: unsafe extern "C" fn($($arg),*) $(-> $out)?,)*
        }

        impl Api {
            fn find(library: &Library) -> Result<Api, libloading::Error> {
                $(
                    // SAFETY: the signature is that of Embree 3's headers.
                    let $field = unsafe {
                        let f: Symbol<unsafe extern "C" fn($($arg),*) $(-> $out)?> = library.get($symbol.as_bytes())?;
                        *f
                    };
                )*
                Ok(Api { $($field,)* })
            }
        }
    };
}

api! {
    new_device = "rtcNewDevice": fn(*const c_char) -> Handle;
    release_device = "rtcReleaseDevice": fn(Handle);
    device_property = "rtcGetDeviceProperty": fn(Handle, c_int) -> isize;
    device_error = "rtcGetDeviceError": fn(Handle) -> c_int;
    set_memory_monitor = "rtcSetDeviceMemoryMonitorFunction": fn(Handle, Option<MemoryMonitor>, *mut c_void);
    new_geometry = "rtcNewGeometry": fn(Handle, c_int) -> Handle;
    set_shared_buffer = "rtcSetSharedGeometryBuffer":
        fn(Handle, c_int, u32, c_int, *const c_void, usize, usize, usize);
    commit_geometry = "rtcCommitGeometry": fn(Handle);
    release_geometry = "rtcReleaseGeometry": fn(Handle);
    new_scene = "rtcNewScene": fn(Handle) -> Handle;
    set_scene_flags = "rtcSetSceneFlags": fn(Handle, c_int);
    set_scene_quality = "rtcSetSceneBuildQuality": fn(Handle, c_int);
    attach_geometry = "rtcAttachGeometry": fn(Handle, Handle) -> u32;
    commit_scene = "rtcCommitScene": fn(Handle);
    release_scene = "rtcReleaseScene": fn(Handle);
    intersect1 = "rtcIntersect1": fn(Handle, *mut RtcContext, *mut RtcRayHit);
    intersect8 = "rtcIntersect8": fn(*const c_int, Handle, *mut RtcContext, *mut RtcRayHit8);
    occluded1 = "rtcOccluded1": fn(Handle, *mut RtcContext, *mut RtcRay);
}

impl Api {
    /// Load the library; the error says how to install it.
    pub fn load() -> Result<Api, String> {
        // SAFETY: Embree's library has no initialisers that ask anything of us.
        let library = NAMES.iter().find_map(|name| unsafe { Library::new(*name) }.ok());
        let library =
            library.ok_or("not found; `apt-get install libembree-dev` (Debian, Ubuntu) installs version 3")?;
        // It stays in memory for good: its threads may run on after its last device is gone.
        let library: &'static Library = Box::leak(Box::new(library));
        Api::find(library).map_err(|e| format!("not the library we know: {e}"))
    }
}
