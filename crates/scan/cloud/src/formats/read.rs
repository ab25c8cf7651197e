//! Reads a cloud of any format.

use super::error::ReadError;
use super::text::{self, TextColumns};
use super::{drawing, e57, las, pcd, ply};
use crate::points::Cloud;
use std::io::Read;
use stream::Values;

/// Points are numbered by 4 bytes.
pub(crate) const MOST: usize = u32::MAX as usize;

/// A format by its name, its first bytes and its reader.
struct Format {
    name: &'static str,
    /// Whether these are its first bytes.
    matches: fn(&[u8]) -> bool,
    read: fn(Vec<u8>) -> Result<Cloud, ReadError>,
}

/// The format whose columns are what they say.
const PLY: &str = "PLY";
/// The format of text.
const TEXT: &str = "XYZ/PTS";

/// Every format that a cloud is read from.
const FORMATS: [Format; 7] = [
    Format { name: PLY, matches: ply::matches, read: ply::read },
    Format { name: "LAS/LAZ", matches: las::matches, read: las::read },
    Format { name: "E57", matches: e57::matches, read: e57::read },
    Format { name: "PCD", matches: pcd::matches, read: pcd::read },
    Format { name: "PTX", matches: text::ptx::matches, read: text::ptx::read },
    Format { name: "STL/OBJ", matches: drawing::matches, read: drawing::read },
    Format { name: TEXT, matches: text::xyz::matches, read: text::xyz::read },
];

/// Reads a cloud to its end, whatever its format.
///
/// Points may be NaN where a scanner had no echo: see [`Cloud::finite`].
///
/// # Errors
/// Content that is not a cloud, or is truncated, with its place.
pub fn read(from: impl Read) -> Result<Cloud, ReadError> {
    go_on(stream::ply::Opened::new(from).map_err(ReadError::Io)?)
}

/// Reads the rest of a cloud whose beginning was looked at.
///
/// # Errors
/// As [`read`].
pub fn go_on(opened: stream::ply::Opened<impl Read>) -> Result<Cloud, ReadError> {
    go_on_as(opened, None)
}

/// The same of text whose columns the user may name.
///
/// # Errors
/// As [`read`]; names for another format than text.
pub fn go_on_as(
    opened: stream::ply::Opened<impl Read>,
    columns: Option<&TextColumns>,
) -> Result<Cloud, ReadError> {
    if columns.is_some() && matches!(opened, stream::ply::Opened::Blocks(_)) {
        return Err(ReadError::Columns("PLY"));
    }
    match streamed(opened)? {
        Ok(cloud) => few_enough(cloud),
        Err(bytes) => from_bytes_as(bytes, columns),
    }
}

/// The same of one of several clouds, of which only those of text get the names; says whether it did.
///
/// # Errors
/// As [`read`].
pub fn go_on_among(
    opened: stream::ply::Opened<impl Read>,
    columns: Option<&TextColumns>,
) -> Result<(Cloud, bool), ReadError> {
    match streamed(opened)? {
        Ok(cloud) => few_enough(cloud).map(|cloud| (cloud, false)),
        Err(bytes) => {
            let columns = columns.filter(|_| format_of(&bytes).is_some_and(|format| format.name == TEXT));
            from_bytes_as(bytes, columns).map(|cloud| (cloud, columns.is_some()))
        }
    }
}

/// The cloud of a plain binary PLY, whose bytes are never all in memory; of another format all bytes.
fn streamed<R: Read>(opened: stream::ply::Opened<R>) -> Result<Result<Cloud, Vec<u8>>, ReadError> {
    let (mut bytes, mut from) = match ply::stream(opened)? {
        Ok(cloud) => return Ok(Ok(cloud)),
        Err(parts) => parts,
    };
    // Bytes of an unknown format may come from an endless stream.
    if name_of(&bytes).is_some() {
        stream::whole::rest(&mut from, &mut bytes).map_err(ReadError::Io)?;
    }
    Ok(Err(bytes))
}

fn few_enough(cloud: Cloud) -> Result<Cloud, ReadError> {
    match cloud.points.len() {
        0..MOST => Ok(cloud),
        points => Err(ReadError::TooMany { points: points as u64 }),
    }
}

/// Reads a cloud that is in memory.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    from_bytes_as(bytes, None)
}

/// The same of text whose columns the user may name.
///
/// # Errors
/// As [`read`]; names for another format than text.
pub fn from_bytes_as(bytes: Vec<u8>, columns: Option<&TextColumns>) -> Result<Cloud, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::Empty);
    }
    if mesh::is_step(&bytes) {
        return Err(mesh::MeshFileError::Step.into());
    }
    let Some(format) = format_of(&bytes) else {
        let start: String =
            bytes.iter().take(12).flat_map(|b| std::ascii::escape_default(*b)).map(char::from).collect();
        return Err(ReadError::Unknown { start: format!("'{start}'"), hint: hint(&bytes) });
    };
    let mut cloud = few_enough(match columns {
        Some(_) if format.name != TEXT => return Err(ReadError::Columns(format.name)),
        Some(columns) => text::xyz::read_as(&bytes, Some(columns))?,
        None => (format.read)(bytes)?,
    })?;
    if format.name != PLY {
        warn_of_long_numbers(&mut cloud);
    }
    Ok(cloud)
}

/// Whole numbers that share an 8-byte number with their neighbours, up to the longest that files hold: 2⁵³ to 2⁶⁴.
const LONG: std::ops::RangeInclusive<f64> = 9_007_199_254_740_992.0..=18_446_744_073_709_551_616.0;

/// Says which columns hold whole numbers whose last digits are lost, as times in nanoseconds.
fn warn_of_long_numbers(cloud: &mut Cloud) {
    let is_long = |values: &Values| match values {
        Values::F64(all) => {
            let is_whole = |v: &f64| v.fract() == 0.0 || !v.is_finite();
            all.iter().all(is_whole) && all.iter().any(|v| LONG.contains(&v.abs()))
        }
        _ => false,
    };
    let long = cloud.attributes.columns().iter().filter(|column| is_long(&column.values));
    let names: Vec<String> = long.map(|column| format!("'{}'", column.name)).collect();
    if !names.is_empty() {
        let what = format!(
            "{} holds whole numbers above 2^53, whose last digits are lost: subtract a whole number from all of them before",
            names.join(", ")
        );
        cloud.leave_out(what);
    }
}

/// The name of the format that `bytes` begin with.
pub fn name_of(bytes: &[u8]) -> Option<&'static str> {
    if mesh::is_step(bytes) {
        return Some("STEP");
    }
    format_of(bytes).map(|f| f.name)
}

/// The format that `bytes` begin with. Text in UTF-16 is none: its bytes may look like those of a drawing.
fn format_of(bytes: &[u8]) -> Option<&'static Format> {
    let is_utf16 = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    FORMATS.iter().find(|f| !is_utf16 && (f.matches)(bytes))
}

/// What else the bytes may be.
fn hint(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x1f, 0x8b, ..] => " (gzip: unpack it first, gunzip -c FILE |)",
        [0x28, 0xb5, 0x2f, 0xfd, ..] => " (zstd: unpack it first, zstd -dc FILE |)",
        [b'P', b'K', 3, 4, ..] => " (zip: unpack it first)",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => {
            " (UTF-16 text: save it as UTF-8, iconv -f UTF-16 -t UTF-8 FILE |)"
        }
        [0x89, b'M', b'C', b'A', b'P', ..] => " (MCAP: walls or a run, not a cloud)",
        _ => "",
    }
}
