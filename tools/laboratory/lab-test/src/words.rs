//! What the curves come to, in sentences and as a table.

use lab::{Figure, Level, Summary};

/// A number with four digits.
fn short(value: f64) -> String {
    geom::Shown(format!("{value:.3e}").parse().unwrap_or(value)).to_string()
}

/// Mean, interval and unit.
fn amount(figure: &Figure) -> Option<String> {
    let unit = if figure.unit.is_empty() { String::new() } else { format!(" {}", figure.unit) };
    let interval = figure.interval.map_or(String::new(), |half| format!(" ± {}", rounded(half)));
    Some(format!("{}{interval}{unit}", short(figure.mean?)))
}

/// A half width with two digits.
fn rounded(half: f64) -> String {
    geom::Shown(format!("{half:.1e}").parse().unwrap_or(half)).to_string()
}

fn name(figure: &Figure) -> String {
    figure.name.replace('_', " ")
}

/// A line for each stress, one for the envelope, and one for strengths.
pub fn sentences(summary: &Summary) -> Vec<String> {
    let list = |figures: &[Figure]| {
        let parts = figures.iter().filter_map(|f| Some(format!("{} {}", name(f), amount(f)?)));
        parts.collect::<Vec<_>>().join("; ")
    };
    let level = |level: &Level| match level.stress {
        Some(stress) => format!("{} Pa: {}", geom::Shown(stress), list(&level.figures)),
        None => list(&level.figures),
    };
    let more = [("envelope", &summary.envelope), ("strengths", &summary.weibull)];
    let more = more.into_iter().filter(|(_, figures)| !figures.is_empty());
    let more = more.map(|(name, figures)| format!("{name}: {}", list(figures)));
    summary.levels.iter().map(level).chain(more).filter(|line| !line.is_empty()).collect()
}

/// A row for each figure, a column for each stress.
pub fn table(summary: &Summary) -> String {
    let heads = summary
        .levels
        .iter()
        .map(|l| l.stress.map_or(" value |".to_owned(), |s| format!(" {} Pa |", geom::Shown(s))));
    let heads: String = heads.collect();
    let rule = "---|".repeat(summary.levels.len());
    let mut text = format!("| figure |{heads}\n|---|{rule}\n");
    let names =
        summary.levels.iter().map(|l| l.figures.as_slice()).max_by_key(|f| f.len()).unwrap_or_default();
    for (row, figure) in names.iter().enumerate() {
        let cell = |level: &Level| {
            format!(" {} |", level.figures.get(row).and_then(amount).unwrap_or_else(|| "–".into()))
        };
        let cells: String = summary.levels.iter().map(cell).collect();
        text += &format!("| {} |{cells}\n", name(figure));
    }
    for figure in summary.envelope.iter().chain(&summary.weibull) {
        let empty = " |".repeat(summary.levels.len().saturating_sub(1));
        text += &format!(
            "| {} of all | {} |{empty}\n",
            name(figure),
            amount(figure).unwrap_or_else(|| "–".into())
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_shown_with_intervals_and_units() {
        let figure = |name: &str, interval| Figure {
            name: name.into(),
            unit: "deg".into(),
            mean: Some(31.23456),
            interval,
            values: vec![],
        };
        let level = Level { stress: Some(5e4), figures: vec![figure("peak_angle", Some(0.456))] };
        let summary =
            Summary { levels: vec![level], envelope: vec![figure("cohesion", None)], weibull: vec![] };
        assert_eq!(
            sentences(&summary),
            ["50000 Pa: peak angle 31.23 ± 0.46 deg", "envelope: cohesion 31.23 deg"]
        );
        assert_eq!(
            table(&summary),
            "| figure | 50000 Pa |\n|---|---|\n| peak angle | 31.23 ± 0.46 deg |\n| cohesion of all | 31.23 deg |\n"
        );
    }
}
