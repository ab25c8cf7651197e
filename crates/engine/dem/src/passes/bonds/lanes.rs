//! What bonds do at one instant: gather → law → keep, for as many bonds at a time as a lane has; those that are left over one by one.

use crate::model::BondedPair;
use crate::model::bonds::law::{Ends, Pull, Pulls, pulls};
use crate::model::bonds::springs::{SpringLanes, Springs};
use crate::state::Particles;
use laws::simd::compiled::Job;
use laws::simd::{BLOCK, Indices, Lane, Row, Row4, Turn, V};
use laws::space::cell::Cell;

/// Added and taken off again, it rounds a number to a whole one: 3/2 · 2⁵².
const ROUND: f64 = 6_755_399_441_055_744.0;

/// First rows of the springs of the bonds of a block.
const FIRST: [u32; BLOCK] = [0, 3, 6, 9, 12, 15, 18, 21];

/// What bonds read of particles.
#[derive(Clone, Copy)]
pub struct Instant<'a> {
    rows: &'a [Row],
    spins: &'a [Row4],
    turns: &'a [Row4],
    /// Lengths of periodic axes [m], 0 of others, and how fast they grow [m/s].
    lengths: [f64; 3],
    speed: [f64; 3],
}

impl<'a> Instant<'a> {
    /// Of these particles, which have turned by `turns`.
    pub fn of(particles: &'a Particles, turns: &'a [Row4], cell: &Cell) -> Instant<'a> {
        let (rows, spins) = (&particles.rows[..turns.len()], &particles.spins[..turns.len()]);
        Instant { rows, spins, turns, lengths: cell.lengths().into(), speed: cell.speed.into() }
    }
}

/// Some bonds, with what each of them does.
pub struct BondChunk<'a> {
    pub at: &'a Instant<'a>,
    pub pairs: &'a [BondedPair],
    pub springs: &'a [Springs],
    pub pulls: &'a mut [Pull],
}

/// What those do that are whole; whether any of them breaks.
impl Job for BondChunk<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<R: Lane>(self) -> bool {
        let at = *self.at;
        groups::<R>(&at, (self.pairs, self.springs), self.pulls)
    }
}

/// What one bond does.
pub fn one(at: &Instant, ends: [u32; 2], springs: &Springs) -> Pull {
    let mut pull = Pull::default();
    let pulls = std::slice::from_mut(&mut pull);
    BondChunk { at, pairs: &[BondedPair::new(ends)], springs: &[*springs], pulls }.run::<f64>();
    pull
}

/// Groups of `WIDTH` bonds, then those that are left over.
#[inline(always)]
fn groups<R: Lane>(at: &Instant, (pairs, springs): (&[BondedPair], &[Springs]), kept: &mut [Pull]) -> bool {
    let (whole, mut breaks) = (pairs.len() / R::WIDTH * R::WIDTH, false);
    for from in (0..whole).step_by(R::WIDTH) {
        let group = from..from + R::WIDTH;
        breaks |= lanes::<R>(at, (&pairs[group.clone()], &springs[group.clone()]), &mut kept[group]);
    }
    for k in whole..pairs.len() {
        breaks |= lanes::<f64>(at, (&pairs[k..=k], &springs[k..=k]), &mut kept[k..=k]);
    }
    breaks
}

/// `WIDTH` bonds.
#[inline(always)]
fn lanes<R: Lane>(at: &Instant, (pairs, springs): (&[BondedPair], &[Springs]), kept: &mut [Pull]) -> bool {
    let (mut ends, mut whole) = ([[0; BLOCK]; 2], false);
    for (k, pair) in pairs.iter().enumerate() {
        [ends[0][k], ends[1][k]] = pair.ends;
        whole |= pair.is_whole();
    }
    if !whole {
        return false;
    }
    let (table, first) = (springs.as_flattened(), &FIRST[..R::WIDTH]);
    let row = |column: usize| Indices::within(first, table.len() - column);
    let of =
        SpringLanes::of([R::rows(table, row(0)), R::rows(&table[1..], row(1)), R::rows(&table[2..], row(2))]);
    let found = pulls(&of, &gather::<R>(at, [&ends[0][..R::WIDTH], &ends[1][..R::WIDTH]]));
    let breaks = of.any_breaks(found.stress);
    keep(&found, pairs, kept);
    breaks
}

/// Reads the rows of both ends.
#[inline(always)]
fn gather<R: Lane>(at: &Instant, ends: [&[u32]; 2]) -> Ends<R> {
    let rows = at.rows.len().min(at.spins.len()).min(at.turns.len());
    let (i, j) = (Indices::within(ends[0], rows), Indices::within(ends[1], rows));
    let [xi, yi, zi, _, ui, vi, wi, _] = R::rows(at.rows, i);
    let [xj, yj, zj, _, uj, vj, wj, _] = R::rows(at.rows, j);
    let x = nearest(at, 0, xi - xj, ui - uj);
    let y = nearest(at, 1, yi - yj, vi - vj);
    let z = nearest(at, 2, zi - zj, wi - wj);
    let [pi, qi, ri, _] = R::rows4(at.spins, i);
    let [pj, qj, rj, _] = R::rows4(at.spins, j);
    Ends {
        arm: V::new(x[0], y[0], z[0]),
        velocity: V::new(x[1], y[1], z[1]),
        spin: [V::new(pi, qi, ri), V::new(pj, qj, rj)],
        turn: [Turn::of(R::rows4(at.turns, i)), Turn::of(R::rows4(at.turns, j))],
    }
}

/// From one centre to the nearest image of another along an axis [m], and how fast that grows [m/s].
#[inline(always)]
fn nearest<R: Lane>(at: &Instant, axis: usize, apart: R, velocity: R) -> [R; 2] {
    let (length, speed) = (at.lengths[axis], at.speed[axis]);
    if length <= 0.0 {
        return [apart, velocity];
    }
    let between = (apart / R::splat(length) + R::splat(ROUND)) - R::splat(ROUND);
    [apart - between * R::splat(length), velocity - between * R::splat(speed)]
}

/// Keeps what those do that are whole.
#[inline(always)]
fn keep<R: Lane>(found: &Pulls<R>, pairs: &[BondedPair], kept: &mut [Pull]) {
    let (mut first, mut second) = ([0.0; 8 * BLOCK], [0.0; 8 * BLOCK]);
    let ([a, b], [tension, shear, mean], f) = (found.moment, found.stress, found.force);
    R::store_rows([f.x, f.y, f.z, found.elastic, a.x, a.y, a.z, found.power], &mut first);
    R::store_rows([b.x, b.y, b.z, tension, shear, mean, tension, tension], &mut second);
    let rows = first.as_chunks::<8>().0.iter().zip(second.as_chunks::<8>().0);
    for ((pull, pair), (first, second)) in kept.iter_mut().zip(pairs).zip(rows) {
        if pair.is_whole() {
            let [x, y, z, elastic, p, q, r, power] = *first;
            let [s, t, u, tension, shear, mean, ..] = *second;
            let (force, moment) = ([x, y, z], [[p, q, r], [s, t, u]]);
            *pull = Pull { force, elastic, moment, power, stress: [tension, shear, mean] };
        }
    }
}
