//! Contacts and bonds of replayed particles, with the ids that the particles get downstream.
//!
//! A particle that crosses has contacts and bonds with particles that have not crossed yet. They are needed downstream once the first is
//! free, while the other is on its way in. So each is written with the later of the two, whose new id is only known then. Along recorded
//! paths the others are on their way before they cross and no id changes: all are written with the first.
//!
//! A bond that broke upstream between the two crossings is not written.

use super::queue::{Generated, Origin};
use crate::outlet::bond::BondRow;
use crate::outlet::contact::ContactRow;
use crate::outlet::crossing::CrossingRow;
use dem::setup::{CrossingBond, PairHistory};
use std::collections::{BTreeMap, VecDeque};

/// Contacts or bonds that wait for their second particle. Beyond this number the oldest are dropped: their second particle has most
/// likely not crossed.
const MOST: usize = 100_000;

/// A particle of one copy in one replay.
type Key = (Origin, u32);

/// What waits for a particle.
struct Waiting<T> {
    by_particle: BTreeMap<Key, Vec<T>>,
    order: VecDeque<Key>,
}

impl<T> Default for Waiting<T> {
    fn default() -> Waiting<T> {
        Waiting { by_particle: BTreeMap::new(), order: VecDeque::new() }
    }
}

impl<T> Waiting<T> {
    fn remove(&mut self, key: Key) -> Vec<T> {
        self.by_particle.remove(&key).unwrap_or_default()
    }

    fn insert(&mut self, key: Key, what: T) {
        self.by_particle.entry(key).or_default().push(what);
        self.order.push_back(key);
        if self.order.len() > MOST
            && let Some(oldest) = self.order.pop_front()
        {
            self.by_particle.remove(&oldest);
        }
    }
}

/// Contacts and bonds whose first particle has been generated, with its new id.
#[derive(Default)]
pub struct Pairs {
    contacts: Waiting<PairHistory>,
    /// With the id that the first particle had.
    bonds: Waiting<(u32, CrossingBond)>,
}

/// Contacts and bonds that are written with one row.
#[derive(Default)]
pub struct PairRows {
    pub contacts: Vec<ContactRow>,
    pub bonds: Vec<BondRow>,
}

impl PairRows {
    /// Adds those of a particle that follows a recorded path.
    pub fn add(&mut self, one: &Generated, row: &CrossingRow) {
        let (time, place) = (row.time, row.particle.position);
        self.contacts.extend(one.partners.contacts.iter().map(|&pair| ContactRow { time, pair }));
        self.bonds.extend(one.partners.bonds.iter().map(|&bond| BondRow { time, place, bond }));
    }
}

impl Pairs {
    /// Adds those that are complete with a particle of so many spheres, which is written as `row`.
    pub fn complete(&mut self, one: &Generated, row: &CrossingRow, members: u32, rows: &mut PairRows) {
        let (was, now, time) = (one.row.particle.id, row.particle.id, row.time);
        let renamed = |id: u32| now.wrapping_add(id.wrapping_sub(was));
        let (place, partners) = (row.particle.position, &one.partners);
        for k in 0..members {
            let id = was.wrapping_add(k);
            for pair in self.contacts.remove((one.origin, id)) {
                let pair = PairHistory { partner: renamed(id), ..pair };
                rows.contacts.push(ContactRow { time, pair });
            }
        }
        for (first, bond) in self.bonds.remove((one.origin, was)) {
            if partners.bonds.iter().any(|mine| mine.partner == first) {
                rows.bonds.push(BondRow { time, place, bond: CrossingBond { partner: now, ..bond } });
            }
        }
        for pair in partners.contacts.iter() {
            let first = PairHistory { id: renamed(pair.id), ..*pair };
            self.contacts.insert((one.origin, pair.partner), first);
        }
        for bond in partners.bonds.iter() {
            self.bonds.insert((one.origin, bond.partner), (was, CrossingBond { id: now, ..*bond }));
        }
    }
}
