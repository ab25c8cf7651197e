//! Lengths of options.

/// A length above 0 [m]: a number in metres, or a text with a unit such as "5 mm". For clap: `value_parser = cli::length`.
///
/// # Errors
/// Another text, a unit of another dimension, a number that is not above 0.
pub fn length(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let such = "give a length above 0, such as 0.012 or '12 mm'";
    let value = match geom::number::finite(text) {
        Err(geom::number::NumberError::Text(_)) => {
            geom::units::parse(text, "m").map_err(|e| format!("{e}: {such}"))?
        }
        other => other.map_err(|e| format!("{e}: {such}"))?,
    };
    if value > 0.0 && value <= geom::LARGEST { Ok(value) } else { Err(such.to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_metres_or_have_a_unit() {
        assert_eq!((length("0.005"), length("5 mm"), length("5mm")), (Ok(0.005), Ok(0.005), Ok(0.005)));
        for text in ["-0.01", "0", "0 mm", "-1 mm", "nan", "1e308", "1e99 km", "5 kg", "five", ""] {
            assert!(length(text).is_err_and(|why| why.contains("a length above 0")), "{text}");
        }
    }
}
