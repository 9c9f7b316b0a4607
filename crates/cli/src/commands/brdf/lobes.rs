//! The shape of highlights, each by its own peak: how far they reach in the plane of incidence, and their outlines as seen along
//! the mirrored direction, where Phong's lobe stays round and half-vector lobes narrow towards grazing light (Ngan, Durand &
//! Matusik 2005).

use super::angles::direction;
use super::look::Look;
use super::material::Matter;
use super::plot::Plot;
use kirkas_geometry::elementary::{acos, cos, sin};
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::LobeSet;
use kirkas_plot::{Around, Axis, Chart, Color, Curve, Dash, Drawing, Entry, Polar, Ray};

/// Outlines at these parts of the peak.
const LEVELS: [f64; 2] = [0.5, 0.1];
/// Half the width of what is seen along the mirrored direction, in degrees.
const LEAST_VIEW: f64 = 10.0;
const MOST_VIEW: f64 = 60.0;

/// A highlight under light from one direction.
struct Highlight<'a> {
    look: &'a Look,
    lobes: LobeSet,
    args: &'a Plot,
    wi: Vec3,
    /// The mirrored direction, what points away from the normal there, and what is across.
    frame: [DVec3; 3],
}

/// One column for each angle of incidence.
pub fn draw(args: &Plot, materials: &[Matter]) -> Drawing {
    let looks: Vec<Look> = materials.iter().map(Look::new).collect();
    let thetas = args.incident();
    let (width, height) = args.size_or(340.0 * thetas.len() as f64, 660.0);
    let column = width / thetas.len() as f64;
    let (head, foot) = (40.0, 34.0 + 20.0 * materials.len().div_ceil(3) as f64);
    let (upper, lower) = (0.40 * (height - head - foot), 0.60 * (height - head - foot));
    let mut sheet = Drawing::new(width, height);
    sheet.heading(args.title_or("Highlights, each by its own peak".into()), [0.5 * width, 27.0], 16.0);

    let mut outlines: Vec<Vec<Curve>> = Vec::new();
    let mut reach = LEAST_VIEW;
    for (t, &theta) in thetas.iter().enumerate() {
        let (mut around, mut curves) = (Vec::new(), Vec::new());
        for (m, look) in looks.iter().enumerate() {
            let highlight = Highlight::new(args, look, theta);
            let (points, peak, at) = highlight.slice();
            let color = Color::of_curve(m);
            around.push(Around { points, color, dash: Dash::of_style(m), is_filled: true });
            for (level, dash) in LEVELS.into_iter().zip([Dash::Solid, Dash::Dashed]) {
                let points = highlight.outline(at, peak * level);
                reach = points.iter().flatten().fold(reach, |r, x| r.max(x.abs()));
                curves.push(Curve { points, color, dash });
            }
        }
        outlines.push(curves);
        let polar = Polar {
            title: format!("θ~i = {theta}°"),
            radius: Axis { step: Some(0.5), ..Axis::linear("part of the peak", (0.0, 1.0)) },
            is_whole: false,
            curves: around,
            rays: vec![Ray { angle: -theta, label: String::new(), color: Color::GREY, arrives: true }],
            legend: Vec::new(),
        };
        sheet.place(polar.draw(column, upper), t as f64 * column, head);
    }

    let view = reach.min(MOST_VIEW) * 1.1;
    for (t, curves) in outlines.into_iter().enumerate() {
        let chart = Chart {
            title: String::new(),
            x: Axis::linear("degrees off the mirrored direction", (-view, view)),
            y: Axis::linear("degrees across", (-view, view)),
            curves,
            marks: Vec::new(),
            legend: Vec::new(),
            is_square: true,
        };
        sheet.place(chart.draw(column, lower), t as f64 * column, head + upper);
    }
    let mut legend: Vec<Entry> = materials
        .iter()
        .enumerate()
        .map(|(m, matter)| Entry { name: matter.label.clone(), color: Color::of_curve(m), dash: Dash::Solid })
        .collect();
    legend.push(Entry { name: "half the peak".into(), color: Color::GREY, dash: Dash::Solid });
    legend.push(Entry { name: "a tenth of it".into(), color: Color::GREY, dash: Dash::Dashed });
    kirkas_plot::legend::draw(&mut sheet, &legend, 20.0, width - 40.0, height - foot);
    sheet
}

impl<'a> Highlight<'a> {
    fn new(args: &'a Plot, look: &'a Look, theta: f64) -> Self {
        let glossy = look.lobes() & LobeSet::GLOSSY & LobeSet::REFLECTION;
        let lobes = if glossy.is_empty() { look.lobes() } else { glossy };
        let phi = args.phi_i + 180.0;
        let frame = [direction(theta, phi), direction(theta + 90.0, phi), direction(90.0, phi + 90.0)];
        Highlight { look, lobes, args, wi: direction(theta, args.phi_i), frame: frame.map(|v| v.as_dvec3()) }
    }

    fn value(&self, wo: DVec3) -> f64 {
        if wo.z <= 1e-4 {
            return 0.0;
        }
        self.args.channel.of(self.look.rgb(self.wi, wo.as_vec3().normalize(), self.lobes))
    }

    /// In the plane of incidence: angles and parts of the peak; the peak, and where it is, in degrees.
    fn slice(&self) -> (Vec<[f64; 2]>, f64, f64) {
        const STEPS: i32 = 1780;
        let at = |angle: f64| {
            let phi = if angle < 0.0 { self.args.phi_i } else { self.args.phi_i + 180.0 };
            self.value(direction(angle.abs(), phi).as_dvec3())
        };
        let points: Vec<[f64; 2]> = (-STEPS / 2..=STEPS / 2).map(|i| f64::from(i) * 0.1).map(|a| [a, at(a)]).collect();
        let peak = points.iter().copied().fold([0.0, 0.0], |best, p| if p[1] > best[1] { p } else { best });
        let scale = if peak[1] > 0.0 { 1.0 / peak[1] } else { 0.0 };
        let closed = std::iter::once([-90.0, 0.0]).chain(points.into_iter().map(|[a, v]| [a, v * scale]));
        (closed.chain([[90.0, 0.0]]).collect(), peak[1], peak[0])
    }

    /// Where values around the peak fall to `level`: degrees off the mirrored direction, in the plane of incidence and across.
    fn outline(&self, peak_at: f64, level: f64) -> Vec<[f64; 2]> {
        let middle = direction(peak_at, self.args.phi_i + 180.0).as_dvec3();
        let [_, away, across] = self.frame;
        let away = (away - middle * away.dot(middle)).normalize();
        let step = MOST_VIEW / 600.0;
        let towards = |turn: f64| {
            let side = away * cos(turn) + across * sin(turn);
            let at = |degrees: f64| middle * cos(degrees.to_radians()) + side * sin(degrees.to_radians());
            let mut last = self.value(middle);
            for i in 1..=1200 {
                let (degrees, value) = (f64::from(i) * step, self.value(at(f64::from(i) * step)));
                if value < level {
                    let part = ((last - level) / (last - value)).clamp(0.0, 1.0);
                    return at(degrees - step * (1.0 - part));
                }
                last = value;
            }
            at(MOST_VIEW * 2.0)
        };
        let turns = (0..=180).map(|i| f64::from(i) * core::f64::consts::TAU / 180.0);
        turns.map(|turn| self.seen(towards(turn))).collect()
    }

    /// A direction as degrees off the mirrored one.
    fn seen(&self, v: DVec3) -> [f64; 2] {
        let [mirrored, away, across] = self.frame;
        let (x, y) = (v.dot(away), v.dot(across));
        let length = (x * x + y * y).sqrt();
        let angle = acos(v.dot(mirrored).clamp(-1.0, 1.0)).to_degrees();
        if length > 0.0 { [angle * x / length, angle * y / length] } else { [0.0; 2] }
    }
}
