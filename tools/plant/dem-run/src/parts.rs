//! Runs that did not come to their end: what they leave as `NAME.part`, and how it is found again.

use crate::continued;
use cli::{Output, Source};
use std::path::{Path, PathBuf};

/// Says which parts of the output are there, but for the one that is resumed.
pub fn say(output: &Output, resumed: Option<&Source>) {
    let Some(path) = output.path() else { return };
    let resumed = resumed.and_then(Source::path).and_then(|p| p.canonicalize().ok());
    for (part, written) in cli::parts_of(path) {
        if part.canonicalize().ok().is_some_and(|p| Some(p) == resumed) {
            continue;
        }
        let (name, part) = (path.display(), part.display());
        cli::warn(&if written {
            format!(
                "another dem-run is writing {name} ({part}): the run that ends last will replace the other one"
            )
        } else {
            format!(
                "{part} is the output of an unfinished run: --resume {part} continues it, dem-view shows it; a resumed run \
                 starts at its last checkpoint, so remove the file only if you do not need the time before that"
            )
        });
    }
}

/// What `--resume FILE` means: the file, or, where there is none, the part that a run of this name has left.
///
/// # Errors
/// Several parts, a part that is still being written.
pub fn resumed(source: &Source) -> anyhow::Result<Source> {
    let Some(path) = source.path() else { return Ok(source.clone()) };
    let parts = match path.exists() {
        // Also by another name: a link.
        true => vec![(path.to_owned(), cli::is_written(path))],
        false => cli::parts_of(path),
    };
    if let Some((part, _)) = parts.iter().find(|part| part.1) {
        let part = part.display();
        anyhow::bail!(
            "--resume {source}: another dem-run is still writing {part}: wait for its end, or stop it"
        );
    }
    if path.exists() {
        return Ok(source.clone());
    }
    let parts: Vec<PathBuf> = parts.into_iter().map(|part| part.0).collect();
    match &parts[..] {
        [] => Ok(source.clone()),
        [part] => {
            cli::warn(&format!(
                "{source} does not exist; resuming from {}, the unfinished output of its run",
                part.display()
            ));
            Ok(Source::File(part.clone()))
        }
        _ => {
            let names: Vec<String> = parts.iter().map(|part| part.display().to_string()).collect();
            anyhow::bail!(
                "--resume {source}: not found, but there are {}: name one of them",
                names.join(", ")
            )
        }
    }
}

/// How far the part of a run that failed is of use.
#[derive(Debug, Clone, Copy, Default)]
pub struct Saved {
    /// Time of the last frame or checkpoint in it [s].
    pub time: f64,
    /// Whether it holds a checkpoint.
    pub resumes: bool,
}

impl Saved {
    /// What the part is good for.
    pub fn use_of(&self, part: &Path) -> String {
        if self.resumes { continued::sentence(part, &[]) } else { "dem-view shows it".to_owned() }
    }
}
