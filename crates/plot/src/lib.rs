//! Plots as SVG and as pixels: curves over an axis, curves around a point, maps in false colour.
//!
//! A chart becomes a [`Drawing`] of paths, texts and pictures, which either writer shows alike. Knows nothing of light, and needs
//! no fonts of the system: its own lies beside it.

pub mod drawing;
pub mod font;
pub mod raster;
pub mod svg;

pub mod color;
pub mod scale;

pub mod chart;
pub mod legend;
pub mod map;
pub mod polar;

pub use chart::{Chart, Curve, Mark};
pub use color::{Color, Dash};
pub use drawing::{Anchor, Drawing, Picture};
pub use legend::Entry;
pub use map::Map;
pub use polar::{Around, Polar, Ray};
pub use raster::{Pixels, rasterize};
pub use scale::{Axis, Scale};
pub use svg::write_svg;
