//! Particles: their margins, their box, their cells, and their order.

use super::add;
use crate::tables::DeviceTables;
use crate::tables::lists::{CHUNK, DIGIT, DIGITS, LeastRow, PART};
use laws::simd::{Row, Row4};
use laws::space::images::Periods;
use laws::space::sphere::FAR;

/// Brings a particle back into the box, and notes its home with the margin around it.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn margins(t: &DeviceTables, _: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    let l = &t.lists;
    // SAFETY: by contract; the rows of this particle are this thread's.
    unsafe {
        let row: &mut Row = &mut *t.particles.rows.at(k);
        if l.wraps_any != 0 {
            let (cell, before) = (l.cell(), row.position());
            let (away, now) = (cell.away(&before), cell.wrapped(before));
            (row[0], row[1], row[2]) = (now.x, now.y, now.z);
            *l.wraps.at::<Periods>(k) = [0, 1, 2].map(|a| -(away[a] as i32));
        }
        *t.particles.home.at(k) = Row4([row[0], row[1], row[2], l.margins.of(&row.velocity())]);
    }
}

/// Home and reach of a particle.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
unsafe fn home_and_reach(t: &DeviceTables, k: usize) -> (Row4, f64) {
    // SAFETY: by contract.
    unsafe {
        let (home, row): (Row4, &Row) = (*t.particles.home.at(k), &*t.particles.rows.at(k));
        (home, row.radius() + home[3])
    }
}

impl LeastRow {
    /// Of no particles.
    pub const NONE: LeastRow = LeastRow {
        low: [f64::INFINITY; 3],
        opposite_high: [f64::INFINITY; 3],
        reach: f64::INFINITY,
        opposite_reach: f64::INFINITY,
    };

    /// The least of both.
    #[inline(always)]
    pub fn and(self, o: LeastRow) -> LeastRow {
        LeastRow {
            low: [0, 1, 2].map(|a| self.low[a].min(o.low[a])),
            opposite_high: [0, 1, 2].map(|a| self.opposite_high[a].min(o.opposite_high[a])),
            reach: self.reach.min(o.reach),
            opposite_reach: self.opposite_reach.min(o.opposite_reach),
        }
    }
}

/// The box of some particles.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn boxes(t: &DeviceTables, _: u32, part: usize) {
    let (from, end) = (part * PART, t.particle_count as usize);
    if from >= end {
        return;
    }
    let mut all = LeastRow::NONE;
    // SAFETY: by contract.
    unsafe {
        for k in from..end.min(from + PART) {
            let (home, reach) = home_and_reach(t, k);
            let [x, y, z, _] = home.0;
            let one = LeastRow { low: [x, y, z], opposite_high: [-x, -y, -z], reach, opposite_reach: -reach };
            all = all.and(one);
        }
        *t.lists.boxes.at(part) = all;
    }
}

/// The box of some boxes.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn fold(t: &DeviceTables, _: u32, part: usize) {
    let l = &t.lists;
    let (from, end) = (part * PART, l.box_count as usize);
    if from >= end {
        return;
    }
    let mut all = LeastRow::NONE;
    // SAFETY: by contract.
    unsafe {
        for k in from..end.min(from + PART) {
            all = all.and(*l.boxes.at(k));
        }
        *l.next_boxes.at(part) = all;
    }
}

/// Counts the reach of a particle in its interval.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn count_reach(t: &DeviceTables, _: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let (_, reach) = home_and_reach(t, k);
        add(t.lists.reach_counts.at(t.lists.interval_of(reach)), 1);
    }
}

/// Notes the reach of a particle where it is in the interval that is asked for; the counter of what is noted is the first one.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn near_reach(t: &DeviceTables, _: u32, k: usize) {
    let l = &t.lists;
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let (_, reach) = home_and_reach(t, k);
        if l.interval_of(reach) == l.interval as usize {
            let at = add(l.reach_counts.at(0), 1);
            *l.reaches.at(at as usize) = reach;
        }
    }
}

/// Key of the cell of a particle.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn keys(t: &DeviceTables, _: u32, k: usize) {
    let l = &t.lists;
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let home: Row4 = *t.particles.home.at(k);
        *l.keys.at::<u64>(k) = l.lattice.key(l.lattice.cell_of(&l.along(&home.vector())));
        *l.order.at(k) = k as u32;
    }
}

/// Number of chunks that keys are sorted in.
#[inline(always)]
fn chunks(t: &DeviceTables) -> usize {
    (t.particle_count as usize).div_ceil(CHUNK)
}

/// The digit of a key after so many bits.
#[inline(always)]
fn digit(key: u64, shift: u32) -> usize {
    (key >> shift) as usize % DIGITS
}

/// Counts the digits of a chunk of keys: a stable sort by digits, the lowest first (Knuth, The Art of Computer Programming 3, 5.2.5).
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn digits(t: &DeviceTables, number: u32, chunk: usize) {
    let (l, from, end) = (&t.lists, chunk * CHUNK, t.particle_count as usize);
    // SAFETY: by contract; the counters of this chunk are this thread's.
    unsafe {
        for k in from..end.min(from + CHUNK) {
            let digit = digit(*l.keys.at(k), number * DIGIT);
            *l.counters.at::<u32>(digit * chunks(t) + chunk) += 1;
        }
    }
}

/// Puts a chunk of keys where they belong by one digit.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn spread(t: &DeviceTables, number: u32, chunk: usize) {
    let (l, from, end) = (&t.lists, chunk * CHUNK, t.particle_count as usize);
    // SAFETY: by contract; no other thread has these places.
    unsafe {
        for k in from..end.min(from + CHUNK) {
            let key: u64 = *l.keys.at(k);
            let place: &mut u32 = &mut *l.counters.at(digit(key, number * DIGIT) * chunks(t) + chunk);
            *l.next_keys.at(*place as usize) = key;
            *l.next_order.at::<u32>(*place as usize) = *l.order.at(k);
            *place += 1;
        }
    }
}

/// Takes the particle that comes in place `n` into its new row. The two rows after all particles stay what they are.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn permute(t: &DeviceTables, _: u32, n: usize) {
    let (l, count) = (&t.lists, t.particle_count as usize);
    let (from, to) = (&t.particles, &l.next);
    if n >= count + FAR.len() {
        return;
    }
    // SAFETY: by contract; the new row is this thread's.
    unsafe {
        if n >= count {
            *to.rows.at(n) = FAR[n - count];
            if t.rotates != 0 {
                *to.spins.at(n) = Row4::default();
            }
            return;
        }
        let was = *l.order.at::<u32>(n) as usize;
        *to.rows.at::<Row>(n) = *from.rows.at(was);
        *to.acceleration.at::<Row4>(n) = *from.acceleration.at(was);
        *to.home.at::<Row4>(n) = *from.home.at(was);
        *to.material.at::<u32>(n) = *from.material.at(was);
        *to.place.at::<u32>(n) = *from.place.at(was);
        if t.rotates != 0 {
            *to.spins.at::<Row4>(n) = *from.spins.at(was);
            *to.angular_acceleration.at::<Row4>(n) = *from.angular_acceleration.at(was);
        }
    }
}

/// Home and reach of a particle, along the axes of the cells.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn spots(t: &DeviceTables, _: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract.
    unsafe {
        let (home, reach) = home_and_reach(t, k);
        let p = t.lists.along(&home.vector());
        *t.lists.spots.at(k) = Row4([p.x, p.y, p.z, reach]);
    }
}

/// Notes where a particle is now, by where it was when all were sent.
///
/// # Safety
/// Tables are in place.
#[inline(always)]
pub unsafe fn rows_now(t: &DeviceTables, _: u32, k: usize) {
    if k >= t.particle_count as usize {
        return;
    }
    // SAFETY: by contract; no two particles were at one place.
    unsafe {
        let place: u32 = *t.particles.place.at(k);
        if place >= t.particle_count {
            return t.beyond(0);
        }
        *t.zones.rows_now.at(place as usize) = k as u32;
    }
}
