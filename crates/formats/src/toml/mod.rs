//! The native format: flat TOML.
//!
//! ```toml
//! version = 1
//! title = "A ball"
//! include = ["studio.toml"]        # read first; paths are relative to this file
//!
//! [film]                           # one film, sampler, integrator, accelerator, background
//! width = 320
//!
//! [materials.red]                  # cameras, lights, textures, materials, objects have names
//! type = "lambert"
//! reflectance = [0.8, 0.1, 0.1]
//!
//! [objects.ball]
//! type = "sphere"
//! radius = 1
//! material = "red"
//! ```
//!
//! - `include`: the entities of included files come first, in written order. A single kind (`[film]`) that stands in several
//!   files is joined key by key, the later word wins; where the later one names another `type`, the earlier one is forgotten
//!   altogether. A file that is included on two ways is read once.
//! - `type` may be left out for single kinds.
//! - Names of entities of a kind are unique over all files.

mod override_value;
mod read;
mod syntax;
mod value;
mod write;

pub use override_value::apply_override;
pub use read::read;
pub use write::write;
