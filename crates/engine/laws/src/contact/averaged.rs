//! Averaged contacts: the part of a kick in which two touch, and their mean overlap in it.
//!
//! Also the part of a contact in a patch. Inlined into the contact loop, with no closures, as everything there is.

use crate::effects::Contact;
use crate::simd::{BLOCK, Lane};

/// The part of a kick in which contacts act, where that is not the whole of it for all of them: δ(t) ≈ δ + δ̇ t for half a step before the instant
/// and half a step after it. Contacts whose surfaces part at a gap of `held` [m] act up to there.
///
/// ```text
/// w = |δ̇| Δt/2,  z = δ + held        acts where z + w > 0; for the whole kick where z > w
/// mean of z where it is positive: (z + w)/2, its share of the kick: (z + w)/2w
/// ```
#[inline(always)]
pub fn average<R: Lane>(ahead: f64, c: &mut Contact<R>, held: R) -> Option<R> {
    let (zero, half) = (R::splat(0.0), R::splat(0.5));
    let way = size(c.approach) * R::splat(ahead);
    // Of two equal centres `held` and the approach are NaN; they touch all the same.
    let now = (c.overlap + held).max(c.overlap);
    let last = now + way;
    c.touching = last.max(now).gt(zero);
    let before = c.before + held;
    c.before = R::select(way.gt(before), (before + way) * half - held, c.before);
    let begins_or_ends = R::both(c.touching, way.gt(now));
    if !R::any(begins_or_ends) {
        return None;
    }
    let share = R::select(begins_or_ends, last / (way + way), R::splat(1.0));
    c.overlap = R::select(begins_or_ends, last * half - held, c.overlap);
    c.present = R::select(begins_or_ends, now.max(zero) - held, c.present);
    c.partial = R::select(begins_or_ends, R::splat(1.0), zero);
    c.turn = c.turn * share;
    Some(share)
}

/// |x|.
#[inline(always)]
pub fn size<R: Lane>(x: R) -> R {
    x.max(R::splat(0.0) - x)
}

/// Part of a patch, from its numbers in columns of a block.
#[inline(always)]
pub fn share<R: Lane>(contact: &mut Contact<R>, patch: &[f64]) {
    contact.share = R::load(patch);
    contact.share_before = R::load(&patch[BLOCK..]);
    let mass = R::load(&patch[2 * BLOCK..]);
    contact.mass = contact.mass * mass;
    contact.inertia = contact.inertia * mass;
    contact.inverse_mass = contact.inverse_mass * R::load(&patch[3 * BLOCK..]);
}
