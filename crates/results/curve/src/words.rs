//! Numbers in plain words.

use crate::point::{Error, Point};
use geom::Shown;
use measure::statistics::theil_sen;

/// Time that differs by less than this share is "as long": two runs of one scene differ by as much.
const SAME: f64 = 0.03;

/// `0.31 %`: two digits that count.
pub fn percent(share: f64) -> String {
    format!("{} %", rounded(100.0 * share))
}

/// Two digits that count, without an exponent where that is readable.
fn rounded(value: f64) -> String {
    let text = format!("{value:.1e}");
    let near: f64 = text.parse().unwrap_or(value);
    Shown(if near >= 100.0 { value.round() } else { near }).to_string()
}

/// `0.31 % ± 0.1 %`, or with the unit of the measure where the truth is zero.
pub fn amount(error: &Error, unit: &str) -> String {
    let one = |v: f64| match (error.relative, unit) {
        (true, _) => percent(v),
        (false, "1" | "") => rounded(v),
        (false, unit) => format!("{} {unit}", rounded(v)),
    };
    if error.size == 0.0 && !(error.interval > 0.0) {
        return "nothing".to_owned();
    }
    if error.interval.is_nan() || error.interval == 0.0 {
        return one(error.size);
    }
    let told = format!("{} ± {}", one(error.size), one(error.interval));
    if error.within_chance() { format!("{told} (no difference is seen)") } else { told }
}

/// How one setting differs from another: `safety × 1.6 (0.8)`, `precision mixed`.
pub fn change(from: &Point, to: &Point) -> String {
    let mut parts = Vec::new();
    for (key, value) in &to.setting {
        let before = from.setting.iter().find(|(k, _)| k == key).map(|(_, v)| v);
        if before == Some(value) {
            continue;
        }
        let number = |text: &String| text.parse::<f64>().ok().filter(|v| *v > 0.0);
        parts.push(match (before.and_then(number), number(value)) {
            (Some(a), Some(b)) if b > a => format!("{key} × {} ({value})", Shown(rounded_ratio(b / a))),
            (Some(a), Some(b)) => format!("{key} ÷ {} ({value})", Shown(rounded_ratio(a / b))),
            _ => format!("{key} {value}"),
        });
    }
    if parts.is_empty() { to.name() } else { parts.join(" with ") }
}

/// How the error goes with the work: `The error goes as work to the power −1.0`, from the Theil–Sen line through the logarithms; `None`
/// for fewer than four errors that are no chance, or work that hardly differs.
pub fn order(points: &[Point], errors: &[Option<Error>], what: (&str, &str)) -> Option<String> {
    let known = points.iter().zip(errors).filter_map(|(p, e)| Some((p.work(), e.as_ref()?)));
    let known = known.filter(|(work, e)| *work > 0.0 && e.size > 0.0 && !e.within_chance());
    let logs: Vec<[f64; 2]> = known.map(|(work, e)| [work.ln(), e.size.ln()]).collect();
    let range = |pick: fn(f64, f64) -> f64, start| logs.iter().map(|p| p[0]).fold(start, pick);
    if logs.len() < 4 || range(f64::max, f64::NEG_INFINITY) - range(f64::min, f64::INFINITY) < 1.0 {
        return None;
    }
    let slope = theil_sen(&logs)?.slope;
    let sign = if slope < 0.0 { "−" } else { "" };
    Some(format!("The error in {} goes as the {} to the power {sign}{:.1}", what.0, what.1, slope.abs()))
}

/// Three digits of a ratio.
fn rounded_ratio(ratio: f64) -> f64 {
    format!("{ratio:.2e}").parse().unwrap_or(ratio)
}

/// `saves 71 % of the time`, `takes 4.9 times the time`.
pub fn share_of_time(work: f64, before: f64, of: &str) -> String {
    let ratio = work / before;
    if (ratio - 1.0).abs() < SAME {
        format!("takes as {} {of}", if of.ends_with('s') { "many" } else { "much" })
    } else if ratio < 1.0 {
        format!("saves {:.0} % of the {of}", 100.0 * (1.0 - ratio))
    } else if ratio < 2.0 {
        format!("takes {:.0} % more {of}", 100.0 * (ratio - 1.0))
    } else {
        format!("takes {} times the {of}", rounded(ratio))
    }
}

/// `safety × 1.6 (0.8) costs 0.31 % ± 0.1 % in mass_flow and saves 37 % of the time`; an error that is less than that of
/// `from` is what it leaves. `what` is the measure and its unit, `of` the kind of work.
pub fn sentence(
    from: (&Point, Option<&Error>),
    to: (&Point, &Error),
    what: (&str, &str),
    of: &str,
) -> String {
    let ((from, base), (to, error)) = (from, to);
    let (work, before) = (to.work(), from.work());
    let less = base.is_some_and(|base| error.size < base.size);
    format!(
        "{} {} {} in {} and {}",
        change(from, to),
        if less { "leaves" } else { "costs" },
        amount(error, what.1),
        what.0,
        share_of_time(work, before, of)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MeasuredRun;

    fn point(value: &str, work: f64) -> Point {
        let setting =
            vec![("safety".to_owned(), value.to_owned()), ("precision".to_owned(), "f64".to_owned())];
        Point { setting, samples: vec![MeasuredRun { value: vec![1.0], work, seed: 0 }], failed: None }
    }

    #[test]
    fn a_setting_in_plain_words() {
        let error = Error { size: 0.00312, interval: f64::NAN, relative: true };
        let said = sentence(
            (&point("0.2", 10.0), None),
            (&point("0.8", 2.9), &error),
            ("mass_flow", "kg/s"),
            "time",
        );
        assert_eq!(said, "safety × 4 (0.8) costs 0.31 % in mass_flow and saves 71 % of the time");
        let error = Error { size: 0.001, interval: 0.002, relative: false };
        let more = Error { size: 0.01, ..error };
        let said = sentence(
            (&point("0.2", 1.0), Some(&more)),
            (&point("0.05", 4.1), &error),
            ("angle", "deg"),
            "time",
        );
        assert_eq!(
            said,
            "safety ÷ 4 (0.05) leaves 0.001 deg ± 0.002 deg (no difference is seen) in angle and takes 4.1 times the time"
        );
    }

    #[test]
    fn numbers_keep_two_digits() {
        assert_eq!(percent(0.123456), "12 %");
        assert_eq!(percent(3.456), "346 %");
        assert_eq!(share_of_time(1.02, 1.0, "time"), "takes as much time");
        assert_eq!(share_of_time(1.5, 1.0, "time"), "takes 50 % more time");
    }

    #[test]
    fn the_order_of_a_method_is_seen() {
        let points: Vec<Point> = [1.0, 2.0, 4.0, 8.0].map(|work| point("1", work)).to_vec();
        let error = |work: f64| Some(Error { size: 0.1 / (work * work), interval: f64::NAN, relative: true });
        let errors: Vec<Option<Error>> = points.iter().map(|p| error(p.work())).collect();
        let said = order(&points, &errors, ("overlap", "steps"));
        assert_eq!(said.as_deref(), Some("The error in overlap goes as the steps to the power −2.0"));
        assert_eq!(order(&points[..3], &errors[..3], ("overlap", "steps")), None);
    }

    #[test]
    fn no_difference_is_said_to_be_none() {
        let error = Error { size: 0.0, interval: f64::NAN, relative: true };
        let said = sentence((&point("0.2", 1.0), None), (&point("0.2", 1.0), &error), ("z", "m"), "steps");
        assert!(said.contains("costs nothing in z"), "{said}");
    }
}
