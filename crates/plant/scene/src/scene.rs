//! A scene that was read and whose values were checked.

use crate::check::Check;
use crate::error::{Result, SceneError};
use crate::keys::{Fill, Insert, SceneKeys};
use crate::materials::{Taken, missing};
use crate::text::{Text, parse, parse_made};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// A scene.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Its text.
    pub text: Text,
    /// Its keys.
    pub keys: SceneKeys,
    /// Files that it names are relative to this folder.
    pub folder: PathBuf,
}

impl Scene {
    /// Reads a scene, applies the `overrides` (`KEY=VALUE`), and checks every value.
    ///
    /// # Errors
    /// What is wrong, with line and column, key, value, unit and cure.
    pub fn new(name: &str, toml: String, overrides: &[String], folder: &Path) -> Result<Scene> {
        let mut text = Text::new(name, toml.clone());
        if !overrides.is_empty() {
            // Errors of the file itself name places in the file itself; what the overrides cure is none.
            if let Err(error) = parse(&text) {
                let mut changed = text.clone();
                let after = changed.set(overrides).and_then(|()| parse(&changed).map(drop));
                if after.is_err_and(|after| after.to_string() == error.to_string()) {
                    return Err(error);
                }
            }
            text.set(overrides)?;
        }
        let keys = parse(&text).map_err(|error| blame(error, name, &toml, overrides))?;
        Check { text: &text }.keys(&keys)?;
        Ok(Scene { text, keys, folder: folder.to_owned() })
    }

    /// A scene that a program has made from a file ([`Text::made_into`]); errors name places in that file.
    ///
    /// # Errors
    /// As for [`Scene::new`].
    pub fn made(text: Text, folder: &Path) -> Result<Scene> {
        let keys = parse_made(&text)?;
        Check { text: &text }.keys(&keys)?;
        Ok(Scene { text, keys, folder: folder.to_owned() })
    }

    /// The same, with numbers that its materials leave out from the table of materials; which these are.
    ///
    /// # Errors
    /// As for [`Scene::new`], and a material that the table does not have.
    pub fn with_materials(
        name: &str,
        toml: String,
        overrides: &[String],
        folder: &Path,
    ) -> Result<(Scene, Vec<Taken>)> {
        let mut text = Text::new(name, toml.clone());
        text.set(overrides)?;
        let taken = missing(&text)?;
        if taken.is_empty() {
            return Ok((Scene::new(name, toml, overrides, folder)?, taken));
        }
        let more = taken.iter().map(|t| format!("{}={:?}", t.key, t.value));
        let all: Vec<String> = overrides.iter().cloned().chain(more).collect();
        let mut text = Text::new(name, toml);
        text.set(&all)?;
        let keys = parse(&text)?;
        Check { text: &text }.keys(&keys)?;
        Ok((Scene { text, keys, folder: folder.to_owned() }, taken))
    }

    /// The error for a key's value that only a run can judge.
    pub fn wrong(&self, key: &str, value: impl Display, why: &str, cure: &str) -> SceneError {
        Check { text: &self.text }.wrong(key, value, why, cure)
    }

    /// Every file that the scene names, whether or not it exists.
    pub fn files(&self) -> Vec<PathBuf> {
        let m = &self.keys;
        let particles = m.particles.iter().map(|p| p.source.as_str());
        let walls = m.wall.iter().flat_map(|w| w.source.iter().chain(&w.mesh)).map(String::as_str);
        let clumps = m.clump.iter().filter_map(|c| c.mesh.as_deref());
        let inlets = m.inlet.iter().filter_map(|i| i.source.as_deref());
        let sizes = m.fill.iter().map(Fill::grains).chain(m.insert.iter().map(Insert::grains));
        let sizes: Vec<String> = sizes.filter_map(|grains| grains.names().1).collect();
        let motions = m.wall.iter().flat_map(|w| w.motion.iter().flat_map(|list| list.iter()));
        let paths = motions.filter_map(|motion| motion.path.as_ref()).map(|path| path.source.as_str());
        let loads = m.wall.iter().filter_map(|w| Some(w.servo.as_ref()?.path.as_ref()?.source.as_str()));
        let walls = walls.chain(paths).chain(loads);
        let shapes = m.fill.iter().map(|f| &f.shape).chain(m.insert.iter().map(|i| &i.shape));
        let shapes = shapes.chain(m.remove.iter().map(|r| &r.shape));
        let shapes = shapes.flat_map(|shape| geom::shape::files_of(shape));
        let strains =
            m.domain.strain.axes().into_iter().filter_map(|(_, s)| Some(s?.path.as_ref()?.source.as_str()));
        let domain = strains.chain(m.domain.source.as_deref());
        let all = particles
            .chain(shapes)
            .chain(domain)
            .chain(walls)
            .chain(clumps)
            .chain(inlets)
            .chain(sizes.iter().map(String::as_str));
        all.map(|f| self.folder.join(f)).collect()
    }
}

/// The error of a changed scene, at the overrides that cause it: the reader does not see the changed text.
fn blame(error: SceneError, name: &str, toml: &str, overrides: &[String]) -> SceneError {
    let alone = |text: &&String| {
        let mut changed = Text::new(name, toml.to_owned());
        changed.set(std::slice::from_ref(*text)).is_ok()
            && parse(&changed).is_err_and(|other| other.without_place() == error.without_place())
    };
    let guilty: Vec<&str> = overrides.iter().filter(alone).map(String::as_str).collect();
    let all: Vec<&str> = overrides.iter().map(String::as_str).collect();
    match overrides {
        [] => error,
        _ => error.at(Text::new(name, String::new()).changes(if guilty.is_empty() { &all } else { &guilty })),
    }
}
