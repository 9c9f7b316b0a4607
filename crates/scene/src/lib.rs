//! What a scene *says*, before anything is built from it: a tree of values that all know where they were written, the
//! tables that say what may be written, validation against them, and the door through which files are read.
//!
//! No behaviour and no file syntax live here. Formats make a [`Description`]; the renderer compiles it.

pub mod assets;
pub mod description;
pub mod diagnostic;
pub mod files;
pub mod params;
pub mod source;
pub mod spec;
pub mod transforms;
pub mod validate;
pub mod value;
pub mod waves;

pub use assets::{Assets, MeshData, MeshPart};
pub use description::{Description, Entity, Kind};
pub use diagnostic::{Diagnostic, Severity};
pub use params::Params;
pub use source::{SourceId, Sources, Span};
pub use spec::{Catalog, Fallback, ParamSpec, ParamType, TypeSpec};
pub use value::{Map, Name, Node, Value};
