//! Refuses outputs that would replace an input of the same call, or each other.

use crate::{
    MaybeFile, OutPath, Source,
    exit::usage,
    placing::Matrix,
    target::{folder, target},
};
use anyhow::Context;
use clap::{Arg, ArgMatches, Command};
use std::{
    any::TypeId,
    ffi::OsStr,
    path::{Path, PathBuf},
    sync::OnceLock,
};

/// A file that the running tool will write.
struct OutputFile {
    flag: String,
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
    let outputs = outputs(command, matches);
    for (n, later) in outputs.iter().enumerate() {
        if let Some(earlier) = outputs[..n].iter().find(|earlier| earlier.file == later.file) {
            let (flag, path) = (&later.flag, later.path.display());
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

/// The files that the command line names for writing, the main output first.
fn outputs(command: &Command, matches: &ArgMatches) -> Vec<OutputFile> {
    let named = |argument: &Arg| {
        let path = matches.try_get_one::<OutPath>(argument.get_id().as_str()).ok().flatten()?.to_path_buf();
        let flag = match (argument.get_short(), argument.get_long()) {
            (Some(short), _) => format!("-{short}"),
            (None, long) => format!("--{}", long.unwrap_or_default()),
        };
        let file = if flag == "-o" && path == Path::new("-") { None } else { written(&path) };
        file.map(|file| OutputFile { flag, path, file })
    };
    let mut all: Vec<OutputFile> =
        command.get_arguments().filter(|a| is_output(a)).filter_map(named).collect();
    all.sort_by_key(|output| output.flag != "-o");
    all
}

/// Whether the value of an argument has this type.
fn holds<T: 'static>(argument: &Arg) -> bool {
    argument.get_value_parser().type_id() == TypeId::of::<T>()
}

/// Whether an argument names a file or folder to write.
pub(crate) fn is_output(argument: &Arg) -> bool {
    holds::<OutPath>(argument)
}

/// The files that an argument names for reading; what is none does no harm.
fn read_by(argument: &Arg, matches: &ArgMatches) -> Vec<PathBuf> {
    let values = matches.try_get_raw(argument.get_id().as_str()).ok().flatten().into_iter().flatten();
    let is_path = holds::<Source>(argument) || holds::<PathBuf>(argument) || argument.is_positional();
    let may_be = holds::<MaybeFile>(argument) || holds::<Matrix>(argument);
    let paths = |value: &OsStr| -> Vec<PathBuf> {
        let text = value.to_str().unwrap_or_default().trim();
        match (is_output(argument), is_path, may_be) {
            (true, _, _) => Vec::new(),
            (_, true, _) => vec![PathBuf::from(value)],
            (_, _, true) => MaybeFile::names(text).map(PathBuf::from).collect(),
            _ => geom::shape::files_of(text).into_iter().map(PathBuf::from).collect(),
        }
    };
    values.flat_map(paths).collect()
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
    use clap::value_parser;

    /// `stone-clump MESH` reads what `cloud-fill --mesh` writes.
    #[test]
    fn the_type_of_a_value_tells_what_is_read_and_what_is_written() {
        let mesh = || Arg::new("mesh");
        let read = |argument: Arg, given: &[&str]| {
            let command = Command::new("tool").arg(argument);
            let matches = command.clone().try_get_matches_from([&["tool"][..], given].concat()).unwrap();
            let written = outputs(&command, &matches).len();
            (command.get_arguments().flat_map(|a| read_by(a, &matches)).collect::<Vec<_>>(), written)
        };
        let stone = || vec![PathBuf::from("stone.ply")];
        assert_eq!(read(mesh().value_parser(value_parser!(PathBuf)), &["stone.ply"]), (stone(), 0));
        let option = || mesh().long("mesh");
        assert_eq!(
            read(option().value_parser(value_parser!(OutPath)), &["--mesh", "stone.ply"]),
            (vec![], 1)
        );
        assert_eq!(
            read(option().value_parser(value_parser!(PathBuf)), &["--mesh", "stone.ply"]),
            (stone(), 0)
        );
        let (files, _) = read(option().value_parser(value_parser!(MaybeFile)), &["--mesh", "a=stone.ply"]);
        assert_eq!(files[1..], stone());
        assert_eq!(read(option(), &["--mesh", "stone.ply"]), (vec![], 0));
    }
}
