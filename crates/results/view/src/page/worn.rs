//! What the parts of walls of a page are coloured by: a column of numbers for each time.

use super::pack::Column;
use super::{Page, blobs::Blobs};
use crate::appearance::scale::{Range, readable};
use crate::appearance::wall_scale::WALL_MAP;
use crate::things::wear_state::PartValues;
use crate::{Map, Role, ViewError, WearState};
use record::WallsEnd;
use serde_json::{Value, json};

/// The values of the parts of one layer or surface over time, thinned as frames are; the last one always stays.
#[derive(Default)]
pub(crate) struct WearTrack {
    /// Number as given, time from which on it is so [s], values.
    states: Vec<(usize, f64, Column)>,
    given: usize,
}

impl WearTrack {
    fn push(&mut self, time: f64, values: &PartValues, stride: usize) {
        if self.states.last().is_some_and(|(number, ..)| number % stride != 0) {
            self.states.pop();
        }
        let last = self.states.last().map(|(.., column)| column);
        let values = values.iter().map(|v| f64::from(*v));
        let range = Range { lo: 0.0, hi: values.clone().fold(0.0, f64::max) };
        let column = Column::new(values, range, 2, last);
        self.states.push((self.given, time, column));
        self.given += 1;
    }

    /// Keeps one state of `stride`, and the last.
    pub fn thin(&mut self, stride: usize) {
        let last = self.given.saturating_sub(1);
        self.states.retain(|(number, ..)| number % stride == 0 || *number == last);
    }

    /// Bytes of all states.
    pub fn bytes(&self) -> usize {
        self.states.iter().map(|(.., column)| column.bytes.len()).sum()
    }

    /// Adds its states to a layer or surface in the page.
    pub(super) fn add_to<'a>(&'a self, thing: &mut Value, blobs: &mut Blobs<'a>) {
        if !self.states.is_empty() {
            let states = self.states.iter().map(|(_, time, column)| json!([time, blobs.column(column)]));
            thing["wear"] = states.collect();
        }
    }
}

impl Page {
    /// Lets the camera leave out grains that have fallen past all walls; before they are pushed.
    pub fn walls_end(&mut self, end: WallsEnd) {
        self.walls_end = Some(end);
    }

    /// Colours the parts of walls from `time` [s] on; times must not fall.
    ///
    /// # Errors
    /// A page beyond its limit.
    pub fn wear(&mut self, time: f64, state: &WearState) -> Result<(), ViewError> {
        for (layer, values) in &state.layers {
            if let Some(layer) = self.layers.get_mut(*layer) {
                layer.wear.push(time, values, self.stride);
            }
        }
        for (surface, values) in &state.surfaces {
            self.worn.entry(*surface).or_default().push(time, values, self.stride);
        }
        let all = state.layers.iter().chain(&state.surfaces);
        self.wall_survey.add(all.flat_map(|(_, values)| values.iter().map(|v| f64::from(*v))));
        self.fit()
    }

    /// A layer or surface in the page, marked where it is hidden at first.
    pub(super) fn hidden(&self, role: Role, name: &str, mut thing: Value) -> Value {
        if self.options.hidden.hides_layer(role, name) {
            thing["hidden"] = true.into();
        }
        thing
    }

    /// The colour maps that a reader can choose, and that of walls where they are coloured.
    pub(super) fn maps_json(&self) -> Value {
        let used = |map: Map| map != WALL_MAP || self.options.walls.is_some() || self.options.map == WALL_MAP;
        let maps = Map::ALL.iter().filter(|(_, map)| used(*map));
        let maps: serde_json::Map<String, Value> =
            maps.map(|(name, map)| ((*name).to_owned(), json!(map.anchors()))).collect();
        maps.into()
    }

    /// What the colours of walls mean, as the page reads it.
    pub(super) fn walls_json(&self) -> Value {
        let Some(scale) = self.options.walls else { return Value::Null };
        let (ends, _) = self.wall_survey.ends(&scale);
        let (unit, factor) = readable(scale.field.unit(), ends.hi.abs());
        let map = Map::ALL.iter().find(|(_, map)| *map == WALL_MAP).map(|(name, _)| *name);
        json!({
            "name": scale.field.words(), "unit": unit, "factor": factor, "map": map, "log": scale.log,
            "shown": [ends.lo, ends.hi], "all": self.wall_survey.all(),
        })
    }
}
