//! Merges the copies and replays of a record into one stream.

use super::Replay;
use super::head::Head;
use super::queue::Generated;
use crate::outlet::crossing::CrossingRow;
use dem::setup::Zone;
use geom::{Shown, Vec3};
use scene::{Result, SceneError};
use std::collections::VecDeque;

/// Two of different copies may overlap by this share of the smaller radius [–].
const OVERLAP: f64 = 0.01;

/// Gives new ids where ids are not unique, and checks that copies do not overlap.
pub struct Merge {
    renumber: Option<u32>,
    several: bool,
    zone: Zone,
    acceleration: Vec3,
    largest: f64,
    recent: VecDeque<Generated>,
}

impl Merge {
    pub fn new(head: &Head, what: &Replay) -> Merge {
        let several = what.copies.count > 1;
        let again = several || what.repeat > 1;
        Merge {
            renumber: what.first_id.or(again.then_some(0)),
            several,
            zone: head.zone.zone,
            acceleration: head.acceleration(),
            largest: head.widest,
            recent: VecDeque::new(),
        }
    }

    /// A row as it is written; `members` is the number of its spheres.
    pub fn pass(&mut self, name: &str, one: Generated, members: u32) -> Result<CrossingRow> {
        if self.several {
            self.check_overlap(name, &one)?;
            self.recent.push_back(one.clone());
        }
        let mut row = one.row;
        if let Some(next) = &mut self.renumber {
            row.particle.id = *next;
            *next = next.checked_add(members).filter(|id| *id < u32::MAX).ok_or_else(|| {
                let why = "there are more grains than ids (4294967294)";
                SceneError::file(name, why, "replay fewer, or use a lower --first-id")
            })?;
        }
        Ok(row)
    }

    /// Refuses a row that overlaps one of another copy when it is generated.
    fn check_overlap(&mut self, name: &str, one: &Generated) -> Result<()> {
        let (now, b) = (one.row.time, &one.row.particle);
        let at = |o: &Generated| {
            let tau = now - o.row.time;
            let p = &o.row.particle;
            p.position + p.velocity * tau + self.acceleration * (0.5 * tau * tau)
        };
        // Those far ahead of the generation plane touch nothing that comes from now on.
        let far = |o: &Generated| self.zone.plane.signed_distance(&at(o)) > 2.0 * self.largest;
        while self.recent.front().is_some_and(far) {
            self.recent.pop_front();
        }
        for other in self.recent.iter().filter(|o| o.origin.copy != one.origin.copy) {
            let a = &other.row.particle;
            let overlap = a.radius + b.radius - (at(other) - b.position).norm();
            if overlap > OVERLAP * a.radius.min(b.radius) {
                let named =
                    |g: &Generated| format!("copy {} of particle {}", g.origin.copy, g.row.particle.id);
                let (overlap, now) = (Shown(overlap), Shown(now));
                let (late, early) = (named(one), named(other));
                let why = format!("{late} overlaps {early} by {overlap} m when it comes in, at {now} s");
                let cure =
                    "use a larger --copy-shift, so that the copies do not overlap, or another --copy-delay";
                return Err(SceneError::file(name, why, cure));
            }
        }
        Ok(())
    }
}
