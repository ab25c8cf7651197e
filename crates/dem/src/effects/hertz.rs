//! Hertz: elastic spheres, with a dashpot that gives the same restitution at every speed.
//!
//! ```text
//! Fₙ = 4/3 E* √R* δ^{3/2} + c δ̇,   S = dFₙ/dδ = 2 E* √(R* δ),   c = γ √(5/6) √(S m*)
//! ```
//!
//! Hertz (1882), J. reine angew. Math. 92; damping ∝ δ^{1/4}: Tsuji, Tanaka & Ishida (1992), Powder Technology 71,
//! doi:10.1016/0032-5910(92)88030-L; γ from e is exact for contact until δ = 0, not Tsuji's polynomial: Antypov &
//! Elliott (2011), EPL 94, doi:10.1209/0295-5075/94/50004.

use super::{Contact, Effect, Load};
use crate::lane::Lane;

/// Hertz's law with a dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// E* [Pa].
    pub modulus: f64,
    /// γ [–], as for [`super::Hooke`].
    pub damping_ratio: f64,
}

impl Effect for Hertz {
    type Memory<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, _: &mut (), load: &mut Load<R>) {
        let overlap = contact.overlap.max(R::splat(0.0));
        let s = R::splat(2.0 * self.modulus) * (contact.radius * overlap).sqrt();
        load.impedance = (s * contact.mass).sqrt();
        let c = R::splat(self.damping_ratio * (5.0f64 / 6.0).sqrt()) * load.impedance;
        let elastic = R::splat(2.0 / 3.0) * s * overlap;
        let damping = c * contact.approach;
        load.normal = load.normal + (elastic + damping);
        load.pressing = load.normal;
        load.stiffness = s;
        // S ∝ √δ; the overlap a step ago follows from the approach.
        let before = (overlap - contact.approach * dt).max(R::splat(0.0));
        load.stiffness_before = (before / overlap.max(R::splat(R::TINY))).sqrt();
        load.elastic = load.elastic + R::splat(0.4) * elastic * overlap;
        load.dissipated[0] = load.dissipated[0] + damping * contact.approach * dt;
    }
}
