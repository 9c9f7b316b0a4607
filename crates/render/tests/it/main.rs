//! Everything that the renderer promises.

mod cameras;
mod filters;
mod shapes;
mod shapes_areas;
mod shapes_cases;
mod shapes_errors;
mod shapes_offsets;
mod textures;
