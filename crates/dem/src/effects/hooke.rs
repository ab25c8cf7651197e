//! Hooke: a linear spring and dashpot along the normal.
//!
//! ```text
//! Fₙ = k δ + c δ̇,   c = γ √(k m*)       e = exp(−c t_c / 2m*),  t_c = π / √(k/m* − (c/2m*)²)
//! ```
//!
//! Cundall & Strack (1979), Géotechnique 29(1), doi:10.1680/geot.1979.29.1.47. γ from the restitution:
//! [`super::damping_ratio`]. The contact lasts until δ = 0, so that e comes out exactly; the force may pull a little
//! in its last moment.

use super::{Contact, Effect, Load};
use crate::lane::Lane;

/// Linear spring and dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hooke {
    /// k [N/m].
    pub stiffness: f64,
    /// γ [–].
    pub damping_ratio: f64,
}

impl Effect for Hooke {
    type Memory<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, _: &mut (), load: &mut Load<R>) {
        let k = R::splat(self.stiffness);
        load.impedance = (k * contact.mass).sqrt();
        let c = R::splat(self.damping_ratio) * load.impedance;
        let damping = c * contact.approach;
        load.normal = load.normal + (k * contact.overlap + damping);
        load.pressing = load.normal;
        load.stiffness = k;
        load.stiffness_before = R::splat(1.0);
        load.elastic = load.elastic + R::splat(0.5) * k * contact.overlap * contact.overlap;
        load.dissipated[0] = load.dissipated[0] + damping * contact.approach * dt;
    }
}
