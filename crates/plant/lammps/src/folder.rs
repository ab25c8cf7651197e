//! A folder that keeps a deck, its dumps, and the states from which LAMMPS goes on.
//!
//! ```text
//! run.in particles.data        the deck
//! state_1 state_2              states, in turn: the newest may be torn, the other one is whole then
//! frames.dump frames-2.dump …  frames of the first start, of the second …; the other dumps likewise
//! finished                     the last step was reached
//! lock                         held by dem-lammps and by its LAMMPS, as long as one of them lives
//! ```
//!
//! LAMMPS writes the dumps itself, so that none of them is lost with dem-lammps, which follows them.

use crate::deck::Deck;
use crate::dump::Parts;
use crate::error::{LammpsError, Result};
use crate::files::{DUMPS, FINISHED, FRAMES, INPUT, LOCK, OF_BODIES, STATES, WHOLE};
use dem::setup::Setup;
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::time::Duration;

/// Time between looks at a file that grows.
const LOOK: Duration = Duration::from_millis(10);

/// From where LAMMPS goes on.
#[derive(Debug)]
pub struct Start {
    pub folder: PathBuf,
    /// The state; none: from the beginning.
    pub state: Option<&'static str>,
    /// Which start it is, from 1.
    pub number: usize,
    /// Whether the last step was reached before.
    pub finished: bool,
    /// What the user should know.
    pub warning: Option<String>,
    /// Held while dem-lammps or its LAMMPS lives.
    pub lock: File,
}

impl Start {
    /// The name of a dump of this start.
    pub fn dump(&self, name: &str) -> PathBuf {
        part(Path::new(name), self.number)
    }
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

/// A dump; one that has the name of a deck's, with the parts of later starts.
///
/// # Errors
/// A file that cannot be opened.
pub fn open<'a>(dump: &Path) -> io::Result<Parts<'a>> {
    let mut all: Parts = vec![Box::new(BufReader::new(File::open(dump)?))];
    let of_deck = dump.file_name().is_some_and(|name| DUMPS.iter().any(|d| name == *d));
    for path in parts(dump).skip(1).filter(|_| of_deck) {
        all.push(Box::new(BufReader::new(File::open(path)?)));
    }
    Ok(all)
}

/// Readies a folder: a new one gets the deck; one that holds it goes on from its newest state that is whole.
///
/// # Errors
/// A folder of another deck, one where another process works, or one that cannot be used.
pub fn ready(deck: &Deck, setup: &Setup, folder: &Path) -> Result<Start> {
    let failed = |error| LammpsError::Folder { folder: folder.display().to_string(), error };
    fs::create_dir_all(folder).map_err(failed)?;
    let lock = File::options().create(true).append(true).open(folder.join(LOCK)).map_err(failed)?;
    if lock.try_lock().is_err() {
        return Err(LammpsError::Busy { folder: folder.display().to_string() });
    }
    let fresh =
        Start { folder: folder.to_owned(), state: None, number: 1, finished: false, warning: None, lock };
    if !folder.join(INPUT).exists() {
        deck.write(setup, folder)?;
        return Ok(fresh);
    }
    same(deck, setup, folder)?;
    let finished = folder.join(FINISHED).exists();
    let (state, count) =
        (newest(folder, deck.is_rigid()).map_err(failed)?, parts(&folder.join(FRAMES)).count());
    if finished || state.is_some() {
        return Ok(Start { state, number: count + 1, finished, ..fresh });
    }
    // What was computed before the first state is computed again.
    let old = DUMPS.iter().flat_map(|name| parts(&folder.join(name)).collect::<Vec<_>>());
    old.into_iter().try_for_each(fs::remove_file).map_err(failed)?;
    let words = || format!("{}: has no whole state: the run begins again", folder.display());
    Ok(Start { warning: (count > 0).then(words), ..fresh })
}

/// Refuses a folder that holds another deck than this, or dumps of one.
///
/// # Errors
/// Where they differ.
pub fn same(deck: &Deck, setup: &Setup, folder: &Path) -> Result<()> {
    let failed = |error| LammpsError::Folder { folder: folder.display().to_string(), error };
    let there = fs::read_to_string(folder.join(INPUT)).map_err(failed)?;
    let other = |what: String| Err(LammpsError::OtherDeck { folder: folder.display().to_string(), what });
    let mut lines = there.lines().zip(deck.input.lines());
    if let Some((old, new)) = lines.find(|(old, new)| old != new) {
        return other(format!("in its run.in, '{old}' stands where this run has '{new}'"));
    }
    if there != deck.input {
        return other("its run.in has another length".to_owned());
    }
    match deck.differs(setup, folder).map_err(failed)? {
        None => Ok(()),
        Some(name) => other(format!("its {name} has other content")),
    }
}

/// Whether a folder has a deck.
pub fn has_deck(folder: &Path) -> bool {
    folder.join(INPUT).exists()
}

/// Whether a deck in a folder has run there.
pub fn has_run(folder: &Path) -> bool {
    STATES.iter().chain(&DUMPS).any(|name| folder.join(name).exists())
}

/// The newest state that is whole; `rigid`: with its rigid bodies.
fn newest(folder: &Path, rigid: bool) -> io::Result<Option<&'static str>> {
    let mut found = Vec::new();
    for name in STATES {
        let path = folder.join(name);
        if path.exists() && is_whole(&mut File::open(&path)?)? && (!rigid || has_bodies(&path)?) {
            found.push((fs::metadata(&path)?.modified()?, name));
        }
    }
    Ok(found.into_iter().max().map(|newest| newest.1))
}

/// Whether the file of bodies that LAMMPS writes after a state belongs to it, and has a line for each.
fn has_bodies(state: &Path) -> io::Result<bool> {
    let mut name = state.as_os_str().to_owned();
    name.push(OF_BODIES);
    let bodies = Path::new(&name);
    if !bodies.exists() || fs::metadata(bodies)?.modified()? < fs::metadata(state)?.modified()? {
        return Ok(false);
    }
    let text = fs::read_to_string(bodies)?;
    let mut lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let count = lines.next().and_then(|line| line.trim().parse().ok());
    Ok(text.ends_with('\n') && count == Some(lines.count()))
}

fn is_whole(state: &mut File) -> io::Result<bool> {
    let length = state.metadata()?.len();
    let Some(from) = length.checked_sub(WHOLE.len() as u64 + 1) else { return Ok(false) };
    state.seek(SeekFrom::Start(from))?;
    let mut end = String::new();
    Ok(state.read_to_string(&mut end).is_ok() && end.trim_end_matches('\0') == WHOLE)
}

/// A dump of a start while LAMMPS writes it, behind what earlier starts have left.
///
/// # Errors
/// Files that cannot be opened.
pub fn followed<'a>(
    start: &Start,
    name: &str,
    ended: Arc<AtomicBool>,
    capacity: usize,
) -> io::Result<Parts<'a>> {
    let dump = start.folder.join(name);
    let mut all: Parts = if start.number > 1 { open(&dump)? } else { Vec::new() };
    let follow = Follow { path: part(&dump, start.number), file: None, ended };
    all.push(Box::new(BufReader::with_capacity(capacity, follow)));
    Ok(all)
}

/// A file that grows until its writer has ended.
struct Follow {
    path: PathBuf,
    file: Option<File>,
    ended: Arc<AtomicBool>,
}

impl Read for Follow {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            // Asked before the file is read: what is written until then is read.
            let last = self.ended.load(SeqCst);
            if self.file.is_none() {
                self.file = match File::open(&self.path) {
                    Ok(file) => Some(file),
                    Err(error) if error.kind() == io::ErrorKind::NotFound => None,
                    Err(error) => return Err(error),
                };
            }
            let n = self.file.as_mut().map_or(Ok(0), |file| file.read(bytes))?;
            if n > 0 || last || bytes.is_empty() {
                return Ok(n);
            }
            std::thread::sleep(LOOK);
        }
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
        assert_eq!(newest(folder.path(), false).unwrap(), None);
        put("state_1", &[b"numbers", WHOLE.as_bytes(), &[0]].concat());
        std::thread::sleep(Duration::from_millis(20));
        put("state_2", b"numb");
        assert_eq!(newest(folder.path(), false).unwrap(), Some("state_1"));
        put("state_2", &[b"numbers", WHOLE.as_bytes(), &[0]].concat());
        assert_eq!(newest(folder.path(), false).unwrap(), Some("state_2"));
        // A state of rigid bodies counts with theirs alone: written after it, and to their end.
        let newest_rigid = || newest(folder.path(), true).unwrap();
        assert_eq!(newest_rigid(), None);
        put("state_1.rigid", b"# bodies\n\n2\n1 0.5\n2 0.5\n");
        assert_eq!(newest_rigid(), Some("state_1"));
        put("state_2.rigid", b"# bodies\n\n2\n1 0.5\n");
        assert_eq!(newest_rigid(), Some("state_1"));
        std::thread::sleep(Duration::from_millis(20));
        put("state_1", &[b"later", WHOLE.as_bytes(), &[0]].concat());
        assert_eq!(newest_rigid(), None);
        // Only dumps of a deck have parts.
        for name in ["frames.dump", "frames-2.dump", "heap.dump", "heap-2.dump"] {
            put(name, b"");
        }
        let count = |name: &str| open(&folder.path().join(name)).unwrap().len();
        assert_eq!([count("frames.dump"), count("heap.dump")], [2, 1]);
    }

    #[test]
    fn a_file_is_followed_to_its_end() {
        let folder = tempfile::tempdir().unwrap();
        let (path, ended) = (folder.path().join("x"), Arc::new(AtomicBool::new(false)));
        let mut follow = Follow { path: path.clone(), file: None, ended: ended.clone() };
        let writer = std::thread::spawn(move || {
            for k in 0..5 {
                use std::io::Write;
                std::thread::sleep(Duration::from_millis(15));
                let mut file = File::options().create(true).append(true).open(&path).unwrap();
                writeln!(file, "{k}").unwrap();
            }
            ended.store(true, SeqCst);
        });
        let mut text = String::new();
        follow.read_to_string(&mut text).unwrap();
        assert_eq!(text, "0\n1\n2\n3\n4\n");
        writer.join().unwrap();
    }
}
