//! What the structures share that cut primitives by cells (`kd_tree`, `grid`), and why they lose no hit.
//!
//! Write `D` for the largest distance, along an axis, from a ray's origin to the far side of the structure, `u` for a
//! rounding (2^-24), `T(x)` for the computed distance to a plane, as the box test has it. By definition a hit's `t` lies in
//! the interval that the box test gives for the primitive's own bounds `B`.
//!
//! 1. *Boxes.* If a plane cuts a box in two, then each `t` of the box' interval lies in the interval of one half: `t` is
//!    either at most `pad_far(T(plane))`, or after `T(plane)`. So for each hit some cell `V` of a kd-tree has `t` in the
//!    interval of `B` cut by `V`; the test being monotone, the ray visits that cell, and enters it no later than `t`. A
//!    primitive that is listed wherever `B` meets a cell is found, for any ray.
//! 2. *Planes.* A triangle may be left out of cells of `B` that its plane passes by ([`Clip`]). The edge test is that of a
//!    triangle whose corners moved by at most `12 u D`; with it, the plane's `t`, clamped into the interval of `B`, is at most
//!    `48 u D` off the plane, and `20 u D` off the cut of `B` by `V`: less than the growth of the plane, `128 u D`, if
//!    `D` is below 8 sizes of the structure. It may not be left out of the cells between its edges and `B`:
//!    where a ray grazes the plane beside an edge, within the error of the edge test, the hit can lie there.
//! 3. *Far rays.* From farther away no growth would do. But the ray as tested passes the triangle itself within
//!    `12 u D`, so somewhere, perhaps not at the hit's `t`, it passes a cell where the triangle is listed: for such rays
//!    all cells within `64 u D` of the whole line are visited ([`CellRay`]). Where numbers leave the range in which this
//!    holds, every cell is.

mod clip;
mod mailbox;
mod reach;

pub(crate) use clip::Clip;
pub(crate) use mailbox::Mailbox;
pub(crate) use reach::{CellRay, growth, thickness};
