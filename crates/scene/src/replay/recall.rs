//! What contacts of a record have to remember downstream, with the ids that grains get there.
//!
//! A grain that passes knows its contacts with those that have not passed yet: they are to be remembered once it is free, while the others are
//! on their way in. So each is told with the later of the two, whose id is only known then. Along recorded paths the others are on their way
//! before they pass, and nobody gets a new id: all are told with the grain itself.

use super::order::Generated;
use crate::crossings::Passage;
use crate::touches::Touching;
use dem::setup::Memory;
use std::collections::{BTreeMap, VecDeque};

/// Contacts that wait for their second grain; most never wait long, and of those whose second grain never passes the oldest are forgotten.
const MOST: usize = 100_000;

/// A grain of one copy in one replay.
type Key = ((u32, u32), u32);

/// Contacts whose first grain has been generated.
#[derive(Default)]
pub struct Recall {
    /// By the grain that they wait for: the memory, with the first grain's new id.
    waiting: BTreeMap<Key, Vec<Memory>>,
    order: VecDeque<Key>,
}

impl Recall {
    /// What is told with a grain of so many spheres, that was recorded with its first id `was` and is written as `row`.
    pub fn with(&mut self, one: &Generated, row: &Passage, (members, at_once): (u32, bool)) -> Vec<Touching> {
        let (was, now, time) = (one.row.particle.id, row.particle.id, row.time);
        let renamed = |id: u32| now.wrapping_add(id.wrapping_sub(was));
        if at_once {
            return one.touches.iter().map(|&memory| Touching { time, memory }).collect();
        }
        let mut told = Vec::new();
        for k in 0..members {
            let id = was.wrapping_add(k);
            for memory in self.waiting.remove(&(one.copy, id)).unwrap_or_default() {
                told.push(Touching { time, memory: Memory { partner: renamed(id), ..memory } });
            }
        }
        for memory in one.touches.iter() {
            let key = (one.copy, memory.partner);
            self.waiting.entry(key).or_default().push(Memory { id: renamed(memory.id), ..*memory });
            self.order.push_back(key);
        }
        while self.order.len() > MOST {
            if let Some(oldest) = self.order.pop_front() {
                self.waiting.remove(&oldest);
            }
        }
        told
    }
}
