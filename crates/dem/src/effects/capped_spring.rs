//! A spring and dashpot in the tangent plane whose force is capped: what sliding and rolling share.
//!
//! ```text
//! ξ ← ξ − (ξ·n) n, length kept       the spring turns with the contact
//! ξ ← ξ min(1, k_before/k)            a spring that stiffens keeps its force, one that softens its length
//! ξ at t = ξ + (½ + p Δt²) v Δt        the rest of the step's way, (½ − p Δt²) v Δt, comes after: the midpoint rule, a little late,
//!                                     because v is predicted, which alone would make energy, (ω Δt)⁴/8 a step; p = ω²/4
//! F = −k ξ − c v,  capped: F ← F cap/|F|,  ξ ← ξ min(1, cap/|k ξ|)
//! ```
//!
//! Cutting ξ back to the cap: Luding (2008), Granular Matter 10(4), doi:10.1007/s10035-008-0099-x. Deviation: the spring is
//! cut to the cap, not to the capped force less the dashpot's: that has no bound as k → 0 (Hertz at first touch), and it
//! stretches the spring, out of nothing, where the dashpot alone passes the cap. Stiffening and softening so that
//! neither makes energy: Mindlin & Deresiewicz (1953), J. Appl. Mech. 20; Thornton, Cummins & Cleary (2013), Powder
//! Technology 233, doi:10.1016/j.powtec.2012.08.012.

use crate::lane::{Lane, V};

/// Smallest square that is divided by.
const TINY: f64 = 1e-300;

/// The spring and dashpot at one instant.
pub struct CappedSpring<R: Lane> {
    /// k, spring.
    pub stiffness: R,
    /// k of the step before over k [–].
    pub before: R,
    /// c, dashpot.
    pub damping: R,
    /// Quarter of the square of the frequency.
    pub pace: R,
    /// Largest force; at least 0.
    pub cap: R,
}

/// What came of it.
pub struct Outcome<R: Lane> {
    /// The force, opposite to the motion.
    pub force: V<R>,
    /// Energy in the spring.
    pub elastic: R,
    /// Energy lost in this step, by the dashpot and by cutting the spring back.
    pub dissipated: R,
}

impl<R: Lane> CappedSpring<R> {
    /// Moves the spring by `rate` over `dt` in the plane across `normal`, and gives its force.
    #[inline(always)]
    pub fn pull(&self, spring: &mut V<R>, normal: V<R>, rate: V<R>, dt: R) -> Outcome<R> {
        let late = (self.pace * dt * dt).min(R::splat(0.5));
        let half = rate.scale((R::splat(0.5) + late) * dt);
        let rest = rate.scale((R::splat(0.5) - late) * dt);
        let there = turned(*spring, normal);
        let keeps = self.before.min(R::splat(1.0));
        let stretched = there.scale(keeps) + half;
        let lost = R::splat(0.5) * self.stiffness * there.dot(there) * (self.before - keeps * keeps);
        let dashpot = rate.scale(self.damping);
        let mut force = V::zero() - stretched.scale(self.stiffness) - dashpot;
        let mut kept = stretched;
        let size = force.dot(force);
        let slides = size.gt(self.cap * self.cap);
        if R::any(slides) {
            let one = R::splat(1.0);
            let shrink = |square: R| (self.cap / square.max(R::splat(TINY)).sqrt()).min(one);
            let pull = stretched.scale(self.stiffness);
            kept = V::select(slides, stretched.scale(shrink(pull.dot(pull))), stretched);
            force = V::select(slides, force.scale(shrink(size)), force);
        }
        *spring = kept + rest;
        let spring_force = kept.scale(self.stiffness);
        Outcome {
            force,
            elastic: R::splat(0.5) * spring_force.dot(kept),
            dissipated: lost + spring_force.dot(stretched - kept) - (force + spring_force).dot(rate) * dt,
        }
    }
}

/// The spring laid into the plane across `normal`, its length kept.
#[inline(always)]
fn turned<R: Lane>(spring: V<R>, normal: V<R>) -> V<R> {
    let flat = spring - normal.scale(spring.dot(normal));
    let (before, after) = (spring.dot(spring), flat.dot(flat));
    flat.scale((before / after.max(R::splat(TINY))).sqrt())
}
