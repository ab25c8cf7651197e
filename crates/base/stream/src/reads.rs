//! What a command reads, by the programs themselves: each of them notes its files where [`VARIABLE`] names a file.
//!
//! ```text
//! GRAINPIPE_READS=trial/reads dem-run scene.toml -o trial/run.mcap
//! trial/reads:  {"path":"/plant/scene.toml","sha256":"9f86…"}      a line for each file; for a folder the hash of the names in it
//!               {"stopped":"stopped by a guard at …","signal":false}     of a program that was stopped, whatever the line does with its exit code
//! ```
//!
//! Files in the folder of that record belong to the trial itself and are left out. What a result was made from can so be compared with what is there now
//! ([`changed`]), whatever shell line made it.

use crate::sha256;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// Environment variable with the name of the record.
pub const VARIABLE: &str = "GRAINPIPE_READS";
/// Usual name of a record in the folder of a trial.
pub const RECORD: &str = "reads";

/// A line of a record.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Line {
    Read { path: PathBuf, sha256: String },
    Stop(Stop),
}

/// A program that was stopped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// By what, when, of how much.
    pub stopped: String,
    /// Whether a signal stopped it, so that it would not stop there again.
    pub signal: bool,
}

/// Adds files to the record that [`VARIABLE`] names; does nothing where it names none.
///
/// # Errors
/// A record that cannot be written to.
pub fn note(files: impl IntoIterator<Item = PathBuf>) -> io::Result<()> {
    let Some(record) = std::env::var_os(VARIABLE).filter(|name| !name.is_empty()) else { return Ok(()) };
    note_in(Path::new(&record), files)
}

/// Adds files to a record; those that are not there, pipes and devices are left out.
///
/// # Errors
/// A record that cannot be written to.
pub fn note_in(record: &Path, files: impl IntoIterator<Item = PathBuf>) -> io::Result<()> {
    let own = record.parent().and_then(|folder| folder.canonicalize().ok());
    let mut lines = Vec::new();
    for path in files.into_iter().filter_map(|file| file.canonicalize().ok()) {
        if own.as_ref().is_some_and(|own| path.starts_with(own)) {
            continue;
        }
        if let Some(sha256) = hash(&path) {
            serde_json::to_writer(&mut lines, &Line::Read { path, sha256 })?;
            lines.push(b'\n');
        }
    }
    append(record, &lines)
}

/// Adds to the record that [`VARIABLE`] names that this program was stopped; does nothing where it names none.
///
/// # Errors
/// A record that cannot be written to.
pub fn note_stop(stop: Stop) -> io::Result<()> {
    let Some(record) = std::env::var_os(VARIABLE).filter(|name| !name.is_empty()) else { return Ok(()) };
    append(Path::new(&record), &[&serde_json::to_vec(&Line::Stop(stop))?[..], b"\n"].concat())
}

/// The programs of a record that were stopped. Empty without a record.
pub fn stops(record: &Path) -> Vec<Stop> {
    let text = fs::read_to_string(record).unwrap_or_default();
    let stop = |line| match serde_json::from_str(line) {
        Ok(Line::Stop(stop)) => Some(stop),
        _ => None,
    };
    text.lines().filter_map(stop).collect()
}

/// Appends lines at once: programs of a pipe write to one record.
fn append(record: &Path, lines: &[u8]) -> io::Result<()> {
    if lines.is_empty() {
        return Ok(());
    }
    OpenOptions::new().create(true).append(true).open(record)?.write_all(lines)
}

/// The file that stdin reads from, where it is one and the system tells its name.
pub fn stdin() -> Option<PathBuf> {
    fs::read_link("/proc/self/fd/0").ok().filter(|path| path.is_file())
}

/// Files of a record that are no longer what they were; `moved`: a folder then, and where it is now. Empty without a record.
pub fn changed(record: &Path, moved: Option<(&Path, &Path)>) -> Vec<PathBuf> {
    let text = fs::read_to_string(record).unwrap_or_default();
    let now =
        |path: PathBuf| match moved.and_then(|(then, now)| Some(now.join(path.strip_prefix(then).ok()?))) {
            Some(new) => new,
            None => path,
        };
    let mut all = BTreeMap::new();
    for line in text.lines() {
        match serde_json::from_str(line) {
            // A file that one trial reads twice while it changes is another file now, whichever of both is there.
            Ok(Line::Read { path, sha256 }) => all.entry(now(path)).or_insert_with(Vec::new).push(sha256),
            Ok(Line::Stop(_)) => {}
            // A line that was cut off names no file: nothing is known.
            Err(_) => all.entry(record.to_owned()).or_insert_with(Vec::new).push(String::new()),
        }
    }
    let is_other = |(path, then): &(PathBuf, Vec<String>)| {
        let now = known(path);
        then.iter().any(|then| now.as_ref() != Some(then))
    };
    all.into_iter().filter(is_other).map(|(path, _)| path).collect()
}

/// When a file was last changed, and its length.
type Mark = (SystemTime, u64);

fn mark(path: &Path) -> Option<Mark> {
    let about: Metadata = fs::metadata(path).ok()?;
    Some((about.modified().ok()?, about.len()))
}

/// Hashes of this process, as long as the files have the same time and length.
static KNOWN: Mutex<BTreeMap<PathBuf, (Mark, Option<String>)>> = Mutex::new(BTreeMap::new());

/// [`hash`], which reads each file once while it does not change.
pub fn known(path: &Path) -> Option<String> {
    let mark = mark(path)?;
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((then, hash)) = known.get(path)
        && *then == mark
    {
        return hash.clone();
    }
    let hash = hash(path);
    known.insert(path.to_owned(), (mark, hash.clone()));
    hash
}

/// SHA-256 of a file, or of the sorted names in a folder; `None`: neither of both, or it cannot be read.
fn hash(path: &Path) -> Option<String> {
    let kind = fs::metadata(path).ok()?;
    if kind.is_dir() {
        let mut names: Vec<_> =
            fs::read_dir(path).ok()?.map(|entry| Some(entry.ok()?.file_name())).collect::<Option<_>>()?;
        names.sort();
        let all: Vec<u8> = names.iter().flat_map(|name| [name.as_encoded_bytes(), b"\0"].concat()).collect();
        return Some(sha256(&all));
    }
    if !kind.is_file() {
        return None;
    }
    let mut hashed = crate::Hashed::new(File::open(path).ok()?);
    io::copy(&mut hashed, &mut io::sink()).ok()?;
    Some(hashed.sha256())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_knows_what_changed_what_went_and_what_is_its_own() {
        let folder = std::env::temp_dir().join(format!("grainpipe-reads-{}", std::process::id()));
        let trial = folder.join("trial");
        fs::create_dir_all(&trial).unwrap();
        let [a, b, own] = [folder.join("a b.csv"), folder.join("b\n.csv"), trial.join("run.mcap")];
        for file in [&a, &b, &own] {
            fs::write(file, "1").unwrap();
        }
        let record = trial.join(RECORD);
        note_in(&record, [a.clone(), b.clone(), own.clone(), folder.join("none")]).unwrap();
        assert_eq!(fs::read_to_string(&record).unwrap().lines().count(), 2);
        assert_eq!(changed(&record, None), Vec::<PathBuf>::new());
        fs::write(&own, "2").unwrap();
        assert_eq!(changed(&record, None), Vec::<PathBuf>::new(), "the trial's own file");
        fs::write(&a, "22").unwrap();
        fs::remove_file(&b).unwrap();
        let real = folder.canonicalize().unwrap();
        assert_eq!(changed(&record, None), [real.join("a b.csv"), real.join("b\n.csv")]);
        // The same files elsewhere.
        fs::create_dir(folder.join("new")).unwrap();
        for name in ["a b.csv", "b\n.csv"] {
            fs::write(folder.join("new").join(name), "1").unwrap();
        }
        assert_eq!(changed(&record, Some((&real, &real.join("new")))), Vec::<PathBuf>::new());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_folder_is_known_by_the_names_in_it() {
        let folder = std::env::temp_dir().join(format!("grainpipe-read-names-{}", std::process::id()));
        fs::create_dir_all(folder.join("library")).unwrap();
        fs::create_dir_all(folder.join("trial")).unwrap();
        let record = folder.join("trial").join(RECORD);
        note_in(&record, [folder.join("library")]).unwrap();
        assert!(changed(&record, None).is_empty());
        fs::write(folder.join("library/rock.ply"), "").unwrap();
        assert_eq!(changed(&record, None).len(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }
}
