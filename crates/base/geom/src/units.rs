//! Units: text such as "8 mm" or "1.5 t/h" as a number in a given unit.
//!
//! A unit is a product of symbols with prefixes and powers: `kg/m³`, `g/cm3`, `N/mm^2`, `Pa·s`. Factors are fractions of whole numbers
//! times powers of ten, so that "8 mm" is the number 0.008 to the last bit.

use thiserror::Error;

/// Exponents of metre, kilogram, second and radian.
type Dimension = [i32; 4];

/// A unit: its dimension, and its size as `num`/`den` × 10^`ten` × `rest` of the SI unit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Unit {
    dimension: Dimension,
    num: u64,
    den: u64,
    ten: i32,
    rest: f64,
}

/// Symbol, dimension, num, den, ten, and whether it takes prefixes.
type Row = (&'static str, Dimension, u64, u64, i32, bool);

const SYMBOLS: [Row; 24] = [
    ("1", [0; 4], 1, 1, 0, false),
    ("%", [0; 4], 1, 1, -2, false),
    ("m", [1, 0, 0, 0], 1, 1, 0, true),
    ("in", [1, 0, 0, 0], 254, 1, -4, false),
    ("ft", [1, 0, 0, 0], 3048, 1, -4, false),
    ("g", [0, 1, 0, 0], 1, 1, -3, true),
    ("t", [0, 1, 0, 0], 1, 1, 3, false),
    ("lb", [0, 1, 0, 0], 45_359_237, 1, -8, false),
    ("s", [0, 0, 1, 0], 1, 1, 0, true),
    ("min", [0, 0, 1, 0], 60, 1, 0, false),
    ("h", [0, 0, 1, 0], 3600, 1, 0, false),
    ("d", [0, 0, 1, 0], 86_400, 1, 0, false),
    ("Hz", [0, 0, -1, 0], 1, 1, 0, true),
    ("N", [1, 1, -2, 0], 1, 1, 0, true),
    ("Pa", [-1, 1, -2, 0], 1, 1, 0, true),
    ("bar", [-1, 1, -2, 0], 1, 1, 5, true),
    ("psi", [-1, 1, -2, 0], 44_482_216_152_605, 64_516, -5, false),
    ("J", [2, 1, -2, 0], 1, 1, 0, true),
    ("rad", [0, 0, 0, 1], 1, 1, 0, false),
    ("deg", [0, 0, 0, 1], 1, 1, 0, false),
    ("°", [0, 0, 0, 1], 1, 1, 0, false),
    ("rpm", [0, 0, -1, 1], 1, 1, 0, false),
    ("rps", [0, 0, -1, 1], 1, 1, 0, false),
    ("P", [-1, 1, -1, 0], 1, 1, -1, true),
];

const PREFIXES: [(&str, i32); 9] =
    [("n", -9), ("µ", -6), ("μ", -6), ("u", -6), ("m", -3), ("c", -2), ("k", 3), ("M", 6), ("G", 9)];

/// Why a text is not a value of a unit.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)]
pub enum UnitError {
    #[error("\"{text}\" has no number in front")]
    Number { text: String },
    #[error("\"{text}\" has no unit: write it {}, or add a unit", plainly(unit))]
    Missing { text: String, unit: &'static str },
    #[error("unknown unit '{symbol}' in \"{text}\"")]
    Unknown { text: String, symbol: String },
    #[error("\"{text}\" is no {unit}: the unit has another dimension")]
    Dimension { text: String, unit: &'static str },
}

/// How a plain number is written.
fn plainly(unit: &str) -> String {
    // Of what has no unit, 0.5 and "50 %" are the same.
    if unit.is_empty() { "without quotes".to_owned() } else { format!("without quotes in {unit}") }
}

/// The number that a text such as "8 mm" stands for, in `unit`.
///
/// # Errors
/// No number, no unit, an unknown unit, a unit of another dimension.
pub fn parse(text: &str, unit: &'static str) -> Result<f64, UnitError> {
    let whole = || text.to_owned();
    let (number, symbols) = split(text.trim());
    let value: f64 = number.parse().map_err(|_| UnitError::Number { text: whole() })?;
    if symbols.is_empty() && value == 0.0 {
        return Ok(0.0);
    }
    if symbols.is_empty() {
        return Err(UnitError::Missing { text: whole(), unit });
    }
    let from = Unit::parse(symbols).map_err(|symbol| UnitError::Unknown { text: whole(), symbol })?;
    let to = Unit::parse(unit).unwrap_or(Unit::ONE);
    if from.dimension != to.dimension {
        return Err(UnitError::Dimension {
            text: whole(),
            unit: if unit.is_empty() { "plain number" } else { unit },
        });
    }
    Ok(from.per(to).times(number, value))
}

/// How many of `unit` a named unit is: `factor("mm", "m")` is 0.001.
///
/// # Errors
/// As for [`parse`].
pub fn factor(name: &str, unit: &'static str) -> Result<f64, UnitError> {
    parse(&format!("1 {name}"), unit)
}

/// How many of the SI unit of its dimension a named unit is: "mm" is 0.001. `None`: unknown.
pub fn in_si(name: &str) -> Option<f64> {
    Unit::parse(name).ok().map(|unit| unit.times("1", 1.0))
}

/// How many of `to` a unit is: `ratio("kPa", "MPa")` is 0.001. `None`: one of them is unknown, or they have other dimensions.
pub fn ratio(from: &str, to: &str) -> Option<f64> {
    let (from, to) = (Unit::parse(from).ok()?, Unit::parse(to).ok()?);
    (from.dimension == to.dimension).then(|| from.per(to).times("1", 1.0))
}

/// The number at the front of a text, and what follows it.
fn split(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let digit = |k: usize| bytes.get(k).is_some_and(u8::is_ascii_digit);
    let mut end = 0;
    while let Some(&b) = bytes.get(end) {
        let sign_of_exponent = matches!(b, b'+' | b'-') && end > 0 && matches!(bytes[end - 1], b'e' | b'E');
        let exponent = matches!(b, b'e' | b'E')
            && (digit(end + 1) || matches!(bytes.get(end + 1), Some(b'+' | b'-')) && digit(end + 2));
        let sign = matches!(b, b'+' | b'-') && end == 0;
        if !(b.is_ascii_digit() || b == b'.' || sign || exponent || sign_of_exponent) {
            break;
        }
        end += 1;
    }
    (&text[..end], text[end..].trim())
}

impl Unit {
    const ONE: Unit = Unit { dimension: [0; 4], num: 1, den: 1, ten: 0, rest: 1.0 };

    /// A product or quotient of powers of symbols; the first symbol that is unknown.
    fn parse(text: &str) -> Result<Unit, String> {
        let mut unit = Unit::ONE;
        let mut rest = text;
        let mut sign = 1;
        while !rest.is_empty() {
            let end = rest.find(['/', '·', '*', ' ']).unwrap_or(rest.len());
            let (factor, power) = power(rest[..end].trim());
            if !factor.is_empty() {
                unit = unit.and(Unit::symbol(factor).ok_or_else(|| factor.to_owned())?, sign * power);
                sign = 1;
            }
            let next = rest[end..].chars().next();
            if next == Some('/') {
                sign = -1;
            }
            rest = &rest[end + next.map_or(0, char::len_utf8)..];
        }
        Ok(unit)
    }

    fn symbol(symbol: &str) -> Option<Unit> {
        let row = |name: &str| SYMBOLS.iter().find(|row| row.0 == name);
        let unit = |&(name, dimension, num, den, ten, _): &Row, prefix: i32| {
            let rest = match name {
                "deg" | "°" => std::f64::consts::PI / 180.0,
                "rpm" => std::f64::consts::TAU / 60.0,
                "rps" => std::f64::consts::TAU,
                _ => 1.0,
            };
            Unit { dimension, num, den, ten: ten + prefix, rest }
        };
        if let Some(found) = row(symbol) {
            return Some(unit(found, 0));
        }
        PREFIXES.iter().find_map(|(prefix, ten)| {
            let found = row(symbol.strip_prefix(prefix)?).filter(|row| row.5)?;
            Some(unit(found, *ten))
        })
    }

    /// This times a power of another.
    fn and(self, other: Unit, power: i32) -> Unit {
        let mut new = self;
        for _ in 0..power.unsigned_abs() {
            let (num, den) = if power > 0 { (other.num, other.den) } else { (other.den, other.num) };
            (new.num, new.den) = (new.num.saturating_mul(num), new.den.saturating_mul(den));
        }
        (0..4).for_each(|d| new.dimension[d] += power * other.dimension[d]);
        new.ten += power * other.ten;
        new.rest *= other.rest.powi(power);
        new
    }

    /// This over another.
    fn per(self, other: Unit) -> Unit {
        let rest = if self.rest == other.rest { 1.0 } else { self.rest / other.rest };
        let (num, den) = (self.num.saturating_mul(other.den), self.den.saturating_mul(other.num));
        let common = divisor(num, den).max(1);
        Unit { num: num / common, den: den / common, ten: self.ten - other.ten, rest, ..Unit::ONE }
    }

    /// A number, as written and as read, times this. Powers of ten are written into the number, so that it is rounded once.
    fn times(self, number: &str, value: f64) -> f64 {
        let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
        let ten = exponent.parse::<i32>().unwrap_or(0).saturating_add(self.ten);
        let product = match (self.num, self.den, digits.parse::<f64>()) {
            (1, 1, _) | (.., Err(_)) => digits.to_owned(),
            (num, den, Ok(digits)) => (digits * num as f64 / den as f64).to_string(),
        };
        format!("{product}e{ten}").parse().unwrap_or(value) * self.rest
    }
}

/// A symbol and its power: `m³`, `m3`, `m^3`, `m-1`.
fn power(text: &str) -> (&str, i32) {
    for (sign, power) in [('²', 2), ('³', 3)] {
        if let Some(symbol) = text.strip_suffix(sign) {
            return (symbol, power);
        }
    }
    let at = text.find(|c: char| c.is_ascii_digit() || c == '-' || c == '^').filter(|&at| at > 0);
    let split = at.map(|at| (&text[..at], text[at..].trim_start_matches('^').parse::<i32>()));
    match split {
        Some((symbol, Ok(power))) if (-4..=4).contains(&power) => (symbol, power),
        _ => (text, 1),
    }
}

/// The greatest common divisor.
fn divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_with_a_unit_is_the_number_that_one_would_write() {
        for (text, unit, value) in [
            ("8 mm", "m", 0.008),
            ("8mm", "m", 0.008),
            ("1.1 mm", "m", 0.0011),
            ("35e-1 cm", "m", 0.035),
            ("-2 µm", "m", -2e-6),
            ("30 rpm", "rpm", 30.0),
            ("5 MPa", "Pa", 5e6),
            ("2.5 g/cm3", "kg/m³", 2500.0),
            ("9.81 m/s^2", "m/s²", 9.81),
            ("9810 mm/s²", "m/s²", 9.81),
            ("3 kN/mm", "N/m", 3e6),
            ("1 in", "m", 0.0254),
            ("200 ms", "s", 0.2),
            ("2 min", "s", 120.0),
            ("50 %", "", 0.5),
            ("1.8e-5 Pa·s", "Pa·s", 1.8e-5),
            ("1 cP", "Pa·s", 1e-3),
            ("4 1/s", "1/s", 4.0),
            ("4 /s", "1/s", 4.0),
            ("180 deg/s", "rad/s", std::f64::consts::PI),
            ("3.6 t/h", "kg/s", 1.0),
        ] {
            assert_eq!(parse(text, unit), Ok(value), "{text}");
        }
        let rate = parse("1.5 t/h", "kg/s").expect("a rate");
        assert!((rate - 1500.0 / 3600.0).abs() < 1e-15, "{rate}");
        assert!((parse("60 rpm", "rad/s").expect("a spin") - std::f64::consts::TAU).abs() < 1e-15);
        assert!((parse("1 psi", "Pa").expect("a stress") - 6_894.757_293_168).abs() < 1e-8);
        assert_eq!(factor("mm", "m"), Ok(0.001));
        assert_eq!((in_si("kPa"), in_si("parsec")), (Some(1000.0), None));
        assert_eq!((ratio("kPa", "MPa"), ratio("kPa", "m")), (Some(0.001), None));
    }

    #[test]
    fn other_texts_are_refused_by_what_is_wrong() {
        let refused = |text: &str, unit| parse(text, unit).expect_err("refused").to_string();
        assert_eq!(refused("8 kg", "m"), "\"8 kg\" is no m: the unit has another dimension");
        assert_eq!(refused("8 mn", "m"), "unknown unit 'mn' in \"8 mn\"");
        assert!(refused("0.008", "m").contains("without quotes in m"));
        assert!(refused("long", "s").contains("no number"));
        assert!(refused("50 Hz", "rpm").contains("another dimension"));
        assert!(refused("8 mm/", "Pa").contains("another dimension"));
        assert!(refused("1 kkm", "m").contains("unknown unit"));
    }
}
