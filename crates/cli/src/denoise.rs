//! Open Image Denoise (Afra 2019), found when it is asked for: a C library of versions 1 or 2, loaded by name.
//!
//! Its filter "RT" takes the noisy picture, and the albedo and normals of the first hits as guides. It runs on the CPU; what it
//! gives may differ between its versions and between processors, so the noisy picture is always kept.

use crate::problem::Problem;
use kirkas_images::RgbImage;
use kirkas_scene::Diagnostic;
use libloading::Library;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null;

/// Where the library is, if not where the system looks for libraries.
const PLACE: &str = "KIRKAS_OIDN";

/// Names under which systems know the library.
const NAMES: &[&str] = if cfg!(windows) {
    &["OpenImageDenoise.dll"]
} else if cfg!(target_os = "macos") {
    &[
        "libOpenImageDenoise.dylib",
        "/opt/homebrew/lib/libOpenImageDenoise.dylib",
        "/usr/local/lib/libOpenImageDenoise.dylib",
    ]
} else {
    &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1", "libOpenImageDenoise.so"]
};

const CPU: c_int = 1;
const FLOAT3: c_int = 3;

/// The library.
pub struct Denoiser(Library);

/// A device or a filter of the library's.
type Handle = *mut c_void;
type SetImage = unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);

impl Denoiser {
    /// Find the library, or say how to get it.
    pub fn find() -> Result<Self, Problem> {
        let named = std::env::var_os(PLACE).filter(|p| !p.is_empty());
        let names: Vec<&Path> = named.as_ref().map_or(NAMES.iter().map(Path::new).collect(), |p| vec![Path::new(p)]);
        let mut why = String::new();
        for name in names {
            // SAFETY: loading runs the initialisers of the library that the user has installed, or named, for this use.
            match unsafe { Library::new(name) } {
                Ok(library) => return Ok(Denoiser(library)),
                Err(e) => why = e.to_string(),
            }
        }
        Err(absent(&why))
    }

    /// The picture without its noise. All three have equally many pixels.
    pub fn denoise(&self, noisy: &RgbImage, albedo: &[[f32; 3]], normals: &[[f32; 3]]) -> Result<RgbImage, Problem> {
        let count = noisy.pixels.len();
        assert!(
            albedo.len() == count && normals.len() == count && count == noisy.width as usize * noisy.height as usize
        );
        let mut clean = noisy.clone();
        // SAFETY: the functions have these types in the headers of versions 1.0 to 2.x (an enum is an `int`); the images are
        // `count` packed triples of floats that outlive the filter, and only `clean` is written to, by no one else.
        unsafe {
            let device = self.function::<unsafe extern "C" fn(c_int) -> Handle>(c"oidnNewDevice")?(CPU);
            if device.is_null() {
                return Err(failed("it has no device for this processor"));
            }
            if let Ok(set) = self
                .either::<unsafe extern "C" fn(Handle, *const c_char, c_int)>(c"oidnSetDeviceInt", c"oidnSetDevice1i")
            {
                set(device, c"numThreads".as_ptr(), rayon::current_num_threads() as c_int);
            }
            self.function::<unsafe extern "C" fn(Handle)>(c"oidnCommitDevice")?(device);
            let filter = self.function::<unsafe extern "C" fn(Handle, *const c_char) -> Handle>(c"oidnNewFilter")?(
                device,
                c"RT".as_ptr(),
            );
            let set_image = self.function::<SetImage>(c"oidnSetSharedFilterImage")?;
            let image = |name: &CStr, data: *mut c_void| {
                set_image(filter, name.as_ptr(), data, FLOAT3, noisy.width as usize, noisy.height as usize, 0, 0, 0);
            };
            image(c"color", noisy.pixels.as_ptr().cast_mut().cast());
            image(c"albedo", albedo.as_ptr().cast_mut().cast());
            image(c"normal", normals.as_ptr().cast_mut().cast());
            image(c"output", clean.pixels.as_mut_ptr().cast());
            let set = self.either::<unsafe extern "C" fn(Handle, *const c_char, bool)>(
                c"oidnSetFilterBool",
                c"oidnSetFilter1b",
            )?;
            set(filter, c"hdr".as_ptr(), true);
            self.function::<unsafe extern "C" fn(Handle)>(c"oidnCommitFilter")?(filter);
            self.function::<unsafe extern "C" fn(Handle)>(c"oidnExecuteFilter")?(filter);
            let mut message = null();
            let error =
                self.function::<unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int>(c"oidnGetDeviceError")?;
            let code = error(device, &mut message);
            let why =
                if message.is_null() { String::new() } else { CStr::from_ptr(message).to_string_lossy().into_owned() };
            self.function::<unsafe extern "C" fn(Handle)>(c"oidnReleaseFilter")?(filter);
            self.function::<unsafe extern "C" fn(Handle)>(c"oidnReleaseDevice")?(device);
            if code != 0 {
                return Err(failed(&why));
            }
        }
        Ok(clean)
    }

    /// A function by name.
    ///
    /// # Safety
    /// `F` must be its type.
    unsafe fn function<F: Copy>(&self, name: &CStr) -> Result<F, Problem> {
        // SAFETY: as the caller promises.
        let symbol = unsafe { self.0.get::<F>(name) };
        symbol.map(|s| *s).map_err(|_| failed(&format!("it has no function `{}`", name.to_string_lossy())))
    }

    /// A function that version 2 calls `new` and version 1 `old`.
    ///
    /// # Safety
    /// As for [`Denoiser::function`].
    unsafe fn either<F: Copy>(&self, new: &CStr, old: &CStr) -> Result<F, Problem> {
        // SAFETY: as the caller promises.
        unsafe { self.function(new).or_else(|_| self.function(old)) }
    }
}

fn absent(why: &str) -> Problem {
    let message = format!("Open Image Denoise is not installed, or cannot be loaded: {why}");
    let help = format!(
        "install it (`apt install libopenimagedenoise2`, `brew install open-image-denoise`, or openimagedenoise.org), or say in \
         {PLACE} where libOpenImageDenoise is; or leave out --denoise"
    );
    Problem::failed(Diagnostic::error("no-denoiser", message).help(help))
}

fn failed(why: &str) -> Problem {
    Problem::failed(
        Diagnostic::error("denoise-failed", format!("Open Image Denoise failed: {why}")).help("leave out --denoise"),
    )
}
