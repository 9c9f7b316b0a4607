//! Scenes written once and printed twice: as native TOML and for POV-Ray.
//!
//! Only what both mean alike: point and spot lights without falloff, matte and mirror surfaces with constants, clear glass
//! with Fresnel's equations, ambient-only patterns where light through glass would need caustics.

use std::fmt::Write;

/// A surface.
#[derive(Clone, Copy)]
pub enum Surface {
    /// Lambert: ambient and diffuse shares of a colour.
    Matte { color: [f64; 3], ambient: f64, diffuse: f64 },
    /// A checkerboard in space that shines by itself, unlit.
    Glowing { a: [f64; 3], b: [f64; 3], size: f64 },
    /// A share of what is mirrored, over a matte colour.
    Mirror { color: [f64; 3], ambient: f64, diffuse: f64, reflect: f64 },
    /// Clear, by Fresnel's equations.
    Glass { ior: f64, priority: i32 },
    /// Clear without any reflection: refraction alone.
    Clear { ior: f64, priority: i32 },
}

/// A body.
#[derive(Clone, Copy)]
pub enum Body {
    /// Center and radius.
    Sphere([f64; 3], f64),
    /// A horizontal plane at this height.
    Floor(f64),
    /// Two corners.
    Block([f64; 3], [f64; 3]),
}

/// A light of intensity 1 without falloff.
#[derive(Clone, Copy)]
pub enum Lamp {
    /// At a point.
    Point([f64; 3], f64),
    /// At a point, towards another, with hotspot and falloff half angles.
    Spot([f64; 3], [f64; 3], f64, f64),
}

/// A scene for both.
pub struct Scene {
    /// File name.
    pub name: &'static str,
    /// Camera position and target.
    pub camera: ([f64; 3], [f64; 3]),
    /// Horizontal, degrees.
    pub fov: f64,
    /// Background.
    pub sky: [f64; 3],
    /// Bounces.
    pub depth: u32,
    /// Lights.
    pub lamps: Vec<Lamp>,
    /// Bodies.
    pub bodies: Vec<(Body, Surface)>,
}

fn v(a: [f64; 3]) -> String {
    format!("{}, {}, {}", a[0], a[1], a[2])
}

impl Scene {
    /// As native TOML: one sample at the middle of each pixel, numbers written as they are.
    pub fn to_toml(&self, width: u32, height: u32) -> String {
        let mut t = String::new();
        let _ = writeln!(t, "[film]\nwidth = {width}\nheight = {height}\nfilter = \"point\"\ntone = \"raw\"");
        let _ = writeln!(t, "[sampler]\nsamples = 1");
        let _ = writeln!(t, "[integrator]\ntype = \"whitted\"\nmax_depth = {}\nmin_contribution = 0.0", self.depth);
        let _ = writeln!(t, "[background]\ncolor = [{}]", v(self.sky));
        let (from, to) = self.camera;
        let _ = writeln!(t, "[cameras.main]\ntype = \"perspective\"\nposition = [{}]\nlook_at = [{}]", v(from), v(to));
        let _ = writeln!(t, "fov = {}\nfov_axis = \"horizontal\"", self.fov);
        let _ = writeln!(t, "[lights.ambient]\ntype = \"ambient\"");
        for (i, lamp) in self.lamps.iter().enumerate() {
            let _ = match lamp {
                Lamp::Point(p, intensity) => writeln!(
                    t,
                    "[lights.lamp_{i}]\ntype = \"point\"\nposition = [{}]\nintensity = {intensity}\nattenuation = [0, 0, 1]",
                    v(*p)
                ),
                Lamp::Spot(p, to, hotspot, falloff) => writeln!(
                    t,
                    "[lights.lamp_{i}]\ntype = \"spot\"\nposition = [{}]\ndirection = [{}]\nhotspot = {hotspot}\n\
                     falloff_angle = {falloff}\nattenuation = [0, 0, 1]",
                    v(*p),
                    v([to[0] - p[0], to[1] - p[1], to[2] - p[2]])
                ),
            };
        }
        for (i, (body, surface)) in self.bodies.iter().enumerate() {
            let scaled = |c: [f64; 3], s: f64| v(c.map(|x| x * s));
            let _ = match surface {
                Surface::Matte { color, ambient, diffuse } => writeln!(
                    t,
                    "[materials.m{i}]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = [{}]\nambient = [{}]",
                    scaled(*color, *diffuse),
                    scaled(*color, *ambient)
                ),
                Surface::Mirror { color, ambient, diffuse, reflect } => writeln!(
                    t,
                    "[materials.m{i}]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = [{}]\nambient = [{}]\n\
                     reflect = {reflect}",
                    scaled(*color, *diffuse),
                    scaled(*color, *ambient)
                ),
                Surface::Glass { ior, priority } => {
                    writeln!(t, "[materials.m{i}]\ntype = \"dielectric\"\nior = {ior}\npriority = {priority}")
                }
                Surface::Clear { ior, priority } => writeln!(
                    t,
                    "[materials.m{i}]\ntype = \"dielectric\"\nior = {ior}\npriority = {priority}\n\
                     fresnel = \"constant\"\nreflectance = 0\ntransmittance = 1"
                ),
                Surface::Glowing { a, b, size } => writeln!(
                    t,
                    "[textures.t{i}]\ntype = \"checker\"\nmapping = \"solid\"\nspace = \"world\"\nscale = {}\na = [{}]\n\
                     b = [{}]\n[materials.m{i}]\ntype = \"phong\"\nform = \"classic\"\ndiffuse = 0\nambient = \"t{i}\"",
                    1.0 / size,
                    v(*a),
                    v(*b)
                ),
            };
            let _ = writeln!(t, "[objects.o{i}]\nmaterial = \"m{i}\"");
            let _ = match body {
                Body::Sphere(c, r) => writeln!(t, "type = \"sphere\"\ncenter = [{}]\nradius = {r}", v(*c)),
                Body::Floor(h) => writeln!(t, "type = \"plane\"\npoint = [0, {h}, 0]\nnormal = [0, 1, 0]"),
                Body::Block(a, b) => writeln!(t, "type = \"box\"\nmin = [{}]\nmax = [{}]", v(*a), v(*b)),
            };
        }
        t
    }

    /// For POV-Ray, in the same right-handed space.
    pub fn to_pov(&self) -> String {
        let mut t = String::from("#version 3.7;\n");
        let _ = writeln!(
            t,
            "global_settings {{ assumed_gamma 1.0 max_trace_level {} adc_bailout 0 ambient_light rgb 1 }}",
            self.depth + 1
        );
        let _ = writeln!(t, "background {{ rgb <{}> }}", v(self.sky));
        let (from, to) = self.camera;
        let _ = writeln!(
            t,
            "camera {{ perspective location <{}> right -x*image_width/image_height up y sky y angle {} look_at <{}> }}",
            v(from),
            self.fov,
            v(to)
        );
        for lamp in &self.lamps {
            let _ = match lamp {
                Lamp::Point(p, i) => writeln!(t, "light_source {{ <{}> rgb {i} }}", v(*p)),
                Lamp::Spot(p, to, hotspot, falloff) => writeln!(
                    t,
                    "light_source {{ <{}> rgb 1 spotlight point_at <{}> radius {hotspot} falloff {falloff} tightness 0 }}",
                    v(*p),
                    v(*to)
                ),
            };
        }
        for (body, surface) in &self.bodies {
            let shape = match body {
                Body::Sphere(c, r) => format!("sphere {{ <{}>, {r}", v(*c)),
                Body::Floor(h) => format!("plane {{ y, {h}"),
                Body::Block(a, b) => format!("box {{ <{}>, <{}>", v(*a), v(*b)),
            };
            let look = match surface {
                Surface::Matte { color, ambient, diffuse } => {
                    format!("pigment {{ rgb <{}> }} finish {{ ambient {ambient} diffuse {diffuse} }}", v(*color))
                }
                Surface::Mirror { color, ambient, diffuse, reflect } => format!(
                    "pigment {{ rgb <{}> }} finish {{ ambient {ambient} diffuse {diffuse} reflection {{ {reflect} }} }}",
                    v(*color)
                ),
                Surface::Glass { ior, .. } => format!(
                    "pigment {{ rgbf 1 }} finish {{ ambient 0 diffuse 0 reflection {{ 0, 1 fresnel on }} conserve_energy }} \
                     interior {{ ior {ior} }}"
                ),
                Surface::Clear { ior, .. } => {
                    format!("pigment {{ rgbf 1 }} finish {{ ambient 0 diffuse 0 }} interior {{ ior {ior} }}")
                }
                Surface::Glowing { a, b, size } => format!(
                    "pigment {{ checker rgb <{}> rgb <{}> scale {size} }} finish {{ ambient 1 diffuse 0 }}",
                    v(*a),
                    v(*b)
                ),
            };
            let _ = writeln!(t, "{shape} {look} }}");
        }
        t
    }
}
