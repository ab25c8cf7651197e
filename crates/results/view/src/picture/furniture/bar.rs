//! The colour bar at the right: its ends are always labelled, and pointed where values lie beyond them.

use super::{Pen, widest};
use crate::appearance::scale::{self, Range};
use crate::picture::ink::Anchor;
use crate::picture::key::BarKey;

/// A place on the bar, from 0 to 1, and its label.
type Mark = (f64, String);

/// Adds a bar between two shares of the height.
pub fn add(pen: &mut Pen, [w, h]: [f64; 2], text: f64, key: &BarKey, [from, to]: [f64; 2]) {
    let ink = pen.colour;
    let largest = key.range.lo.abs().max(key.range.hi.abs());
    let (unit, factor) = scale::readable(key.unit, largest);
    // In small pictures the axes, too, want their place.
    let (top, bottom) = ((from * h).round(), (to * h).min(h - 10.5 * text).round());
    let width = (1.5 * text).round();
    let apart = 1.7 * text / (bottom - top).max(1.0);
    let marks = marks(Range { lo: key.range.lo * factor, hi: key.range.hi * factor }, key.log, apart);
    let labels: Vec<String> = marks.iter().map(|(_, label)| label.clone()).collect();
    let left = (w - (0.078 * w).max(width + 2.15 * text + widest(&labels, text))).round();
    for y in (top - width) as i64..(bottom + width) as i64 {
        let middle = y as f64 + 0.5;
        let over = (top - middle).max(middle - bottom).max(0.0);
        if over > 0.0 && !key.beyond[usize::from(middle < top)] {
            continue;
        }
        let inset = 0.5 * over;
        pen.colour = key.map.at((bottom - middle) / (bottom - top)).map(|c| (c * 255.0).round() as u8);
        pen.fill([left + inset, y as f64, left + width - inset, y as f64 + 1.0]);
    }
    pen.colour = ink;
    for (share, label) in marks {
        let y = bottom - (bottom - top) * share;
        pen.strokes(&[[[left + width, y], [left + width + 0.4 * text, y]]], (0.09 * text).max(1.0));
        pen.text([left + width + 1.25 * text, y + 0.5 * text], text, Anchor::Left, &label);
    }
    let title = if unit.is_empty() { key.title.clone() } else { format!("{} [{unit}]", key.title) };
    pen.text([w - 0.9 * text, top - width - 1.3 * text], text, Anchor::Right, &title);
}

/// The ends, and round values between that are at least `apart` from them.
fn marks(range: Range, log: bool, apart: f64) -> Vec<Mark> {
    let (ticks, decimals) = if log { (decades(range), None) } else { linear(range) };
    let label = |value: f64| decimals.map_or_else(|| significant(value), |decimals| number(value, decimals));
    let ln = |v: f64| v.max(f64::MIN_POSITIVE).ln();
    let share = |value: f64| match log {
        true => (ln(value) - ln(range.lo)) / (ln(range.hi) - ln(range.lo)),
        false => range.share(value),
    };
    let inner = ticks.into_iter().map(|tick| (share(tick), label(tick)));
    let inner = inner.filter(|(at, _)| *at >= apart && *at <= 1.0 - apart);
    let end = |value: f64| {
        let on_tick = decimals.map(|decimals| number(value, decimals));
        let exact = on_tick.filter(|text| is_near(text, value, range.hi - range.lo));
        exact.unwrap_or_else(|| significant(value))
    };
    [(0.0, end(range.lo))].into_iter().chain(inner).chain([(1.0, end(range.hi))]).collect()
}

/// Whether a label tells a value to a thousandth of the range.
fn is_near(text: &str, value: f64, width: f64) -> bool {
    let told: f64 = text.replace('−', "-").parse().unwrap_or(f64::NAN);
    (told - value).abs() <= 1e-3 * width
}

fn linear(range: Range) -> (Vec<f64>, Option<usize>) {
    let (ticks, decimals) = scale::ticks(range, 6);
    (ticks, Some(decimals))
}

/// Powers of ten in a range; where they are few, 2 and 5 times them, too.
fn decades(range: Range) -> Vec<f64> {
    let (first, last) = (range.lo.log10().floor() as i32, range.hi.log10().ceil() as i32);
    let few = last - first <= 2;
    let steps: &[f64] = if few { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let all = (first..=last).flat_map(|n| steps.iter().map(move |step| step * 10f64.powi(n)));
    all.filter(|tick| (range.lo..=range.hi).contains(tick)).collect()
}

/// A number to three digits.
fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value, 0);
    }
    let digits = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&digits) {
        return format!("{value:.1e}").replace('-', "−");
    }
    let text = number(value, (2 - digits).max(0) as usize);
    let tidy = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    tidy.to_owned()
}

/// A number as printed, with a true minus.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().any(|b| (b'1'..=b'9').contains(&b)) => format!("−{rest}"),
        Some(rest) => rest.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::caption::text_height;
    use crate::picture::ink::Canvas;

    /// In a small picture, too: nothing is written over its right edge.
    #[test]
    fn the_labels_of_the_bar_stay_in_the_picture() {
        for size in [[340, 210], [640, 720], [1920, 1080]] {
            let [width, height] = size;
            let mut rgba = vec![255; 4 * (width * height) as usize];
            let range = Range { lo: -11.8, hi: -10.7 };
            let (title, unit) = ("z".to_owned(), "m");
            let map = crate::Map::default();
            let key = BarKey { title, unit, range, beyond: [true; 2], log: false, map };
            let canvas = Canvas { size, top: 0, rgba: &mut rgba };
            let mut pen = Pen { canvas, colour: [0; 3], paper: [255; 3] };
            add(&mut pen, size.map(f64::from), text_height(width, height), &key, [0.22, 0.74]);
            let inked = |x: u32| (0..height).any(|y| rgba[4 * (y * width + x) as usize..][..4] != [255; 4]);
            let last = (0..width).rfind(|&x| inked(x)).unwrap();
            assert!(last < width - 2, "{size:?}: ink in column {last}");
        }
    }

    #[test]
    fn numbers_are_printed_for_readers() {
        assert_eq!([number(-0.04, 1), number(-1.5, 1), number(2.0, 0)], ["0.0", "−1.5", "2"]);
        let three = [0.0, 0.05234, 1234.5, -3.0, 2.5e-7, 4e9].map(significant);
        assert_eq!(three, ["0", "0.0523", "1234", "−3", "2.5e−7", "4.0e9"]);
    }

    /// A reader must know what the first and the last colour mean, wherever round values lie.
    #[test]
    fn both_ends_of_a_bar_are_labelled() {
        let of = |lo: f64, hi: f64, log| {
            let all = marks(Range { lo, hi }, log, 0.08);
            let texts: Vec<String> = all.iter().map(|(_, text)| text.clone()).collect();
            assert_eq!((all[0].0, all[all.len() - 1].0), (0.0, 1.0));
            texts
        };
        assert_eq!(of(0.0, 1.0, false), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(of(0.137, 1.46, false), ["0.137", "0.4", "0.6", "0.8", "1.0", "1.2", "1.46"]);
        assert_eq!(of(0.05, 500.0, true), ["0.05", "1", "10", "100", "500"]);
        assert_eq!(of(3.0, 30.0, true), ["3", "5", "10", "20", "30"]);
    }
}
