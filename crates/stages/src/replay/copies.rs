//! Several replays of one record, and superposed copies of it.
//!
//! Copy k = 0 … n−1 is displaced by k s and delayed by k T; replay m = 0 … r−1 is delayed by m P. All of them together get new ids, in
//! the order in which they enter. Superposed copies scale a rate, and not the flow: they know nothing of each other where they
//! were recorded, and must not overlap where they come in.

use super::Replay;
use super::order::Generated;
use crate::crossings::Passage;
use crate::error::SceneError;
use dem::setup::Zone;
use geom::{Shown, Vec3};
use std::collections::VecDeque;

/// Two of different copies may overlap by this share of the smaller radius [–].
const OVERLAP: f64 = 0.01;

/// Superposed copies of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Copies {
    /// How many, the record itself included.
    pub count: u32,
    /// s [m].
    pub shift: Vec3,
    /// T [s].
    pub delay: f64,
}

impl Default for Copies {
    fn default() -> Copies {
        Copies { count: 1, shift: Vec3::zeros(), delay: 0.0 }
    }
}

impl Copies {
    /// The copies of a passage, with the number of each.
    pub fn of(&self, row: Passage) -> impl Iterator<Item = (u32, Passage)> + use<> {
        let Copies { count, shift, delay } = *self;
        (0..count).map(move |k| {
            let mut row = row;
            row.particle.position += shift * f64::from(k);
            row.time += delay * f64::from(k);
            (k, row)
        })
    }
}

/// Gives new ids where there are several of one, and looks at copies side by side.
pub struct Merge {
    renumber: Option<u32>,
    several: bool,
    zone: Zone,
    acceleration: Vec3,
    largest: f64,
    recent: VecDeque<Generated>,
}

impl Merge {
    pub fn new(what: &Replay, zone: Zone, gravity: Vec3, largest: f64) -> Merge {
        let several = what.copies.count > 1;
        let again = several || what.repeat > 1;
        Merge {
            renumber: what.first_id.or(again.then_some(0)),
            several,
            zone,
            acceleration: zone.acceleration(&gravity),
            largest,
            recent: VecDeque::new(),
        }
    }

    /// A passage as it is written; `members` is the number of its spheres.
    pub fn pass(&mut self, name: &str, one: Generated, members: u32) -> Result<Passage, SceneError> {
        if self.several {
            self.beside(name, &one)?;
            self.recent.push_back(one.clone());
        }
        let mut row = one.row;
        if let Some(next) = &mut self.renumber {
            row.particle.id = *next;
            *next = next.checked_add(members).filter(|id| *id < u32::MAX).ok_or_else(|| {
                SceneError::file(
                    name,
                    "there are more grains than ids (4294967294)",
                    "replay fewer, or use a lower --first-id",
                )
            })?;
        }
        Ok(row)
    }

    /// Refuses a passage that overlaps one of another copy when it is generated.
    fn beside(&mut self, name: &str, one: &Generated) -> Result<(), SceneError> {
        let (now, b) = (one.row.time, &one.row.particle);
        let at = |o: &Generated| {
            let tau = now - o.row.time;
            let p = &o.row.particle;
            p.position + p.velocity * tau + self.acceleration * (0.5 * tau * tau)
        };
        // Those far ahead of the generation plane touch nothing that comes from now on.
        let gone = |o: &Generated| self.zone.plane.signed_distance(&at(o)) > 2.0 * self.largest;
        while self.recent.front().is_some_and(gone) {
            self.recent.pop_front();
        }
        for other in self.recent.iter().filter(|o| o.copy.0 != one.copy.0) {
            let a = &other.row.particle;
            let overlap = a.radius + b.radius - (at(other) - b.position).norm();
            if overlap > OVERLAP * a.radius.min(b.radius) {
                let why = format!(
                    "copy {} of particle {} overlaps copy {} of particle {} by {} m when it comes in, at {} s",
                    one.copy.0,
                    b.id,
                    other.copy.0,
                    a.id,
                    Shown(overlap),
                    Shown(now)
                );
                let cure = "give copies another --copy-shift, so that they come in beside each other, or another --copy-delay";
                return Err(SceneError::file(name, why, cure));
            }
        }
        Ok(())
    }
}
