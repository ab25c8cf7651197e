//! Inputs: a file, or `-` for stdin, with the name that messages use.

use crate::exit::usage;
use anyhow::Context;
use geom::number::NumberError;
use std::{
    convert::Infallible,
    ffi::OsString,
    fmt,
    fs::File,
    io::{self, IsTerminal, Read},
    os::fd::AsFd,
    path::{Path, PathBuf},
    str::FromStr,
};
use stream::mcap::{Event, McapError};

/// A file or stdin. As a clap argument: `#[arg(value_name = "RUN.mcap", default_value = "-")] run: cli::Source`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// `-`
    Stdin,
    /// A path.
    File(PathBuf),
}

impl FromStr for Source {
    type Err = Infallible;
    fn from_str(text: &str) -> Result<Source, Infallible> {
        Ok(if text == "-" { Source::Stdin } else { Source::File(PathBuf::from(text)) })
    }
}

/// Names of files are bytes, not text.
impl From<OsString> for Source {
    fn from(name: OsString) -> Source {
        if name == "-" { Source::Stdin } else { Source::File(PathBuf::from(name)) }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Source::Stdin => f.write_str("stdin"),
            Source::File(path) => write!(f, "{}", path.display()),
        }
    }
}

impl Source {
    /// Refuses that more than one of the inputs is stdin: the first would leave nothing for the others.
    ///
    /// # Errors
    /// Wrong usage.
    pub fn one_stdin<'a>(sources: impl IntoIterator<Item = &'a Source>) -> anyhow::Result<()> {
        if sources.into_iter().filter(|source| **source == Source::Stdin).count() > 1 {
            return Err(usage("-: stdin can be only one of the inputs: give files for the others"));
        }
        Ok(())
    }

    /// Opens the source; a pipe can be read while it is still being written. Messages of an MCAP file are put in the order of time.
    ///
    /// # Errors
    /// No such file; stdin is a terminal (wrong usage).
    pub fn open(&self) -> anyhow::Result<Box<dyn Read + Send>> {
        match self {
            Source::Stdin if io::stdin().is_terminal() => Err(usage(
                "stdin is a terminal: give a file, or pipe the output of another tool into this one",
            )),
            // Past the buffer of `std::io::Stdin`, which would cut every read into small ones.
            Source::Stdin => {
                let stdin = io::stdin().as_fd().try_clone_to_owned().context("stdin: cannot open it")?;
                crate::output::widen(&stdin);
                Ok(Box::new(File::from(stdin)))
            }
            Source::File(path) if path.is_dir() => {
                Err(anyhow::anyhow!("{self}: is a folder: name a file in it"))
            }
            Source::File(path) => {
                let file = stream::whole::open(path).map_err(|e| match e.kind() {
                    io::ErrorKind::InvalidInput => anyhow::anyhow!("{self}: {e}"),
                    _ => anyhow::Error::new(e).context(self.missing(path)),
                })?;
                stream::mcap::in_order(file).with_context(|| format!("{self}: cannot read"))
            }
        }
    }

    /// What to do about a file that cannot be opened.
    fn missing(&self, path: &Path) -> String {
        match crate::parts_of(path).pop() {
            Some((part, _)) if !path.exists() => {
                format!("{self}: its run has not ended; what it wrote is in {}", part.display())
            }
            _ => format!("{self}: cannot open it (check the path, '-' is stdin)"),
        }
    }

    /// Reads everything.
    ///
    /// # Errors
    /// As [`Source::open`]; a read that fails.
    pub fn read_all(&self) -> anyhow::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        stream::whole::rest(&mut self.open()?, &mut bytes).with_context(|| format!("{self}: cannot read"))?;
        Ok(bytes)
    }

    /// Reads everything as text.
    ///
    /// # Errors
    /// As [`Source::open`]; a read that fails; too much, or bytes that are not UTF-8.
    pub fn read_text(&self) -> anyhow::Result<String> {
        stream::whole::rest_of_text(&mut self.open()?).map_err(|e| match e.kind() {
            io::ErrorKind::InvalidData => anyhow::anyhow!("{self}: {e}: is it the right file?"),
            _ => anyhow::Error::new(e).context(format!("{self}: cannot read")),
        })
    }

    /// An event of this stream; `None` where a file breaks off whose name says that it is unfinished: what is there is read, and a
    /// warning says that it is incomplete.
    ///
    /// # Errors
    /// Those of the stream.
    pub fn as_far_as_it_goes(&self, event: Result<Event, McapError>) -> Result<Option<Event>, McapError> {
        match event {
            Err(McapError::Truncated { messages, .. }) if self.path().is_some_and(crate::is_part) => {
                crate::warn(&format!(
                    "{self}: the run did not end; this is what it wrote, {}",
                    geom::counted(messages, "message")
                ));
                Ok(None)
            }
            other => other.map(Some),
        }
    }

    /// The path, when it is a file.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Source::Stdin => None,
            Source::File(path) => Some(path),
        }
    }
}

/// What a length in a file is: flatten it into the arguments of a tool that reads geometry.
#[derive(Debug, Clone, clap::Args)]
pub struct Lengths {
    /// Multiply coordinates as they are read: 0.001 for millimetres
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    pub scale: Option<f64>,
    /// Unit of the coordinates: mm, cm, m, in or ft; instead of --scale
    #[arg(long, value_name = "UNIT", value_parser = unit, conflicts_with = "scale")]
    pub units: Option<f64>,
}

impl Lengths {
    /// The factor that makes the lengths of a file metres [–], if one was given.
    pub fn factor(&self) -> Option<f64> {
        self.scale.or(self.units)
    }
}

fn unit(text: &str) -> Result<f64, String> {
    geom::units::factor(text, "m").map_err(|_| "give mm, cm, m, in or ft".into())
}

fn factor(text: &str) -> Result<f64, String> {
    geom::number::positive(text).map_err(|e| match e {
        NumberError::TooLarge(_) => e.to_string(),
        _ => "give a number above 0, such as 0.001 for millimetres".into(),
    })
}
