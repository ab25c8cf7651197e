//! What contacts of a record have to remember downstream, and who is bonded, with the ids that grains get there.
//!
//! A grain that passes knows its contacts and bonds with those that have not passed yet: they are to be remembered once it is free, while the others are
//! on their way in. So each is told with the later of the two, whose id is only known then. Along recorded paths the others are on their way
//! before they pass, and nobody gets a new id: all are told with the grain itself.
//!
//! A bond that broke upstream between the two passages is not told: what is broken never heals.

use super::order::Generated;
use crate::crossings::Passage;
use crate::links::Linking;
use crate::touches::Touching;
use dem::setup::{Link, Memory};
use std::collections::{BTreeMap, VecDeque};

/// Those that wait for their second grain; most never wait long, and of those whose second grain never passes the oldest are forgotten.
const MOST: usize = 100_000;

/// A grain of one copy in one replay.
type Key = ((u32, u32), u32);

/// What waits for a grain.
struct Shelf<T> {
    waiting: BTreeMap<Key, Vec<T>>,
    order: VecDeque<Key>,
}

impl<T> Default for Shelf<T> {
    fn default() -> Shelf<T> {
        Shelf { waiting: BTreeMap::new(), order: VecDeque::new() }
    }
}

impl<T> Shelf<T> {
    fn take(&mut self, key: Key) -> Vec<T> {
        self.waiting.remove(&key).unwrap_or_default()
    }

    fn put(&mut self, key: Key, what: T) {
        self.waiting.entry(key).or_default().push(what);
        self.order.push_back(key);
        if self.order.len() > MOST
            && let Some(oldest) = self.order.pop_front()
        {
            self.waiting.remove(&oldest);
        }
    }
}

/// Contacts and bonds whose first grain has been generated, with its new id.
#[derive(Default)]
pub struct Recall {
    memories: Shelf<Memory>,
    /// And the id that it had.
    links: Shelf<(u32, Link)>,
}

impl Recall {
    /// What is told with a grain of so many spheres, that was recorded with its first id `was` and is written as `row`.
    pub fn with(
        &mut self,
        one: &Generated,
        row: &Passage,
        (members, at_once): (u32, bool),
    ) -> (Vec<Touching>, Vec<Linking>) {
        let (was, now, time) = (one.row.particle.id, row.particle.id, row.time);
        let renamed = |id: u32| now.wrapping_add(id.wrapping_sub(was));
        let place = row.particle.position;
        let known = &one.known;
        if at_once {
            let touches = known.touches.iter().map(|&memory| Touching { time, memory });
            let links = known.links.iter().map(|&link| Linking { time, place, link });
            return (touches.collect(), links.collect());
        }
        let (mut told, mut bonded) = (Vec::new(), Vec::new());
        for k in 0..members {
            let id = was.wrapping_add(k);
            for memory in self.memories.take((one.copy, id)) {
                told.push(Touching { time, memory: Memory { partner: renamed(id), ..memory } });
            }
        }
        for (first, link) in self.links.take((one.copy, was)) {
            if known.links.iter().any(|mine| mine.partner == first) {
                bonded.push(Linking { time, place, link: Link { partner: now, ..link } });
            }
        }
        for memory in known.touches.iter() {
            self.memories.put((one.copy, memory.partner), Memory { id: renamed(memory.id), ..*memory });
        }
        for link in known.links.iter() {
            self.links.put((one.copy, link.partner), (was, Link { id: now, ..*link }));
        }
        (told, bonded)
    }
}
