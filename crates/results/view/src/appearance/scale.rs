//! Ranges, units and round numbers for colour bars and scale bars.

use std::borrow::Borrow;

/// A range of values to colour by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower end, in the field's unit.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

impl Range {
    /// The range nothing has entered yet.
    pub const EMPTY: Range = Range { lo: f64::INFINITY, hi: f64::NEG_INFINITY };

    /// Smallest and largest finite value.
    pub fn of(values: impl IntoIterator<Item: Borrow<f64>>) -> Range {
        finite(values).fold(Range::EMPTY, |r, v| r.with(Range { lo: v, hi: v }))
    }

    /// What 98 % of the values lie in: a few fast grains must not wash out the colours of all others.
    pub fn of_most(values: impl IntoIterator<Item: Borrow<f64>>) -> Range {
        let mut values: Vec<f64> = finite(values).collect();
        if values.is_empty() {
            return Range::EMPTY;
        }
        let last = (values.len() - 1) as f64;
        let mut at =
            |share: f64| *values.select_nth_unstable_by((share * last).round() as usize, f64::total_cmp).1;
        Range { lo: at(0.01), hi: at(0.99) }
    }

    /// The range of both.
    pub fn with(self, other: Range) -> Range {
        Range { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// A range with a width, so that one can divide by it; from 0 when it nearly starts there.
    pub fn opened(self) -> Range {
        let Range { lo, hi } = self;
        if lo > hi {
            return Range { lo: 0.0, hi: 1.0 };
        }
        let lo = if lo > 0.0 && lo < 0.25 * hi { 0.0 } else { lo };
        if hi - lo > 1e-12 * lo.abs().max(hi.abs()) {
            return Range { lo, hi };
        }
        let half = if lo == 0.0 { 0.5 } else { 0.05 * lo.abs() };
        Range { lo: lo - half, hi: hi + half }
    }

    /// Where a value lies in it, 0 to 1.
    pub fn share(self, value: f64) -> f64 {
        ((value - self.lo) / (self.hi - self.lo)).clamp(0.0, 1.0)
    }
}

/// The finite ones of the values.
fn finite(values: impl IntoIterator<Item: Borrow<f64>>) -> impl Iterator<Item = f64> {
    values.into_iter().map(|v| *v.borrow()).filter(|v| v.is_finite())
}

/// The prefixed unit in which `largest` is easy to read, and how many of it make one of `unit`.
pub fn readable(unit: &str, largest: f64) -> (String, f64) {
    let steps: &[(&str, f64)] = match unit {
        "m" => &[("m", 1.0), ("mm", 1e3), ("µm", 1e6)],
        "m/s" => &[("m/s", 1.0), ("mm/s", 1e3), ("µm/s", 1e6)],
        "s" => &[("s", 1.0), ("ms", 1e3), ("µs", 1e6)],
        "N" => &[("MN", 1e-6), ("kN", 1e-3), ("N", 1.0), ("mN", 1e3), ("µN", 1e6)],
        "Pa" => &[("GPa", 1e-9), ("MPa", 1e-6), ("kPa", 1e-3), ("Pa", 1.0)],
        "J/m²" => &[("MJ/m²", 1e-6), ("kJ/m²", 1e-3), ("J/m²", 1.0), ("mJ/m²", 1e3), ("µJ/m²", 1e6)],
        "kg" => &[("t", 1e-3), ("kg", 1.0), ("g", 1e3), ("mg", 1e6)],
        _ => &[],
    };
    let fits = steps.iter().find(|(_, factor)| largest * factor >= 0.5).or(steps.last());
    fits.map_or((unit.to_owned(), 1.0), |(name, factor)| ((*name).to_owned(), *factor))
}

/// The largest of 1, 2, 5 × 10ⁿ that is not above `limit`.
pub fn round_below(limit: f64) -> f64 {
    let ten = 10f64.powi(limit.log10().floor() as i32);
    [5.0, 2.0, 1.0].iter().map(|m| m * ten).find(|v| *v <= limit * (1.0 + 1e-9)).unwrap_or(ten)
}

/// The least number of two digits that is not below a positive one.
pub fn rounded_out(value: f64) -> f64 {
    let ten = 10f64.powi(value.log10().floor() as i32 - 1);
    // A power of ten below one is not exact: the text of two digits is the number nearest to it.
    let text = format!("{:.1e}", (value / ten * (1.0 - 1e-12)).ceil() * ten);
    text.parse().unwrap_or(value)
}

/// Round values inside the range, about `count` of them, and the decimals they need.
pub fn ticks(range: Range, count: usize) -> (Vec<f64>, usize) {
    let step = round_below((range.hi - range.lo) / count.max(1) as f64 * 1.5);
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let slack = 1e-6 * step;
    let first = ((range.lo - slack) / step).ceil() as i64;
    let last = ((range.hi + slack) / step).floor() as i64;
    ((first..=last).take(50).map(|k| k as f64 * step).collect(), decimals)
}

/// The box around everything that is looked at.
pub(crate) fn around(extents: impl Iterator<Item = [Range; 3]>) -> [Range; 3] {
    extents.fold([Range::EMPTY; 3], |all, one| std::array::from_fn(|k| all[k].with(one[k])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(
            ticks(Range { lo: 0.0, hi: 1.0 }, 5),
            (vec![0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0], 1)
        );
        let (inside, decimals) = ticks(Range { lo: 1.7, hi: 2.6 }, 5);
        assert!(inside.iter().all(|t| (1.7..=2.6).contains(t)) && decimals == 1);
    }

    #[test]
    fn units_get_the_prefix_that_reads_well() {
        assert_eq!(readable("m", 0.0024), ("mm".to_owned(), 1e3));
        assert_eq!(readable("Pa", 3e7), ("MPa".to_owned(), 1e-6));
        assert_eq!(readable("rad/s", 1e-5), ("rad/s".to_owned(), 1.0));
    }

    #[test]
    fn one_fast_grain_does_not_set_the_scale() {
        let mut values: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        values.push(1e6);
        assert!(Range::of_most(&values).hi < 1.0 && Range::of(&values).hi == 1e6);
    }

    #[test]
    fn a_range_of_one_value_can_be_divided_by() {
        let open = Range { lo: 3.0, hi: 3.0 }.opened();
        assert!(open.lo < 3.0 && open.hi > 3.0 && open.share(3.0) == 0.5);
    }
}
