//! Sums of the loads on each particle, and the order in which they are made.
//!
//! A contact's load is computed once and added to both of its particles. A particle sums, in the order of their places, the contacts
//! with particles of its own tile and with walls, while they are computed; then those that arrive from elsewhere, which were kept until its
//! tile has its turn: of images across periodic faces, and of earlier tiles. The order depends on the lists alone, so that no sum depends
//! on threads.

use crate::simd::number::{COUPLE, FORCE, Layout, Number, as_kept, of_a_load};
use crate::simd::scalar::Each;
use crate::simd::{Four, fetch};

/// Arrivals between one whose load is asked for and the one that is added; chosen on the bench pile.
const AHEAD: usize = 24;

/// Adds a load of `N` numbers to a sum; to none that does not exist.
#[inline(always)]
fn add<T: Number, const N: usize>(sums: &mut [T], at: usize, load: &[T]) {
    let (Some(sum), Some(load)) = (sums.as_chunks_mut::<N>().0.get_mut(at), load.first_chunk::<N>()) else {
        return;
    };
    for a in 0..N {
        sum[a] += load[a];
    }
}

/// Adds what a contact does to its second particle: the opposite force or couple, the same moment of radius −1.
#[inline(always)]
fn add_opposite<T: Number, const N: usize>(sums: &mut [T], at: usize, load: &[T]) {
    let (Some(sum), Some(load)) = (sums.as_chunks_mut::<N>().0.get_mut(at), load.first_chunk::<N>()) else {
        return;
    };
    for a in 0..FORCE.min(N) {
        sum[a] -= load[a];
    }
    for a in FORCE..N {
        sum[a] += load[a];
    }
}

/// Words of the loads and couples (empty where no effect makes any) of some contacts, or of the sums of some particles.
pub type WrenchSlices<'a> = (&'a [f64], &'a [f64]);

/// A load that arrives at a tile from elsewhere.
#[derive(Debug, Clone, Copy)]
pub struct Arrival {
    /// Place among the loads that are kept × 2, + 1 where the particle is the second of the contact.
    pub from: u32,
    /// The particle that takes it.
    pub particle: u32,
}

/// Sums of some particles, as they are being made.
#[derive(Default)]
pub struct Sums<'a> {
    /// Number of the first particle.
    pub first: usize,
    /// How they are kept.
    pub form: Layout,
    /// Words of loads.
    pub loads: &'a mut [f64],
    /// Words of couples; empty where no effect makes any.
    pub torques: &'a mut [f64],
}

impl<'a> Sums<'a> {
    /// The same, for a while.
    pub fn by_ref(&mut self) -> Sums<'_> {
        Sums { first: self.first, form: self.form, loads: self.loads, torques: self.torques }
    }

    /// The first `n` particles, if there are so many, and the others.
    pub fn split(self, n: usize) -> (Sums<'a>, Sums<'a>) {
        let Sums { first, form, loads, torques } = self;
        let (loads, loads2) = loads.split_at_mut((n * form.load()).min(loads.len()));
        let (torques, couples2) = torques.split_at_mut((n * form.torque()).min(torques.len()));
        let two = Sums { first: first + n, form, loads: loads2, torques: couples2 };
        (Sums { first, form, loads, torques }, two)
    }

    /// Sets all to 0.
    pub fn clear(&mut self) {
        self.loads.fill(0.0);
        self.torques.fill(0.0);
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.loads.len() / self.form.load()
    }

    /// Begins with these.
    pub fn put(&mut self, (loads, torques): &(Vec<f64>, Vec<f64>)) {
        self.loads.copy_from_slice(loads);
        self.torques.copy_from_slice(torques);
    }

    /// Adds the loads (of `N` numbers) and couples (or none) of contacts between particles i and j: to i, and if `both` to j; to none
    /// that is not of these.
    #[inline(always)]
    pub fn take<T: Number, const N: usize>(
        &mut self,
        (i, j): (&[u32], &[u32]),
        both: bool,
        (loads, torques): (&[T], &[T]),
    ) {
        let first = self.first as u32;
        let at = |k: u32| k.wrapping_sub(first) as usize;
        let sums = T::of_mut(self.loads);
        for ((&i, &j), load) in i.iter().zip(j).zip(loads.as_chunks::<N>().0) {
            add::<T, N>(sums, at(i), load);
            if both {
                add_opposite::<T, N>(sums, at(j), load);
            }
        }
        let sums = T::of_mut(self.torques);
        for ((&i, &j), torque) in i.iter().zip(j).zip(torques.as_chunks::<COUPLE>().0) {
            add::<T, COUPLE>(sums, at(i), torque);
            if both {
                add_opposite::<T, COUPLE>(sums, at(j), torque);
            }
        }
    }

    /// Adds what was computed before.
    pub fn take_again(&mut self, pairs: (&[u32], &[u32]), both: bool, (loads, torques): WrenchSlices) {
        as_kept!(self.form, T, ROTATES => {
            self.take::<T, { of_a_load(ROTATES) }>(pairs, both, (T::of(loads), T::of(torques)));
        });
    }

    /// Adds what arrives from elsewhere.
    pub fn collect(&mut self, arrivals: &[Arrival], kept: WrenchSlices) {
        as_kept!(self.form, T, ROTATES => self.collect_rows::<T, { of_a_load(ROTATES) }>(arrivals, kept));
    }

    fn collect_rows<T: Number, const N: usize>(&mut self, arrivals: &[Arrival], kept: WrenchSlices) {
        let (loads, torques) = (T::of(kept.0), T::of(kept.1));
        let (sums, sums2) = (T::of_mut(self.loads), T::of_mut(self.torques));
        for (n, &Arrival { from, particle }) in arrivals.iter().enumerate() {
            if let Some(soon) = arrivals.get(n + AHEAD) {
                fetch(loads.as_chunks::<N>().0, (soon.from >> 1) as usize);
            }
            let (place, second) = ((from >> 1) as usize, from & 1 == 1);
            let at = particle as usize - self.first;
            let load = loads.get(place * N..).unwrap_or_default();
            let torque = torques.get(place * COUPLE..).unwrap_or_default();
            if second {
                add_opposite::<T, N>(sums, at, load);
                add_opposite::<T, COUPLE>(sums2, at, torque);
            } else {
                add::<T, N>(sums, at, load);
                add::<T, COUPLE>(sums2, at, torque);
            }
        }
    }

    /// Adds to the force [N] and couple [N·m] on the particle after `k` others of these.
    pub fn add(&mut self, k: usize, force: [f64; 3], torque: [f64; 3]) {
        let form = self.form;
        for (words, size, by) in
            [(&mut *self.loads, form.load(), force), (&mut *self.torques, form.torque(), torque)]
        {
            let own = &mut words[k * size..(k + 1) * size];
            (0..3).for_each(|axis| form.put(own, axis, form.get(own, axis) + by[axis]));
        }
    }

    /// As they are.
    pub fn seen(&self) -> WrenchSums<'_> {
        WrenchSums { first: self.first, form: self.form, sums: (self.loads, self.torques) }
    }
}

/// Sums of the loads on some particles.
#[derive(Clone, Copy)]
pub struct WrenchSums<'a> {
    /// Number of the first particle.
    pub first: usize,
    /// How they are kept.
    pub form: Layout,
    /// Sums.
    pub sums: WrenchSlices<'a>,
}

/// Force [N] and moment [N·m]; the fourth number of each means nothing.
#[derive(Clone, Copy)]
pub struct Sum<Q> {
    pub force: Q,
    pub moment: Q,
}

impl WrenchSums<'_> {
    /// On the particle after `k` others of `radius` [m].
    #[inline(always)]
    pub fn sum<T: Number, Q: Four, const SPIN: bool>(&self, k: usize, radius: f64) -> Sum<Q> {
        let (sums, torques) = (T::of(self.sums.0).as_chunks::<4>().0, T::of(self.sums.1).as_chunks::<4>().0);
        let read = |row: &[T; 4]| Q::read(&[row[0].wide(), row[1].wide(), row[2].wide(), row[3].wide()]);
        if !SPIN {
            return Sum { force: read(&sums[k]), moment: Q::all(0.0) };
        }
        let torque = torques.get(k).map_or(Q::all(0.0), read);
        Sum { force: read(&sums[2 * k]), moment: torque - Q::all(radius) * read(&sums[2 * k + 1]) }
    }

    /// Force [N] and moment [N·m] on particle number `k` of `radius` [m].
    pub fn on(&self, k: usize, radius: f64) -> ([f64; 3], [f64; 3]) {
        let at = k - self.first;
        let sum = as_kept!(self.form, T, ROTATES => self.sum::<T, Each, ROTATES>(at, radius));
        let three = |q: Each| {
            let mut row = [0.0; 4];
            q.write(&mut row);
            [row[0], row[1], row[2]]
        };
        (three(sum.force), three(sum.moment))
    }
}
