//! Numbers in messages: rounded, and with what they count.

use alloc::format;
use alloc::string::String;
use core::fmt;

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

/// A number and what it counts: a word that takes an s where there are more than one, or none.
pub fn counted(count: impl TryInto<u64>, word: &str) -> String {
    let count = count.try_into().unwrap_or(u64::MAX);
    if count == 1 { format!("1 {word}") } else { format!("{count} {word}s") }
}

/// A number, what it counts, and a verb that goes with one or with several: "1 grain is", "2 grains are".
pub fn counted_as(count: impl TryInto<u64>, word: &str, [one, several]: [&str; 2]) -> String {
    let count = count.try_into().unwrap_or(u64::MAX);
    format!("{} {}", counted(count, word), if count == 1 { one } else { several })
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::string::{String, ToString};
    use alloc::vec::Vec;

    #[test]
    fn one_has_no_s() {
        assert_eq!([0, 1, 2].map(|n| counted(n, "grain")), ["0 grains", "1 grain", "2 grains"]);
    }

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
