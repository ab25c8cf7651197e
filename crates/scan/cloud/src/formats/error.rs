//! Why bytes are no cloud.

use stream::ply::PlyError;
use stream::table::TableError;
use thiserror::Error;

/// Why bytes are no cloud.
#[derive(Debug, Error)]
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
