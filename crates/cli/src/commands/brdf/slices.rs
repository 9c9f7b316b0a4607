//! Slices in the plane of incidence: values over the angle at which light leaves.

use super::angles::direction;
use super::look::{Channel, Look};
use super::material::Matter;
use super::plot::Plot;
use kirkas_geometry::elementary::cos;
use kirkas_optics::LobeSet;
use kirkas_plot::{Around, Axis, Chart, Color, Curve, Dash, Drawing, Entry, Mark, Polar, Ray, Scale};

/// From one direction to the next, in degrees.
const STEP: f64 = 0.1;
/// What a logarithmic axis shows below the greatest value.
const DECADES: i32 = 5;

/// The curve of one material at one incidence: angles (positive on the mirrored side) and values.
struct Slice {
    points: Vec<[f64; 2]>,
    color: Color,
    dash: Dash,
}

/// What all plots of slices have in common.
struct Family {
    slices: Vec<Slice>,
    legend: Vec<Entry>,
    /// Colours of the angles of incidence.
    incident: Vec<(f64, Color)>,
    is_whole: bool,
}

/// Around the surface.
pub fn polar(args: &Plot, materials: &[Matter]) -> Drawing {
    let family = family(args, materials);
    let radius = axis(args, &family);
    let around = |s: Slice| Around { points: s.points, color: s.color, dash: s.dash, is_filled: false };
    let rays = family.incident.iter().map(|(theta, color)| Ray {
        angle: -theta,
        label: String::new(),
        color: *color,
        arrives: true,
    });
    let (width, height) = args.size_or(720.0, if family.is_whole { 800.0 } else { 460.0 });
    let polar = Polar {
        title: args.title_or("Reflection in the plane of incidence".into()),
        radius,
        is_whole: family.is_whole,
        rays: rays.collect(),
        curves: family.slices.into_iter().map(around).collect(),
        legend: family.legend,
    };
    polar.draw(width, height)
}

/// Over the angle.
pub fn cartesian(args: &Plot, materials: &[Matter]) -> Drawing {
    let family = family(args, materials);
    let y = axis(args, &family);
    let mark = |(theta, color): &(f64, Color)| Mark { x: *theta, label: format!("{theta}°"), color: *color };
    let (width, height) = args.size_or(720.0, 480.0);
    let chart = Chart {
        title: args.title_or("Reflection in the plane of incidence".into()),
        x: angle_axis(family.is_whole),
        y,
        marks: family.incident.iter().map(mark).collect(),
        curves: family.slices.into_iter().map(|s| Curve { points: s.points, color: s.color, dash: s.dash }).collect(),
        legend: family.legend,
        is_square: false,
    };
    chart.draw(width, height)
}

/// Two materials, a colour for each incidence, the second one dashed.
pub fn overlaid(materials: &[Matter], thetas: &[f64], (width, height): (f64, f64)) -> Drawing {
    let looks: Vec<Look> = materials.iter().map(Look::new).collect();
    let is_whole = looks.iter().any(Look::goes_through);
    let (mut slices, mut legend) = (Vec::new(), Vec::new());
    for (t, &theta) in thetas.iter().enumerate() {
        let color = Color::of_curve(t);
        for (m, look) in looks.iter().enumerate() {
            let points = slice((look, Channel::Luminance), (theta, 0.0), 1.0, is_whole);
            slices.push(Slice { points, color, dash: Dash::of_style(m) });
        }
        legend.push(Entry { name: format!("θ~i = {theta}°"), color, dash: Dash::Solid });
    }
    let name = |m: usize| format!("{}: {}", ["A", "B"][m % 2], materials[m].label);
    legend.extend((0..materials.len()).map(|m| Entry { name: name(m), color: Color::GREY, dash: Dash::of_style(m) }));
    let values = slices.iter().flat_map(|s| s.points.iter().map(|p| p[1]));
    let chart = Chart {
        title: String::new(),
        x: angle_axis(is_whole),
        y: Axis::of_values("f in 1/sr", values, Scale::Log, DECADES + 2),
        marks: Vec::new(),
        curves: slices.into_iter().map(|s| Curve { points: s.points, color: s.color, dash: s.dash }).collect(),
        legend,
        is_square: false,
    };
    chart.draw(width, height)
}

fn angle_axis(is_whole: bool) -> Axis {
    let end = if is_whole { 180.0 } else { 90.0 };
    Axis::degrees("θ~o in degrees, positive on the side of the mirrored direction", (-end, end), end / 6.0)
}

fn axis(args: &Plot, family: &Family) -> Axis {
    let scale = if args.log { Scale::Log } else { Scale::Linear };
    Axis::of_values(args.quantity(), family.slices.iter().flat_map(|s| s.points.iter().map(|p| p[1])), scale, DECADES)
}

/// One material: a colour for each incidence. Several: a colour for each material, dashes for incidence.
fn family(args: &Plot, materials: &[Matter]) -> Family {
    let looks: Vec<Look> = materials.iter().map(Look::new).collect();
    let thetas = args.incident();
    let is_whole = looks.iter().any(Look::goes_through);
    let is_single = materials.len() == 1;
    let style = |m: usize, t: usize| {
        if is_single { (Color::of_curve(t), Dash::Solid) } else { (Color::of_curve(m), Dash::of_style(t)) }
    };
    let mut slices = Vec::new();
    for (m, look) in looks.iter().enumerate() {
        for (t, &theta) in thetas.iter().enumerate() {
            let (color, dash) = style(m, t);
            let cosine = if args.with_cosine { cos(theta.to_radians()) } else { 1.0 };
            let points = slice((look, args.channel), (theta, args.phi_i), cosine, is_whole);
            slices.push(Slice { points, color, dash });
        }
    }
    let incidence = |theta: f64| format!("θ~i = {theta}°");
    let entry = |name: String, (color, dash): (Color, Dash)| Entry { name, color, dash };
    let mut legend = Vec::new();
    match (is_single, thetas.len()) {
        (true, _) => {
            let name = |theta: f64| format!("{}, {}", materials[0].label, incidence(theta));
            legend.extend(thetas.iter().enumerate().map(|(t, &theta)| entry(name(theta), style(0, t))));
        }
        (false, 1) => {
            let name = |m: &Matter| format!("{}, {}", m.label, incidence(thetas[0]));
            legend.extend(materials.iter().enumerate().map(|(i, m)| entry(name(m), style(i, 0))));
        }
        (false, _) => {
            legend.extend(materials.iter().enumerate().map(|(i, m)| entry(m.label.clone(), style(i, 0))));
            let grey = |t: usize| (Color::GREY, Dash::of_style(t));
            legend.extend(thetas.iter().enumerate().map(|(t, &theta)| entry(incidence(theta), grey(t))));
        }
    }
    let color = |t: usize| if is_single { Color::of_curve(t) } else { Color::GREY };
    let incident = thetas.iter().enumerate().map(|(t, &theta)| (theta, color(t))).collect();
    Family { slices, legend, incident, is_whole }
}

fn slice(
    (look, channel): (&Look, Channel),
    (theta_i, phi_i): (f64, f64),
    cosine: f64,
    is_whole: bool,
) -> Vec<[f64; 2]> {
    let wi = direction(theta_i, phi_i);
    let end = if is_whole { 180.0 } else { 90.0 };
    let count = (end / STEP).round() as i32;
    let value = |angle: f64| {
        let phi = if angle < 0.0 { phi_i } else { phi_i + 180.0 };
        channel.of(look.rgb(wi, direction(angle.abs(), phi), LobeSet::ALL)) * cosine
    };
    // Just above the horizon in place of on it.
    let shown = |angle: f64| if angle.abs() == 90.0 { angle * (1.0 - 1e-5) } else { angle };
    (-count..=count).map(|i| f64::from(i) * STEP).map(|angle| [angle, value(shown(angle))]).collect()
}
