//! A scene and its cut, and the text of the stage in the making: what the other steps work on.

use super::{Cut, Stage};
use geom::Shown;
use scene::{Result, Scene, SceneError};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

pub(super) struct Cutting<'a> {
    pub scene: &'a Scene,
    pub cut: &'a Cut,
    /// Largest diameter [m].
    pub largest: f64,
}

/// The text of the stage that is kept.
pub(super) struct StageText {
    pub document: DocumentMut,
    /// Entries that are left out, each with its place in the text.
    gone: Vec<(Option<isize>, String)>,
    /// Whether grains start, or come in, upstream of the plane.
    pub upstream: bool,
}

impl StageText {
    /// Nothing has been left out yet.
    pub fn new(document: DocumentMut) -> StageText {
        StageText { document, gone: Vec::new(), upstream: false }
    }

    /// Removes an entry of a list of tables.
    pub fn remove(&mut self, key: &str, index: usize, name: String) {
        if let Some(tables) = self.document.get_mut(key).and_then(Item::as_array_of_tables_mut) {
            self.gone.push((tables.get(index).and_then(Table::position), name));
            tables.remove(index);
            if tables.is_empty() {
                self.document.remove(key);
            }
        }
    }

    /// The text, and what was left out in the order of the scene.
    pub fn done(mut self) -> (String, Vec<String>) {
        self.gone.sort_by_key(|(place, _)| *place);
        (self.document.to_string(), self.gone.into_iter().map(|(_, name)| name).collect())
    }
}

impl Cutting<'_> {
    /// The error of a scene that cannot be cut so.
    pub fn wrong(&self, why: impl Into<String>, cure: impl Into<String>) -> SceneError {
        SceneError::file(&self.scene.text.name, why, cure)
    }

    /// Adds the zone of the cut.
    pub fn add_zone(&self, document: &mut DocumentMut) -> Result<()> {
        let (cut, kind) = (self.cut, self.cut.keep.zone());
        let word = if cut.keep == Stage::Upstream { "upstream" } else { "downstream" };
        let mut zone = Table::new();
        zone.insert("plane", value(cut.plane.to_string()));
        if let Some(length) = cut.length {
            zone.insert("length", value(length));
        }
        zone.insert("motion", value(cut.motion.name()));
        zone.insert("test", value(cut.test.name()));
        zone.decor_mut().set_prefix(format!("\n# The cut: {word} stage.\n"));
        let tables = document.entry(kind).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
        let Some(tables) = tables.as_array_of_tables_mut() else {
            let why = format!("'{kind}' is written as a list in one line");
            return Err(self.wrong(why, format!("write it as [[{kind}]]")));
        };
        tables.push(zone);
        Ok(())
    }

    /// Refuses a cut across which a particle would come back through a periodic face.
    pub fn check_periodic(&self) -> Result<()> {
        for axis in self.scene.keys.domain.periodic.iter().map(|axis| *axis as usize) {
            let (name, along) = (["x", "y", "z"][axis], self.cut.plane.normal[axis]);
            if along.abs() > 1e-9 {
                let why = format!(
                    "the plane's normal has {name} = {}, and the domain is periodic along {name}: a grain that passes the plane would come back upstream",
                    Shown(along)
                );
                return Err(self.wrong(why, "cut along a direction that is not periodic"));
            }
        }
        Ok(())
    }

    /// Refuses what only the whole plant can follow.
    pub fn check_whole(&self) -> Result<()> {
        let keys = &self.scene.keys;
        let rests = [
            ("until_unbalanced", keys.time.until_unbalanced.is_some()),
            ("until_kinetic", keys.time.until_kinetic.is_some()),
        ];
        if let Some((key, _)) = rests.iter().find(|(_, given)| *given) {
            let why =
                format!("time.{key} ends the plant when all its grains rest, and a stage sees only its own");
            return Err(self.wrong(why, "take it out, and end the stages by until"));
        }
        if !keys.domain.strain.is_empty() {
            let why = "domain.strain: a domain that is strained has no inlets and outlets";
            return Err(self.wrong(why, "take it out, or simulate the plant undivided"));
        }
        Ok(())
    }

    pub fn check_length(&self) -> Result<()> {
        let Some(length) = self.cut.length else { return Ok(()) };
        if length.is_finite() && length > self.largest {
            return Ok(());
        }
        let place = if length == f64::INFINITY { "is infinite" } else { "is not above the largest diameter" };
        let why = format!("--length {length} m {place}, {} m", Shown(self.largest));
        Err(self.wrong(why, format!("use at least {} m", Shown(1.2 * self.largest))))
    }
}

/// Distances [m] from the plane that something covers, lowest and highest.
pub type Range = (f64, f64);
