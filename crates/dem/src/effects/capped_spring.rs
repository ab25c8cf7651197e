//! A spring and dashpot in the tangent plane whose force is capped: what sliding and rolling share.
//!
//! ```text
//! ξ ← ξ − (ξ·n) n, length kept       the spring turns with the contact
//! ξ at t = ξ + v Δt/2                 stored ξ are half a step ahead, so that the sum is the midpoint rule
//! F = −k ξ − c v,  capped: F ← F cap/|F|,  ξ ← −F/k
//! ```
//!
//! Cutting ξ back to the cap: Luding (2008), Granular Matter 10(4), doi:10.1007/s10035-008-0099-x. Deviation: the spring
//! keeps the whole capped force and not the force less the dashpot's, which has no bound as k → 0 (Hertz at first touch).

use crate::lane::{Lane, V};

/// Smallest square that is divided by.
const TINY: f64 = 1e-300;

/// The spring and dashpot at one instant.
pub struct CappedSpring<R: Lane> {
    /// k, spring.
    pub stiffness: R,
    /// c, dashpot.
    pub damping: R,
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
        let half = rate.scale(R::splat(0.5) * dt);
        let stretched = turned(*spring, normal) + half;
        let dashpot = rate.scale(self.damping);
        let trial = V::zero() - stretched.scale(self.stiffness) - dashpot;
        let size = trial.dot(trial);
        let slides = size.gt(self.cap * self.cap);
        let shrink = R::select(slides, self.cap / size.max(R::splat(TINY)).sqrt(), R::splat(1.0));
        let force = trial.scale(shrink);
        let back = force.scale(R::splat(-1.0) / self.stiffness);
        let kept = V::select(slides, back, stretched);
        *spring = kept + half;
        let cut = (stretched - kept).dot(kept) * self.stiffness;
        Outcome {
            force,
            elastic: R::splat(0.5) * self.stiffness * kept.dot(kept),
            dissipated: dashpot.dot(rate) * dt + R::select(slides, cut, R::splat(0.0)),
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
