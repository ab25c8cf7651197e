//! A spring and dashpot whose force is capped: what sliding, rolling and twisting share. Sliding and rolling are vectors in the
//! tangent plane, twisting is a number, the angle about the normal.
//!
//! ```text
//! ξ ← ξ' + φ n × ξ',  ξ' = ξ − (ξ·n) n, length kept       the spring turns with the contact: its normal, and about it by
//!                                                     φ = ½ (ω_i + ω_j)·n Δt, so that a pair that turns as one body keeps its force
//! ξ ← ξ min(1, k_before/k)            a spring that stiffens keeps its force, one that softens its length
//! ξ at t = ξ + (½ + p Δt²) v Δt        the rest of the step's way, (½ − p Δt²) v Δt, comes after: the midpoint rule, a little late,
//!                                     because v is predicted, which alone would make energy, (ω Δt)⁴/8 a step; p = ω²/4
//! F = −k ξ − c v,  where |F| > cap: F ← F cap/|F|,  the slider gives way at (|F| − cap)/c along −F
//! ```
//!
//! Spring and dashpot side by side, and a slider behind both that bears the cap: ξ̇ = (cap − k ξ)/c as it slides, so that k ξ tends to the cap within c/k,
//! without a dashpot at once. Nothing jumps where sliding begins or ends, so results have a limit as Δt → 0; k ξ never passes the largest cap, however soft
//! the spring is (Hertz at first touch), and nothing makes energy. A contact that ends loses what its spring holds; the ledger books that as dissipated by the effect.
//!
//! Cutting ξ back to the cap: Luding (2008), Granular Matter 10(4), doi:10.1007/s10035-008-0099-x. Deviation: there, the spring is
//! cut at once to the capped force less the dashpot's, which stretches it, out of nothing, where the dashpot alone passes the cap. Stiffening and softening so that
//! neither makes energy: Mindlin & Deresiewicz (1953), J. Appl. Mech. 20; Thornton, Cummins & Cleary (2013), Powder
//! Technology 233, doi:10.1016/j.powtec.2012.08.012.

use super::Contact;
use crate::simd::{Lane, V};
use core::ops::{Add, Sub};

/// The stretch of a spring: a vector or a number.
pub trait Stretch<R: Lane>: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// None.
    fn zero() -> Self;
    /// Times a number.
    fn scale(self, s: R) -> Self;
    /// Scalar product.
    fn dot(self, other: Self) -> R;
    /// `yes` where the mask holds, else `no`.
    fn select(mask: R::Mask, yes: Self, no: Self) -> Self;
}

impl<R: Lane> Stretch<R> for R {
    #[inline(always)]
    fn zero() -> R {
        R::splat(0.0)
    }
    #[inline(always)]
    fn scale(self, s: R) -> R {
        self * s
    }
    #[inline(always)]
    fn dot(self, other: R) -> R {
        self * other
    }
    #[inline(always)]
    fn select(mask: R::Mask, yes: R, no: R) -> R {
        R::select(mask, yes, no)
    }
}

impl<R: Lane> Stretch<R> for V<R> {
    #[inline(always)]
    fn zero() -> V<R> {
        V::zero()
    }
    #[inline(always)]
    fn scale(self, s: R) -> V<R> {
        self.scale(s)
    }
    #[inline(always)]
    fn dot(self, other: V<R>) -> R {
        self.dot(other)
    }
    #[inline(always)]
    fn select(mask: R::Mask, yes: V<R>, no: V<R>) -> V<R> {
        V::select(mask, yes, no)
    }
}

/// The spring and dashpot at one instant.
pub struct CappedSpring<R: Lane> {
    /// Where there is a contact: elsewhere the result is ignored.
    pub touching: R::Mask,
    /// k, spring.
    pub stiffness: R,
    /// k of the step before over k [–].
    pub before: R,
    /// The same as the spring held energy in the step before: `before` is from a predicted velocity.
    pub booked: R,
    /// k of the step before, where the contact has just ended.
    pub last: R,
    /// c, dashpot.
    pub damping: R,
    /// Quarter of the square of the frequency.
    pub pace: R,
    /// Largest force; at least 0.
    pub cap: R,
}

/// The result of a step.
pub struct Outcome<R: Lane, X> {
    /// The force, opposite to the motion.
    pub force: X,
    /// Energy in the spring.
    pub elastic: R,
    /// Energy lost in this step, by the dashpot and by cutting the spring back.
    pub dissipated: R,
}

impl<R: Lane> CappedSpring<R> {
    /// Share of a force of this square that the cap leaves [–].
    #[inline(always)]
    fn share(&self, square: R) -> R {
        (self.cap / square.max(R::splat(R::TINY)).sqrt()).min(R::splat(1.0))
    }

    /// How far the spring gives way in a step, over the force beyond the cap: (1 − exp(−k Δt/c))/k, by the midpoint rule, all of it from 2 c/k on.
    #[inline(always)]
    fn slack(&self, dt: R) -> R {
        let slow = dt / (self.damping + R::splat(0.5) * dt * self.stiffness);
        slow.min(R::splat(1.0) / self.stiffness)
    }

    /// Moves the spring by `rate` over `dt`, and gives its force.
    #[inline(always)]
    pub fn pull<X: Stretch<R>>(&self, spring: &mut X, rate: X, dt: R) -> Outcome<R, X> {
        let late = (self.pace * dt * dt).min(R::splat(0.5));
        let half = rate.scale((R::splat(0.5) + late) * dt);
        let rest = rate.scale((R::splat(0.5) - late) * dt);
        let there = *spring;
        let keeps = self.before.min(R::splat(1.0));
        let stretched = there.scale(keeps) + half;
        let lost = R::splat(0.5) * self.stiffness * there.dot(there) * (self.booked - keeps * keeps);
        let dashpot = rate.scale(self.damping);
        let mut force = X::zero() - stretched.scale(self.stiffness) - dashpot;
        let mut kept = stretched;
        let size = force.dot(force);
        let slides = R::both(self.touching, size.gt(self.cap * self.cap));
        if R::any(slides) {
            let beyond = R::splat(1.0) - self.share(size);
            kept = X::select(slides, stretched + force.scale(beyond * self.slack(dt)), stretched);
            force = X::select(slides, force.scale(self.share(size)), force);
        }
        *spring = kept + rest;
        let spring_force = kept.scale(self.stiffness);
        // What is cut off slid under a force between that of the step before and that of now: also where the cap falls to nothing.
        let middle = (kept + stretched - rate.scale(dt)).scale(R::splat(0.5) * self.stiffness);
        let dissipated = lost + middle.dot(stretched - kept) - (force + spring_force).dot(rate) * dt;
        let elastic = R::splat(0.5) * spring_force.dot(kept);
        let dissipated = R::select(self.touching, dissipated, self.released(there, rest, half));
        Outcome { force, elastic, dissipated }
    }

    /// What a contact that has just ended lets go of: as if its spring were cut to nothing.
    #[inline(always)]
    fn released<X: Stretch<R>>(&self, there: X, rest: X, half: X) -> R {
        let held = there.dot(there).gt(R::splat(0.0));
        R::select(held, R::splat(0.5) * self.last * (there - rest).dot(there + half), R::splat(0.0))
    }
}

/// The spring turned with its contact, its length kept.
#[inline(always)]
pub fn turned<R: Lane>(spring: V<R>, contact: &Contact<R>) -> V<R> {
    let n = contact.normal;
    let flat = spring - n.scale(spring.dot(n));
    let there = flat + n.cross(flat).scale(contact.turn);
    let (before, after) = (spring.dot(spring), there.dot(there));
    there.scale((before / after.max(R::splat(R::TINY))).sqrt())
}
