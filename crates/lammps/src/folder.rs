//! A folder that keeps a deck, its dumps, and the states from which LAMMPS goes on.
//!
//! ```text
//! run.in particles.data     the deck
//! state_1 state_2           states, in turn: the newest may be torn, the other one is whole then
//! frames.dump frames-2.dump …  frames of the first start, of the second …; zone.dump … likewise
//! ```

use crate::deck::{Deck, FRAMES, STATES, ZONE};
use crate::dump::Parts;
use crate::error::{LammpsError, Result};
use dem::setup::Setup;
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// How a state that is whole ends.
pub const END: &str = "LammpS RestartT\0";

/// From where LAMMPS goes on.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    /// The state; none: from the beginning.
    pub state: Option<&'static str>,
    /// Which start it is, from 1.
    pub number: usize,
}

/// The name of a dump of a start: `frames.dump`, then `frames-2.dump`.
fn part(dump: &Path, number: usize) -> PathBuf {
    match number {
        1 => dump.to_owned(),
        n => {
            let stem = dump.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let ending = dump.extension().map_or(String::new(), |e| format!(".{}", e.to_string_lossy()));
            dump.with_file_name(format!("{stem}-{n}{ending}"))
        }
    }
}

/// All parts of a dump that are there.
fn parts(dump: &Path) -> impl Iterator<Item = PathBuf> {
    (1..).map(|n| part(dump, n)).take_while(|path| path.exists())
}

/// A dump with the parts of later starts.
///
/// # Errors
/// A file that cannot be opened.
pub fn open<'a>(dump: &Path) -> io::Result<Parts<'a>> {
    let mut all: Parts = vec![Box::new(BufReader::new(File::open(dump)?))];
    for path in parts(dump).skip(1) {
        all.push(Box::new(BufReader::new(File::open(path)?)));
    }
    Ok(all)
}

/// Readies a folder: a new one gets the deck; one that holds it goes on from its newest state that is whole.
///
/// # Errors
/// A folder of another deck, or one that cannot be used.
pub fn ready(deck: &Deck, setup: &Setup, folder: &Path) -> Result<Start> {
    let failed = |error| LammpsError::Deck { folder: folder.display().to_string(), error };
    let used = folder.is_dir() && fs::read_dir(folder).map_err(failed)?.next().is_some();
    if !used {
        deck.write(setup, folder)?;
        return Ok(Start { state: None, number: 1 });
    }
    if !deck.is_in(setup, folder).map_err(failed)? {
        return Err(LammpsError::OtherDeck { folder: folder.display().to_string() });
    }
    let state = newest(folder).map_err(failed)?;
    let dumps = [FRAMES, ZONE].map(|name| folder.join(name));
    if state.is_none() {
        // What was computed before the first state is computed again.
        dumps.iter().flat_map(|d| parts(d)).try_for_each(fs::remove_file).map_err(failed)?;
    }
    Ok(Start { state, number: parts(&dumps[0]).count() + 1 })
}

/// The newest state that is whole.
fn newest(folder: &Path) -> io::Result<Option<&'static str>> {
    let mut found = Vec::new();
    for name in STATES {
        let path = folder.join(name);
        if path.exists() && is_whole(&mut File::open(&path)?)? {
            found.push((fs::metadata(&path)?.modified()?, name));
        }
    }
    Ok(found.into_iter().max().map(|newest| newest.1))
}

fn is_whole(state: &mut File) -> io::Result<bool> {
    let length = state.metadata()?.len();
    let Some(from) = length.checked_sub(END.len() as u64) else { return Ok(false) };
    state.seek(SeekFrom::Start(from))?;
    let mut end = [0; END.len()];
    state.read_exact(&mut end)?;
    Ok(end == END.as_bytes())
}

/// A dump on its way from LAMMPS, which is kept in a file, behind what earlier starts have left.
///
/// # Errors
/// Files that cannot be opened or made.
pub fn kept<'a>(
    dump: &Path,
    start: &Start,
    live: impl Read + Send + 'a,
    capacity: usize,
) -> io::Result<Parts<'a>> {
    let mut all: Parts = if start.number > 1 { open(dump)? } else { Vec::new() };
    let copy = Copy { live, file: File::create(part(dump, start.number))? };
    all.push(Box::new(BufReader::with_capacity(capacity, copy)));
    Ok(all)
}

/// What is read, written to a file as well.
struct Copy<R> {
    live: R,
    file: File,
}

impl<R: Read> Read for Copy<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let n = self.live.read(bytes)?;
        self.file.write_all(&bytes[..n])?;
        Ok(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_numbered_and_only_whole_states_count() {
        assert_eq!(part(Path::new("a/frames.dump"), 1), Path::new("a/frames.dump"));
        assert_eq!(part(Path::new("a/frames.dump"), 3), Path::new("a/frames-3.dump"));
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: &[u8]| fs::write(folder.path().join(name), text).unwrap();
        assert_eq!(newest(folder.path()).unwrap(), None);
        put("state_1", &[b"numbers", END.as_bytes()].concat());
        std::thread::sleep(std::time::Duration::from_millis(20));
        put("state_2", b"numb");
        assert_eq!(newest(folder.path()).unwrap(), Some("state_1"));
        put("state_2", &[b"numbers", END.as_bytes()].concat());
        assert_eq!(newest(folder.path()).unwrap(), Some("state_2"));
    }
}
