//! Computed numbers, rounded for messages.

use std::fmt;

/// A number in messages: six significant digits, without the zeros that end them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = format!("{:.5e}", self.0).parse().unwrap_or(self.0);
        let size = f64::abs(rounded);
        if size != 0.0 && !(1e-4..1e7).contains(&size) && size.is_finite() {
            write!(f, "{rounded:e}")
        } else {
            write!(f, "{rounded}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Shown;

    #[test]
    fn six_digits_and_no_more() {
        let shown: Vec<String> =
            [0.010000000000000009, 0.043304955039662606, -12.0, 0.0, 1.0 / 3e6, 2e11, f64::NAN]
                .iter()
                .map(|&v| Shown(v).to_string())
                .collect();
        assert_eq!(shown, ["0.01", "0.043305", "-12", "0", "3.33333e-7", "2e11", "NaN"]);
    }
}
