//! Colours of walls by what was done to them.

use super::key::BarKey;
use crate::appearance::wall_scale::{WALL_MAP, WallScale, WallSurvey};
use crate::things::wear_state::WORN;
use stream::Table;

/// What the colours of walls mean.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WallKey {
    scale: WallScale,
    pub bar: BarKey,
}

impl WallKey {
    /// Of what was seen.
    pub fn of(survey: &WallSurvey, scale: WallScale) -> WallKey {
        let (range, beyond) = survey.ends(&scale);
        let title = format!("walls: {}", scale.field.words());
        let bar = BarKey { title, unit: scale.field.unit(), range, beyond, log: scale.log, map: WALL_MAP };
        WallKey { scale, bar }
    }

    /// The colour of each value, parts 0 to 1.
    pub fn colours(&self, values: impl Iterator<Item = f64>) -> Vec<[f32; 3]> {
        let steps: Vec<[f32; 3]> = (0..=1023).map(|i| WALL_MAP.at(f64::from(i) / 1023.0)).collect();
        values.map(|v| steps[(1023.0 * self.scale.share(self.bar.range, v)) as usize]).collect()
    }

    /// The colours of wall spheres; none where their values are not known.
    pub fn of_spheres(&self, table: &Table) -> Option<Vec<[f32; 3]>> {
        Some(self.colours(table.get(WORN)?.to_f64().into_iter()))
    }
}
