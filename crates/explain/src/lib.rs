//! Why a pixel has its colour: the samples that made it are replayed before a recorder, and what it saw is told as a tree, as a
//! paragraph, and as JSON.
//!
//! Nothing here traces light a second time: [`Recorder`] is an observer of the one code path that renders, and what it
//! records adds up to the pixel's stored integers exactly.
//!
//! ```text
//! Renderer::replay -> Recorder -> Explanation (record.rs, one list of all fields: JSON, schema and docs)
//!                                   -> stories  what share of the light came which way
//!                                   -> findings what may be wrong
//!                                   -> tree     for the terminal
//!                                   -> page     for the browser: one file of HTML
//! ```

mod fields;
mod finding;
mod page;
mod record;
mod recorder;
mod story;
mod tree;
mod wireframe;

pub use finding::{Finding, findings};
pub use page::page;
pub use record::{
    Answered, Asked, Blocker, Contribution, Explanation, Hit, Node, Sample, Saw, Sending, VERSION, schema,
};
pub use recorder::{Recorder, explain};
pub use story::{Story, stories, summary};
pub use tree::{Style, tree};
