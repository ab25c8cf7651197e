//! What cannot be shown, and why.

use thiserror::Error;

/// Why no page or picture was made.
#[derive(Debug, Error)]
pub enum ViewError {
    /// A table without positions.
    #[error("{name}: no column '{column}', so there is nothing to place: give a table with x, y, z")]
    NoPosition {
        /// The layer.
        name: String,
        /// The column that is missing.
        column: &'static str,
    },
    /// A position or radius that is not a number.
    #[error("{name}: row {row}: {column} is {value}: remove the row or repair what wrote it")]
    NotFinite {
        /// The layer.
        name: String,
        /// Row, from 0.
        row: usize,
        /// The column.
        column: &'static str,
        /// What stands there.
        value: f64,
    },
    /// Nothing at all to draw.
    #[error("nothing to show: no input has a sphere or a point in it")]
    Empty,
    /// A page beyond its limit, though every frame but two is left out.
    #[error(
        "{name}: {count} spheres or points, {frames} of its frames: a page of {megabytes:.0} MB, and the limit is {limit} MB: \
         give --max-mb {megabytes:.0} (a browser takes a few hundred), or show fewer: a part of the cloud, a picture"
    )]
    TooBig {
        /// The layer.
        name: String,
        /// Spheres of its last frame.
        count: usize,
        /// Frames that cannot be left out.
        frames: usize,
        /// What the page would take, at least [MB].
        megabytes: f64,
        /// What it may take [MB].
        limit: f64,
    },
    /// A field to colour by that no layer has.
    #[error("colour: no field '{name}' here: choose one of {}", known.join(", "))]
    NoField {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A view direction that cannot be read.
    #[error(
        "camera '{text}': {problem}: give iso, top, bottom, front, back, left, right, the side of the eye (x, -x, y, -y, z, \
         -z), its azimuth/elevation in degrees (35/20), or its x,y,z [m] and, after it, those of the point looked at"
    )]
    Camera {
        /// As given.
        text: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// A picture size out of range.
    #[error("picture of {width} x {height} pixels: give 64 to 16384 each way")]
    Size {
        /// Width [pixel].
        width: u32,
        /// Height [pixel].
        height: u32,
    },
    /// The PNG encoder failed.
    #[error("cannot encode the picture as PNG")]
    Png(#[source] png::EncodingError),
    /// The GIF encoder failed.
    #[error("cannot encode the film as GIF")]
    Gif(#[source] gif::EncodingError),
    /// A file that a moment of a run was to be kept in.
    #[error("{file}: cannot write")]
    Keep {
        /// The file.
        file: String,
        /// Why.
        #[source]
        source: std::io::Error,
    },
}
