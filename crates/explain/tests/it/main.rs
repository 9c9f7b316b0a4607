//! What is said of a pixel is exactly what made it, and what is found is right.

mod course;
mod defects;
mod exact;
mod layout;
mod support;
