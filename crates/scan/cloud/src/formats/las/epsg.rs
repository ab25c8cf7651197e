//! Units of length of the coordinate reference systems that EPSG numbers, as far as they are not the metre.

use crate::points::LengthUnit;

/// Lines of `kind metres name: codes`; `a-b` are all codes from a to b, `a-b/2` every other one.
const TABLE: &str = include_str!("epsg_units.txt");
/// Codes of EPSG's systems. Lower ones are of GeoTIFF alone, higher ones of a user.
const CODES: std::ops::Range<u16> = 1024..32_767;
/// Codes of vertical systems in GeoTIFF 1.0, whose unit was left open.
const OLD_VERTICAL: std::ops::Range<u16> = 5000..5200;

/// Kinds of coordinate reference systems, each with its own codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Projected,
    Vertical,
}

/// The unit of a system; `None` for a code that is not EPSG's.
pub(crate) fn of(kind: Kind, code: u16) -> Option<LengthUnit> {
    if !CODES.contains(&code) || kind == Kind::Vertical && OLD_VERTICAL.contains(&code) {
        return None;
    }
    let word = match kind {
        Kind::Projected => "projected",
        Kind::Vertical => "vertical",
    };
    let found = rows().find(|row| row.kind == word && row.codes().any(|codes| codes.holds(code)));
    Some(found.map_or(LengthUnit { name: "metre".to_owned(), metres: 1.0 }, |row| row.unit()))
}

struct Row {
    kind: &'static str,
    metres: &'static str,
    name: &'static str,
    codes: &'static str,
}

struct Codes {
    first: u16,
    last: u16,
    step: u16,
}

fn rows() -> impl Iterator<Item = Row> {
    TABLE.lines().filter_map(|line| {
        let (head, codes) = line.strip_suffix('\n').unwrap_or(line).split_once(": ")?;
        let (kind, rest) = head.split_once(' ')?;
        let (metres, name) = rest.split_once(' ')?;
        (!kind.starts_with('#')).then_some(Row { kind, metres, name, codes })
    })
}

impl Row {
    fn codes(&self) -> impl Iterator<Item = Codes> {
        self.codes.split(' ').filter_map(|text| {
            let (range, step) = text.split_once('/').unwrap_or((text, "1"));
            let (first, last) = range.split_once('-').unwrap_or((range, range));
            Some(Codes { first: first.parse().ok()?, last: last.parse().ok()?, step: step.parse().ok()? })
        })
    }

    fn unit(&self) -> LengthUnit {
        LengthUnit { name: self.name.to_owned(), metres: self.metres.parse().unwrap_or(f64::NAN) }
    }
}

impl Codes {
    fn holds(&self, code: u16) -> bool {
        (self.first..=self.last).contains(&code) && (code - self.first).is_multiple_of(self.step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_can_be_read_and_no_code_has_two_units() {
        let mut seen = std::collections::HashMap::new();
        for row in rows() {
            assert!((1e-2..=1e3).contains(&row.unit().metres), "{}", row.metres);
            assert_eq!(row.codes().count(), row.codes.split(' ').count(), "{}", row.codes);
            for codes in row.codes() {
                assert!(codes.first <= codes.last && codes.step > 0, "{}", row.codes);
                for code in CODES.filter(|code| codes.holds(*code)) {
                    assert_eq!(seen.insert((row.kind, code), row.name), None, "{} {code}", row.kind);
                }
            }
        }
        // 974 numbers of projected systems in EPSG v11.022, and some that EPSG leaves out between them.
        assert!(seen.len() > 974, "{}", seen.len());
        assert_eq!(rows().count() + 1, TABLE.lines().count(), "the first line is a remark");
    }

    #[test]
    fn systems_in_feet_are_known() {
        let metres = |kind, code| of(kind, code).map(|unit| unit.metres);
        for (code, unit) in [
            (2263, 1200.0 / 3937.0),
            (2994, 0.3048),
            (2225, 1200.0 / 3937.0),
            (6557, 0.3048),
            (6556, 1.0),
            (25832, 1.0),
            (2193, 1.0),
        ] {
            assert!((metres(Kind::Projected, code).unwrap() - unit).abs() < 1e-15, "{code}");
        }
        assert!((metres(Kind::Vertical, 6360).unwrap() - 1200.0 / 3937.0).abs() < 1e-15);
        assert_eq!((metres(Kind::Vertical, 5703), metres(Kind::Vertical, 8228)), (Some(1.0), Some(0.3048)));
        assert_eq!(
            (of(Kind::Vertical, 5103), of(Kind::Projected, 32_767), of(Kind::Projected, 0)),
            (None, None, None)
        );
    }
}
