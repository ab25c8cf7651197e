//! Errors: what cannot be shown, and why.

use thiserror::Error;

/// Why no page or picture was made.
#[derive(Debug, Error)]
pub enum ViewError {
    /// A table without positions.
    #[error("{name}: no column '{column}': give a table with x, y, z")]
    NoPosition {
        /// The layer.
        name: String,
        /// The column that is missing.
        column: &'static str,
    },
    /// A position or radius that is not a number.
    #[error("{name}: row {row}: {column} is {value}: remove the row, or repair the program that wrote it")]
    NotFinite {
        /// The layer.
        name: String,
        /// Row, from 0.
        row: usize,
        column: &'static str,
        /// What stands there.
        value: f64,
    },
    /// A sphere without a size.
    #[error("{name}: row {row}: radius {value} m must be above 0: remove the row, or write the file again")]
    Radius {
        /// The layer.
        name: String,
        /// Row, from 0.
        row: usize,
        /// What stands there [m].
        value: f64,
    },
    /// Nothing at all to draw.
    #[error(
        "nothing to show: no sphere and no point in the inputs, or in the time that --from, --to and --every choose"
    )]
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
    /// A run without what is asked for.
    #[error("{option}: run holds no {what}: {cure}")]
    NoSuch {
        /// The option that asks for it.
        option: String,
        /// What is missing.
        what: &'static str,
        cure: &'static str,
    },
    /// A message without its columns.
    #[error("{topic}: columns are missing: write the run with dem-run")]
    Columns { topic: &'static str },
    /// A message of wear that cannot be read.
    #[error(
        "/wall_wear at {} s: {why}: the run is damaged here: show it without --walls-colour, or run again",
        geom::Shown(*time)
    )]
    Wear { time: f64, why: String },
    /// A map of nothing.
    #[error(
        "--walls-colour: no grain has touched a triangle or wall sphere so far, so there is nothing to colour: run longer, or leave it out"
    )]
    Untouched,
    /// Columns that do not make a table.
    #[error("cannot make a table of what is shown: {why}")]
    Table {
        /// What is wrong.
        why: String,
    },
    /// A field that no layer has.
    #[error("{what}: no field '{name}' here: choose one of {}", known.join(", "))]
    NoField {
        what: &'static str,
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// Something to hide that is not there.
    #[error("--hide: no '{name}' here: choose one of {}", known.join(", "))]
    NoHidden { name: String, known: Vec<String> },
    /// A material that the run does not have.
    #[error("only: no material '{name}' here: {}", match known.len() {
        0 => "materials have numbers alone, so give one, such as material=1".to_owned(),
        _ => format!("choose one of {}", known.join(", ")),
    })]
    NoMaterial {
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
        file: String,
        /// Why.
        #[source]
        source: std::io::Error,
    },
    /// A stream that cannot be read.
    #[error(transparent)]
    Mcap(#[from] stream::mcap::McapError),
    /// An MCAP without anything to show.
    #[error("no /particles and no /walls in this MCAP, but {}: give a run or walls", seen(others))]
    NoTopic {
        /// Topics of its point clouds.
        others: Vec<String>,
    },
    /// A message of the topic `/surfaces` that cannot be read.
    #[error("/surfaces: {0}")]
    Surfaces(String),
    /// MP4 without ffmpeg.
    #[error(
        "MP4 is packed by the program ffmpeg, which is not on the PATH: install it (apt install ffmpeg, brew install ffmpeg), or \
         write a .gif, which needs no other program"
    )]
    NoFfmpeg,
    /// ffmpeg failed.
    #[error("ffmpeg {why}")]
    Ffmpeg {
        /// Its last words.
        why: String,
    },
    /// A folder that is in the way of a series.
    #[error(
        "{folder}: exists and would be replaced, but holds '{file}', which {list} does not list: move it elsewhere, or give another name with -o"
    )]
    NotSeries {
        folder: String,
        /// The first file that is not of the series.
        file: String,
        /// The collection that lists its files.
        list: String,
    },
    /// A file or pipe that cannot be used.
    #[error("{what}")]
    Io {
        /// The file, and what cannot be done with it.
        what: String,
        /// Why.
        #[source]
        source: std::io::Error,
    },
}

impl ViewError {
    /// The error of an operation on a file or pipe.
    pub(crate) fn io(what: impl Into<String>) -> impl FnOnce(std::io::Error) -> ViewError {
        let what = what.into();
        move |source| ViewError::Io { what, source }
    }
}

fn seen(others: &[String]) -> String {
    if others.is_empty() { "no point clouds at all".to_owned() } else { others.join(", ") }
}
