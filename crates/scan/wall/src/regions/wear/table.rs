//! The table of roughness over wear and position.

use super::error::WearError;

/// Roughness over wear and position.
#[derive(Debug, Clone)]
pub(super) struct WearTable {
    /// Along the direction [m], ascending.
    pub(super) positions: Vec<f64>,
    /// Ascending.
    pub(super) wears: Vec<f64>,
    /// ζ [m], a row a wear.
    pub(super) roughness: Vec<Vec<f64>>,
}

impl WearTable {
    /// The table of a CSV file.
    pub(super) fn parse(file: &str, text: &str) -> Result<WearTable, WearError> {
        let mut lines =
            (1..).zip(text.lines()).filter(|(_, l)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
        let wrong = |line: usize, what: &'static str, text: &str| WearError::Line {
            file: file.to_owned(),
            line,
            what,
            text: text.trim().chars().take(60).collect(),
        };
        let numbers =
            |words: &str| words.split(',').map(|w| w.trim().parse().ok()).collect::<Option<Vec<f64>>>();
        let Some((line, head)) = lines.next() else {
            return Err(WearError::File {
                file: file.to_owned(),
                why: "is empty: give positions and wears".to_owned(),
            });
        };
        let positions = head.split_once(',').and_then(|(_, rest)| numbers(rest)).filter(|p| ascends(p));
        let positions = positions.ok_or_else(|| {
            wrong(line, "the first line is a word and then positions in m, ascending, not", head)
        })?;
        let (mut wears, mut roughness) = (Vec::new(), Vec::new());
        for (line, text) in lines {
            let row = numbers(text).filter(|row| row.len() == positions.len() + 1);
            let row = row.ok_or_else(|| {
                wrong(line, "a line is a wear and a roughness for each position, not", text)
            })?;
            if !row[1..].iter().all(|&zeta| zeta > 0.0 && zeta.is_finite()) {
                return Err(wrong(line, "roughness must be positive, in m", text));
            }
            wears.push(row[0]);
            if !ascends(&wears) {
                return Err(wrong(line, "wear must ascend from line to line", text));
            }
            roughness.push(row[1..].to_vec());
        }
        if wears.is_empty() {
            return Err(WearError::File {
                file: file.to_owned(),
                why: "has no line below the positions".to_owned(),
            });
        }
        Ok(WearTable { positions, wears, roughness })
    }
}

/// The entry at or before a value, the share of the next one, and whether the value is in the table.
pub(super) fn place(entries: &[f64], value: f64) -> ((usize, f64), bool) {
    let last = entries.len() - 1;
    let is_in = value >= entries[0] && value <= entries[last];
    let value = value.clamp(entries[0], entries[last]);
    let before = entries.partition_point(|&e| e <= value).saturating_sub(1).min(last.saturating_sub(1));
    if last == 0 {
        return ((0, 0.0), is_in);
    }
    ((before, (value - entries[before]) / (entries[before + 1] - entries[before])), is_in)
}

fn ascends(values: &[f64]) -> bool {
    !values.is_empty() && values.iter().all(|v| v.is_finite()) && values.windows(2).all(|w| w[0] < w[1])
}
