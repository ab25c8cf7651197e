//! Tables in the memory of a device: what its threads ([`crate::threads`]) read and write.
#![expect(unsafe_code, reason = "a table is an address in the memory of the device")]

mod columns;
pub mod lists;

pub use columns::{Address, ContactTables, ParticleTables};
use core::slice;
use laws::contact::MoveInputs;
use laws::simd::Layout;
use laws::slowing::fluid::Drag;
use lists::ListTables;

/// A kind of contact, as a device knows it.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct DeviceKind {
    /// Which of the compositions ([`crate::compositions::NAMES`]).
    pub composition: u32,
    /// What its particles meet.
    pub with: u32,
    /// First of the numbers of its effects.
    pub numbers: u32,
    /// Which wall they meet.
    pub wall: u32,
    /// Materials of its particles; the second is that of the wall where they meet one.
    pub between: [u32; 2],
    /// First of its classes in the lists of a tile; of images, its number among them.
    pub class: u32,
    /// Numbers of history that each contact keeps.
    pub columns: u32,
    /// Which of these take the opposite sign when the two particles are exchanged, by bits.
    pub flips: u32,
    /// How contacts with spheres of a wall share it: 0: each by itself; 1: u ∝ δ²; 2: u ∝ δ^(5/2).
    pub patch: u32,
    /// Gap at which their contacts break ([`laws::contact::touch::PatchLaw::gap`]) [m].
    pub gap: f64,
    /// Point and normal of a plane, as at t = 0.
    pub plane: [[f64; 3]; 2],
}

/// What the particles of a kind meet: each other.
pub const PARTICLES: u32 = 0;
/// Each other across a periodic face.
pub const IMAGES: u32 = 1;
/// Wall spheres at rest.
pub const SPHERES: u32 = 2;
/// Wall spheres that move, or whose surface does.
pub const MOVED_SPHERES: u32 = 3;
/// A plane.
pub const PLANE: u32 = 4;
/// Triangles.
pub const MESH: u32 = 5;

/// The triangles of a wall, as at t = 0.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct DeviceMesh {
    /// Three corners of each [m].
    pub corners: Address,
    /// Whether each lies on one before it, a byte; 0 where none does.
    pub doubled: Address,
    /// Tree of their boxes ([`primitives::BoxTree`]).
    pub nodes: Address,
    /// Numbers of the triangles in the order of the tree, four bytes.
    pub order: Address,
    /// Their boxes in that order.
    pub boxes: Address,
    /// Numbers of the walls that are one surface with this one, four bytes, in order and with itself.
    pub surface: Address,
    /// How many nodes the tree has.
    pub node_count: u32,
    /// How many triangles.
    pub parts: u32,
    /// How many walls are one surface with it; 0: no other is.
    pub surface_count: u32,
    /// Nothing.
    pub pad: u32,
    /// Upper bound of the speed of the wall [m/s].
    pub fastest: f64,
    /// Largest gap at which a contact that was made still acts [m].
    pub reach: f64,
}

/// Added to the number of a step: its move waits where an overlap is too deep, as that of a step in which particles begin to move does.
pub const HOLD: u32 = 1 << 31;

/// Where a particle in a zone is after a step.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct DeviceZoneRow {
    /// [m].
    pub position: [f64; 3],
    /// [m/s].
    pub velocity: [f64; 3],
    /// [m/s²].
    pub acceleration: [f64; 3],
    /// [rad/s].
    pub spin: [f64; 3],
    /// 1 where it is still in the zone; [`WATCHED`].
    pub acts: u64,
}

/// Of [`DeviceZoneRow::acts`]: it is in the zone, and whatever it meets counts.
pub const WATCHED: u64 = 2;

/// Particles in zones, and those that begin to move.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct ZoneTables {
    /// How many.
    pub count: u32,
    /// Nothing.
    pub pad: u32,
    /// Where each was among all when all were sent, four bytes.
    pub at: Address,
    /// Step of the launch in which each begins to move, four bytes.
    pub starts: Address,
    /// [`DeviceZoneRow`] of each, in each step of the launch.
    pub rows: Address,
    /// Where each particle is now, by where it was when all were sent, four bytes.
    pub rows_now: Address,
    /// From which step of the launch on each particle is free, by where it was when all were sent, four bytes; none where nothing slows particles besides contacts.
    pub free_from: Address,
}

/// A block of slots.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct DeviceBlock {
    /// Its kind of contact.
    pub kind: u32,
    /// First word of its history.
    pub history: u32,
    /// First of its points ([`DeviceTables::points`]).
    pub point: u32,
}

/// What a step found, beside what it moved.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(C)]
pub struct DeviceFlags {
    /// 1 + the step after which lists must be rebuilt or a guard asked; 0: none yet. Later steps do nothing.
    pub stopped: u32,
    /// Whether a particle has left its margin.
    pub left_margin: u32,
    /// Whether one moved too far.
    pub too_fast: u32,
    /// Whether an overlap passes its limit.
    pub deep: u32,
    /// Whether a number in a table names a row that another does not have: memory is damaged, and the run cannot go on.
    pub beyond: u32,
    /// Whether what is inserted may have met something on its way.
    pub met: u32,
}

/// Tables of a step, and what all threads share.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct DeviceTables {
    /// Of the move.
    pub drive: MoveInputs,
    /// A fluid, where there is one.
    pub fluid: Drag,
    /// 1 where there is.
    pub has_fluid: u32,
    /// α of local damping [–]; 0: none.
    pub damping: f64,
    /// Largest overlap over the smaller radius [–].
    pub overlap_limit: f64,
    /// Number of particles.
    pub particle_count: u32,
    /// Number of slots.
    pub slot_count: u32,
    /// 1 where particles turn.
    pub rotates: u32,
    /// 1 where any effect makes torques.
    pub torques: u32,
    /// Number of points.
    pub point_count: u32,
    /// Number of words of history.
    pub history_count: u32,
    /// Number of listed triangles of all particles.
    pub triangle_count: u32,
    /// Nothing.
    pub pad: u32,
    /// Columns of the particles.
    pub particles: ParticleTables,
    /// Columns of the contacts.
    pub contacts: ContactTables,
    /// Whether the contact in a slot acts, a byte.
    pub acts: Address,
    /// Whether the contact in a slot had been made when the step began, a byte; where contacts last beyond touching.
    pub made: Address,
    /// Force of each contact, and the moment of its tangential part where particles turn.
    pub forces: Address,
    /// Torque of each contact besides; none where no effect makes any.
    pub moments: Address,
    /// [`Row`] of each contact that is not between two particles: of its contact point on wall spheres at rest; else centre and radius of the wall sphere as
    /// at t = 0, or the point of a triangle now, and the shift of the image.
    pub points: Address,
    /// [`WallPose`] of each wall, in each step of the launch.
    pub poses: Address,
    /// [`DeviceMesh`] of each wall.
    pub meshes: Address,
    /// First of the rows below of each particle, and one more: it has one for each listed triangle.
    pub triangle_starts: Address,
    /// [`laws::contact::seams::Nearest`]: memory of a step.
    pub nearest: Address,
    /// [`laws::contact::seams::Member`]: likewise.
    pub members: Address,
    /// [`DeviceKind`] of each kind of contact.
    pub kinds: Address,
    /// Numbers of their effects.
    pub numbers: Address,
    /// Particles of a tile.
    pub tile: u32,
    /// Number of walls.
    pub walls: u32,
    /// First slot of each tile.
    pub tiles: Address,
    /// Particles in zones.
    pub zones: ZoneTables,
    /// [`DeviceFlags`].
    pub flags: Address,
    /// What lists are made with.
    pub lists: ListTables,
}

impl DeviceTables {
    /// Rows of a table.
    ///
    /// # Safety
    /// There are so many, and no thread writes to them meanwhile.
    #[inline(always)]
    pub unsafe fn table<T>(&self, from: Address, rows: u32) -> &[T] {
        // SAFETY: by contract.
        unsafe { slice::from_raw_parts(from.at(0), rows as usize) }
    }

    /// Whether an earlier step has ended the launch.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    pub unsafe fn is_over(&self, step: u32) -> bool {
        // SAFETY: by contract. Threads of this step may write 1 + step meanwhile, which is no earlier one.
        let stopped = unsafe { self.flags.at::<u32>(0).read_volatile() };
        stopped != 0 && stopped <= step
    }

    /// Whether an overlap is too deep in this step.
    ///
    /// # Safety
    /// Tables are in place, and no thread computes contacts meanwhile.
    #[inline(always)]
    pub unsafe fn is_too_deep(&self, step: u32) -> bool {
        // SAFETY: by contract.
        unsafe {
            let flags = self.flags;
            flags.at::<u32>(3).read_volatile() != 0 && flags.at::<u32>(0).read_volatile() == step + 1
        }
    }

    /// Notes that a number of a table lies beyond another table, and ends the launch; in step `step` of it.
    ///
    /// # Safety
    /// Tables are in place.
    #[cold]
    pub unsafe fn beyond(&self, step: u32) {
        // SAFETY: by contract.
        unsafe {
            self.flag(4, 1);
            self.flag(0, step + 1);
        }
    }

    /// Sets a flag of [`DeviceFlags`] by its place. All threads write the same number.
    ///
    /// # Safety
    /// Tables are in place.
    #[inline(always)]
    pub unsafe fn flag(&self, place: usize, value: u32) {
        // SAFETY: by contract.
        unsafe { self.flags.at::<u32>(place).write_volatile(value) }
    }

    /// How wrenches lie in their columns.
    #[inline(always)]
    pub fn layout(&self) -> Layout {
        Layout { rotates: self.rotates != 0, single: false }
    }
}
