//! # group
//!
//! Objects that move and are placed together: those that name it as their `parent`. Its material holds for children without
//! one. `compile_scene` takes it apart; no ray ever meets it.
//!
//! ## Parameters
//! - `template` (default `false`): true: drawn only where an `instance` puts it.
//!
//! ## Example
//! ```toml
//! [objects.tree]
//! type = "group"
//! template = true
//! ```
//!
//! ## Limits
//! A group may not be its own ancestor.
//!
//! ## References
//! None needed.

use kirkas_scene::{Kind, ParamSpec, TypeSpec};

/// Its table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Object,
    name: "group",
    doc: "Objects that belong together: those that name it as `parent`.",
    params: &[ParamSpec::bool("template", false, "Drawn only through instances.")],
};
