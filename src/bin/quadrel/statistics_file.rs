//! Statistics as JSON.

use quadrel::statistics::Statistics;
use serde_json::{json, Map, Value};

/// The statistics as a JSON object, its keys in a fixed order.
pub fn to_json(statistics: &Statistics) -> Value {
    let mut seconds = Map::new();
    for (stage, value) in statistics.stage_seconds {
        seconds.insert(stage.name().into(), number(value));
    }
    seconds.insert("total".into(), number(statistics.total_seconds));
    let rounds: Vec<Value> = statistics
        .rounds
        .iter()
        .map(|round| {
            json!({
                "action": round.action,
                "elements": round.elements,
                "scaled_jacobian": number(round.scaled_jacobian),
                "boundary_error": number(round.boundary_error),
            })
        })
        .collect();
    let list = |values: &[f64]| values.iter().map(|v| number(*v)).collect::<Vec<Value>>();
    json!({
        "status": statistics.status,
        "message": statistics.message,
        "place": statistics.place.map(|p| list(&[p.x, p.y])),
        "seconds": seconds,
        "triangles": statistics.triangles,
        "singularities": statistics.singularities,
        "separatrices": statistics.separatrices,
        "blocks": statistics.blocks,
        "elements": statistics.elements,
        "order": statistics.order,
        "nodes": statistics.nodes,
        "irregular": {
            "interior": statistics.irregular.map(|i| i.interior),
            "boundary": statistics.irregular.map(|i| i.boundary),
        },
        "irregular_expected": statistics.irregular_expected,
        "scaled_jacobian": {
            "min": statistics.scaled_jacobian.map(|d| number(d.min)),
            "p1": statistics.scaled_jacobian.map(|d| number(d.p1)),
            "mean": statistics.scaled_jacobian.map(|d| number(d.mean)),
        },
        "scaled_jacobian_ceiling": statistics.scaled_jacobian_ceiling.map(number),
        "boundary_error": {
            "max": statistics.boundary_error.as_ref().map(|e| number(e.max)),
            "loops": statistics.boundary_error.as_ref().map(|e| list(&e.loops)),
        },
        "fallback": statistics.fallback,
        "attempts": statistics.attempts,
        "rounds": rounds,
        "warnings": statistics.warnings,
    })
}

/// The text of a statistics file.
pub fn to_text(statistics: &Statistics) -> String {
    let mut text = serde_json::to_string_pretty(&to_json(statistics)).unwrap_or_default();
    text.push('\n');
    text
}

/// JSON has no infinities and no NaN: those become null.
fn number(value: f64) -> Value {
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

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
