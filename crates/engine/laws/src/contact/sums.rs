//! Sums of the wrenches on each particle, and the order in which they are made.
//!
//! A contact's wrench is computed once and added to both of its particles. A particle sums, in the order of their slots, the contacts
//! with particles of its own tile and with walls, while they are computed; then those that arrive from elsewhere, which were kept until its
//! tile is summed: of images across periodic faces, and of earlier tiles. The order depends on the lists alone, so that no sum depends
//! on threads.

use crate::contact::{Arrival, WrenchSlices, WrenchSlicesMut};
use crate::simd::number::numbers_of_force;
use crate::simd::{Each, FORCE, Four, Layout, Number, TORQUE, fetch};
use crate::with_layout;
use primitives::Vec3;

/// Arrivals between the one whose wrench is prefetched and the one that is added; chosen on the bench pile.
const AHEAD: usize = 24;

/// Adds a row of `N` numbers to a sum; to none that does not exist.
#[inline(always)]
pub fn add<T: Number, const N: usize>(sums: &mut [T], at: usize, row: &[T]) {
    let (Some(sum), Some(row)) = (sums.as_chunks_mut::<N>().0.get_mut(at), row.first_chunk::<N>()) else {
        return;
    };
    for a in 0..N {
        sum[a] += row[a];
    }
}

/// Adds what a contact does to its second particle: the opposite force or torque, the same moment of radius −1.
#[inline(always)]
pub fn add_opposite<T: Number, const N: usize>(sums: &mut [T], at: usize, row: &[T]) {
    let (Some(sum), Some(row)) = (sums.as_chunks_mut::<N>().0.get_mut(at), row.first_chunk::<N>()) else {
        return;
    };
    for a in 0..FORCE.min(N) {
        sum[a] -= row[a];
    }
    for a in FORCE..N {
        sum[a] += row[a];
    }
}

/// The particles of some contacts, and which of them take their wrenches.
#[derive(Clone, Copy)]
pub struct Pairs<'a> {
    /// First particle of each.
    pub i: &'a [u32],
    /// Second particle of each.
    pub j: &'a [u32],
    /// Whether the second takes its wrench, too.
    pub both: bool,
}

/// Sums of some particles, as they are being made.
#[derive(Default)]
pub struct Sums<'a> {
    /// Number of the first particle.
    pub first: usize,
    /// How numbers lie in them.
    pub layout: Layout,
    /// The sums, a row a particle.
    pub wrenches: WrenchSlicesMut<'a>,
}

impl<'a> Sums<'a> {
    /// Reborrowed.
    pub fn by_ref(&mut self) -> Sums<'_> {
        let wrenches = WrenchSlicesMut { forces: self.wrenches.forces, torques: self.wrenches.torques };
        Sums { first: self.first, layout: self.layout, wrenches }
    }

    /// Takes the first `n` particles off, or all where there are fewer.
    pub fn split_off(&mut self, n: usize) -> Sums<'a> {
        let Sums { first, layout, .. } = *self;
        self.first += n;
        Sums { first, layout, wrenches: self.wrenches.split_off(n, layout) }
    }

    /// Sets all to 0.
    pub fn clear(&mut self) {
        self.wrenches.forces.fill(0.0);
        self.wrenches.torques.fill(0.0);
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.wrenches.forces.len() / self.layout.force()
    }

    /// Sets them to these.
    pub fn set(&mut self, sums: WrenchSlices) {
        self.wrenches.copy_from(sums);
    }

    /// Adds forces (of `N` numbers) and torques (or none) of contacts to those of their particles that are of these.
    #[inline(always)]
    pub fn accumulate<T: Number, const N: usize>(&mut self, pairs: Pairs, forces: &[T], torques: &[T]) {
        let first = self.first as u32;
        let at = |k: u32| k.wrapping_sub(first) as usize;
        let ends = || pairs.i.iter().zip(pairs.j);
        let sums = T::of_mut(self.wrenches.forces);
        for ((&i, &j), force) in ends().zip(forces.as_chunks::<N>().0) {
            add::<T, N>(sums, at(i), force);
            if pairs.both {
                add_opposite::<T, N>(sums, at(j), force);
            }
        }
        let sums = T::of_mut(self.wrenches.torques);
        for ((&i, &j), torque) in ends().zip(torques.as_chunks::<TORQUE>().0) {
            add::<T, TORQUE>(sums, at(i), torque);
            if pairs.both {
                add_opposite::<T, TORQUE>(sums, at(j), torque);
            }
        }
    }

    /// Adds wrenches that were computed before.
    pub fn accumulate_kept(&mut self, pairs: Pairs, kept: WrenchSlices) {
        with_layout!(self.layout, T, ROTATES => {
            self.accumulate::<T, { numbers_of_force(ROTATES) }>(pairs, T::of(kept.forces), T::of(kept.torques));
        });
    }

    /// Adds what arrives from elsewhere.
    pub fn accumulate_arrivals(&mut self, arrivals: &[Arrival], kept: WrenchSlices) {
        with_layout!(self.layout, T, ROTATES => self.add_arrivals::<T, { numbers_of_force(ROTATES) }>(arrivals, kept));
    }

    fn add_arrivals<T: Number, const N: usize>(&mut self, arrivals: &[Arrival], kept: WrenchSlices) {
        let (forces, torques) = (T::of(kept.forces), T::of(kept.torques));
        let (sums, sums2) = (T::of_mut(self.wrenches.forces), T::of_mut(self.wrenches.torques));
        for (n, &Arrival { from, particle }) in arrivals.iter().enumerate() {
            if let Some(soon) = arrivals.get(n + AHEAD) {
                fetch(forces.as_chunks::<N>().0, soon.from.slot());
            }
            let at = particle as usize - self.first;
            let force = forces.get(from.slot() * N..).unwrap_or_default();
            let torque = torques.get(from.slot() * TORQUE..).unwrap_or_default();
            if from.is_second() {
                add_opposite::<T, N>(sums, at, force);
                add_opposite::<T, TORQUE>(sums2, at, torque);
            } else {
                add::<T, N>(sums, at, force);
                add::<T, TORQUE>(sums2, at, torque);
            }
        }
    }

    /// Adds to the force [N] and torque [N·m] on the particle after `k` others of these.
    #[inline]
    pub fn add(&mut self, k: usize, force: [f64; 3], torque: [f64; 3]) {
        let layout = self.layout;
        let WrenchSlicesMut { forces, torques } = &mut self.wrenches;
        for (words, size, by) in [(forces, layout.force(), force), (torques, layout.torque(), torque)] {
            let own = &mut words[k * size..(k + 1) * size];
            (0..3).for_each(|axis| layout.put(own, axis, layout.get(own, axis) + by[axis]));
        }
    }

    /// To be read.
    pub fn as_ref(&self) -> WrenchSums<'_> {
        WrenchSums { first: self.first, layout: self.layout, sums: self.wrenches.as_ref() }
    }
}

/// Sums of the wrenches on some particles.
#[derive(Clone, Copy)]
pub struct WrenchSums<'a> {
    /// Number of the first particle.
    pub first: usize,
    /// How numbers lie in them.
    pub layout: Layout,
    /// The sums, a row a particle.
    pub sums: WrenchSlices<'a>,
}

/// Force [N] and moment [N·m]; the fourth number of each means nothing.
#[derive(Clone, Copy)]
pub struct Sum<Q> {
    /// Force [N].
    pub force: Q,
    /// Moment [N·m].
    pub moment: Q,
}

impl WrenchSums<'_> {
    /// On the particle after `k` others of `radius` [m].
    #[inline(always)]
    pub fn sum<T: Number, Q: Four, const SPIN: bool>(&self, k: usize, radius: f64) -> Sum<Q> {
        let (sums, torques) =
            (T::of(self.sums.forces).as_chunks::<4>().0, T::of(self.sums.torques).as_chunks::<4>().0);
        let read = |row: &[T; 4]| Q::read(&[row[0].wide(), row[1].wide(), row[2].wide(), row[3].wide()]);
        if !SPIN {
            return Sum { force: read(&sums[k]), moment: Q::all(0.0) };
        }
        let torque = torques.get(k).map_or(Q::all(0.0), read);
        Sum { force: read(&sums[2 * k]), moment: torque - Q::all(radius) * read(&sums[2 * k + 1]) }
    }

    /// Force [N] and moment [N·m] on particle number `k` of `radius` [m].
    pub fn on(&self, k: usize, radius: f64) -> (Vec3, Vec3) {
        let at = k - self.first;
        let sum = with_layout!(self.layout, T, ROTATES => self.sum::<T, Each, ROTATES>(at, radius));
        let three = |q: Each| {
            let mut row = [0.0; 4];
            q.write(&mut row);
            Vec3::new(row[0], row[1], row[2])
        };
        (three(sum.force), three(sum.moment))
    }
}
