//! From material constants to the composition of effects that a pair of materials calls for.

use crate::effects::{Effect, Hertz, Hooke, RollingResistance, SlidingFriction, damping_ratio};
use crate::kernel::Kernel;
use crate::setup::{Contact, Law, Material};

/// Elastic constants of a pair.
///
/// ```text
/// 1/E* = (1 − ν_i²)/E_i + (1 − ν_j²)/E_j,   1/G* = (2 − ν_i)/G_i + (2 − ν_j)/G_j,   G = E / 2(1 + ν)
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// E* [Pa].
    pub modulus: f64,
    /// Tangential over normal stiffness at the same overlap, 4 G*/E* [–].
    pub tangential_ratio: f64,
}

impl Elastic {
    /// Constants of two materials in contact.
    pub fn of(a: &Material, b: &Material) -> Elastic {
        let compliance = |m: &Material| (1.0 - m.poisson * m.poisson) / m.young;
        let shear = |m: &Material| 2.0 * (1.0 + m.poisson) * (2.0 - m.poisson) / m.young;
        let modulus = 1.0 / (compliance(a) + compliance(b));
        Elastic { modulus, tangential_ratio: 4.0 / (shear(a) + shear(b)) / modulus }
    }
}

/// k_t over the normal law's stiffness [–].
pub fn tangential_ratio(contact: &Contact, elastic: Elastic) -> f64 {
    match contact.law {
        Law::Hooke { tangential_ratio: Some(ratio), .. } => ratio,
        _ => elastic.tangential_ratio,
    }
}

/// The effects of a contact, composed; the only place that knows which compositions there are.
pub fn compose(contact: &Contact, elastic: Elastic) -> Box<dyn Kernel> {
    let damping_ratio = damping_ratio(contact.restitution);
    match contact.law {
        Law::Hooke { stiffness, .. } => with_friction(Hooke { stiffness, damping_ratio }, contact, elastic),
        Law::Hertz => with_friction(Hertz { modulus: elastic.modulus, damping_ratio }, contact, elastic),
    }
}

fn with_friction<N: Effect>(normal: N, contact: &Contact, elastic: Elastic) -> Box<dyn Kernel> {
    let Some(friction) = contact.sliding_friction else { return Box::new((normal, ())) };
    let sliding = SlidingFriction {
        friction,
        stiffness_ratio: tangential_ratio(contact, elastic),
        damping_ratio: damping_ratio(contact.restitution),
    };
    match contact.rolling_resistance {
        Some(resistance) => Box::new((normal, (sliding, RollingResistance { resistance }))),
        None => Box::new((normal, sliding)),
    }
}
