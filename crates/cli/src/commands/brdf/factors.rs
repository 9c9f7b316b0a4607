//! The factors of a microfacet model, each over its angle: facets D, their shadows G, Fresnel's F.

use super::angles::direction;
use super::look::Channel;
use super::material::Matter;
use super::plot::Plot;
use crate::problem::Problem;
use kirkas_optics::microfacet::{Distribution, Facets};
use kirkas_optics::{Lobe, Mode};
use kirkas_plot::{Axis, Chart, Color, Curve, Dash, Drawing, Entry, Scale};
use kirkas_scene::{Diagnostic, Kind, Params};

/// Models with such factors, and the smooth ones whose reflection is F alone.
const MODELS: [(&str, &str); 5] = [
    ("rough_conductor", "conductor"),
    ("rough_dielectric", "dielectric"),
    ("rough_plastic", "plastic"),
    ("rough_mirror", "mirror"),
    ("cook_torrance", "dielectric"),
];
const DECADES: i32 = 6;

/// What is known of one material.
struct Factors {
    facets: Facets,
    has_grooves: bool,
    is_anisotropic: bool,
    smooth: Matter,
}

/// Three charts side by side.
pub fn draw(args: &Plot, materials: &[Matter]) -> Result<Drawing, Problem> {
    let all: Vec<Factors> = materials.iter().map(Factors::of).collect::<Result<_, _>>()?;
    let (mut d, mut g, mut f) = (Vec::new(), Vec::new(), Vec::new());
    for (i, factors) in all.iter().enumerate() {
        let color = Color::of_curve(i);
        let curve = |end: f64, dash: Dash, value: &dyn Fn(f64) -> f64| {
            let angles = (0..=1000).map(|k| end * f64::from(k) / 1000.0);
            Curve { points: angles.map(|a| [a, value(a)]).collect(), color, dash }
        };
        d.push(curve(89.9, Dash::Solid, &|a| f64::from(factors.facets.d(direction(a, 0.0)))));
        if factors.is_anisotropic {
            d.push(curve(89.9, Dash::Dashed, &|a| f64::from(factors.facets.d(direction(a, 90.0)))));
            g.push(curve(89.9, Dash::Dashed, &|a| factors.visible(a, 90.0)));
        }
        g.push(curve(89.9, Dash::Solid, &|a| factors.visible(a, 0.0)));
        f.push(curve(89.9, Dash::Solid, &|a| factors.reflected(args.channel, a)));
    }
    let (width, height) = args.size_or(1080.0, 430.0);
    let mut legend: Vec<Entry> = materials
        .iter()
        .enumerate()
        .map(|(i, m)| Entry { name: m.label.clone(), color: Color::of_curve(i), dash: Dash::Solid })
        .collect();
    if all.iter().any(|f| f.is_anisotropic) {
        legend.push(Entry { name: "along u".into(), color: Color::GREY, dash: Dash::Solid });
        legend.push(Entry { name: "along v".into(), color: Color::GREY, dash: Dash::Dashed });
    }
    let foot = kirkas_plot::legend::height(&legend, width - 40.0);
    let mut sheet = Drawing::new(width, height);
    sheet.heading(args.title_or("The factors of microfacet models".into()), [0.5 * width, 27.0], 16.0);
    let scale = if args.log { Scale::Log } else { Scale::Linear };
    let values = d.iter().flat_map(|c| c.points.iter().map(|p| p[1])).collect::<Vec<_>>();
    let part = |label: &str| Axis::linear(label, (0.0, 1.0));
    let angle = |label: &str| Axis::degrees(label, (0.0, 90.0), 15.0);
    let charts = [
        ("D: facets", angle("θ~h in degrees"), Axis::of_values("D in 1/sr", values.into_iter(), scale, DECADES), d),
        ("G: what is not shadowed or masked", angle("θ~i = θ~o in degrees, mirrored"), part("G"), g),
        ("F: reflected by a facet", angle("θ~d in degrees"), part(&format!("F{}", args.channel.words())), f),
    ];
    for (i, (title, x, y, curves)) in charts.into_iter().enumerate() {
        let chart = Chart { title: title.into(), x, y, curves, marks: vec![], legend: vec![], is_square: false };
        sheet.place(chart.draw(width / 3.0, height - 38.0 - foot), i as f64 * width / 3.0, 38.0);
    }
    kirkas_plot::legend::draw(&mut sheet, &legend, 20.0, width - 40.0, height - foot);
    Ok(sheet)
}

impl Factors {
    fn of(matter: &Matter) -> Result<Self, Problem> {
        let Some((name, smooth)) = MODELS.into_iter().find(|m| m.0 == matter.type_name()) else {
            let names: Vec<String> = MODELS.iter().map(|m| format!("`{}`", m.0)).collect();
            let message = format!("`{}` has no factors D, G and F that could be shown apart", matter.type_name());
            let help = format!("they are known of {}", names.join(", "));
            return Err(Problem::input(Diagnostic::error("no-facets", message).help(help)));
        };
        let catalog = kirkas_render::catalog();
        let entity = matter.file.description.find(Kind::Material, &matter.name);
        let params = entity.and_then(|e| Params::new(e, Kind::Material, &catalog));
        let has = |row: &str| params.is_some_and(|p| p.spec().params.iter().any(|r| r.name == row));
        let number = |row: &str| params.filter(|_| has(row)).map_or(0.0, |p| p.f32(row));
        let (roughness, anisotropy) = (number("roughness"), number("anisotropy"));
        let has_grooves = name == "cook_torrance";
        let is_beckmann = has_grooves
            || params.filter(|_| has("distribution")).and_then(|p| p.text("distribution")) == Some("beckmann");
        let distribution = if is_beckmann { Distribution::Beckmann } else { Distribution::Ggx };
        let alphas = (roughness * (1.0 + anisotropy), roughness * (1.0 - anisotropy));
        Ok(Factors {
            facets: Facets::new(distribution, alphas),
            has_grooves,
            is_anisotropic: anisotropy != 0.0,
            smooth: matter.retyped(smooth)?,
        })
    }

    /// G for light that is mirrored at this angle.
    fn visible(&self, theta: f64, phi: f64) -> f64 {
        let (wo, wi) = (direction(theta, phi), direction(theta, phi + 180.0));
        match self.has_grooves {
            true => f64::from(2.0 * wo.z).min(1.0),
            false => f64::from(self.facets.g2_reflection(wo, wi)),
        }
    }

    fn reflected(&self, channel: Channel, theta: f64) -> f64 {
        let lanes = self.smooth.lanes();
        let branches = self.smooth.at(&lanes).delta_branches(direction(theta, 0.0), Mode::Radiance);
        let mirrored = branches.iter().find(|b| b.lobe == Lobe::DeltaReflection);
        mirrored.map_or(0.0, |b| channel.of([0, 1, 2].map(|c| f64::from(b.f[c]))))
    }
}
