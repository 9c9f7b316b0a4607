//! Structures of which each field is listed once, with its documentation: what is written as JSON and what the schema says come from
//! the same list.

use serde_json::{Map, Value, json};

/// Becomes JSON, and can say what that looks like.
pub trait Json {
    /// The value.
    fn json(&self) -> Value;
    /// JSON Schema of such values.
    fn schema() -> Value;
}

macro_rules! records {
    ($($(#[doc = $doc:literal])+ $name:ident { $($(#[doc = $field_doc:literal])+ $field:ident: $ty:ty,)+ })+) => {
        $(
            $(#[doc = $doc])+
            #[derive(Clone, Debug, PartialEq)]
            pub struct $name {
                $($(#[doc = $field_doc])+ pub $field: $ty,)+
            }

            impl $crate::fields::Json for $name {
                fn json(&self) -> serde_json::Value {
                    let mut map = serde_json::Map::new();
                    $(map.insert(stringify!($field).into(), $crate::fields::Json::json(&self.$field));)+
                    serde_json::Value::Object(map)
                }

                fn schema() -> serde_json::Value {
                    serde_json::json!({ "$ref": concat!("#/$defs/", stringify!($name)) })
                }
            }
        )+

        /// JSON Schema of every structure, by name.
        fn definitions() -> serde_json::Map<String, serde_json::Value> {
            let mut all = serde_json::Map::new();
            $({
                let fields: Vec<(&str, &str, serde_json::Value)> =
                    vec![$((stringify!($field), concat!($($field_doc),+), <$ty as $crate::fields::Json>::schema())),+];
                all.insert(stringify!($name).into(), $crate::fields::object(concat!($($doc),+), &fields));
            })+
            all
        }
    };
}
pub(crate) use records;

/// Schema of an object with these fields: name, documentation, schema.
pub fn object(doc: &str, fields: &[(&str, &str, Value)]) -> Value {
    let property = |(name, doc, schema): &(&str, &str, Value)| {
        // Beside a reference nothing else counts in older drafts.
        let described = json!({ "description": doc.trim(), "allOf": [schema] });
        let plain = |mut schema: Value| {
            schema["description"] = json!(doc.trim());
            schema
        };
        let value = if schema.get("$ref").is_some() { described } else { plain(schema.clone()) };
        ((*name).to_string(), value)
    };
    let names: Vec<&str> = fields.iter().map(|f| f.0).collect();
    json!({
        "type": "object",
        "description": doc.trim(),
        "properties": fields.iter().map(property).collect::<Map<_, _>>(),
        "required": names,
        "additionalProperties": false,
    })
}

macro_rules! plain {
    ($($ty:ty => $schema:expr;)+) => {
        $(impl Json for $ty {
            fn json(&self) -> Value {
                json!(self)
            }
            fn schema() -> Value {
                $schema
            }
        })+
    };
}
plain! {
    bool => json!({ "type": "boolean" });
    u32 => json!({ "type": "integer", "minimum": 0 });
    u64 => json!({ "type": "integer", "minimum": 0 });
    usize => json!({ "type": "integer", "minimum": 0 });
    String => json!({ "type": "string" });
    &'static str => json!({ "type": "string" });
}

/// Numbers that are not finite have no JSON: they become texts.
fn number(v: f64, short: impl Fn() -> Value) -> Value {
    if v.is_finite() {
        short()
    } else {
        json!(if v.is_nan() {
            "nan"
        } else if v > 0.0 {
            "infinity"
        } else {
            "-infinity"
        })
    }
}

fn number_schema() -> Value {
    json!({ "anyOf": [{ "type": "number" }, { "enum": ["nan", "infinity", "-infinity"] }] })
}

impl Json for f32 {
    fn json(&self) -> Value {
        // As short as tells it from its neighbours.
        number(f64::from(*self), || self.to_string().parse::<f64>().map_or(Value::Null, |v| json!(v)))
    }
    fn schema() -> Value {
        number_schema()
    }
}

impl Json for f64 {
    fn json(&self) -> Value {
        number(*self, || json!(self))
    }
    fn schema() -> Value {
        number_schema()
    }
}

/// Units of 2^-64: too long for most readers of JSON, so a text.
impl Json for i128 {
    fn json(&self) -> Value {
        json!(self.to_string())
    }
    fn schema() -> Value {
        json!({ "type": "string", "pattern": "^-?[0-9]+$" })
    }
}

impl<T: Json> Json for Option<T> {
    fn json(&self) -> Value {
        self.as_ref().map_or(Value::Null, T::json)
    }
    fn schema() -> Value {
        json!({ "anyOf": [T::schema(), { "type": "null" }] })
    }
}

impl<T: Json> Json for Vec<T> {
    fn json(&self) -> Value {
        self.iter().map(T::json).collect()
    }
    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema() })
    }
}

impl<T: Json, const N: usize> Json for [T; N] {
    fn json(&self) -> Value {
        self.iter().map(T::json).collect()
    }
    fn schema() -> Value {
        json!({ "type": "array", "items": T::schema(), "minItems": N, "maxItems": N })
    }
}
