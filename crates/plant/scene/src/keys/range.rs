//! The numbers that keys take.

use std::fmt;

/// The numbers that a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// What its type takes; other keys may say more.
    Any,
    /// The name of a file.
    File,
    /// Finite, and no larger than a quantity of its unit may be.
    Finite,
    /// Above 0, and of a size that its unit allows ([`dem::magnitudes`]).
    Positive,
    /// Two numbers above 0, the smaller first.
    Pair,
    /// From 0.
    FromZero,
    /// From the first to the second, both included.
    Within(f64, f64),
    /// Between the two, both left out, and why; "" where that needs no words.
    Between(f64, f64, &'static str),
    /// This or more.
    AtLeast(f64),
    /// Above 0, up to this.
    AboveZeroUpTo(f64),
    /// Numbers whose squares have the sum 1, up to rounding.
    UnitLength,
    /// Of Poisson's ratio.
    Poisson,
    /// A name without control characters: it goes into scripts and tables.
    Name,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Range::Any | Range::File | Range::Finite => Ok(()),
            Range::Positive | Range::Pair => f.write_str("above 0"),
            Range::FromZero => f.write_str("from 0"),
            Range::Within(low, high) => write!(f, "{} to {}", geom::Shown(*low), geom::Shown(*high)),
            Range::Between(low, high, _) => {
                write!(f, "between {} and {}", geom::Shown(*low), geom::Shown(*high))
            }
            Range::AtLeast(low) => write!(f, "{} or more", geom::Shown(*low)),
            Range::AboveZeroUpTo(high) => write!(f, "above 0, up to {}", geom::Shown(*high)),
            Range::UnitLength => f.write_str("of length 1"),
            Range::Poisson => f.write_str(record::POISSON),
            Range::Name => f.write_str("without control characters"),
        }
    }
}
