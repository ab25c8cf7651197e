//! Files of a table of wear, and what is wrong with them.

use thiserror::Error;

/// Files beside the one that names them: text, and meshes.
pub type Load<'a, T> = &'a dyn Fn(&str) -> Result<T, String>;

/// What is wrong with a table of wear.
#[derive(Debug, Error, Clone, PartialEq)]
pub enum WearError {
    #[error(
        "wear: give one of measured = \"PROPERTY\", drawing = \"MESH\", value = NUMBER; {given} are given"
    )]
    WearSource { given: usize },
    #[error("wear: along = {along:?} has no direction: give one, such as [1, 0, 0]")]
    Along { along: [f64; 3] },
    #[error("wear: {file}: {why}")]
    File { file: String, why: String },
    #[error("wear: {file}: line {line}: {what}: '{text}'")]
    Line { file: String, line: usize, what: &'static str, text: String },
    #[error(
        "wear: run = \"{0}\": its column is not named: add measured = \"sliding_work\", and leave drawing and value out"
    )]
    RunColumn(String),
    #[error("wear: value {0}: must be finite")]
    Value(f64),
    #[error(
        "wear: the cloud has no property '{0}': name the one that holds the measurement; see the file's header"
    )]
    NoProperty(String),
    #[error(
        "wear: point {point} has no measurement ({found}), and the file has no `roughness` for such points: add it"
    )]
    NotMeasured { point: usize, found: f64 },
}
