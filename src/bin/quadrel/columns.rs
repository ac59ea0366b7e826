//! Statistics as columns of a table.

use serde_json::Value;

/// The keys of a statistics object, flattened with dots, with their values as text: the columns
/// of a table. Lists of numbers are joined by blanks, rounds are counted.
pub fn flatten(statistics: &Value) -> Vec<(String, String)> {
    let mut columns = Vec::new();
    if let Value::Object(map) = statistics {
        for (key, value) in map {
            flatten_into(key, value, &mut columns);
        }
    }
    columns
}

fn flatten_into(name: &str, value: &Value, columns: &mut Vec<(String, String)>) {
    let text = match value {
        Value::Object(map) => {
            for (key, inner) in map {
                flatten_into(&format!("{name}.{key}"), inner, columns);
            }
            return;
        }
        Value::Array(list) if list.iter().any(Value::is_object) => list.len().to_string(),
        Value::Array(list) if name == "rounds" => list.len().to_string(),
        Value::Array(list) => {
            list.iter().map(plain).collect::<Vec<_>>().join(if name == "warnings" { "; " } else { " " })
        }
        other => plain(other),
    };
    columns.push((name.to_string(), text));
}

fn plain(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
