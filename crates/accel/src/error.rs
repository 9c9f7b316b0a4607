//! Why a scene was refused.

use core::fmt;

/// What is wrong with a scene, and where. `aggregate` is `None` for the world itself.
#[derive(Clone, Debug, PartialEq)]
pub enum AccelError {
    /// A vertex, a number of a primitive, or a user shape's bound is NaN, or infinite where it must not be.
    NotFinite {
        /// Where; `None` is the world itself.
        aggregate: Option<usize>,
        /// Index of the geometry there.
        geometry: usize,
        /// Index of the vertex, curve point or primitive.
        element: usize,
        /// What it is.
        what: &'static str,
    },
    /// A primitive that cannot be: a negative radius, a disk without a normal.
    BadPrimitive {
        /// Where; `None` is the world itself.
        aggregate: Option<usize>,
        /// Index of the geometry there.
        geometry: usize,
        /// Index of the primitive or curve point.
        element: usize,
        /// What it is.
        what: &'static str,
        /// What it has that it must not have.
        fault: &'static str,
    },
    /// Moving triangles without two keys, or with keys of different lengths.
    BadKeys {
        /// Where; `None` is the world itself.
        aggregate: Option<usize>,
        /// Index of the geometry there.
        geometry: usize,
        /// Number of vertices at each key.
        lengths: Vec<usize>,
    },
    /// A triangle, quad or curve segment names a vertex that does not exist.
    IndexOutOfRange {
        /// Where; `None` is the world itself.
        aggregate: Option<usize>,
        /// Index of the geometry there.
        geometry: usize,
        /// What names it.
        what: &'static str,
        /// Index of the primitive.
        element: usize,
        /// The vertex it names.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// More primitives than a structure can address.
    TooManyPrimitives {
        /// Where; `None` is the world itself.
        aggregate: Option<usize>,
        /// How many there are.
        count: u64,
        /// How many there may be.
        limit: u64,
    },
    /// An instance names an aggregate that does not exist.
    NoSuchAggregate {
        /// The aggregate that holds the instance; `None` is the world itself.
        within: Option<usize>,
        /// Index of the instance there.
        instance: usize,
        /// The aggregate it names.
        aggregate: usize,
        /// How many aggregates there are.
        aggregates: usize,
    },
    /// An instance's transform cannot be inverted, or holds NaN or infinity, at this time.
    BadTransform {
        /// The aggregate that holds the instance; `None` is the world itself.
        within: Option<usize>,
        /// Index of the instance there.
        instance: usize,
        /// Seconds.
        time: f64,
    },
    /// An aggregate holds itself, by its own instances or by those of what it places.
    Cycle {
        /// Index of the aggregate.
        aggregate: usize,
    },
    /// Instances stand in instances too deep.
    NestedTooDeep {
        /// Index of the outermost instance, in the world.
        instance: usize,
        /// How deep.
        levels: usize,
        /// How deep they may.
        limit: usize,
    },
    /// The shutter ends before it starts, or is not finite.
    BadShutter {
        /// Seconds.
        start: f64,
        /// Seconds.
        end: f64,
    },
}

impl fmt::Display for AccelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |aggregate: &Option<usize>| match aggregate {
            None => "the world".to_string(),
            Some(a) => format!("aggregate {a}"),
        };
        let inside = |within: &Option<usize>| within.map_or(String::new(), |a| format!(" in aggregate {a}"));
        match self {
            Self::NotFinite { aggregate, geometry, element, what } => {
                write!(f, "{what} {element} of geometry {geometry} in {} is not a finite number", place(aggregate))
            }
            Self::BadPrimitive { aggregate, geometry, element, what, fault } => {
                write!(f, "{what} {element} of geometry {geometry} in {} has {fault}", place(aggregate))
            }
            Self::BadKeys { aggregate, geometry, lengths } => write!(
                f,
                "geometry {geometry} in {} moves: it needs two or more keys with as many vertices each, and has {lengths:?}",
                place(aggregate)
            ),
            Self::IndexOutOfRange { aggregate, geometry, what, element, index, vertices } => write!(
                f,
                "{what} {element} of geometry {geometry} in {} uses vertex {index}, but there are {vertices}",
                place(aggregate)
            ),
            Self::TooManyPrimitives { aggregate, count, limit } => {
                write!(f, "{} holds {count} primitives; the limit is {limit}", place(aggregate))
            }
            Self::NoSuchAggregate { within, instance, aggregate, aggregates } => {
                write!(
                    f,
                    "instance {instance}{} places aggregate {aggregate}, but there are {aggregates}",
                    inside(within)
                )
            }
            Self::BadTransform { within, instance, time } => {
                write!(f, "the transform of instance {instance}{} cannot be inverted at time {time}", inside(within))
            }
            Self::Cycle { aggregate } => write!(f, "aggregate {aggregate} holds an instance of itself"),
            Self::NestedTooDeep { instance, levels, limit } => {
                write!(f, "instance {instance} holds instances {levels} deep, itself counted; the limit is {limit}")
            }
            Self::BadShutter { start, end } => write!(f, "the shutter cannot be open from {start} to {end}"),
        }
    }
}

impl std::error::Error for AccelError {}
