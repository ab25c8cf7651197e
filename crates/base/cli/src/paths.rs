//! Values of the command line that name files, as types: what a tool writes and what it may read is known of every option.

use clap::builder::{
    MapValueParser, PathBufValueParser, StringValueParser, TypedValueParser, ValueParserFactory,
};
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// A file or folder that a tool writes. As a clap argument: `#[arg(long, value_name = "FILE")] plot: Option<cli::OutPath>`. No such file may be an input of the same
/// call, and its name changes no result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutPath(PathBuf);

impl From<&Path> for OutPath {
    fn from(path: &Path) -> OutPath {
        OutPath(path.to_owned())
    }
}

impl Deref for OutPath {
    type Target = Path;
    fn deref(&self) -> &Path {
        &self.0
    }
}

impl AsRef<Path> for OutPath {
    fn as_ref(&self) -> &Path {
        self
    }
}

impl ValueParserFactory for OutPath {
    type Parser = MapValueParser<PathBufValueParser, fn(PathBuf) -> OutPath>;
    fn value_parser() -> Self::Parser {
        PathBufValueParser::new().map(OutPath)
    }
}

/// A text that may name a file to read: `0.002` or `regions.toml`, `data.csv` or `heap=data.csv`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MaybeFile(String);

impl MaybeFile {
    /// The text as it was given.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// What may be the name of a file in it: all of it, or what stands behind the first `=`.
    pub(crate) fn names(text: &str) -> impl Iterator<Item = &str> {
        [text].into_iter().chain(text.split_once('=').map(|(_, file)| file))
    }
}

impl ValueParserFactory for MaybeFile {
    type Parser = MapValueParser<StringValueParser, fn(String) -> MaybeFile>;
    fn value_parser() -> Self::Parser {
        StringValueParser::new().map(MaybeFile)
    }
}
