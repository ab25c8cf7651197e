//! Lists of finite numbers on a command line, with the place of the first wrong one.

use crate::LARGEST;
use thiserror::Error;

/// Why a text is not a list of so many finite numbers.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NumbersError {
    /// More or fewer of them.
    #[error("expected {wanted} numbers, separated by commas, and found {found} in '{text}'")]
    Count {
        /// How many were wanted.
        wanted: usize,
        /// How many were there.
        found: usize,
        /// The text.
        text: String,
    },
    /// One that is farther from 0 than [`LARGEST`].
    #[error("'{part}' at character {at} is beyond {LARGEST:e}: check the exponent")]
    TooLarge {
        /// The part between its commas.
        part: String,
        /// Where it starts, counted from 1.
        at: usize,
    },
    /// One that is no finite number.
    #[error("'{part}' at character {at} is not a finite number")]
    Number {
        /// The part between its commas.
        part: String,
        /// Where it starts, counted from 1.
        at: usize,
    },
}

/// Reads exactly `N` finite numbers separated by commas; `offset` is what stands before `text`, for messages.
pub(crate) fn numbers<const N: usize>(text: &str, offset: usize) -> Result<[f64; N], NumbersError> {
    let parts: Vec<&str> = text.split(',').collect();
    if parts.len() != N {
        let found = if text.trim().is_empty() { 0 } else { parts.len() };
        return Err(NumbersError::Count { wanted: N, found, text: text.to_owned() });
    }
    let mut values = [0.0; N];
    let mut at = offset + 1;
    for (value, part) in values.iter_mut().zip(parts) {
        *value = match part.trim().parse::<f64>() {
            Ok(v) if v.abs() <= LARGEST => v,
            Ok(v) if v.is_finite() => return Err(NumbersError::TooLarge { part: part.to_owned(), at }),
            _ => return Err(NumbersError::Number { part: part.to_owned(), at }),
        };
        at += part.chars().count() + 1;
    }
    Ok(values)
}
