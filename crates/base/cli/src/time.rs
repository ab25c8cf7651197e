//! Times on the command line.

use record::LATEST;

/// Shortest span of time [s]: files hold whole nanoseconds.
const SHORTEST: f64 = 1e-9;

/// A time [s]; as a clap argument: `value_parser = cli::seconds`.
///
/// # Errors
/// Text that is not a number, or a time that no file can hold.
pub fn seconds(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.is_finite());
    let time = time.ok_or("give a time in seconds, such as 0.5")?;
    if time.abs() <= LATEST {
        Ok(time)
    } else {
        Err(format!("{time:e} s is beyond the latest time, {LATEST:e} s"))
    }
}

/// A span of time [s].
///
/// # Errors
/// As [`seconds`]; less than a nanosecond.
pub fn span(text: &str) -> Result<f64, String> {
    let time = seconds(text).ok().filter(|time| *time > 0.0);
    let time = time.ok_or_else(|| format!("give seconds above 0 and at most {LATEST:e}, such as 0.01"))?;
    if time >= SHORTEST { Ok(time) } else { Err(format!("{time:e} s is less than a nanosecond")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_ranges() {
        assert_eq!((seconds("-0.5"), span("0.01")), (Ok(-0.5), Ok(0.01)));
        assert!(["nan", "1e308", "-1e308", "inf", "", "1 s"].iter().all(|text| seconds(text).is_err()));
        assert!(["0", "-1", "1e-300", "1e308"].iter().all(|text| span(text).is_err()));
    }
}
