//! What walls are coloured by, and how values become colours: along a line, or along the logarithm.

use crate::appearance::{
    colour::Map,
    scale::{Range, rounded_out},
};
use wear::WearField;

/// The map of walls: unlike those of grains, and pale where nothing was done.
pub(crate) const WALL_MAP: Map = Map::Heat;

/// Decades that a logarithmic scale has at most, where its ends are not given.
const DECADES: i32 = 4;

/// What walls are coloured by, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallScale {
    /// The quantity.
    pub field: WearField,
    /// Ends of the scale in its unit; none: from 0, or over four decades, to what 99 % of the parts that were touched do not exceed.
    pub range: Option<[f64; 2]>,
    /// Whether colours go by the logarithm.
    pub log: bool,
}

impl WallScale {
    /// The ends of the scale for these values of touched parts.
    pub(crate) fn ends(&self, touched: &[f64]) -> Range {
        if let Some([lo, hi]) = self.range {
            return Range { lo, hi };
        }
        let most = Range::of_most(touched);
        let hi = if most.hi > 0.0 && most.hi.is_finite() { rounded_out(most.hi) } else { 1.0 };
        match self.log {
            false => Range { lo: 0.0, hi },
            true => {
                let decades = if most.lo > 0.0 { (hi / most.lo).log10().ceil() as i32 } else { DECADES };
                Range { lo: hi * 10f64.powi(-decades.clamp(1, DECADES)), hi }
            }
        }
    }

    /// Where a value lies between the ends, 0 to 1.
    pub(crate) fn share(&self, ends: Range, value: f64) -> f64 {
        if !self.log {
            return ends.share(value);
        }
        let log = |v: f64| v.max(f64::MIN_POSITIVE).ln();
        Range { lo: log(ends.lo), hi: log(ends.hi) }.share(log(value))
    }
}

/// Values of a moment that are kept to find the ends of a scale, at most.
const SAMPLE: usize = 20_000;

/// Values that were seen.
#[derive(Debug, Clone)]
pub(crate) struct WallSurvey {
    /// Of parts that were touched, at the moment at which most of them are largest.
    touched: Vec<f64>,
    /// Of all parts at all moments.
    all: Range,
}

impl Default for WallSurvey {
    fn default() -> Self {
        WallSurvey { touched: Vec::new(), all: Range::EMPTY }
    }
}

impl WallSurvey {
    /// Takes in the values of a moment.
    pub fn add(&mut self, values: impl Iterator<Item = f64>) {
        let mut touched = Vec::new();
        for value in values {
            self.all = self.all.with(Range { lo: value, hi: value });
            if value > 0.0 {
                touched.push(value);
            }
        }
        let step = touched.len().div_ceil(SAMPLE).max(1);
        let touched: Vec<f64> = touched.into_iter().step_by(step).collect();
        let most = |of: &[f64]| Range::of_most(of).hi;
        if self.touched.is_empty() || most(&touched) > most(&self.touched) {
            self.touched = touched;
        }
    }

    /// The least and the largest value of all parts at all moments.
    pub fn all(&self) -> [f64; 2] {
        if self.all.lo > self.all.hi { [0.0; 2] } else { [self.all.lo, self.all.hi] }
    }

    /// The ends of a scale, and whether values lie below and above.
    pub fn ends(&self, scale: &WallScale) -> (Range, [bool; 2]) {
        let ends = scale.ends(&self.touched);
        let slack = 1e-6 * (ends.hi - ends.lo);
        (ends, [self.all.lo < ends.lo - slack, self.all.hi > ends.hi + slack])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(log: bool) -> WallScale {
        WallScale { field: WearField::SlidingWork, range: None, log }
    }

    #[test]
    fn a_linear_scale_begins_at_nothing_and_a_logarithmic_one_some_decades_below_its_end() {
        let values: Vec<f64> = (1..=100).map(f64::from).collect();
        assert_eq!(scale(false).ends(&values), Range { lo: 0.0, hi: 99.0 });
        let ends = scale(true).ends(&values);
        assert!(ends.hi == 99.0 && (ends.lo - 0.99).abs() < 1e-12, "{ends:?}");
        let wide: Vec<f64> = (0..100).map(|k| 10f64.powi(k / 10)).collect();
        let ends = scale(true).ends(&wide);
        assert!((ends.hi / ends.lo / 1e4 - 1.0).abs() < 1e-9, "{ends:?}");
        assert_eq!(scale(false).ends(&[]), Range { lo: 0.0, hi: 1.0 });
    }

    #[test]
    fn equal_factors_are_equal_ways_on_a_logarithmic_scale() {
        let ends = Range { lo: 0.01, hi: 100.0 };
        let shares = [0.0, 0.01, 1.0, 100.0, 1e9].map(|v| scale(true).share(ends, v));
        assert!(shares.iter().zip([0.0, 0.0, 0.5, 1.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
