//! `[[outlet]]`: storage planes with their zones.

use super::builder::PlanBuilder;
use super::walls;
use crate::error::SceneError;
use crate::keys::OrAuto;
use dem::setup::Zone;
use geom::Shown;

impl PlanBuilder<'_> {
    pub(super) fn outlets(&mut self) -> Result<(), SceneError> {
        let largest = 2.0 * self.sizes().map_or(0.0, |s| s.largest).max(self.widest_clump());
        for (i, entry) in self.keys().outlet.iter().enumerate() {
            let plane = walls::plane(&self.check, &format!("outlet.{i}.plane"), &entry.plane)?;
            let length = match entry.length {
                OrAuto::Auto => 1.2 * largest,
                OrAuto::Given(length) => length,
            };
            if length <= largest {
                let why = format!("is not above the largest diameter, {} m", Shown(largest));
                let cure = format!("use \"auto\", or at least {} m", Shown(1.2 * largest));
                let key = format!("outlet.{i}.length");
                return Err(self.check.wrong(&key, format!("{length} m"), &why, &cure));
            }
            self.outlets.push(Zone { plane, length, motion: entry.motion, test: entry.test });
        }
        Ok(())
    }
}
