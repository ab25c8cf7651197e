//! Particles that come in too fast, and those that go back.

use crate::model::{Entrance, Halt};
use crate::setup::{Particle, Setup};
use crate::state::{Direction, Kinematics, Zones};
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

    /// Whether any inlet is watched for particles that go back.
    pub(crate) fn is_watched(&self) -> bool {
        !self.lost.returned.inlets.is_empty()
    }

    /// Whether no particle on its way in, or that comes in between two times [s], moves by more than the guard's share of its radius in a step, up to then. Where motions are in
    /// closed form their speeds are largest at an end.
    pub(crate) fn stay_slow(&self, [from, to]: [f64; 2], dt: f64, setup: &Setup) -> bool {
        // A little less, so that no rounding hides what the guard finds.
        let limit = setup.guards.motion * (1.0 - 1e-9);
        let slow = |start: &Particle, since: f64, acceleration: Vec3| {
            [from.max(since), to.max(since)].into_iter().all(|time| {
                let speed = Kinematics::after(time - since, start, acceleration).velocity.norm();
                speed * dt / start.radius <= limit
            })
        };
        let due = self.pending.iter().take_while(|entry| entry.time <= to);
        let coming = due.chain(&self.waiting);
        let on_their_way = self.zone_particles.iter().filter(|t| matches!(t.direction, Direction::In(_)));
        self.paths.is_empty()
            && on_their_way
                .into_iter()
                .all(|t| slow(&t.start, t.since, t.zone(self).acceleration(&setup.gravity)))
            && coming.into_iter().all(|entry| {
                let zone = self.inlets[entry.inlet as usize];
                slow(&entry.particle, entry.time, zone.acceleration(&setup.gravity))
            })
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
