//! The JSON Schema of scene files in TOML, for editors.

use super::Scene;
use serde_json::{Map, Value};

/// The schema of a scene in TOML form: strict, and with the types' documentation.
pub fn json_schema() -> Value {
    let mut schema = schemars::SchemaGenerator::default().into_root_schema_for::<Scene>().to_value();
    if let Some(root) = schema.as_object_mut() {
        root.insert("title".into(), "Terrarium scene".into());
    }
    tidy(&mut schema);
    schema
}

/// TOML has no null, and the RON snippets of the documentation don't belong here.
fn tidy(value: &mut Value) {
    match value {
        Value::Object(object) => {
            without_null(object);
            if let Some(Value::String(text)) = object.get_mut("description") {
                *text = without_snippets(text);
            }
            object.values_mut().for_each(tidy);
        }
        Value::Array(items) => items.iter_mut().for_each(tidy),
        _ => {}
    }
}

fn without_null(object: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|t| t != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            object.insert("type".into(), only);
        }
    }
    if let Some(Value::Array(options)) = object.get_mut("anyOf") {
        options.retain(|option| option.get("type").is_none_or(|t| t != "null"));
    }
    if object.get("default").is_some_and(Value::is_null) {
        object.remove("default");
    }
}

fn without_snippets(text: &str) -> String {
    let prose: Vec<&str> =
        text.split("```").step_by(2).map(str::trim).filter(|part| !part.is_empty()).collect();
    prose.join("\n")
}
