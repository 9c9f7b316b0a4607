//! Parameter tables: what each type of each kind takes. Everything that must know a parameter reads its row here:
//! validation, "did you mean", the schema, the manual, sliders.

use crate::Kind;

/// What a parameter may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamType {
    /// true or false
    Bool,
    /// A whole number.
    Integer,
    /// A number.
    Number,
    /// Free text.
    Text,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Two numbers.
    Vector2,
    /// Three numbers: a point, a direction, sizes.
    Vector,
    /// Linear Rec.709 `[r, g, b]`, one number for grey, or `"#rrggbb"` in sRGB.
    Color,
    /// A colour, or the name of a texture.
    ColorTexture,
    /// A refractive index: a number, or by wavelength: see [`crate::waves`].
    Index,
    /// A number, or the name of a texture (its mean of r, g, b).
    NumberTexture,
    /// Three numbers, or the name of a texture whose red, green and blue they are.
    VectorTexture,
    /// The name of another entity.
    Reference(Kind),
    /// Several names.
    References(Kind),
    /// A file, relative to the one that names it.
    Path,
    /// A list of steps, applied in order: `[{scale = 2}, {rotate = [0, 1, 0, 90]}, {translate = [1, 0, 0]}]`.
    Transform,
    /// Key frames: `[{time = 0, transform = [...]}, {time = 1, transform = [...]}]`.
    Motion,
    /// Any number of numbers.
    Numbers,
    /// Any number of `[x, y, z]`.
    Vectors,
    /// Any number of `[position, colour]` pairs, rising.
    Gradient,
}

/// What holds where nothing is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fallback {
    /// It must be written.
    Required,
    /// Absent, which the doc line explains.
    Absent,
    /// This truth value.
    Bool(bool),
    /// This number (also for `Integer`, and grey for colours).
    Number(f64),
    /// This text or choice.
    Text(&'static str),
    /// These two numbers.
    Vector2([f64; 2]),
    /// These three numbers.
    Vector([f64; 3]),
}

/// One row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamSpec {
    /// Name as written.
    pub name: &'static str,
    /// What it may be.
    pub ty: ParamType,
    /// Unit, "" for none.
    pub unit: &'static str,
    /// Lowest and highest allowed number, for every number in it.
    pub range: (f64, f64),
    /// What holds where nothing is written.
    pub fallback: Fallback,
    /// One line.
    pub doc: &'static str,
}

/// Any finite number.
pub const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
/// Zero and up.
pub const NOT_NEGATIVE: (f64, f64) = (0.0, f64::INFINITY);
/// Above zero.
pub const POSITIVE: (f64, f64) = (f64::MIN_POSITIVE, f64::INFINITY);
/// From 0 to 1.
pub const UNIT: (f64, f64) = (0.0, 1.0);

impl ParamSpec {
    /// A row without unit and range.
    pub const fn new(name: &'static str, ty: ParamType, fallback: Fallback, doc: &'static str) -> Self {
        ParamSpec { name, ty, unit: "", range: ANY, fallback, doc }
    }
    /// With a unit.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }
    /// With a range.
    pub const fn range(mut self, range: (f64, f64)) -> Self {
        self.range = range;
        self
    }
    /// A number.
    pub const fn number(name: &'static str, default: f64, doc: &'static str) -> Self {
        Self::new(name, ParamType::Number, Fallback::Number(default), doc)
    }
    /// A whole number.
    pub const fn integer(name: &'static str, default: i64, range: (f64, f64), doc: &'static str) -> Self {
        Self::new(name, ParamType::Integer, Fallback::Number(default as f64), doc).range(range)
    }
    /// true or false.
    pub const fn bool(name: &'static str, default: bool, doc: &'static str) -> Self {
        Self::new(name, ParamType::Bool, Fallback::Bool(default), doc)
    }
    /// One of several words; the first is the default.
    pub const fn choice(name: &'static str, words: &'static [&'static str], doc: &'static str) -> Self {
        Self::new(name, ParamType::Choice(words), Fallback::Text(words[0]), doc)
    }
    /// A point or direction.
    pub const fn vector(name: &'static str, default: [f64; 3], doc: &'static str) -> Self {
        Self::new(name, ParamType::Vector, Fallback::Vector(default), doc)
    }
    /// A plain colour, not negative.
    pub const fn color(name: &'static str, default: [f64; 3], doc: &'static str) -> Self {
        Self::new(name, ParamType::Color, Fallback::Vector(default), doc).range(NOT_NEGATIVE)
    }
    /// A colour or texture between 0 and 1.
    pub const fn reflectance(name: &'static str, default: [f64; 3], doc: &'static str) -> Self {
        Self::new(name, ParamType::ColorTexture, Fallback::Vector(default), doc).range(UNIT)
    }
    /// A number or texture.
    pub const fn number_texture(name: &'static str, default: f64, range: (f64, f64), doc: &'static str) -> Self {
        Self::new(name, ParamType::NumberTexture, Fallback::Number(default), doc).range(range)
    }
}

/// One type of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TypeSpec {
    /// Of which kind.
    pub kind: Kind,
    /// Name as written: `lambert`.
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    /// Its own rows (those common to the kind come besides).
    pub params: &'static [ParamSpec],
}

/// Every type that a build of Kirkas knows.
#[derive(Clone, Debug, Default)]
pub struct Catalog {
    /// All types, in listed order.
    pub types: Vec<&'static TypeSpec>,
    /// Rows that every type of a kind takes.
    pub common: Vec<(Kind, &'static [ParamSpec])>,
}

impl Catalog {
    /// A type by kind and name.
    pub fn find(&self, kind: Kind, name: &str) -> Option<&'static TypeSpec> {
        self.types.iter().copied().find(|t| t.kind == kind && t.name == name)
    }

    /// All types of a kind.
    pub fn of_kind(&self, kind: Kind) -> impl Iterator<Item = &'static TypeSpec> + '_ {
        self.types.iter().copied().filter(move |t| t.kind == kind)
    }

    /// Rows that every type of a kind takes.
    pub fn common(&self, kind: Kind) -> &'static [ParamSpec] {
        self.common.iter().find(|c| c.0 == kind).map_or(&[], |c| c.1)
    }

    /// All rows of a type, its own first.
    pub fn rows(&self, spec: &'static TypeSpec) -> impl Iterator<Item = &'static ParamSpec> + use<> {
        spec.params.iter().chain(self.common(spec.kind))
    }
}
