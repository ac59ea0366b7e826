//! Statistics as JSON: the statistics files of the command line, the statistics of the C interface.

use crate::stages::SymmetryCount;
use crate::statistics::Statistics;
use serde_json::{json, Map, Value};

impl Statistics {
    /// The statistics as a JSON object, its keys in a fixed order.
    pub fn to_json(&self) -> Value {
        let mut seconds = Map::new();
        for (stage, value) in self.stage_seconds {
            seconds.insert(stage.name().into(), number(value));
        }
        seconds.insert("total".into(), number(self.total_seconds));
        let rounds: Vec<Value> = self
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
        let count = |c: SymmetryCount| json!({ "rotations": c.rotations, "mirrors": c.mirrors });
        json!({
            "status": self.status,
            "message": self.message,
            "place": self.place.map(|p| list(&[p.x, p.y])),
            "seconds": seconds,
            "triangles": self.triangles,
            "singularities": self.singularities,
            "separatrices": self.separatrices,
            "blocks": self.blocks,
            "elements": self.elements,
            "order": self.order,
            "nodes": self.nodes,
            "irregular": {
                "interior": self.irregular.map(|i| i.interior),
                "boundary": self.irregular.map(|i| i.boundary),
            },
            "irregular_expected": self.irregular_expected,
            "scaled_jacobian": {
                "min": self.scaled_jacobian.map(|d| number(d.min)),
                "p1": self.scaled_jacobian.map(|d| number(d.p1)),
                "mean": self.scaled_jacobian.map(|d| number(d.mean)),
            },
            "scaled_jacobian_ceiling": self.scaled_jacobian_ceiling.map(number),
            "boundary_error": {
                "max": self.boundary_error.as_ref().map(|e| number(e.max)),
                "loops": self.boundary_error.as_ref().map(|e| list(&e.loops)),
            },
            "symmetry": {
                "domain": self.symmetry.map(|s| count(s.domain)),
                "mesh": self.symmetry.filter(|_| self.elements.is_some()).map(|s| count(s.mesh)),
                "asymmetry": self.symmetry.and_then(|s| s.asymmetry).map(|a| a.name()),
            },
            "fallback": self.fallback,
            "attempts": self.attempts,
            "rounds": rounds,
            "warnings": self.warnings,
        })
    }

    /// The text of a statistics file.
    pub fn to_json_text(&self) -> String {
        let mut text = serde_json::to_string_pretty(&self.to_json()).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// JSON has no infinities and no NaN: those become null.
fn number(value: f64) -> Value {
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}
