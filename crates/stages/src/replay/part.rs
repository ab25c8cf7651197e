//! The files of a run: one, or several where it was stopped and gone on with.

use super::Replay;
use super::head::{Head, head};
use crate::error::SceneError;
use crate::inlet::Source;
use geom::Shown;
use std::collections::BTreeMap;
use stream::mcap::{Event, McapError, Reader};

/// One of them, read up to its first message.
pub struct Part {
    pub name: String,
    reader: Reader<Source>,
    first: Option<Event>,
    /// When it begins [s]: above 0 where it goes on from another run.
    pub begins: f64,
    /// Its scene, for who wants to know where a stream comes from.
    pub scene: Option<(String, String)>,
}

/// Opens all of them, and looks whether they follow each other.
///
/// # Errors
/// A stream that is no run with an outlet; one that begins after what is asked for, or not after the one before, or has another outlet.
pub fn open(files: Vec<(String, Source)>, what: &Replay) -> Result<(Vec<Part>, Head), SceneError> {
    let (mut parts, mut heads) = (Vec::new(), Vec::new());
    for (name, source) in files {
        let (part, head) = Part::open(name, source, what)?;
        parts.push(part);
        heads.push(head);
    }
    // What a message tells is rounded to some digits.
    let from = what.from.unwrap_or(0.0) * (1.0 + 1e-4);
    if let Some(first) = parts.first().filter(|first| first.begins > from) {
        let begins = Shown(first.begins);
        let why = format!(
            "begins at {begins} s, where it goes on from another run: what passed before is recorded there"
        );
        let cure = format!("give that run before this one, or --from {begins} to replay this part alone");
        return Err(SceneError::file(&first.name, why, cure));
    }
    for two in parts.windows(2) {
        if !(two[1].begins > two[0].begins) {
            let why = format!(
                "begins at {} s, and {}, which is given before it, at {} s",
                Shown(two[1].begins),
                two[0].name,
                Shown(two[0].begins)
            );
            return Err(SceneError::file(&two[1].name, why, "give a run first, then what goes on from it"));
        }
    }
    for (part, two) in parts.iter().skip(1).zip(heads.windows(2)) {
        if two[0].gate != two[1].gate || two[0].materials != two[1].materials {
            let why = "has another outlet, or other materials, than the run that is given before it";
            return Err(SceneError::file(&part.name, why, "give runs of one scene"));
        }
    }
    let none = || SceneError::file("stage-replay", "no run is given", "give one");
    let head = heads.into_iter().next().ok_or_else(none)?;
    Ok((parts, head))
}

impl Part {
    fn open(name: String, source: Source, what: &Replay) -> Result<(Part, Head), SceneError> {
        let mut reader = Reader::new(source);
        let mut records: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
        let first = loop {
            match reader.next().transpose().map_err(|e| broken(&name, e))? {
                Some(Event::Metadata { name, map }) => drop(records.insert(name, map)),
                other => break other,
            }
        };
        let text = records.get(crate::input::SCENE).and_then(|r| r.get("toml"));
        let scene = text.map(|toml| ("scene of the run".to_owned(), crate::sha256(toml)));
        let start = records.get("time").and_then(|r| r.get("start"));
        let begins = start.and_then(|s| s.parse().ok()).unwrap_or(0.0);
        let head = head(&name, records, what)?;
        Ok((Part { name, reader, first, begins, scene }, head))
    }

    /// What it has next.
    pub fn next(&mut self) -> Option<Result<Event, SceneError>> {
        match self.first.take() {
            Some(event) => Some(Ok(event)),
            None => self.reader.next().map(|event| event.map_err(|e| broken(&self.name, e))),
        }
    }

    /// It ends, at a time [s], before the next one begins.
    pub fn gap(&self, next: &Part, ends: f64) -> SceneError {
        let why = format!("ends at {} s, and {} begins at {} s", Shown(ends), next.name, Shown(next.begins));
        SceneError::file(&self.name, why, "give what lies between, too")
    }
}

fn broken(name: &str, e: McapError) -> SceneError {
    SceneError::Content { name: name.to_owned(), wanted: "a run", source: e.into() }
}
