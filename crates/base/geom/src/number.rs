//! One number of a command line: finite, and of the sign that is wanted.

use crate::LARGEST;
use std::num::ParseFloatError;
use thiserror::Error;

/// Why a text is not the number that is wanted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NumberError {
    /// No number at all.
    #[error("{0}")]
    Text(#[from] ParseFloatError),
    /// Infinite, or NaN.
    #[error("not a finite number")]
    NotFinite,
    /// Farther from 0 than [`LARGEST`].
    #[error("{0:e} is beyond {LARGEST:e}: check the exponent")]
    TooLarge(f64),
    /// A negative one, or 0.
    #[error("give a number above 0")]
    NotPositive,
    /// A negative one.
    #[error("give a number of 0 or more")]
    Negative,
    /// No share of a whole.
    #[error("give a share above 0 and below 1, such as 0.3 or 30%")]
    NoShare,
}

/// A finite number, at most [`LARGEST`].
///
/// # Errors
/// Another text.
pub fn finite(text: &str) -> Result<f64, NumberError> {
    let value: f64 = text.trim().parse()?;
    match value.abs() {
        size if size <= LARGEST => Ok(value),
        size if size.is_finite() => Err(NumberError::TooLarge(value)),
        _ => Err(NumberError::NotFinite),
    }
}

/// A finite number above 0.
///
/// # Errors
/// Another text or number.
pub fn positive(text: &str) -> Result<f64, NumberError> {
    finite(text).and_then(|value| if value > 0.0 { Ok(value) } else { Err(NumberError::NotPositive) })
}

/// A share above 0 and below 1, as 0.3 or 30%.
///
/// # Errors
/// Another text or number.
pub fn share(text: &str) -> Result<f64, NumberError> {
    let value = match text.strip_suffix('%') {
        Some(percent) => positive(percent).map(|p| p / 100.0),
        None => positive(text),
    };
    value.ok().filter(|v| *v < 1.0).ok_or(NumberError::NoShare)
}

/// A finite number that is not negative.
///
/// # Errors
/// Another text or number.
pub fn not_negative(text: &str) -> Result<f64, NumberError> {
    finite(text).and_then(|value| if value >= 0.0 { Ok(value) } else { Err(NumberError::Negative) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_numbers_of_the_wanted_sign() {
        assert_eq!((finite(" -2.5"), positive("1e-300"), not_negative("0")), (Ok(-2.5), Ok(1e-300), Ok(0.0)));
        for text in ["nan", "inf", "-inf", "1e999"] {
            assert_eq!(finite(text), Err(NumberError::NotFinite), "{text}");
        }
        assert_eq!(positive("1e308"), Err(NumberError::TooLarge(1e308)));
        assert_eq!(positive("0"), Err(NumberError::NotPositive));
        assert_eq!(not_negative("-1"), Err(NumberError::Negative));
        assert_eq!(finite("12mm").unwrap_err().to_string(), "invalid float literal");
    }
}
