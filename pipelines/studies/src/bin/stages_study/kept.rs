//! What was found, as JSON: a study that was stopped goes on.

use crate::plant::Found;
use serde_json::{Value, json};

/// As text; numbers that are none are written as null.
pub fn text(found: &[Found]) -> String {
    let one = |f: &Found| json!({"values": f.values, "passed": f.passed, "profile": f.profile, "stopped": f.stopped});
    Value::Array(found.iter().map(one).collect()).to_string()
}

/// From text; `None` where it is not whole.
pub fn read(text: &Value) -> Option<Vec<Found>> {
    text.as_array()?.iter().map(one).collect()
}

fn one(text: &Value) -> Option<Found> {
    let curve = |v: &Value| -> Option<Vec<(f64, f64)>> {
        v.as_array()?.iter().map(|p| Some((p[0].as_f64()?, p[1].as_f64().unwrap_or(f64::NAN)))).collect()
    };
    let values: Vec<f64> =
        text["values"].as_array()?.iter().map(|v| v.as_f64().unwrap_or(f64::NAN)).collect();
    Some(Found {
        values: values.try_into().ok()?,
        passed: [curve(&text["passed"][0])?, curve(&text["passed"][1])?],
        profile: curve(&text["profile"])?,
        stopped: text["stopped"].as_str().map(str::to_owned),
    })
}
