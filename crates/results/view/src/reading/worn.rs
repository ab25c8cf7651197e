//! Adds up what grains did to the parts of walls, and gives it to those layers and meshes that have them.

use crate::things::wear_state::WearState;
use std::collections::BTreeMap;
use std::sync::Arc;
use stream::Table;
use wear::{PartLoads, WallWear, WearField};

/// Where the parts of a wall are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShownPart {
    /// Wall spheres, by the number of their layer.
    Layer(usize),
    /// A mesh, by its number.
    Surface(usize),
}

/// Parts of one wall that follow each other.
struct Group {
    shown: usize,
    /// Row of the first of them.
    first: usize,
    /// What each stands for of the wall [m²].
    areas: Vec<f64>,
}

/// What grains did to walls so far.
pub struct WornWalls {
    field: WearField,
    loads: PartLoads,
    /// What is shown, with its number of rows.
    shown: Vec<(ShownPart, usize)>,
    groups: BTreeMap<u64, Vec<Group>>,
}

impl WornWalls {
    /// Nothing yet; of this field.
    pub fn new(field: WearField) -> WornWalls {
        WornWalls { field, loads: PartLoads::default(), shown: Vec::new(), groups: BTreeMap::new() }
    }

    /// Whether no wall with parts is shown.
    pub fn is_empty(&self) -> bool {
        self.shown.is_empty()
    }

    /// Whether anything was touched.
    pub fn is_touched(&self) -> bool {
        self.loads.touched() > 0
    }

    /// Adds what is shown of parts: walls, in the order of its rows, with the areas of theirs [m²].
    pub fn show(&mut self, part: ShownPart, walls: Vec<(u64, Vec<f64>)>) {
        let (shown, mut first) = (self.shown.len(), 0);
        for (wall, areas) in walls {
            let count = areas.len();
            self.groups.entry(wall).or_default().push(Group { shown, first, areas });
            first += count;
        }
        self.shown.push((part, first));
    }

    /// Takes in a message.
    ///
    /// # Errors
    /// Columns that are missing or wrong.
    pub fn take(&mut self, time: f64, table: &Table) -> Result<(), record::RecordError> {
        let wear = WallWear::new(time, table)?;
        self.loads.add(&wear, |_| true);
        Ok(())
    }

    /// The state so far.
    pub fn state(&self) -> WearState {
        let mut values: Vec<Vec<f32>> = self.shown.iter().map(|(_, rows)| vec![0.0; *rows]).collect();
        for ((wall, part), load) in self.loads.iter() {
            for group in self.groups.get(&wall).into_iter().flatten() {
                let Some(area) = usize::try_from(part).ok().and_then(|part| group.areas.get(part)) else {
                    continue;
                };
                let value = self.field.of(load, *area, self.loads.length());
                values[group.shown][group.first + part as usize] = value as f32;
            }
        }
        let mut state = WearState::default();
        for ((part, _), values) in self.shown.iter().zip(values) {
            match part {
                ShownPart::Layer(layer) => state.layers.push((*layer, Arc::new(values))),
                ShownPart::Surface(surface) => state.surfaces.push((*surface, Arc::new(values))),
            }
        }
        state
    }
}
