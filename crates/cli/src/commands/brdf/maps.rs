//! Maps: the plane of incidence over both angles, and the slice of half and difference angle at phi_d = 90 degrees in which
//! B. Burley, "Physically Based Shading at Disney", SIGGRAPH 2012, shows measured materials.

use super::angles::direction;
use super::look::Look;
use super::material::Matter;
use super::plot::Plot;
use super::sheet::pack;
use kirkas_geometry::elementary::{cos, sin};
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::LobeSet;
use kirkas_plot::{Axis, Drawing, Map, Scale};

/// Cells over 90 degrees.
const CELLS: usize = 120;
const DECADES: i32 = 5;

/// Two maps for each material, all in the same colours.
pub fn draw(args: &Plot, materials: &[Matter]) -> Drawing {
    let (width, height) = args.size_or(860.0, 60.0 + 360.0 * materials.len() as f64);
    let row = (height - 48.0) / materials.len() as f64;
    let mut sheet = Drawing::new(width, height);
    sheet.heading(args.title_or(format!("Values in false colour: {}", args.quantity())), [0.5 * width, 28.0], 16.0);
    let values: Vec<[Vec<f64>; 2]> = materials.iter().map(|m| values(args, &Look::new(m))).collect();
    let scale = if args.log { Scale::Log } else { Scale::Linear };
    let all = || values.iter().flatten().flatten().copied().filter(|v| v.is_finite());
    // Up to here: the greatest would leave all else dark.
    let part = if args.log { 0.995 } else { 0.97 };
    let most = percentile(all().collect(), part);
    let value = match scale {
        Scale::Log => Axis::of_values(args.quantity(), all().filter(|v| *v <= most), scale, DECADES),
        Scale::Linear => Axis::linear(args.quantity(), (0.0, most)),
    };
    for (i, (matter, [plane, halves])) in materials.iter().zip(values).enumerate() {
        let top = 44.0 + i as f64 * row;
        let both = |title: &str| format!("{}: {title}", matter.label);
        let plane = Map {
            title: both("plane of incidence"),
            x: Axis::degrees("θ~o in degrees, positive on the mirrored side", (-90.0, 90.0), 30.0),
            y: Axis::degrees("θ~i in degrees", (0.0, 90.0), 30.0),
            value: value.clone(),
            columns: 2 * CELLS,
            values: plane,
            is_difference: false,
        };
        let halves = Map {
            title: both("φ~d = 90°"),
            x: Axis::degrees("θ~h in degrees", (0.0, 90.0), 30.0),
            y: Axis::degrees("θ~d in degrees", (0.0, 90.0), 30.0),
            value: value.clone(),
            columns: CELLS,
            values: halves,
            is_difference: false,
        };
        let left = 0.56 * width;
        sheet.place(plane.draw(left, row, &pack), 0.0, top);
        sheet.place(halves.draw(width - left, row, &pack), left, top);
    }
    sheet
}

fn values(args: &Plot, look: &Look) -> [Vec<f64>; 2] {
    let value = |wi: Vec3, wo: Vec3| {
        let cosine = if args.with_cosine { f64::from(wi.z) } else { 1.0 };
        args.channel.of(look.rgb(wi, wo, LobeSet::ALL)) * cosine
    };
    let angle = |i: usize| (i as f64 + 0.5) * 90.0 / CELLS as f64;
    let (mut plane, mut halves) = (Vec::new(), Vec::new());
    for i in (0..CELLS).rev().map(angle) {
        for o in (0..2 * CELLS).map(|k| angle(k) - 90.0) {
            let phi = if o < 0.0 { args.phi_i } else { args.phi_i + 180.0 };
            plane.push(value(direction(i, args.phi_i), direction(o.abs(), phi)));
        }
        for h in (0..CELLS).map(angle) {
            let (wi, wo) = of_halves(h, args.phi_i, i, 90.0);
            halves.push(if wi.z > 0.0 && wo.z > 0.0 { value(wi, wo) } else { f64::NAN });
        }
    }
    [plane, halves]
}

/// Both directions from half and difference angles in degrees (S. Rusinkiewicz, "A New Change of Variables for Efficient BRDF
/// Representation", 1998).
pub fn of_halves(theta_h: f64, phi_h: f64, theta_d: f64, phi_d: f64) -> (Vec3, Vec3) {
    let h = direction(theta_h, phi_h).as_dvec3();
    let d = direction(theta_d, phi_d).as_dvec3();
    // Turn d by theta_h about y, then by phi_h about z.
    let (theta, phi) = (theta_h.to_radians(), phi_h.to_radians());
    let tilted = DVec3::new(d.x * cos(theta) + d.z * sin(theta), d.y, d.z * cos(theta) - d.x * sin(theta));
    let wi = DVec3::new(tilted.x * cos(phi) - tilted.y * sin(phi), tilted.x * sin(phi) + tilted.y * cos(phi), tilted.z);
    let wo = h * (2.0 * wi.dot(h)) - wi;
    (wi.as_vec3().normalize(), wo.as_vec3().normalize())
}

/// The value that this part of all of them does not exceed.
fn percentile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let at = ((values.len() as f64 * part) as usize).min(values.len().saturating_sub(1));
    values.get(at).copied().filter(|v| *v > 0.0).unwrap_or(1.0)
}
