//! Sums of the loads on each particle, and the order in which they are made.
//!
//! A contact's load is computed once and added to both of its particles. A particle sums, in the order of their places, the contacts
//! with particles of its own tile and with walls, while they are computed; then those that arrive from elsewhere, which were kept until its
//! tile has its turn: of images across periodic faces, and of earlier tiles. The order depends on the lists alone, so that no sum depends
//! on threads.

use crate::lane::scalar::Each;
use crate::lane::{Four, fetch};

/// Numbers of a load without rotation: force on i and a pad.
pub const FORCE: usize = 4;
/// With rotation: force on i, a pad, n × F_t times distance over reach (the moment on a particle of radius −1), a pad.
pub const FORCE_AND_MOMENT: usize = 8;
/// Numbers of a couple: on i, and a pad.
pub const COUPLE: usize = 4;

/// Arrivals between one whose load is asked for and the one that is added; chosen on the bench pile.
const AHEAD: usize = 24;

/// Numbers of one load.
pub fn stride(rotates: bool) -> usize {
    if rotates { FORCE_AND_MOMENT } else { FORCE }
}

/// Adds a load of `N` numbers to a sum; to none that does not exist.
#[inline(always)]
fn add<const N: usize>(sums: &mut [f64], at: usize, load: &[f64]) {
    let (Some(sum), Some(load)) = (sums.as_chunks_mut::<N>().0.get_mut(at), load.first_chunk::<N>()) else {
        return;
    };
    for a in 0..N {
        sum[a] += load[a];
    }
}

/// Adds what a contact does to its second particle: the opposite force or couple, the same moment of radius −1.
#[inline(always)]
fn add_opposite<const N: usize>(sums: &mut [f64], at: usize, load: &[f64]) {
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

/// Loads and couples (empty where no effect makes any) of some contacts, or sums of some particles.
pub type Computed<'a> = (&'a [f64], &'a [f64]);

/// A load that arrives at a tile from elsewhere.
#[derive(Debug, Clone, Copy)]
pub struct Arrival {
    /// Place among the loads that are kept × 2, + 1 where the particle is the second of the contact.
    pub from: u32,
    /// Who takes it.
    pub particle: u32,
}

/// Sums of some particles, as they are being made.
#[derive(Default)]
pub struct Sums<'a> {
    /// Number of the first particle.
    pub first: usize,
    /// Numbers of one load.
    pub stride: usize,
    /// Of loads, `stride` numbers a particle.
    pub loads: &'a mut [f64],
    /// Of couples, [`COUPLE`] numbers a particle; empty where no effect makes any.
    pub couples: &'a mut [f64],
}

impl<'a> Sums<'a> {
    /// The same, for a while.
    pub fn by_ref(&mut self) -> Sums<'_> {
        Sums { first: self.first, stride: self.stride, loads: self.loads, couples: self.couples }
    }

    /// The first `n` particles, if there are so many, and the others.
    pub fn split(self, n: usize) -> (Sums<'a>, Sums<'a>) {
        let Sums { first, stride, loads, couples } = self;
        let (loads, loads2) = loads.split_at_mut((n * stride).min(loads.len()));
        let (couples, couples2) = couples.split_at_mut((n * COUPLE).min(couples.len()));
        let two = Sums { first: first + n, stride, loads: loads2, couples: couples2 };
        (Sums { first, stride, loads, couples }, two)
    }

    /// Begins anew.
    pub fn clear(&mut self) {
        self.loads.fill(0.0);
        self.couples.fill(0.0);
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.loads.len().checked_div(self.stride).unwrap_or(0)
    }

    /// Begins with these.
    pub fn put(&mut self, (loads, couples): &(Vec<f64>, Vec<f64>)) {
        self.loads.copy_from_slice(loads);
        self.couples.copy_from_slice(couples);
    }

    /// Adds the loads (of `N` numbers) and couples (or none) of contacts between particles i and j: to i, and if `both` to j; to none
    /// that is not of these.
    #[inline(always)]
    pub fn take<const N: usize>(&mut self, (i, j): (&[u32], &[u32]), both: bool, (loads, couples): Computed) {
        let first = self.first as u32;
        let at = |k: u32| k.wrapping_sub(first) as usize;
        for ((&i, &j), load) in i.iter().zip(j).zip(loads.as_chunks::<N>().0) {
            add::<N>(self.loads, at(i), load);
            if both {
                add_opposite::<N>(self.loads, at(j), load);
            }
        }
        for ((&i, &j), couple) in i.iter().zip(j).zip(couples.as_chunks::<COUPLE>().0) {
            add::<COUPLE>(self.couples, at(i), couple);
            if both {
                add_opposite::<COUPLE>(self.couples, at(j), couple);
            }
        }
    }

    /// Adds what arrives from elsewhere.
    pub fn collect(&mut self, arrivals: &[Arrival], kept: Computed) {
        match self.stride {
            FORCE => self.collect_rows::<FORCE>(arrivals, kept),
            _ => self.collect_rows::<FORCE_AND_MOMENT>(arrivals, kept),
        }
    }

    fn collect_rows<const N: usize>(&mut self, arrivals: &[Arrival], kept: Computed) {
        let (loads, couples) = kept;
        for (n, &Arrival { from, particle }) in arrivals.iter().enumerate() {
            if let Some(soon) = arrivals.get(n + AHEAD) {
                fetch(loads.as_chunks::<N>().0, (soon.from >> 1) as usize);
            }
            let (place, second) = ((from >> 1) as usize, from & 1 == 1);
            let at = particle as usize - self.first;
            let load = loads.get(place * N..).unwrap_or_default();
            let couple = couples.get(place * COUPLE..).unwrap_or_default();
            if second {
                add_opposite::<N>(self.loads, at, load);
                add_opposite::<COUPLE>(self.couples, at, couple);
            } else {
                add::<N>(self.loads, at, load);
                add::<COUPLE>(self.couples, at, couple);
            }
        }
    }

    /// As they are.
    pub fn seen(&self) -> Loads<'_> {
        Loads { first: self.first, sums: (self.loads, self.couples) }
    }
}

/// Sums of the loads on some particles.
#[derive(Clone, Copy)]
pub struct Loads<'a> {
    /// Number of the first particle.
    pub first: usize,
    /// Sums.
    pub sums: Computed<'a>,
}

/// Force [N] and moment [N·m]; the fourth number of each means nothing.
#[derive(Clone, Copy)]
pub struct Sum<Q> {
    pub force: Q,
    pub moment: Q,
}

impl Loads<'_> {
    /// On the particle after `k` others of `radius` [m].
    #[inline(always)]
    pub fn sum<Q: Four, const SPIN: bool>(&self, k: usize, radius: f64) -> Sum<Q> {
        let (sums, couples) = (self.sums.0.as_chunks::<4>().0, self.sums.1.as_chunks::<4>().0);
        if !SPIN {
            return Sum { force: Q::read(&sums[k]), moment: Q::all(0.0) };
        }
        let couple = couples.get(k).map_or(Q::all(0.0), Q::read);
        Sum { force: Q::read(&sums[2 * k]), moment: couple - Q::all(radius) * Q::read(&sums[2 * k + 1]) }
    }

    /// Force [N] and moment [N·m] on particle number `k` of `radius` [m].
    pub fn on(&self, k: usize, radius: f64, spin: bool) -> ([f64; 3], [f64; 3]) {
        let at = k - self.first;
        let sum = if spin { self.sum::<Each, true>(at, radius) } else { self.sum::<Each, false>(at, radius) };
        let three = |q: Each| {
            let mut row = [0.0; 4];
            q.write(&mut row);
            [row[0], row[1], row[2]]
        };
        (three(sum.force), three(sum.moment))
    }
}
