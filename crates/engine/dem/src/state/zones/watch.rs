//! Particles that come in too fast, and those that go back.

use crate::model::{Entrance, Halt};
use crate::setup::Setup;
use crate::state::{Direction, Zones};
use geom::Vec3;

impl Zones {
    /// Refuses a particle on its way in that moves by more than the guard's share of its radius in a step.
    pub(crate) fn fast(&self, time: f64, dt: f64, setup: &Setup) -> Result<(), Halt> {
        let limit = setup.guards.motion;
        for t in &self.zone_particles {
            let Direction::In(inlet) = t.direction else { continue };
            let speed = t.flow(time, self, setup).velocity.norm();
            let share = speed * dt / t.start.radius;
            if !(share <= limit) {
                let by = Entrance::of(inlet, setup.guards.cuts);
                return Err(Halt::TooFast { time, id: t.start.id, by, speed, dt, share, limit });
            }
        }
        Ok(())
    }

    /// How far a free particle is behind the calculation plane that it came by, less the length of the zone: above 0 it is behind
    /// the generation plane; and its inlet. Counts those that come back.
    pub(crate) fn came_back(&mut self, k: usize, position: &Vec3, radius: f64) -> Option<(u32, f64)> {
        // None is watched where all that comes in is inserted.
        let origin = *self.lost.origins.get(k)?;
        if origin.inlet == 0 || self.gone[k] || self.prescribed[k] {
            return None;
        }
        let inlet = origin.inlet - 1;
        let zone = &self.inlets[inlet as usize];
        let past = zone.past(position, radius);
        if (past < 0.0) != origin.behind {
            self.lost.origins[k].behind = past < 0.0;
            self.lost.returned.inlets[inlet as usize] += u64::from(past < 0.0);
        }
        Some((inlet, -past - zone.length))
    }
}
