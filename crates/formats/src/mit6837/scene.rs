//! What a scene text says, before it becomes native.

use kirkas_geometry::{DAffine3, DMat3, DVec3};
use kirkas_scene::{Map, Node, Span};

/// A value and its place.
pub(super) type At<T> = (T, Span);

/// The whole text.
#[derive(Default)]
pub(super) struct Scene {
    pub cameras: Vec<Camera>,
    pub lights: Vec<Light>,
    /// Whether a `Lights` block stands in the text, even an empty one.
    pub names_lights: bool,
    pub background: Option<At<[f64; 3]>>,
    pub ambient: Option<At<[f64; 3]>>,
    pub materials: Vec<At<Material>>,
    pub objects: Vec<Object>,
    /// True for the words that only the course of 2012 knows.
    pub is_2012: bool,
}

pub(super) struct Camera {
    pub span: Span,
    pub center: At<[f64; 3]>,
    pub direction: At<[f64; 3]>,
    pub up: Option<At<[f64; 3]>>,
    /// Degrees for a perspective camera, scene units for an orthographic one.
    pub extent: At<f64>,
    pub is_perspective: bool,
}

pub(super) struct Light {
    pub span: Span,
    pub color: At<[f64; 3]>,
    pub place: LightPlace,
}

pub(super) enum LightPlace {
    Directional(At<[f64; 3]>),
    /// Position, and the course's constant, linear and quadratic attenuation.
    Point(At<[f64; 3]>, At<[f64; 3]>),
}

pub(super) enum Material {
    Surface(Box<Surface>),
    Pattern(Pattern),
}

#[derive(Default)]
pub(super) struct Surface {
    pub diffuse: Option<At<[f64; 3]>>,
    pub specular: Option<At<[f64; 3]>>,
    pub reflective: Option<At<[f64; 3]>>,
    pub transparent: Option<At<[f64; 3]>>,
    pub exponent: Option<At<f64>>,
    /// True if the exponent was written as `shininess`.
    pub has_shininess: bool,
    pub ior: Option<At<f64>>,
    pub texture: Option<At<String>>,
    /// Two colours mixed by the marble of 2012.
    pub noise: Option<ColorNoise>,
}

pub(super) struct ColorNoise {
    pub colors: [At<[f64; 3]>; 2],
    pub turbulence: Turbulence,
}

#[derive(Clone, Copy, Default)]
pub(super) struct Turbulence {
    pub octaves: Option<At<usize>>,
    pub frequency: Option<At<f64>>,
    pub amplitude: Option<At<f64>>,
}

/// Two materials mixed by place.
pub(super) struct Pattern {
    /// The native texture: `checker`, `noise`, `marble`, `wood`.
    pub texture: &'static str,
    /// Takes world to texture space.
    pub steps: Vec<Step>,
    pub materials: [At<usize>; 2],
    pub turbulence: Turbulence,
}

/// One step of a transformation.
#[derive(Clone, Copy)]
pub(super) struct Step {
    pub span: Span,
    pub action: Action,
}

#[derive(Clone, Copy)]
pub(super) enum Action {
    Translate([f64; 3]),
    Scale([f64; 3]),
    /// Axis and degrees.
    Rotate([f64; 4]),
    /// Twelve numbers by rows.
    Matrix([f64; 12]),
}

impl Step {
    /// As a native step.
    pub fn native(&self) -> Node {
        let map = match self.action {
            Action::Translate(v) => Map::default().with("translate", v),
            Action::Scale([x, y, z]) if x == y && y == z => Map::default().with("scale", x),
            Action::Scale(v) => Map::default().with("scale", v),
            Action::Rotate(v) => Map::default().with("rotate", v),
            Action::Matrix(m) => Map::default().with("matrix", m),
        };
        Node::spanned(map, self.span)
    }

    /// The step that undoes this one; `None` if it cannot be undone.
    pub fn inverse(&self) -> Option<Step> {
        let action = match self.action {
            Action::Translate(v) => Action::Translate(v.map(|x| 0.0 - x)),
            Action::Scale(v) => Action::Scale(v.map(|x| 1.0 / x)),
            Action::Rotate([x, y, z, a]) => Action::Rotate([x, y, z, 0.0 - a]),
            Action::Matrix(m) => {
                let column = |c: usize| DVec3::new(m[c], m[4 + c], m[8 + c]);
                let matrix3 = DMat3::from_cols(column(0), column(1), column(2));
                let a = DAffine3 { matrix3, translation: column(3) }.inverse();
                let (r, t) = (a.matrix3.transpose(), a.translation);
                let row = |r: DVec3, t: f64| [r.x, r.y, r.z, t];
                let rows = [row(r.x_axis, t.x), row(r.y_axis, t.y), row(r.z_axis, t.z)];
                Action::Matrix(std::array::from_fn(|i| rows[i / 4][i % 4]))
            }
        };
        let numbers: &[f64] = match &action {
            Action::Translate(v) | Action::Scale(v) => v,
            Action::Rotate(v) => v,
            Action::Matrix(m) => m,
        };
        numbers.iter().all(|v| v.is_finite()).then_some(Step { span: self.span, action })
    }
}

pub(super) struct Object {
    pub span: Span,
    pub material: Option<At<usize>>,
    pub shape: Shape,
}

pub(super) enum Shape {
    Group(Vec<Object>),
    /// The first step is the outermost.
    Transform(Vec<Step>, Box<Object>),
    Sphere(At<[f64; 3]>, At<f64>),
    /// Normal and offset: the plane `normal . p = offset` (unit normal).
    Plane(At<[f64; 3]>, At<f64>),
    Triangle([At<[f64; 3]>; 3]),
    Mesh(At<String>),
}
