//! Diagrams beside the picture of a page: curves over time, with a mark at the time shown.

use serde_json::{Value, json};

/// Curves over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// What is drawn, with unit.
    pub label: String,
    pub curves: Vec<DiagramCurve>,
}

/// A curve over time.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramCurve {
    /// Its name; empty for one alone.
    pub name: String,
    /// Time [s] and value.
    pub points: Vec<[f64; 2]>,
}

impl Diagram {
    /// For the header of a page: numbers of six digits, without those that are not finite.
    pub(crate) fn to_json(&self) -> Value {
        let curve = |c: &DiagramCurve| {
            let finite = c.points.iter().filter(|p| p.iter().all(|v| v.is_finite()));
            let points: Vec<[f64; 2]> = finite.map(|p| p.map(rounded)).collect();
            json!({ "name": c.name, "points": points })
        };
        json!({ "label": self.label, "curves": self.curves.iter().map(curve).collect::<Vec<_>>() })
    }
}

fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_finite() {
        let points = vec![[0.0, 1.0 / 3.0], [0.1, f64::NAN]];
        let curves = vec![DiagramCurve { name: "a".into(), points }];
        let json = Diagram { label: "f [N]".into(), curves }.to_json();
        assert_eq!(json["curves"][0]["points"], json!([[0.0, 0.333333]]));
    }
}
