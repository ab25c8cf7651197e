//! Keeps passages in the order in which they are generated.

use crate::crossings::Passage;
use dem::setup::{Link, Memory};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::collections::binary_heap::PeekMut;
use std::rc::Rc;

/// A passage that is generated, which copy of it, and what it knows of others.
#[derive(Clone)]
pub struct Generated {
    pub row: Passage,
    pub copy: (u32, u32),
    pub known: Known,
}

/// What a passage knows of others.
#[derive(Clone)]
pub struct Known {
    /// What its contacts remember.
    pub touches: Rc<[Memory]>,
    /// Its bonds.
    pub links: Rc<[Link]>,
}

/// Passages that wait for those that may be generated before them; no more than pass in the time that one may wait.
#[derive(Default)]
pub struct Order {
    waiting: BinaryHeap<Waiting>,
    count: u64,
}

/// The first to be generated is the greatest; of two at one time, the one that came first.
struct Waiting {
    one: Generated,
    number: u64,
}

impl Order {
    pub fn put(&mut self, one: Generated) {
        self.count += 1;
        self.waiting.push(Waiting { one, number: self.count });
    }

    /// The next one that is generated at `bound` [s] or before.
    pub fn next_until(&mut self, bound: f64) -> Option<Generated> {
        let first = self.waiting.peek_mut().filter(|w| w.one.row.time <= bound)?;
        Some(PeekMut::pop(first).one)
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Waiting) -> Ordering {
        other.one.row.time.total_cmp(&self.one.row.time).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Waiting) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Waiting) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}
