//! Columns in the memory of a device: of particles, and of contacts.

/// Where a table begins, in the memory of the device.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Address(pub u64);

impl Address {
    /// Row `k` of a table.
    #[inline(always)]
    pub fn at<T>(self, k: usize) -> *mut T {
        (self.0 as *mut T).wrapping_add(k)
    }
}

/// Columns of particles.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct ParticleTables {
    /// [`laws::simd::Row`] of each, and two more that nothing touches.
    pub rows: Address,
    /// [`laws::simd::Row4`] of each, and two more; none without rotation.
    pub spins: Address,
    /// [`laws::simd::Row4`] of each.
    pub acceleration: Address,
    /// [`laws::simd::Row4`] of each; none without rotation.
    pub angular_acceleration: Address,
    /// [`laws::simd::Row4`] of each: where it was listed, and its margin.
    pub home: Address,
    /// Material of each, four bytes.
    pub material: Address,
    /// Where each was when all of them were sent.
    pub place: Address,
}

/// Columns of contacts, and which of them each particle has.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct ContactTables {
    /// First particle of each, a number of four bytes.
    pub i: Address,
    /// Second particle, or image and part of a wall.
    pub partner: Address,
    /// History, by block and column.
    pub history: Address,
    /// [`crate::tables::DeviceBlock`] of each block of slots.
    pub blocks: Address,
    /// First contact of each particle, and one more.
    pub starts: Address,
    /// Contacts of particles ([`laws::contact::SlotEnd`]) in the order of their slots.
    pub entries: Address,
}
