//! The JSON Schema of scenes holds for what can be read, and for nothing else.

use super::FULL_TOML;
use terrarium::description::json_schema;

#[test]
fn the_schema_accepts_the_full_scene_and_refuses_misspelt_ones() {
    let schema = json_schema();
    let value = |text: &str| {
        serde_json::to_value(toml::from_str::<toml::Table>(text).expect("it is TOML")).expect("no dates")
    };
    let problems = |text: &str| {
        let mut problems = Vec::new();
        validate(&schema, &schema, &value(text), "", &mut problems);
        problems
    };
    assert_eq!(problems(FULL_TOML), Vec::<String>::new());
    assert_eq!(problems("antialiasing = \"progressive\""), Vec::<String>::new());
    for wrong in [
        "camra = 1",
        "[camera]\neye = [1, 2]\ntarget = [0, 0, 0]",
        "[camera]\neye = [1, 2, 3]",
        "antialiasing = \"often\"",
        "[materials.a]\nior = \"glas\"",
        "[materials.a]\ndiffuse = { texture = 3 }",
        "[[objects]]\nshape.sphere = { radus = 1 }",
        "[image]\nwidth = -1",
    ] {
        assert!(!problems(wrong).is_empty(), "{wrong}");
    }
}

/// The part of JSON Schema that our schema uses; an unknown keyword is a problem too.
fn validate(
    root: &serde_json::Value,
    schema: &serde_json::Value,
    value: &serde_json::Value,
    at: &str,
    problems: &mut Vec<String>,
) {
    use serde_json::Value;
    let valid = |schema: &Value| {
        let mut inner = Vec::new();
        validate(root, schema, value, at, &mut inner);
        inner.is_empty()
    };
    let Some(rules) = schema.as_object() else { return };
    for (rule, argument) in rules {
        let ok = match rule.as_str() {
            "$schema" | "title" | "description" | "default" | "format" | "$defs" => true,
            "$ref" => {
                let pointer = argument.as_str().expect("a reference is a text").trim_start_matches('#');
                validate(
                    root,
                    root.pointer(pointer).expect("references lead somewhere"),
                    value,
                    at,
                    problems,
                );
                true
            }
            "type" => match argument.as_str() {
                Some("object") => value.is_object(),
                Some("array") => value.is_array(),
                Some("string") => value.is_string(),
                Some("boolean") => value.is_boolean(),
                Some("number") => value.is_number(),
                Some("integer") => value.is_i64() || value.is_u64(),
                _ => false,
            },
            "properties" => {
                for (key, schema) in argument.as_object().expect("properties are a map") {
                    if let Some(inner) = value.get(key) {
                        validate(root, schema, inner, &format!("{at}.{key}"), problems);
                    }
                }
                true
            }
            "additionalProperties" => {
                let known = rules.get("properties").and_then(Value::as_object);
                for (key, inner) in value.as_object().into_iter().flatten() {
                    if known.is_some_and(|known| known.contains_key(key)) {
                        continue;
                    }
                    match argument {
                        Value::Bool(false) => problems.push(format!("{at}: `{key}` is not known")),
                        schema => validate(root, schema, inner, &format!("{at}.{key}"), problems),
                    }
                }
                true
            }
            "required" => argument
                .as_array()
                .into_iter()
                .flatten()
                .all(|key| value.get(key.as_str().unwrap_or("")).is_some()),
            "items" => {
                for (i, inner) in value.as_array().into_iter().flatten().enumerate() {
                    validate(root, argument, inner, &format!("{at}.{i}"), problems);
                }
                true
            }
            "minItems" => value.as_array().is_none_or(|a| a.len() as u64 >= argument.as_u64().unwrap_or(0)),
            "maxItems" => value.as_array().is_none_or(|a| a.len() as u64 <= argument.as_u64().unwrap_or(0)),
            "anyOf" => argument.as_array().into_iter().flatten().any(valid),
            "oneOf" => argument.as_array().into_iter().flatten().filter(|s| valid(s)).count() == 1,
            "enum" => argument.as_array().is_some_and(|all| all.contains(value)),
            "const" => argument == value,
            "minimum" => value.as_f64().is_none_or(|x| x >= argument.as_f64().unwrap_or(0.0)),
            "maximum" => value.as_f64().is_none_or(|x| x <= argument.as_f64().unwrap_or(0.0)),
            "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > argument.as_f64().unwrap_or(0.0)),
            "exclusiveMaximum" => value.as_f64().is_none_or(|x| x < argument.as_f64().unwrap_or(0.0)),
            other => {
                problems.push(format!("{at}: the validator does not know `{other}`"));
                true
            }
        };
        if !ok {
            problems.push(format!("{at}: {rule} {argument}"));
        }
    }
}
