//! The sphereflake of 66,430 spheres, for each that renders it.

use super::renders::{Case, LIT_HEAD, LIT_POV_HEAD, SCALAR, mitsuba_head, write};
use std::fmt::Write as _;
use std::path::Path;

/// 66,430 mirror spheres over a floor, at most five bounces.
pub fn lit(folder: &Path, depth: u32) -> Result<Case, String> {
    let case = Case { name: "flake", folder: folder.into(), has_pov: true, mitsuba: &[] };
    let toml = format!(
        "{LIT_HEAD}[integrator]\ntype = \"whitted\"\nmax_depth = 5\nmin_contribution = 0.004\n\
         [cameras.main]\ntype = \"perspective\"\nposition = [2.1, 1.3, 1.7]\nlook_at = [0, 0, 0]\nfov = 45\nfov_axis = \"horizontal\"\n\
         [materials.flake]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0.2\nambient = 0.04\nreflect = 0.7\n\
         [materials.floor]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0.6\nambient = 0.1\n\
         [objects.flake]\ntype = \"sphereflake\"\nradius = 0.5\ndepth = {depth}\naxis = [0, 0, 1]\nmaterial = \"flake\"\n\
         [objects.floor]\ntype = \"plane\"\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n"
    );
    let mut pov = format!(
        "{LIT_POV_HEAD}global_settings {{ assumed_gamma 1.0 max_trace_level 6 adc_bailout 0.004 ambient_light rgb 1 }}\n\
         camera {{ perspective location <2.1, 1.3, 1.7> right -x up y sky y angle 45 look_at <0, 0, 0> }}\n\
         plane {{ y, -1 pigment {{ rgb 1 }} finish {{ ambient 0.1 diffuse 0.6 }} }}\n\
         #declare F = texture {{ pigment {{ rgb 1 }} finish {{ ambient 0.04 diffuse 0.2 reflection {{ 0.7 }} }} }}\nunion {{\n"
    );
    each_sphere(depth, |c, radius| {
        let _ = writeln!(pov, "sphere {{ <{}, {}, {}>, {radius} }}", c[0], c[1], c[2]);
    });
    pov.push_str("texture { F } }\n");
    write(&case, "toml", &toml)?;
    write(&case, "pov", &pov)?;
    Ok(case)
}

/// Its mirrors alone under a plain sky: work that is the same for all, at most five bounces.
pub fn mirrors(folder: &Path, depth: u32) -> Result<Case, String> {
    let case = Case { name: "mirrors", folder: folder.into(), has_pov: true, mitsuba: &[SCALAR] };
    let toml = format!(
        "[film]\nwidth = 512\nheight = 512\nfilter = \"box\"\n[sampler]\nsamples = 4\n[integrator]\ntype = \"whitted\"\nmax_depth = 5\n\
         [background]\ncolor = [0.35, 0.5, 0.7]\n\
         [cameras.main]\ntype = \"perspective\"\nposition = [2.1, 1.3, 1.7]\nlook_at = [0, 0, 0]\nfov = 45\nfov_axis = \"horizontal\"\n\
         [materials.mirror]\ntype = \"mirror\"\nreflectance = 0.7\n\
         [objects.flake]\ntype = \"sphereflake\"\nradius = 0.5\ndepth = {depth}\naxis = [0, 0, 1]\nmaterial = \"mirror\"\n"
    );
    let mut pov =
        "#version 3.7;\nbackground { rgb <0.35, 0.5, 0.7> }\nglobal_settings { assumed_gamma 1.0 max_trace_level 6 }\n\
         camera { perspective location <2.1, 1.3, 1.7> right -x up y sky y angle 45 look_at <0, 0, 0> }\nunion {\n"
            .to_string();
    let mut xml = mitsuba_head(5, 4, [2.1, 1.3, 1.7], [0.35, 0.5, 0.7]);
    xml.push_str(
        "<bsdf type=\"conductor\" id=\"mirror\"><string name=\"material\" value=\"none\"/>\
         <rgb name=\"specular_reflectance\" value=\"0.7\"/></bsdf>\n",
    );
    each_sphere(depth, |c, radius| {
        let _ = writeln!(pov, "sphere {{ <{}, {}, {}>, {radius} }}", c[0], c[1], c[2]);
        let _ = writeln!(
            xml,
            "<shape type=\"sphere\"><point name=\"center\" x=\"{}\" y=\"{}\" z=\"{}\"/>\
             <float name=\"radius\" value=\"{radius}\"/><ref id=\"mirror\"/></shape>",
            c[0], c[1], c[2]
        );
    });
    pov.push_str("pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection { 0.7 } } }\n");
    xml.push_str("</scene>\n");
    write(&case, "toml", &toml)?;
    write(&case, "pov", &pov)?;
    write(&case, "xml", &xml)?;
    Ok(case)
}

/// The sphereflake again, as plainly as can be: the twin of the renderer's own.
fn each_sphere(depth: u32, mut visit: impl FnMut([f64; 3], f64)) {
    flake(&mut visit, [0.0; 3], 0.5, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], depth);
}

fn flake(visit: &mut dyn FnMut([f64; 3], f64), center: [f64; 3], radius: f64, frame: [[f64; 3]; 3], depth: u32) {
    visit(center, radius);
    if depth == 0 {
        return;
    }
    let (third, h) = (radius / 3.0, 0.75_f64.sqrt());
    for quarter in [(1.0, 0.0), (-0.5, h), (-0.5, -h)] {
        for d in [[h, -0.5, 0.0], [h, 0.5, 0.0], [(1.0_f64 / 3.0).sqrt(), 0.0, (2.0_f64 / 3.0).sqrt()]] {
            let d = [quarter.0 * d[0] - quarter.1 * d[1], quarter.1 * d[0] + quarter.0 * d[1], d[2]];
            let along: [f64; 3] = std::array::from_fn(|k| (0..3).map(|j| frame[j][k] * d[j]).sum());
            let at: [f64; 3] = std::array::from_fn(|k| center[k] + along[k] * (radius + third));
            flake(visit, at, third, turned(frame, along), depth - 1);
        }
    }
}

/// The frame turned the shortest way so that its last axis becomes `z`.
fn turned(frame: [[f64; 3]; 3], z: [f64; 3]) -> [[f64; 3]; 3] {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let (axis, c) = (cross(frame[2], z), dot(frame[2], z));
    let turn = |v: [f64; 3]| {
        let (w, s) = (cross(axis, v), dot(axis, v) / (1.0 + c));
        std::array::from_fn(|k| v[k] * c + w[k] + axis[k] * s)
    };
    [turn(frame[0]), turn(frame[1]), z]
}
