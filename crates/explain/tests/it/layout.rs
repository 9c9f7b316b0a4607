//! What is written is what the schema says, field by field.

use crate::support::scene;
use kirkas_explain::{explain, schema};
use serde_json::Value;

/// Where `value` is not as `schema` says.
fn differences(root: &Value, schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    if let Some(name) = schema["$ref"].as_str() {
        let name = name.trim_start_matches("#/$defs/");
        return differences(root, &root["$defs"][name], value, at, found);
    }
    if let Some(all) = schema["allOf"].as_array() {
        return all.iter().for_each(|s| differences(root, s, value, at, found));
    }
    if let Some(any) = schema["anyOf"].as_array() {
        let fits = |s: &&Value| {
            let mut own = Vec::new();
            differences(root, s, value, at, &mut own);
            own.is_empty()
        };
        if !any.iter().any(|s| fits(&s)) {
            found.push(format!("{at}: {value} fits none of {schema}"));
        }
        return;
    }
    if let Some(allowed) = schema["enum"].as_array() {
        if !allowed.contains(value) {
            found.push(format!("{at}: {value} is none of {allowed:?}"));
        }
        return;
    }
    let fits = match schema["type"].as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("integer") => value.is_u64() || value.is_i64(),
        Some("boolean") => value.is_boolean(),
        Some("null") => value.is_null(),
        other => panic!("{other:?} at {at}"),
    };
    if !fits {
        return found.push(format!("{at}: {value} is no {}", schema["type"]));
    }
    if let (Some(properties), Some(fields)) = (schema["properties"].as_object(), value.as_object()) {
        for (name, field) in fields {
            match properties.get(name) {
                Some(s) => differences(root, s, field, &format!("{at}.{name}"), found),
                None => found.push(format!("{at}.{name} is not in the schema")),
            }
        }
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !fields.contains_key(name) {
                found.push(format!("{at}.{name} is missing"));
            }
        }
    }
    for (i, item) in value.as_array().into_iter().flatten().enumerate() {
        differences(root, &schema["items"], item, &format!("{at}[{i}]"), found);
    }
}

#[test]
fn explanations_are_as_their_schema_says() {
    let schema = schema();
    let cases = [
        ("sphereflake.toml", "integrator.type=whitted", "film.color=rgb"),
        ("light/prism.toml", "integrator.type=path", "film.color=spectral"),
        ("light/fog.toml", "integrator.type=path", "film.color=rgb"),
        ("light/glass_caustics.toml", "integrator.type=photon", "film.color=rgb"),
    ];
    for (name, integrator, color) in cases {
        let p = scene(name, &[integrator, color, "film.width=40", "film.height=30", "sampler.samples=2"]);
        let e = explain(&p, (20, 15), 0..2, "path", name, &mut |_| {});
        let json = e.to_json();
        let mut found = Vec::new();
        differences(&schema, &schema, &json, name, &mut found);
        assert!(found.is_empty(), "{found:#?}");
        assert!(json["trees"].as_array().is_some_and(|t| t.len() == 2));
        // The test can fail: a field too many, one too few, one of another type.
        let mut wrong = json.clone();
        wrong["trees"][0]["rays"][0]["kind"] = serde_json::json!(1);
        wrong["scene"] = Value::Null;
        wrong["extra"] = Value::Null;
        let mut found = Vec::new();
        differences(&schema, &schema, &wrong, name, &mut found);
        assert_eq!(found.len(), 3, "{found:?}");
    }
}

#[test]
fn every_field_is_documented() {
    let schema = schema();
    for (name, of) in schema["$defs"].as_object().expect("structures") {
        assert!(of["description"].as_str().is_some_and(|d| d.len() > 5), "{name}");
        for (field, of) in of["properties"].as_object().expect("fields") {
            assert!(of["description"].as_str().is_some_and(|d| d.len() > 3), "{name}.{field}");
        }
    }
}
