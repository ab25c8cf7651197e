//! Formats of clouds, detected by their first bytes, never by the file name.
//!
//! A format is one file here and one line in [`FORMATS`]. Text without a magic number comes last.

mod drawing;
mod e57;
mod e57_claims;
mod e57_color;
mod e57_extra;
mod e57_point;
mod e57_xml;
mod epsg_units;
mod foreign;
mod las;
mod las_crs;
mod las_extra;
mod las_units;
mod laz;
mod pcd;
mod ply;
mod ptx;
mod text_names;
mod xyz;
mod xyz_columns;
mod xyz_names;

pub use ply::{read_mesh, to_ply, write_mesh, write_ply};
pub use text_names::TextColumns;

use crate::Cloud;
use std::io::Read;
use stream::Values;
use stream::ply::PlyError;
use stream::table::TableError;
use thiserror::Error;

/// Points are numbered by 4 bytes.
pub(crate) const MOST: usize = u32::MAX as usize;

/// One format.
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
    Format { name: "PTX", matches: ptx::matches, read: ptx::read },
    Format { name: "STL/OBJ", matches: drawing::matches, read: drawing::read },
    Format { name: TEXT, matches: xyz::matches, read: xyz::read },
];

/// Why bytes are no cloud.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum ReadError {
    #[error("cannot read")]
    Io(#[source] std::io::Error),
    #[error("nothing to read: the input is empty; did the previous tool fail?")]
    Empty,
    #[error(
        "no known cloud format begins with {start}{hint}: give PLY, LAS, LAZ, E57, PCD, STL, OBJ, PTX or XYZ/PTS text"
    )]
    Unknown { start: String, hint: &'static str },
    #[error("not a cloud")]
    Ply(#[source] PlyError),
    #[error("PLY: not a cloud: no element has the properties x, y, z")]
    NoPosition,
    #[error(
        "PLY: two elements, '{one}' and '{other}', have the properties x, y, z: write each to a file of its own"
    )]
    TwoClouds { one: String, other: String },
    #[error("PLY: element '{element}' has x but no '{missing}': a point needs x, y and z")]
    HalfPosition { element: String, missing: &'static str },
    #[error(transparent)]
    Mesh(#[from] mesh::MeshFileError),
    #[error("{format}: {}{}", plain(.what), at_point(*.point))]
    Broken { format: &'static str, what: String, point: Option<u64> },
    #[error("XYZ/PTS: line {line}: {what}: '{text}'")]
    Text { line: usize, what: String, text: String },
    #[error("{format}: cannot combine the columns")]
    Table {
        format: &'static str,
        #[source]
        source: TableError,
    },
    #[error("--columns names the columns of text, and this is {0}, which names them itself: leave it out")]
    Columns(&'static str),
    #[error("{points} points are more than one cloud can hold ({}): divide the scan into parts", u32::MAX - 1)]
    TooMany { points: u64 },
}

fn at_point(point: Option<u64>) -> String {
    point.map(|p| format!(" (at point {p})")).unwrap_or_default()
}

/// What the reader of another crate said, and what to do when it did not say that.
fn plain(what: &str) -> String {
    if what.contains("failed to fill whole buffer") {
        "the file ends early: it is cut off, write or copy it again".to_owned()
    } else if ["cut off", "again", "there are"].iter().any(|cure| what.contains(cure)) {
        what.to_owned()
    } else {
        format!("{what}: the file is damaged or cut off, export it again")
    }
}

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
    match ply::stream(opened)? {
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
    match ply::stream(opened)? {
        Ok(cloud) => few_enough(cloud).map(|cloud| (cloud, false)),
        Err(bytes) => {
            let columns = columns.filter(|_| format_of(&bytes).is_some_and(|format| format.name == TEXT));
            from_bytes_as(bytes, columns).map(|cloud| (cloud, columns.is_some()))
        }
    }
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
        Some(columns) => xyz::read_as(&bytes, Some(columns))?,
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

/// Colours in the smallest type that holds them all.
fn narrowed(column: Vec<f32>) -> Values {
    let fits = |top: f32| column.iter().all(|&c| c.fract() == 0.0 && (0.0..=top).contains(&c));
    if fits(255.0) {
        Values::U8(column.iter().map(|&c| c as u8).collect())
    } else if fits(65535.0) {
        Values::U16(column.iter().map(|&c| c as u16).collect())
    } else {
        Values::F32(column)
    }
}
