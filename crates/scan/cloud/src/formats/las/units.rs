//! Units of length that the coordinate reference system of a LAS file names.
//!
//! ```text
//! well-known text   PROJCS[…, UNIT["name", metres], …], VERT_CS[…, UNIT["name", metres]], or with LENGTHUNIT in an AXIS or behind all of them
//! keys of GeoTIFF   3076 and 4099: 9001 metre, 9002 foot, 9003 US survey foot; 3077: metres; else the units of the systems 3072 and 4096
//! ```
//!
//! ISO 19162 (2019); OGC 01-009; OGC 19-008r4, GeoTIFF 1.1.

use super::epsg::{self, Kind};
use crate::points::{LengthUnit, ReadWarning};
use las::Header;
use las::crs::GeoTiffData;

/// Names of projected, geocentric and local systems, in both versions of the text.
const HORIZONTAL: [&str; 8] =
    ["PROJCS", "PROJCRS", "PROJECTEDCRS", "GEOCCS", "LOCAL_CS", "ENGCRS", "GEODCRS", "GEODETICCRS"];
/// Names of vertical ones.
const VERTICAL: [&str; 3] = ["VERT_CS", "VERTCRS", "VERTICALCRS"];
/// Share that a metre may differ from 1.
const ROUNDED: f64 = 1e-9;

/// What to say of a file whose lengths are no metres.
pub(crate) fn warning(header: &Header) -> Option<ReadWarning> {
    let text = String::from_utf8_lossy(header.get_wkt_crs_bytes().unwrap_or_default()).into_owned();
    let (horizontal, vertical) = if text.trim_matches('\0').trim().is_empty() {
        by_keys(header)
    } else {
        (by_text(&text, &HORIZONTAL), by_text(&text, &VERTICAL))
    };
    let is_metre = |unit: &LengthUnit| (unit.metres - 1.0).abs() < ROUNDED;
    let horizontal = horizontal?;
    // A system without heights leaves their unit open: most often it is that of the others.
    let vertical = vertical.unwrap_or_else(|| horizontal.clone());
    if is_metre(&horizontal) && is_metre(&vertical) {
        return None;
    }
    Some(if (horizontal.metres / vertical.metres - 1.0).abs() < 1e-5 {
        ReadWarning::Unit(horizontal)
    } else {
        ReadWarning::TwoUnits { horizontal, vertical }
    })
}

/// The unit of length that stands in one of the systems `of`, itself or in its axes.
fn by_text(text: &str, of: &[&str]) -> Option<LengthUnit> {
    let mut open: Vec<String> = Vec::new();
    let (mut word, mut rest) = (String::new(), text.chars());
    while let Some(c) = rest.next() {
        match c {
            '"' => rest.by_ref().take_while(|&c| c != '"').for_each(drop),
            '[' | '(' => {
                let outer = open.last().map(String::as_str).unwrap_or_default();
                let outer = if outer == "AXIS" { open.iter().rev().nth(1).map_or("", |s| s) } else { outer };
                if of.contains(&outer) && (word == "UNIT" || word == "LENGTHUNIT") {
                    return unit(rest.as_str());
                }
                open.push(std::mem::take(&mut word));
            }
            ']' | ')' => {
                open.pop();
                word.clear();
            }
            c if c.is_ascii_alphanumeric() || c == '_' => word.push(c.to_ascii_uppercase()),
            _ => word.clear(),
        }
    }
    None
}

/// `"name", metres …`
fn unit(text: &str) -> Option<LengthUnit> {
    let (name, rest) = text.trim_start().strip_prefix('"')?.split_once('"')?;
    let number = rest.trim_start().strip_prefix(',')?.split([',', ']', ')']).next()?;
    let metres = number.trim().parse().ok().filter(|m| (1e-6..1e6).contains(m))?;
    let plain = |c: char| if c.is_ascii_graphic() || c == ' ' { c } else { '_' };
    Some(LengthUnit { name: name.chars().take(40).map(plain).collect(), metres })
}

/// The units that keys of GeoTIFF name, horizontal and vertical.
fn by_keys(header: &Header) -> (Option<LengthUnit>, Option<LengthUnit>) {
    let keys = header.get_geotiff_crs().ok().flatten().map_or(Vec::new(), |keys| keys.entries);
    let value = |id: u16| keys.iter().find(|key| key.id == id).map(|key| &key.data);
    let named = |id: u16| match value(id) {
        Some(GeoTiffData::U16(9001)) => Some(("metre", 1.0)),
        Some(GeoTiffData::U16(9002)) => Some(("foot", 0.3048)),
        Some(GeoTiffData::U16(9003)) => Some(("US survey foot", 1200.0 / 3937.0)),
        _ => None,
    };
    let unit = |id: u16| named(id).map(|(name, metres)| LengthUnit { name: name.to_owned(), metres });
    let own = match value(3077) {
        Some(GeoTiffData::Doubles(metres)) => metres.first().copied().filter(|m| (1e-6..1e6).contains(m)),
        _ => None,
    };
    let by_code = |kind: Kind, id: u16| match value(id) {
        Some(GeoTiffData::U16(code)) => epsg::of(kind, *code),
        _ => None,
    };
    let own = own.map(|metres| LengthUnit { name: "a unit of its own".to_owned(), metres });
    let horizontal = unit(3076).or(own).or_else(|| by_code(Kind::Projected, 3072));
    (horizontal, unit(4099).or_else(|| by_code(Kind::Vertical, 4096)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_in_their_systems() {
        let first = r#"COMPD_CS["x",PROJCS["NAD83 / UNIT[ ""a",GEOGCS["NAD83",UNIT["degree",0.017]],PARAMETER["easting",1],UNIT["US survey foot",0.3048006]],
            VERT_CS["NAVD88",VERT_DATUM["d",2005],UNIT["metre",1.0],AXIS["Up",UP]]]"#;
        let told = |text: &str, of: &[&str]| by_text(text, of).map(|unit| (unit.name, unit.metres));
        assert_eq!(told(first, &HORIZONTAL), Some(("US survey foot".to_owned(), 0.3048006)));
        assert_eq!(told(first, &VERTICAL), Some(("metre".to_owned(), 1.0)));
        let second = r#"PROJCRS["x",BASEGEOGCRS["g",DATUM["d",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]]]],
            CONVERSION["c",PARAMETER["p",0,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],LENGTHUNIT["foot",0.3048]]]"#;
        assert_eq!(told(second, &HORIZONTAL), Some(("foot".to_owned(), 0.3048)));
        assert_eq!(told(second, &VERTICAL), None);
        assert_eq!(told("PROJCS[", &HORIZONTAL), None);
        assert_eq!(told("UNIT[\"foot\",0.3]]]]PROJCS[UNIT[", &HORIZONTAL), None);
    }
}
