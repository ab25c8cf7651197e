//! Size classes: a few sizes as they are, many sizes between round diameters.

use crate::appearance::scale::{Range, readable, ticks};
use std::collections::BTreeSet;

/// Most classes.
const MOST: usize = 8;

/// The diameters that were seen.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sizes {
    /// Different ones to four digits [m], as bits; one more than there may be classes.
    distinct: BTreeSet<u64>,
    range: Option<Range>,
}

/// Classes of diameter, small ones first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Classes {
    /// Between two classes [m].
    pub edges: Vec<f64>,
    /// Names with unit.
    pub names: Vec<String>,
    /// Smallest and largest diameter [m].
    pub range: Range,
}

impl Sizes {
    /// Takes in diameters [m].
    pub fn add(&mut self, diameters: impl Iterator<Item = f64>) {
        for d in diameters.filter(|d| *d > 0.0 && d.is_finite()) {
            let own = Range { lo: d, hi: d };
            self.range = Some(self.range.map_or(own, |r| r.with(own)));
            if self.distinct.len() <= MOST {
                self.distinct.insert(rounded(d).to_bits());
            }
        }
    }

    /// The classes; none before any diameter.
    pub fn classes(&self) -> Option<Classes> {
        let range = self.range?;
        let (unit, factor) = readable("m", range.hi);
        if self.distinct.len() <= MOST {
            let all: Vec<f64> = self.distinct.iter().map(|d| f64::from_bits(*d)).collect();
            let edges = all.windows(2).map(|two| 0.5 * (two[0] + two[1])).collect();
            let name = |d: &f64| format!("{} {unit}", geom::Shown(rounded(d * factor)));
            return Some(Classes { edges, names: all.iter().map(name).collect(), range });
        }
        let scaled = Range { lo: range.lo * factor, hi: range.hi * factor };
        let inner = |count| {
            let slack = 1e-3 * (scaled.hi - scaled.lo);
            let (mut all, decimals) = ticks(scaled, count);
            all.retain(|t| *t > scaled.lo + slack && *t < scaled.hi - slack);
            (all, decimals)
        };
        let fits = (1..=6).rev().map(inner).find(|(all, _)| all.len() < MOST);
        let (edges, decimals) = fits.unwrap_or_default();
        let text = |t: &f64| format!("{t:.decimals$}");
        let mut names: Vec<String> =
            edges.first().map(|t| format!("< {} {unit}", text(t))).into_iter().collect();
        names.extend(edges.windows(2).map(|two| format!("{}-{} {unit}", text(&two[0]), text(&two[1]))));
        names.extend(edges.last().map(|t| format!("> {} {unit}", text(t))));
        if names.is_empty() {
            names.push(format!("{}-{} {unit}", text(&scaled.lo), text(&scaled.hi)));
        }
        Some(Classes { edges: edges.into_iter().map(|t| t / factor).collect(), names, range })
    }
}

impl Classes {
    /// The class of a diameter [m].
    pub fn of(&self, diameter: f64) -> usize {
        self.edges.partition_point(|edge| *edge <= diameter)
    }

    /// The place of a class in a colour map, 0 to 1.
    pub fn share(&self, class: usize) -> f64 {
        class as f64 / (self.names.len() - 1).max(1) as f64
    }
}

/// To four digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(diameters: &[f64]) -> Classes {
        let mut sizes = Sizes::default();
        sizes.add(diameters.iter().copied());
        sizes.classes().expect("some")
    }

    #[test]
    fn a_few_sizes_are_classes_by_themselves() {
        let classes = of(&[0.008, 0.016, 0.012, 0.008 + 1e-9]);
        assert_eq!(classes.names, ["8 mm", "12 mm", "16 mm"]);
        assert_eq!([0.008, 0.0121, 0.016].map(|d| classes.of(d)), [0, 1, 2]);
        assert_eq!([0, 1, 2].map(|k| classes.share(k)), [0.0, 0.5, 1.0]);
    }

    #[test]
    fn many_sizes_are_classes_between_round_diameters() {
        let many: Vec<f64> = (0..1000).map(|k| 0.012 + 6e-6 * f64::from(k)).collect();
        let classes = of(&many);
        assert_eq!(classes.names, ["< 13 mm", "13-14 mm", "14-15 mm", "15-16 mm", "16-17 mm", "> 17 mm"]);
        assert_eq!([0.0125, 0.0135, 0.0179].map(|d| classes.of(d)), [0, 1, 5]);
        let wide: Vec<f64> = (0..1000).map(|k| 1e-4 * 1.01f64.powi(k)).collect();
        assert!(of(&wide).names.len() <= MOST, "{:?}", of(&wide).names);
    }

    #[test]
    fn without_grains_there_are_no_classes() {
        assert_eq!(Sizes::default().classes(), None);
        assert_eq!(of(&[0.01]).names, ["10 mm"]);
    }
}
