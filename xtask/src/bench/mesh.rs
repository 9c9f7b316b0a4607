//! A displaced sphere of a million triangles, for each that renders it.

use super::renders::{COMPILED, Case, LIT_HEAD, LIT_POV_HEAD, SCALAR, mitsuba_head, write};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// A displaced sphere of `n^2` triangles over a floor, under a lamp: a million for n = 1000.
pub fn lit(folder: &Path, n: usize) -> Result<Case, String> {
    let case = Case { name: "mesh", folder: folder.into(), has_pov: true, mitsuba: &[] };
    let (points, faces) = displaced_sphere(n);
    write_ply(&folder.join("mesh.ply"), &points, &faces).map_err(|e| e.to_string())?;
    let toml = format!(
        "{LIT_HEAD}[cameras.main]\ntype = \"perspective\"\nposition = [1.2, 1.4, 2.6]\nlook_at = [0, 0, 0]\nfov = 45\nfov_axis = \"horizontal\"\n\
         [materials.clay]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0.7\nambient = 0.1\n\
         [objects.mesh]\ntype = \"mesh\"\nfile = \"mesh.ply\"\nmaterial = \"clay\"\n\
         [objects.floor]\ntype = \"plane\"\npoint = [0, -1.1, 0]\nnormal = [0, 1, 0]\nmaterial = \"clay\"\n"
    );
    let mut pov = format!(
        "{LIT_POV_HEAD}global_settings {{ assumed_gamma 1.0 ambient_light rgb 1 }}\n\
         camera {{ perspective location <1.2, 1.4, 2.6> right -x up y sky y angle 45 look_at <0, 0, 0> }}\n\
         #declare C = texture {{ pigment {{ rgb 1 }} finish {{ ambient 0.1 diffuse 0.7 }} }}\n\
         plane {{ y, -1.1 texture {{ C }} }}\nmesh2 {{ vertex_vectors {{ {}",
        points.len()
    );
    for p in &points {
        let _ = write!(pov, ",<{},{},{}>", p[0], p[1], p[2]);
    }
    let _ = write!(pov, "}}\nface_indices {{ {}", faces.len());
    for f in &faces {
        let _ = write!(pov, ",<{},{},{}>", f[0], f[1], f[2]);
    }
    pov.push_str("}\ntexture { C } }\n");
    write(&case, "toml", &toml)?;
    write(&case, "pov", &pov)?;
    Ok(case)
}

/// The mesh of [`lit`] under a plain sky, matte, so that light goes on from surface to surface: eight bounces, 16 samples.
pub fn under_a_sky(folder: &Path, n: usize) -> Result<Case, String> {
    let case = Case { name: "sky", folder: folder.into(), has_pov: false, mitsuba: &[SCALAR, COMPILED] };
    let (points, faces) = displaced_sphere(n);
    write_ply(&folder.join("mesh.ply"), &points, &faces).map_err(|e| e.to_string())?;
    let toml = "[film]\nwidth = 512\nheight = 512\nfilter = \"box\"\n[sampler]\nsamples = 16\n\
         [integrator]\ntype = \"path\"\nmax_depth = 8\nroulette_depth = 8\n[background]\ncolor = [0.35, 0.5, 0.7]\n\
         [cameras.main]\ntype = \"perspective\"\nposition = [1.2, 1.4, 2.6]\nlook_at = [0, 0, 0]\nfov = 45\nfov_axis = \"horizontal\"\n\
         [materials.clay]\ntype = \"lambert\"\nreflectance = 0.7\n\
         [objects.mesh]\ntype = \"mesh\"\nfile = \"mesh.ply\"\nmaterial = \"clay\"\n";
    let mut xml = mitsuba_head(8, 16, [1.2, 1.4, 2.6], [0.35, 0.5, 0.7]);
    xml.push_str(
        "<shape type=\"ply\"><string name=\"filename\" value=\"mesh.ply\"/><boolean name=\"face_normals\" value=\"true\"/>\n\
         <bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7\"/></bsdf></bsdf></shape>\n</scene>\n",
    );
    write(&case, "toml", toml)?;
    write(&case, "xml", &xml)?;
    Ok(case)
}

/// Corners and faces of the sphere, `n` columns by `n / 2` rows.
fn displaced_sphere(n: usize) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let (rows, columns) = (n / 2, n);
    let mut points = Vec::new();
    for i in 0..=rows {
        for j in 0..columns {
            let (theta, phi) =
                (std::f64::consts::PI * i as f64 / rows as f64, std::f64::consts::TAU * j as f64 / columns as f64);
            let r = 1.0
                + 0.05 * (9.0 * theta).sin() * (11.0 * phi).sin()
                + 0.01 * (60.0 * theta).sin() * (70.0 * phi).cos();
            points.push([r * theta.sin() * phi.cos(), r * theta.cos(), r * theta.sin() * phi.sin()].map(|x| x as f32));
        }
    }
    let mut faces = Vec::new();
    let at = |i: usize, j: usize| (i * columns + j % columns) as u32;
    for i in 0..rows {
        for j in 0..columns {
            faces.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            faces.push([at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)]);
        }
    }
    (points, faces)
}

fn write_ply(path: &Path, points: &[[f32; 3]], faces: &[[u32; 3]]) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(fs::File::create(path)?);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        points.len(),
        faces.len()
    )?;
    for c in points.iter().flatten() {
        out.write_all(&c.to_le_bytes())?;
    }
    for f in faces {
        out.write_all(&[3])?;
        for i in f {
            out.write_all(&i.to_le_bytes())?;
        }
    }
    out.flush()
}
