//! # instance
//!
//! Another object once more, at another place and without a copy in memory. `compile_scene` places it.
//!
//! ## Parameters
//! - `of` (name of an object, required): what to show; a group with all its children, or one shape. The instance's transform
//!   comes after the object's own.
//!
//! ## Example
//! ```toml
//! [objects.second_tree]
//! type = "instance"
//! of = "tree"
//! transform = [{ translate = [3, 0, 0] }]
//! ```
//!
//! ## Limits
//! An instance may not contain itself.
//!
//! ## References
//! None needed.

use kirkas_scene::{Fallback, Kind, ParamSpec, ParamType, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "instance",
    doc: "Another object once more, at another place.",
    params: &[ParamSpec::new("of", ParamType::Reference(Kind::Object), Fallback::Required, "What to show.")],
};
