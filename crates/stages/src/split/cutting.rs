//! A scene and its cut: what the other steps work on.

use super::{Cut, Stage};
use geom::Shown;
use scene::keys::Axis;
use scene::{Scene, SceneError};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

pub(super) struct Cutting<'a> {
    pub scene: &'a Scene,
    pub cut: &'a Cut,
    /// Largest diameter [m].
    pub largest: f64,
}

impl Cutting<'_> {
    /// Adds the zone of the cut.
    pub fn add_zone(&self, document: &mut DocumentMut) -> Result<(), SceneError> {
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
        match tables.as_array_of_tables_mut() {
            Some(tables) => tables.push(zone),
            None => {
                let why = format!("'{kind}' is written as a list in one line");
                return Err(SceneError::file(&self.scene.text.name, why, format!("write it as [[{kind}]]")));
            }
        }
        Ok(())
    }

    /// Refuses a cut across which a particle would come back through a periodic face.
    pub fn check_periodic(&self) -> Result<(), SceneError> {
        for axis in &self.scene.keys.domain.periodic {
            let (name, along) = match axis {
                Axis::X => ("x", self.cut.plane.normal.x),
                Axis::Y => ("y", self.cut.plane.normal.y),
                Axis::Z => ("z", self.cut.plane.normal.z),
            };
            if along.abs() > 1e-9 {
                let why = format!(
                    "the plane's normal has {name} = {}, and the domain is periodic along {name}: a grain that passes would come back from upstream",
                    Shown(along)
                );
                return Err(SceneError::file(
                    &self.scene.text.name,
                    why,
                    "cut along a direction that is not periodic",
                ));
            }
        }
        Ok(())
    }

    pub fn check_length(&self) -> Result<(), SceneError> {
        match self.cut.length {
            Some(length) if !length.is_finite() || length <= self.largest => {
                let place =
                    if length == f64::INFINITY { "has no end" } else { "is not above the largest diameter" };
                let why = format!("--length {length} m {place}, {} m", Shown(self.largest));
                Err(SceneError::file(
                    &self.scene.text.name,
                    why,
                    format!("use at least {} m", Shown(1.2 * self.largest)),
                ))
            }
            _ => Ok(()),
        }
    }
}
