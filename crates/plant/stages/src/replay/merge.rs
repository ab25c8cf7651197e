//! Merges the copies and replays of a record into one stream.

use super::Replay;
use super::head::Head;
use super::queue::{Generated, Origin};
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
    /// Copies of the record in each replay, and in all replays together.
    copies: u32,
    times: u32,
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
            times: what.copies.count.saturating_mul(what.repeat.max(1)),
            copies: what.copies.count,
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
        row.cluster = self.cluster(name, &one)?;
        if let Some(next) = &mut self.renumber {
            row.particle.id = *next;
            *next = next.checked_add(members).filter(|id| *id < u32::MAX).ok_or_else(|| {
                let why = "there are more grains than ids (4294967294)";
                SceneError::file(name, why, "replay fewer, or use a lower --first-id")
            })?;
        }
        Ok(row)
    }

    /// The cluster of a row: a stone of one copy is not that of another.
    fn cluster(&self, name: &str, one: &Generated) -> Result<u32> {
        if one.row.cluster == 0 {
            return Ok(0);
        }
        let Origin { copy, replay } = one.origin;
        let number = replay.checked_mul(self.copies).and_then(|before| before.checked_add(copy + 1));
        let before = (one.row.cluster - 1).checked_mul(self.times);
        number.zip(before).and_then(|(number, before)| before.checked_add(number)).ok_or_else(|| {
            let why = format!(
                "cluster {} in {} copies gets a number above {}",
                one.row.cluster,
                self.times,
                u32::MAX
            );
            SceneError::file(name, why, "replay fewer")
        })
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
