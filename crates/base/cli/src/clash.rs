//! Refuses outputs that would replace an input of the same call, or each other.

use crate::{
    Source,
    exit::usage,
    target::{folder, target},
};
use anyhow::Context;
use clap::{Arg, ArgMatches, Command};
use std::{
    path::{Path, PathBuf},
    sync::OnceLock,
};

/// Options that name a file to write, in any tool: id and flag. None of them changes the result.
const OUTPUTS: [(&str, &str); 15] = [
    ("output", "-o"),
    ("report", "--report"),
    ("plot", "--plot"),
    ("changes", "--changes"),
    ("mesh", "--mesh"),
    ("words", "--words"),
    ("places", "--places"),
    ("surfaces", "--surfaces"),
    ("rigid", "--rigid"),
    ("sheet", "--sheet"),
    ("jobs_file", "--jobs-file"),
    ("samples", "--samples"),
    ("page", "--page"),
    ("design", "--design"),
    ("write_deck", "--write-deck"),
];

/// A file that the running tool will write.
struct OutputFile {
    flag: &'static str,
    path: PathBuf,
    /// Its one name.
    file: PathBuf,
}

static WRITTEN: OnceLock<Vec<OutputFile>> = OnceLock::new();

/// Refuses an output of the command line that is also one of its inputs, or another output.
///
/// # Errors
/// Wrong usage.
pub(crate) fn refuse(command: &Command, matches: &ArgMatches) -> anyhow::Result<()> {
    let outputs = outputs(matches);
    for (n, later) in outputs.iter().enumerate() {
        if let Some(earlier) = outputs[..n].iter().find(|earlier| earlier.file == later.file) {
            let (flag, path) = (later.flag, later.path.display());
            return Err(usage(format!("{flag} {path} is also {}: choose another name", earlier.flag)));
        }
    }
    let outputs = WRITTEN.get_or_init(|| outputs);
    let inputs: Vec<PathBuf> =
        command.get_arguments().flat_map(|argument| read_by(argument, matches)).collect();
    against(outputs, inputs.iter().cloned())?;
    note(inputs.into_iter().chain(stream::reads::stdin()))
}

/// Adds files to the record of what this command reads, where one is kept ([`stream::reads`]).
fn note(files: impl IntoIterator<Item = PathBuf>) -> anyhow::Result<()> {
    stream::reads::note(files).with_context(|| format!("{}: cannot write there", stream::reads::VARIABLE))
}

/// Refuses an output of the command line that is one of `files`, which the tool is about to read: those that a scene names. They are noted as read.
///
/// # Errors
/// Wrong usage.
pub fn also_reads(files: impl IntoIterator<Item = PathBuf>) -> anyhow::Result<()> {
    let files: Vec<PathBuf> = files.into_iter().collect();
    WRITTEN.get().map_or(Ok(()), |outputs| against(outputs, files.iter().cloned()))?;
    note(files)
}

fn against(outputs: &[OutputFile], inputs: impl IntoIterator<Item = PathBuf>) -> anyhow::Result<()> {
    if outputs.is_empty() {
        return Ok(());
    }
    for input in inputs {
        let Some(file) = real(&input) else { continue };
        if let Some(OutputFile { flag, path, .. }) = outputs.iter().find(|output| output.file == file) {
            let known = path.file_name() == input.file_name();
            let (path, input) = (path.display(), input.display());
            let also = if known { String::new() } else { format!(" ({input})") };
            return Err(usage(format!("{flag} {path} is also an input{also}: choose another name")));
        }
    }
    Ok(())
}

fn outputs(matches: &ArgMatches) -> Vec<OutputFile> {
    let named = |&(id, flag): &(&str, &'static str)| {
        let path = matches.try_get_one::<PathBuf>(id).ok().flatten()?.clone();
        let file = if flag == "-o" && path == Path::new("-") { None } else { written(&path) };
        file.map(|file| OutputFile { flag, path, file })
    };
    OUTPUTS.iter().filter_map(named).collect()
}

/// Whether an argument names a file to write. What has no flag is an input, whatever its name.
pub(crate) fn is_output(argument: &Arg) -> bool {
    !argument.is_positional() && OUTPUTS.iter().any(|output| output.0 == argument.get_id().as_str())
}

/// The files that an argument names for reading; what is none does no harm.
fn read_by(argument: &Arg, matches: &ArgMatches) -> Vec<PathBuf> {
    let id = argument.get_id().as_str();
    if is_output(argument) {
        return Vec::new();
    }
    let values = matches.try_get_raw(id).ok().flatten().into_iter().flatten();
    let whole = argument.is_positional()
        || matches!(matches.try_get_many::<Source>(id), Ok(Some(_)))
        || argument.get_value_names().is_some_and(|names| names.iter().any(|name| name.contains("FILE")));
    let path = |value: &std::ffi::OsStr| match whole {
        true => vec![PathBuf::from(value)],
        false => {
            let text = value.to_str().unwrap_or_default().trim();
            geom::shape::files_of(text).into_iter().map(PathBuf::from).collect()
        }
    };
    values.flat_map(path).collect()
}

/// The one name of a file; devices and pipes are not replaced by an output and have none.
fn real(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().filter(|path| path.is_file())
}

/// The same for a file that may not exist yet.
fn written(path: &Path) -> Option<PathBuf> {
    if path.exists() {
        return real(path);
    }
    let target = target(path).ok()?;
    Some(folder(&target).canonicalize().ok()?.join(target.file_name()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `stone-clump MESH` reads what `cloud-fill --mesh` writes.
    #[test]
    fn an_argument_without_a_flag_is_read_whatever_its_name() {
        let read = |argument: Arg, given: [&str; 2]| {
            let command = Command::new("tool").arg(argument.value_parser(clap::value_parser!(PathBuf)));
            let given = [&["tool"], &given[..]].concat().into_iter().filter(|word| !word.is_empty());
            let matches = command.clone().try_get_matches_from(given).unwrap();
            command.get_arguments().flat_map(|a| read_by(a, &matches)).collect::<Vec<_>>()
        };
        assert_eq!(read(Arg::new("mesh"), ["stone.ply", ""]), [Path::new("stone.ply")]);
        assert!(read(Arg::new("mesh").long("mesh").value_name("FILE"), ["--mesh", "stone.ply"]).is_empty());
        assert_eq!(
            read(Arg::new("other").long("other").value_name("FILE"), ["--other", "a.ply"]),
            [Path::new("a.ply")]
        );
    }
}
