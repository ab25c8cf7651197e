//! A specimen between two plates: of a slow test both bear the same.

use crate::series::{Curve, at, reaches};

/// Difference of what both plates bear over the larger one, from which a test is too fast [–].
const UNEVEN: f64 = 0.1;

/// Where a column has come this share of the way from its first value to that of row `top`.
pub fn on_the_way(values: &[f64], top: usize, share: f64) -> Option<(usize, f64)> {
    reaches(values, values[0] + share * (values[top] - values[0]))
}

/// A warning where the upper and the lower plate bear different loads half-way to row `top`; the speed is that of the plate [m/s].
pub fn uneven(
    curve: &Curve,
    [upper, lower]: [&str; 2],
    unit: &str,
    top: usize,
    speed: f64,
) -> Option<String> {
    let half = on_the_way(curve.column(upper), top, 0.5)?;
    let [upper, lower] = [upper, lower].map(|name| at(curve.column(name), half));
    let off = (upper - lower).abs() / upper.max(lower);
    (off > UNEVEN).then(|| {
        format!(
            "at half the strength the upper plate bears {upper:.3e} {unit} and the lower one {lower:.3e} {unit}: the test is too fast for its values to be those of a slow one: use --speed {:.2e} or less (now {speed:.2e} m/s)",
            speed * 0.5 * UNEVEN / off
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A core that was pressed together begins at 0.4 of its strength.
    #[test]
    fn a_load_that_begins_high_has_a_quarter_of_its_way() {
        let (row, share) = on_the_way(&[4.0, 5.0, 9.0, 10.0, 3.0], 3, 0.25).unwrap();
        assert!(row == 2 && (share - 0.125).abs() < 1e-12);
        assert_eq!(on_the_way(&[4.0, 3.0], 0, 0.25), None);
    }

    #[test]
    fn plates_that_bear_different_loads_are_told_with_a_slower_speed() {
        let of = |lower: f64| {
            let curve = Curve::default().with("up", "N", vec![0.0, 2.0, 4.0, 1.0]);
            uneven(&curve.with("low", "N", vec![0.0, lower, 4.0, 1.0]), ["up", "low"], "N", 2, 0.4)
        };
        assert_eq!(of(1.9), None);
        let words = of(1.0).unwrap();
        assert!(words.contains("2.000e0 N and the lower one 1.000e0 N"), "{words}");
        assert!(words.contains("--speed 4.00e-2 or less (now 4.00e-1 m/s)"), "{words}");
    }
}
