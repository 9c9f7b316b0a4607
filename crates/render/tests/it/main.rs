//! Everything that the renderer promises.

mod adaptive;
mod backgrounds;
mod bodies;
mod cameras;
mod contributions;
mod effects;
mod everything;
mod films;
mod filters;
mod hostile;
mod light_sampling;
mod manuals;
mod numbers;
mod observer;
mod samplers;
mod scale;
mod shapes;
mod shapes_areas;
mod shapes_cases;
mod shapes_errors;
mod shapes_offsets;
mod support;
mod textures;
mod whitted;
