//! Findings read back: grouped by part and by what holds, the worst variant kept, as a table.
//!
//! The same findings make the same bytes, in whatever order tests ran.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Parts in the order of the page; others follow by name.
const PARTS: [&str; 11] = [
    "One contact",
    "Friction and rolling",
    "Many grains",
    "Bonds",
    "Time step",
    "Energy",
    "Rest and extremes",
    "Walls of spheres",
    "Faults",
    "Guards",
    "Same bits",
];

/// All findings, by part of the page.
#[derive(Debug, Default)]
pub struct Page {
    /// Parts, in order.
    pub parts: Vec<Part>,
}

/// A part of the page.
#[derive(Debug, Default)]
pub struct Part {
    /// Heading.
    pub name: String,
    /// Its lines, by what holds.
    pub lines: Vec<Line>,
}

/// What holds, and what was found.
#[derive(Debug, Default)]
pub struct Line {
    /// What holds.
    pub holds: String,
    /// Variants it was tried on.
    pub tried: BTreeSet<String>,
    /// The number nearest to its limit, or beyond it.
    pub worst: Option<Number>,
    /// The first message by the name of the variant, of those that were refused.
    pub refused: Option<(String, String)>,
    /// Orders of convergence.
    pub orders: Vec<Order>,
    /// Curves.
    pub curves: Vec<Curve>,
}

/// A number under a limit.
#[derive(Debug, Clone)]
pub struct Number {
    /// Variant.
    pub on: String,
    /// What was found, in `unit`.
    pub value: f64,
    /// The most that is allowed, in `unit`.
    pub limit: f64,
    /// Unit; "–" for none.
    pub unit: String,
}

impl Number {
    /// Share of the limit [–].
    pub fn share(&self) -> f64 {
        if self.limit > 0.0 {
            self.value.abs() / self.limit
        } else if self.value == 0.0 {
            0.0
        } else {
            f64::INFINITY
        }
    }
}

/// Errors over steps.
#[derive(Debug, Clone)]
pub struct Order {
    /// Variant.
    pub on: String,
    /// Slope that was found [–].
    pub order: f64,
    /// Slope that is expected [–].
    pub expected: f64,
    /// (step, error).
    pub points: Vec<(f64, f64)>,
}

/// A curve.
#[derive(Debug, Clone)]
pub struct Curve {
    /// Variant.
    pub on: String,
    /// Name of the horizontal axis.
    pub x: String,
    /// Name of the vertical axis.
    pub y: String,
    /// (x, y).
    pub points: Vec<(f64, f64)>,
}

/// Reads lines of findings; `wanted` names the parts, none for all.
///
/// # Errors
/// The line that is not a finding.
pub fn read(text: &str, wanted: &[String]) -> Result<Page, String> {
    let mut parts: BTreeMap<(usize, String), BTreeMap<String, Line>> = BTreeMap::new();
    // Sorted and each once: tests run in any order, and may be run again into the same file.
    let lines: BTreeSet<&str> = text.lines().filter(|l| !l.trim().is_empty()).collect();
    for text in lines {
        let finding: Value =
            serde_json::from_str(text).map_err(|why| format!("not a finding ({why}): {text}"))?;
        let (part, holds) = (word(&finding, "part"), word(&finding, "holds"));
        if !wanted.is_empty() && !wanted.contains(&part) {
            continue;
        }
        let place = PARTS.iter().position(|p| *p == part).unwrap_or(PARTS.len());
        let line = parts.entry((place, part)).or_default().entry(holds.clone()).or_default();
        line.holds = holds;
        line.add(&finding);
    }
    let part = |((_, name), lines): ((usize, String), BTreeMap<String, Line>)| Part {
        name,
        lines: lines.into_values().collect(),
    };
    Ok(Page { parts: parts.into_iter().map(part).collect() })
}

fn word(finding: &Value, key: &str) -> String {
    finding[key].as_str().unwrap_or_default().to_owned()
}

fn points(finding: &Value) -> Vec<(f64, f64)> {
    let pairs = finding["points"].as_array().into_iter().flatten();
    pairs.filter_map(|p| Some((p[0].as_f64()?, p[1].as_f64()?))).collect()
}

impl Line {
    fn add(&mut self, finding: &Value) {
        let on = word(finding, "on");
        self.tried.insert(on.clone());
        let number = |key: &str| finding[key].as_f64();
        if let (Some(order), Some(expected)) = (number("order"), number("expected")) {
            self.orders.push(Order { on, order, expected, points: points(finding) });
        } else if let Some(limit) = number("limit") {
            // A value that is not a number is written as null.
            let value = number("value").unwrap_or(f64::NAN);
            let found = Number { on, value, limit, unit: word(finding, "unit") };
            let worse = |w: &Number| !(found.share() <= w.share());
            if self.worst.as_ref().is_none_or(worse) {
                self.worst = Some(found);
            }
        } else if let Some(message) = finding["message"].as_str() {
            self.refused.get_or_insert((on, message.to_owned()));
        } else {
            let (x, y) = (word(finding, "x"), word(finding, "y"));
            self.curves.push(Curve { on, x, y, points: points(finding) });
        }
    }

    /// The order that falls shortest of what is expected.
    pub fn lowest_order(&self) -> Option<&Order> {
        self.orders.iter().min_by(|a, b| (a.order - a.expected).total_cmp(&(b.order - b.expected)))
    }

    /// One row of [`Part::table`].
    fn row(&self) -> String {
        let on = self.worst.as_ref().map(|w| &w.on).or(self.refused.as_ref().map(|r| &r.0));
        let on = on.or(self.lowest_order().map(|o| &o.on)).or(self.tried.first());
        let on = on.map_or(String::new(), |on| on.replace('|', "\\|"));
        let tried = if self.tried.len() < 2 { on } else { format!("{}; worst: {on}", self.tried.len()) };
        let (mut found, mut allowed) = ("–".to_owned(), "–".to_owned());
        if let Some(w) = &self.worst {
            let unit = if w.unit == "–" { String::new() } else { format!(" {}", w.unit) };
            found = format!("{:.1e}{unit}", w.value.abs());
            allowed = format!("{:.1e}{unit}", w.limit);
        } else if let Some((_, message)) = &self.refused {
            found = format!("refused: `{}`", message.lines().next().unwrap_or_default().replace('|', "\\|"));
        }
        let order = self.lowest_order();
        let order = order.map_or("–".to_owned(), |o| format!("{:.2} ({})", o.order, o.expected));
        format!("| {} | {tried} | {found} | {allowed} | {order} |\n", self.holds.replace('|', "\\|"))
    }
}

impl Part {
    /// A markdown table, a row for each line.
    pub fn table(&self) -> String {
        let mut table = "| claim | tried on | worst found | limit | order (expected) |\n".to_owned();
        table += "|---|---|---|---|---|\n";
        self.lines.iter().for_each(|line| table += &line.row());
        table
    }
}

impl Page {
    /// All tables under their headings.
    pub fn tables(&self) -> String {
        self.parts.iter().fold(String::new(), |mut text, part| {
            let _ = write!(text, "\n## {}\n\n{}", part.name, part.table());
            text
        })
    }

    /// All lines.
    pub fn lines(&self) -> impl Iterator<Item = &Line> {
        self.parts.iter().flat_map(|p| &p.lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_variant_is_kept_in_whatever_order_they_come() {
        let a = r#"{"part":"Energy","holds":"h","on":"a","value":0.1,"unit":"m","limit":1.0}"#;
        let b = r#"{"part":"Energy","holds":"h","on":"b","value":-0.5,"unit":"m","limit":1.0}"#;
        let c = r#"{"part":"One contact","holds":"o","on":"c","order":1.9,"expected":2.0,"points":[[1,2],[3,4]]}"#;
        let one = read(&format!("{a}\n{b}\n{c}\n"), &[]).expect("findings").tables();
        assert_eq!(one, read(&format!("{c}\n{b}\n{a}\n{b}\n"), &[]).expect("findings").tables());
        assert!(one.contains("| h | 2; worst: b | 5.0e-1 m | 1.0e0 m | – |"), "{one}");
        assert!(one.contains("| o | c | – | – | 1.90 (2) |"), "{one}");
        assert!(one.find("One contact") < one.find("Energy"), "{one}");
        assert!(read("{", &[]).is_err());
    }
}
