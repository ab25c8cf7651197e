//! What a run that fails leaves as `NAME.part`.

use cli::{NotRenamed, Output};
use std::path::{Path, PathBuf};

/// The path of a part as the user would write it; that of a link lies beside its target.
pub fn as_named(output: &Output, part: Option<&Path>) -> Option<PathBuf> {
    let (path, part) = (output.path()?, part?);
    let named = path.with_file_name(part.file_name()?);
    Some(if path.is_symlink() { part.to_owned() } else { named })
}

/// What a run that fails says of the part that it leaves, with frames until a time [s].
pub fn leaves(error: anyhow::Error, part: Option<&Path>, saved: f64) -> anyhow::Error {
    // A complete output that has no name says so itself.
    let whole = error.chain().any(|cause| cause.is::<NotRenamed>());
    let Some(part) = part.filter(|part| part.is_file() && !whole) else { return error };
    let (time, part) = (geom::Shown(saved), part.display());
    error.context(format!("the run until t = {time} s is kept in {part} (dem-view shows it)"))
}
