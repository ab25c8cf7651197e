//! A sample: what a specimen is made of. It is a scene without walls, times and outputs, which the test adds.
//!
//! Its grains are either one `[[fill]]` without shape and amount, which the test chooses, or `[[particles]]` that are packed already.

use crate::composing::compose::Composition;
use crate::error::{LabError, Result};
use crate::grains::Grains;
use scene::keys::DRAWN;
use scene::{Scene, Text};
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, Table};

/// Sections that the test writes, or that no specimen has.
const SECTIONS: [&str; 8] = ["wall", "output", "domain", "inlet", "outlet", "remove", "insert", "sleep"];
/// Keys of `[time]` that the test sets.
const TIMES: [&str; 3] = ["until", "until_unbalanced", "until_kinetic"];
/// Keys of `[[fill]]` that the test sets.
const AMOUNTS: [&str; 5] = ["shape", "mass", "count", "lattice", "seed"];
/// Largest gap between packed grains along an axis, in diameters of the largest: what is farther away belongs to no specimen, and walls would take long to
/// reach it.
const APART: f64 = 10.0;
/// Grains of a trial filling, from which sizes and time step are known.
const TRIAL: usize = 500;

#[derive(Debug, Clone)]
pub struct Sample {
    /// Its file, for messages.
    pub name: String,
    /// Files that it names are relative to this folder.
    pub folder: PathBuf,
    pub grains: Grains,
    /// Files that it names.
    pub files: Vec<PathBuf>,
    /// As it was written, with the changes of `set`.
    text: Text,
    document: DocumentMut,
}

impl Sample {
    /// What is wrong with it, and the cure.
    pub(crate) fn refusal(&self, what: impl Into<String>, cure: impl Into<String>) -> LabError {
        LabError::Sample { file: self.name.clone(), what: what.into(), cure: cure.into() }
    }

    /// Reads a sample; `set` changes keys of it (`KEY=VALUE`).
    ///
    /// # Errors
    /// Keys that the test sets, no grains, whatever a scene refuses.
    pub fn new(name: &str, toml: String, set: &[String], folder: &Path) -> Result<Sample> {
        let mut text = Text::new(name, toml);
        text.set(set)?;
        let document = text.document()?;
        let refuse = |what: String, cure: &str| LabError::Sample {
            file: name.to_owned(),
            what,
            cure: cure.to_owned(),
        };
        check(&document, &refuse)?;
        let mut sample = Sample {
            name: name.to_owned(),
            folder: folder.to_owned(),
            grains: Grains::none(),
            files: Vec::new(),
            text,
            document,
        };
        let trial = sample.trial()?;
        sample.files = trial.files();
        sample.grains = Grains::of(&trial, sample.is_packed())?;
        if !sample.is_packed() && sample.has("bond") {
            // The trial lacks them.
            let bonded = trial_scene(&sample, &sample.few())?.plan(Vec::new())?;
            sample.grains.breaking = sample.grains.breaking_of(&bonded.setup.bonds);
        }
        let limit = APART * sample.grains.largest;
        match sample.grains.packed.as_ref().and_then(|packed| packed.gap_above(limit)) {
            None => Ok(sample),
            Some((axis, low, high)) => Err(refuse(
                format!("no grain lies between {axis} = {low:.4} m and {high:.4} m"),
                "take the grains beyond out, or move them to the others: a specimen is one body of grains",
            )),
        }
    }

    /// Whether its grains are packed already.
    pub(crate) fn is_packed(&self) -> bool {
        is_packed(&self.document)
    }

    /// Whether it has a section.
    pub(crate) fn has(&self, section: &str) -> bool {
        self.document.contains_key(section)
    }

    /// Whether its `[[fill]]` has a key.
    pub(crate) fn fill_has(&self, key: &str) -> bool {
        let fills = self.document.get("fill").and_then(Item::as_array_of_tables);
        fills.is_some_and(|fills| fills.iter().any(|fill| fill.contains_key(key)))
    }

    /// Whether a seed changes a specimen of it: its filling, or the strengths of its bonds.
    pub(crate) fn is_random(&self) -> bool {
        let bonds = self.document.get("bond").and_then(Item::as_array_of_tables);
        !self.is_packed() || bonds.is_some_and(|bonds| bonds.iter().any(is_drawn))
    }

    /// The scene to which a recipe adds.
    pub(crate) fn compose(&self) -> Composition {
        Composition::new(self.document.clone())
    }

    /// The same with files as seen from another folder.
    pub(crate) fn compose_in(&self, folder: &Path) -> Composition {
        let mut document = self.document.clone();
        scene::text::rebase(&mut document, &self.folder, folder);
        Composition::new(document)
    }

    /// A scene of the sample with its bonds: its packed grains, or one in a box.
    fn few(&self) -> Composition {
        let mut scene = self.compose();
        scene.set("time", "until", 1.0);
        if !self.is_packed() {
            scene.set("fill.0", "shape", "box:0,0,0,1,1,1");
            scene.set("fill.0", "count", 1);
        }
        scene
    }

    /// A scene of the sample alone: its packed grains, or a few in a large box.
    fn trial(&self) -> Result<Scene> {
        let mut trial = self.few();
        if !self.is_packed() {
            trial.remove("bond");
            let largest = match trial_scene(self, &trial)? {
                scene if scene.keys.fill.first().is_some_and(|fill| fill.clump.is_some()) => {
                    2.0 * largest(&scene.clump_reaches()?) * scale(&scene)
                }
                scene => largest(&scene.largest_diameters()?),
            };
            // One in ten parts of the volume are grains.
            let side = (TRIAL as f64 * 5.0).cbrt() * largest;
            trial.set("fill.0", "shape", format!("box:0,0,0,{side},{side},{side}"));
            trial.set("fill.0", "count", TRIAL as i64);
        }
        trial_scene(self, &trial)
    }
}

fn trial_scene(sample: &Sample, trial: &Composition) -> Result<Scene> {
    Ok(Scene::made(sample.text.made_into(trial.text()), &sample.folder)?)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Largest scale of the clumps of the `[[fill]]`.
fn scale(scene: &Scene) -> f64 {
    scene.keys.fill.first().and_then(|fill| fill.scale.as_ref()).map_or(1.0, |scale| scale.high)
}

/// Whether the strengths of a `[[bond]]` are drawn.
pub(crate) fn is_drawn(bond: &Table) -> bool {
    DRAWN.iter().any(|key| bond.contains_key(key))
}

/// Whether grains are placed by the sample itself.
fn is_packed(document: &DocumentMut) -> bool {
    ["particles", "body"].iter().any(|section| document.contains_key(section))
}

/// Refuses what the test adds itself.
fn check(document: &DocumentMut, refuse: &dyn Fn(String, &str) -> LabError) -> Result<()> {
    if let Some(section) = SECTIONS.into_iter().find(|s| document.contains_key(s)) {
        let what = format!("[{section}] is not part of a sample");
        return Err(refuse(
            what,
            "take it out: lab-test adds walls, times and outputs (--print-scene shows them)",
        ));
    }
    let keys = |table: Option<&Table>, names: &[&'static str]| {
        names.iter().copied().find(|name| table.is_some_and(|table| table.contains_key(name)))
    };
    if let Some(key) = keys(document.get("time").and_then(Item::as_table), &TIMES) {
        return Err(refuse(
            format!("time.{key} is not part of a sample"),
            "take it out: lab-test chooses how long its runs take",
        ));
    }
    let fills = document.get("fill").and_then(Item::as_array_of_tables);
    let packed = is_packed(document);
    match (fills.map_or(0, |f| f.len()), packed) {
        (1, false) | (0, true) => {}
        (0, false) => {
            return Err(refuse(
                "has no grains".into(),
                "give one [[fill]] without shape and amount, or [[particles]]",
            ));
        }
        (_, true) => {
            return Err(refuse("has [[fill]] and [[particles]] or [[body]]".into(), "give one of them"));
        }
        (n, false) => {
            return Err(refuse(format!("has {n} [[fill]]"), "give one; its sizes may name materials"));
        }
    }
    if let Some(key) = keys(fills.and_then(|f| f.get(0)), &AMOUNTS) {
        let cure = "take it out: --grains or --size choose the amount, --seed the seed";
        return Err(refuse(format!("fill.0.{key} is not part of a sample"), cure));
    }
    Ok(())
}
