//! Keeps rows in the order in which they are generated.

use crate::outlet::crossing::CrossingRow;
use dem::setup::{CrossingBond, PairHistory};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::collections::binary_heap::PeekMut;
use std::rc::Rc;

/// A row that is generated.
#[derive(Clone)]
pub struct Generated {
    pub row: CrossingRow,
    /// Which copy in which replay it is.
    pub origin: Origin,
    pub partners: Partners,
}

/// Which copy of a record, in which replay of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Origin {
    pub copy: u32,
    pub replay: u32,
}

/// Contacts and bonds of a row.
#[derive(Clone)]
pub struct Partners {
    pub contacts: Rc<[PairHistory]>,
    pub bonds: Rc<[CrossingBond]>,
}

/// Rows that wait for those that may be generated before them.
#[derive(Default)]
pub struct Queue {
    waiting: BinaryHeap<Waiting>,
    count: u64,
}

/// The first to be generated is the greatest; of two at one time, the one that came first.
struct Waiting {
    one: Generated,
    number: u64,
}

impl Queue {
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
