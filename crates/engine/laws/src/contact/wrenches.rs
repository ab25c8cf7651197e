//! Wrenches as columns of words: forces with the moments of tangential forces, and torques besides, where an effect makes any.

use crate::simd::Layout;

/// Wrenches of some contacts or particles.
#[derive(Debug, Clone, Copy, Default)]
pub struct WrenchSlices<'a> {
    /// Words of forces; empty where they are not kept.
    pub forces: &'a [f64],
    /// Words of torques; empty where no effect makes any.
    pub torques: &'a [f64],
}

/// The same, to be written.
#[derive(Debug, Default)]
pub struct WrenchSlicesMut<'a> {
    /// Words of forces; empty where they are not kept.
    pub forces: &'a mut [f64],
    /// Words of torques; empty where no effect makes any.
    pub torques: &'a mut [f64],
}

impl<'a> WrenchSlices<'a> {
    /// `n` rows after `from` others.
    pub fn rows(self, from: usize, n: usize, layout: Layout) -> WrenchSlices<'a> {
        let (force, torque) = (layout.force(), layout.torque());
        WrenchSlices {
            forces: rows(self.forces, from * force, n * force),
            torques: rows(self.torques, from * torque, n * torque),
        }
    }
}

impl<'a> WrenchSlicesMut<'a> {
    /// To be read.
    pub fn as_ref(&self) -> WrenchSlices<'_> {
        WrenchSlices { forces: self.forces, torques: self.torques }
    }

    /// `n` rows after `from` others.
    pub fn rows_mut(&mut self, from: usize, n: usize, layout: Layout) -> WrenchSlicesMut<'_> {
        let (force, torque) = (layout.force(), layout.torque());
        WrenchSlicesMut {
            forces: rows_mut(self.forces, from * force, n * force),
            torques: rows_mut(self.torques, from * torque, n * torque),
        }
    }

    /// Sets them to these.
    pub fn copy_from(&mut self, other: WrenchSlices) {
        self.forces.copy_from_slice(other.forces);
        self.torques.copy_from_slice(other.torques);
    }

    /// Takes the first `n` rows off, or all where there are fewer.
    pub fn split_off(&mut self, n: usize, layout: Layout) -> WrenchSlicesMut<'a> {
        let forces = split_off(&mut self.forces, n * layout.force());
        WrenchSlicesMut { forces, torques: split_off(&mut self.torques, n * layout.torque()) }
    }
}

/// `n` numbers of a column, or none of a column that does not exist.
pub fn rows<T>(of: &[T], from: usize, n: usize) -> &[T] {
    if of.is_empty() { &[] } else { &of[from..from + n] }
}

/// The same, to be written.
pub fn rows_mut<T>(of: &mut [T], from: usize, n: usize) -> &mut [T] {
    if of.is_empty() { &mut [] } else { &mut of[from..from + n] }
}

/// Takes the first `n` numbers off a column, or all where there are fewer.
pub fn split_off<'a, T>(column: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    let n = n.min(column.len());
    column.split_off_mut(..n).unwrap_or_default()
}

/// One end of a contact: a slot, and which of its two particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(transparent)]
pub struct SlotEnd(u32);

impl SlotEnd {
    /// The first particle of the contact in a slot, or its second.
    pub fn new(slot: usize, second: bool) -> SlotEnd {
        SlotEnd(2 * slot as u32 + u32::from(second))
    }

    /// The slot of the contact.
    #[inline(always)]
    pub fn slot(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Its place in the order of slots, of one contact the first particle first.
    #[inline(always)]
    pub fn order(self) -> u32 {
        self.0
    }

    /// Whether the particle is the second of the contact.
    #[inline(always)]
    pub fn is_second(self) -> bool {
        self.0 & 1 == 1
    }
}

/// A wrench that arrives at a tile from elsewhere.
#[derive(Debug, Clone, Copy)]
pub struct Arrival {
    /// Its contact, among those whose wrenches are kept, and which end the particle is.
    pub from: SlotEnd,
    /// The particle that takes it.
    pub particle: u32,
}
