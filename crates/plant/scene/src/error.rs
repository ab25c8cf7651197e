//! Errors of scenes and of the files that they name.

use record::RecordError;
use std::fmt;
use std::path::Path;
use thiserror::Error;

/// A place in a scene file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Place {
    /// The file, as it was named.
    pub file: String,
    /// Line and column, from 1; `None` when the key is not written in the file.
    pub at: Option<(usize, usize)>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.at {
            Some((line, column)) => write!(f, "{}:{line}:{column}", self.file),
            None => f.write_str(&self.file),
        }
    }
}

/// Why a scene cannot be run.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum SceneError {
    #[error("{name}: cannot read the file")]
    Read { name: String, source: std::io::Error },
    #[error("{place}: {key}: {name}: cannot read the file")]
    Named { place: Place, key: String, name: String, source: std::io::Error },
    #[error("{place}: {message}")]
    Syntax { place: Place, message: String },
    #[error("{place}: unknown key '{key}'{hint}")]
    UnknownKey { place: Place, key: String, hint: String },
    #[error("{place}: not available yet: '{key}'; {instead}")]
    NotYet { place: Place, key: String, instead: &'static str },
    #[error(transparent)]
    Value(Box<ValueError>),
    #[error("--set {text}: {why}")]
    Override { text: String, why: String },
    #[error(transparent)]
    File(#[from] RecordError),
    #[error("{name}: particle {id} starts inside {partner} (overlap {overlap:.3e} m): move it")]
    Inside { name: String, id: u32, partner: String, overlap: f64 },
    #[error("{name}: cannot be read as {wanted}")]
    Content { name: String, wanted: &'static str, source: Box<dyn std::error::Error + Send + Sync + 'static> },
}

/// What can fail because of a scene.
pub type Result<T, E = SceneError> = std::result::Result<T, E>;

/// A value that a key cannot have.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{place}: {key} = {value}: {why}; {cure}")]
pub struct ValueError {
    /// Where it is written.
    pub place: Place,
    /// The dotted key.
    pub key: String,
    /// The value and its unit.
    pub value: String,
    /// What is wrong with it.
    pub why: String,
    /// What to do.
    pub cure: String,
}

impl SceneError {
    /// The same error at another place.
    pub(crate) fn at(mut self, there: Place) -> SceneError {
        use SceneError::{NotYet, Syntax, UnknownKey};
        if let Syntax { place, .. } | UnknownKey { place, .. } | NotYet { place, .. } = &mut self {
            *place = there;
        }
        self
    }

    /// The message without the place.
    pub(crate) fn without_place(&self) -> String {
        match self {
            SceneError::Syntax { message, .. } => message.clone(),
            SceneError::UnknownKey { key, hint, .. } => format!("{key}{hint}"),
            other => other.to_string(),
        }
    }

    /// A file that holds something else than wanted.
    pub fn file(name: &str, why: impl Into<String>, cure: impl Into<String>) -> SceneError {
        SceneError::File(RecordError::new(name, why, cure))
    }

    /// A file that cannot be read.
    pub fn read(path: &Path, source: std::io::Error) -> SceneError {
        SceneError::Read { name: path.display().to_string(), source }
    }

    /// A file that cannot be read as what is wanted.
    pub fn content(
        name: &str,
        wanted: &'static str,
        source: impl std::error::Error + Send + Sync + 'static,
    ) -> SceneError {
        SceneError::Content { name: name.to_owned(), wanted, source: Box::new(source) }
    }
}

/// The known name nearest to `name`, when one is near enough to suggest: a third of its letters may differ, or whole words may be missing.
pub fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let words = |text: &'a str| text.split('_');
    let distance = |k: &'a str| (strsim::damerau_levenshtein(name, k), k);
    let near = |&(d, k): &(usize, &'a str)| {
        let longest = name.chars().count().max(k.chars().count());
        (d <= 1.max(longest / 3) && d < longest) || (longest > 3 && words(k).any(|word| word == name))
    };
    known.filter(|k| !k.is_empty()).map(distance).filter(near).min().map(|(_, k)| k)
}

/// A number with all its digits, or with an exponent where these would be many.
pub(crate) fn shown(value: f64) -> String {
    let usual = value == 0.0 || !value.is_finite() || (1e-9..1e16).contains(&value.abs());
    if usual { value.to_string() } else { format!("{value:e}") }
}
