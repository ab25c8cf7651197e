//! The files of a run: one, or several when it was stopped and resumed.

use super::Replay;
use super::head::Head;
use geom::Shown;
use record::{Map, RunTimes, metadata};
use scene::input::Source;
use scene::{Result, SceneError};
use std::collections::BTreeMap;
use stream::mcap::{Event, McapError, Reader};

/// A file, read up to its first message.
pub struct RunFile {
    pub name: String,
    reader: Reader<Source>,
    first: Option<Event>,
    /// When it begins [s]; above 0 when it resumes another run.
    pub begins: f64,
    /// Role and SHA-256 of its scene, for the provenance of the stream.
    pub scene: Option<(String, String)>,
}

/// Opens all of them, and checks that they follow each other.
///
/// # Errors
/// A stream without an outlet; one that begins after what is asked for, or not after the one before, or has another outlet.
pub fn open(files: Vec<(String, Source)>, what: &Replay) -> Result<(Vec<RunFile>, Head)> {
    let (mut runs, mut heads) = (Vec::new(), Vec::new());
    for (name, source) in files {
        let (run, head) = RunFile::open(name, source, what)?;
        runs.push(run);
        heads.push(head);
    }
    // The time in a message is rounded.
    let from = what.from.unwrap_or(0.0) * (1.0 + 1e-4);
    if let Some(first) = runs.first().filter(|first| first.begins > from) {
        let begins = Shown(first.begins);
        let why = format!(
            "begins at {begins} s, where it resumes another run: earlier crossings are recorded there"
        );
        let cure = format!("give that run before this one, or --from {begins} to replay this file alone");
        return Err(SceneError::file(&first.name, why, cure));
    }
    for (before, run) in runs.iter().zip(runs.iter().skip(1)) {
        if !(run.begins > before.begins) {
            let (begins, first, name) = (Shown(run.begins), Shown(before.begins), &before.name);
            let why = format!("begins at {begins} s, and {name}, which is given before it, at {first} s");
            return Err(SceneError::file(&run.name, why, "give a run first, then the one that resumes it"));
        }
    }
    for (run, two) in runs.iter().skip(1).zip(heads.windows(2)) {
        if two[0].zone != two[1].zone || two[0].materials != two[1].materials {
            let why = "has another outlet, or other materials, than the run that is given before it";
            return Err(SceneError::file(&run.name, why, "give runs of one scene"));
        }
    }
    let none = || SceneError::file("stage-replay", "no run is given", "give one");
    let head = heads.into_iter().next().ok_or_else(none)?;
    Ok((runs, head))
}

impl RunFile {
    fn open(name: String, source: Source, what: &Replay) -> Result<(RunFile, Head)> {
        let mut reader = Reader::new(source);
        let mut records: BTreeMap<String, Map> = BTreeMap::new();
        let first = loop {
            match reader.next().transpose().map_err(|e| broken(&name, e))? {
                Some(Event::Metadata { name, map }) => drop(records.insert(name, map)),
                other => break other,
            }
        };
        let text = records.get(metadata::SCENE).and_then(|r| r.get("toml"));
        let scene = text.map(|toml| ("scene of the run".to_owned(), stream::sha256(toml.as_bytes())));
        let begins = records.get(metadata::TIME).and_then(|map| RunTimes::read(map).start).unwrap_or(0.0);
        let head = Head::new(&name, records, what)?;
        Ok((RunFile { name, reader, first, begins, scene }, head))
    }

    pub fn next(&mut self) -> Option<Result<Event>> {
        match self.first.take() {
            Some(event) => Some(Ok(event)),
            None => self.reader.next().map(|event| event.map_err(|e| broken(&self.name, e))),
        }
    }

    /// The error of a file that ends, at a time [s], before the next one begins.
    pub fn gap(&self, next: &RunFile, ends: f64) -> SceneError {
        let why = format!("ends at {} s, and {} begins at {} s", Shown(ends), next.name, Shown(next.begins));
        SceneError::file(&self.name, why, "give the runs between them, too")
    }
}

fn broken(name: &str, e: McapError) -> SceneError {
    SceneError::content(name, "a run", e)
}
