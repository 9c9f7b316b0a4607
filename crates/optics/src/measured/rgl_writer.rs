//! Writing `.bsdf` files: any reflectance, looked at where the file's own warp puts its measurements.
//!
//! What an instrument does by the method of Dupuy & Jakob (2018, section 4), except that the density of facets is given and
//! not found by power iterations.

use super::rgl::{angles, facet, square};
use super::tensor_file;
use super::warp::{Blend, Grid, Warp};
use crate::fresnel::reflect;
use core::f64::consts::{FRAC_PI_2, PI};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::sin;

/// How fine a file is.
#[derive(Clone, Debug, PartialEq)]
pub struct RglGrid {
    /// Longitudes of the slices, radians, rising; one for isotropic materials, else all round, or half or a quarter of it for those
    /// that are the same after that turn, or mirrored in x and y: from -pi up.
    pub phi_i: Vec<f32>,
    /// Angles of the slices, radians, rising.
    pub theta_i: Vec<f32>,
    /// Vertices each way of the tables of facets.
    pub facets: usize,
    /// Vertices each way of the measurements.
    pub values: usize,
    /// Wavelengths in nm, rising; nothing for red, green and blue.
    pub wavelengths: Option<Vec<f32>>,
}

/// The bytes of a file. `density` is of facets by normal, 1/sr, to any scale; `f(i, o, channel)` the reflectance in 1/sr,
/// without the cosine.
pub fn write_rgl(grid: &RglGrid, density: impl Fn(Vec3) -> f32, f: impl Fn(Vec3, Vec3, usize) -> f32) -> Vec<u8> {
    let (n, is_isotropic) = (grid.facets, grid.phi_i.len() <= 2);
    let vertex = |i: usize, n: usize| i as f32 / (n - 1) as f32;
    let points = |n: usize| (0..n * n).map(move |k| (vertex(k % n, n), vertex(k / n, n)));
    let table = |values: Vec<f32>| Grid { width: n, height: n, values };

    // Density and projected area of the facets.
    let ndf = table(points(n).map(|p| density(facet(p, 0.0))).collect());
    let cell = 1.0 / ((n - 1) * (n - 1)) as f32;
    // The first and last longitude are one.
    let weigh = |p: (f32, f32)| (facet(p, 0.0), ndf.at(p) * solid_angle(p.0) * cell);
    let facets: Vec<(Vec3, f32)> = points(n).filter(|p| p.1 < 1.0).map(weigh).collect();
    let seen = |w: Vec3| facets.iter().map(|(m, area)| area * w.dot(*m).max(0.0)).sum::<f32>();
    let sigma = table(points(n).map(|p| seen(facet(p, 0.0))).collect());

    // Each slice: the warp by visible facets, and what is measured through it.
    let (mut visible, mut luminance, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let channels = grid.wavelengths.as_ref().map_or(3, Vec::len);
    for &phi in &grid.phi_i {
        for &theta in &grid.theta_i {
            let at = (((theta / core::f32::consts::FRAC_PI_2).sqrt()), (phi / core::f32::consts::TAU + 0.5));
            let i = facet(at, 0.0);
            let from = if is_isotropic { phi } else { 0.0 };
            let slice: Vec<f32> = points(n)
                .map(|p| {
                    let m = facet(p, from);
                    density(m) * i.dot(m).max(0.0) * solid_angle(p.0)
                })
                .collect();
            let warp = Warp::new(n, n, slice.clone());
            visible.extend(slice);
            let projected = sigma.at(at);
            let measured: Vec<(Vec<f32>, bool)> = points(grid.values)
                .map(|u| {
                    let m = warp.sample(&Blend::only(0), u);
                    let o = reflect(i, facet(m, from));
                    let (i, seen) = (above(i), above(o));
                    let at_edge = angles(i + seen);
                    let m = if o.z > 0.0 { m } else { square(at_edge.0, at_edge.1 - from) };
                    let scale = seen.z * 4.0 * projected / ndf.at(m);
                    let values = (0..channels).map(|c| f(i, seen, c) * scale).collect();
                    (values, o.z > 0.0)
                })
                .collect();
            let mean = |values: &[f32]| values.iter().sum::<f32>() / channels as f32;
            luminance.extend(measured.iter().map(|(values, is_above)| if *is_above { mean(values) } else { 0.0 }));
            for c in 0..channels {
                values.extend(measured.iter().map(|(values, _)| values[c]));
            }
        }
    }

    let (phis, thetas, m) = (grid.phi_i.len(), grid.theta_i.len(), grid.values);
    let name = if grid.wavelengths.is_some() { "spectra" } else { "rgb" };
    let mut floats: Vec<(&str, Vec<usize>, &[f32])> = vec![
        ("phi_i", vec![phis], &grid.phi_i),
        ("theta_i", vec![thetas], &grid.theta_i),
        ("ndf", vec![n, n], &ndf.values),
        ("sigma", vec![n, n], &sigma.values),
        ("vndf", vec![phis, thetas, n, n], &visible),
        ("luminance", vec![phis, thetas, m, m], &luminance),
        (name, vec![phis, thetas, channels, m, m], &values),
    ];
    if let Some(waves) = &grid.wavelengths {
        floats.push(("wavelengths", vec![channels], waves));
    }
    let floats: Vec<(&str, &[usize], &[f32])> = floats.iter().map(|(n, s, v)| (*n, &s[..], *v)).collect();
    tensor_file::write(&floats, &[("description", b"made by Kirkas"), ("jacobian", &[1])])
}

/// Below the horizon goes on what is just above it, so that what lies between stays smooth; none of it is drawn.
fn above(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z.max(1e-3)).normalize()
}

/// Solid angle of facets per area of their unit square.
fn solid_angle(x: f32) -> f32 {
    let x = f64::from(x);
    (2.0 * PI * PI * x * sin(x * x * FRAC_PI_2)) as f32
}
