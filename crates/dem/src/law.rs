//! From material constants to the composition of effects that a pair of materials calls for.

use crate::bodies::Ease;
use crate::effects::{
    Coefficient, Cohesion, ConstantRolling, Effect, Friction, Hertz, Hooke, Jkr, RollingResistance,
    SlidingFriction, TwistingResistance, Weakening, damping_ratio,
};
use crate::kernel::{Kernel, Narrow};
use crate::setup::{Contact, Law, Material, Precision, RollingModel};
use std::f64::consts::PI;

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

/// Largest overlap of two grains that bear no load, over the smaller radius [–], for radii [m] in a range: 0 without cohesion,
/// infinite where the pull grows faster than the spring.
///
/// ```text
/// Hooke with cohesion: 0 as long as C < k/2πR*      Hertz with cohesion: (9π²/4) (C/E*)²      JKR: 2·6^(1/3) (π w/8E* r)^(2/3)
/// ```
pub fn overlap_without_load(contact: &Contact, elastic: Elastic, smallest: f64, largest: f64) -> f64 {
    match (contact.law, contact.cohesion) {
        (Law::Jkr { work_of_adhesion }, _) => {
            let root = libm::cbrt(PI * work_of_adhesion / (8.0 * elastic.modulus * smallest));
            2.0 * libm::cbrt(6.0) * root * root
        }
        (_, None) => 0.0,
        (Law::Hertz, Some(density)) => 2.25 * (PI * density / elastic.modulus).powi(2),
        (Law::Hooke { stiffness, .. }, Some(density)) => {
            if density < stiffness / (2.0 * PI * largest) {
                0.0
            } else {
                f64::INFINITY
            }
        }
    }
}

/// Largest gap at which a contact that was made still acts [m], for grains up to a radius [m]: neighbours are to be listed
/// at least up to there.
pub fn reach(contact: &Contact, elastic: Elastic, largest: f64) -> f64 {
    match contact.law {
        Law::Jkr { work_of_adhesion } => {
            let law = Jkr { modulus: elastic.modulus, work_of_adhesion, damping_ratio: 0.0 };
            Jkr::last_gap(largest, law.last_radius(largest))
        }
        _ => 0.0,
    }
}

/// Largest stiffness of a contact [N/m] up to an overlap that is a share of the `smaller` radius [m]; `radius` is R* [m].
///
/// ```text
/// S = k (Hooke), dF_n/dδ there (Hertz), 2 E* a there (JKR)
/// ```
pub fn stiffest(contact: &Contact, elastic: Elastic, radius: f64, smaller: f64, share: f64) -> f64 {
    match contact.law {
        Law::Hooke { stiffness, .. } => stiffness,
        Law::Hertz => 2.0 * elastic.modulus * (radius * share * smaller).sqrt(),
        Law::Jkr { work_of_adhesion } => {
            let law = Jkr { modulus: elastic.modulus, work_of_adhesion, damping_ratio: 0.0 };
            let last = law.last_radius(radius);
            2.0 * elastic.modulus * last * Jkr::spread(share * smaller, radius, last).powi(2)
        }
    }
}

/// A contact's numbers, and what follows from its two materials.
#[derive(Clone, Copy)]
struct Pair<'a> {
    contact: &'a Contact,
    elastic: Elastic,
    precision: Precision,
    ease: Ease,
}

/// Whether a law has an effect that is offered in double precision only.
pub fn is_rare(c: &Contact) -> bool {
    let constant = c.rolling_resistance.is_some() && c.rolling_model == RollingModel::Constant;
    let adheres = c.cohesion.is_some() || matches!(c.law, Law::Jkr { .. });
    adheres || c.weakening.is_some() || c.twisting_resistance.is_some() || constant
}

/// The effects of a contact, composed; the only place that knows which compositions there are.
///
/// Each composition is compiled for every width of lanes, with and without the ledger. So that there are not too many, what has
/// no memory and is rare is not a composition of its own: cohesion and the weakening of friction are a question that a kernel
/// asks once for each group of contacts, and only kernels with something rare in them.
///
/// `ease`: how much easier the bodies of both materials yield than spheres of their mass.
pub fn compose(contact: &Contact, elastic: Elastic, precision: Precision, ease: Ease) -> Box<dyn Kernel> {
    let pair = Pair { contact, elastic, precision, ease };
    let (damping_ratio, modulus) = (damping_ratio(contact.restitution), elastic.modulus);
    match contact.law {
        Law::Hooke { stiffness, .. } => pair.normal(Hooke { stiffness, damping_ratio }),
        Law::Hertz => pair.normal(Hertz { modulus, damping_ratio }),
        Law::Jkr { work_of_adhesion } => pair.rare(Jkr { modulus, work_of_adhesion, damping_ratio }),
    }
}

impl Pair<'_> {
    fn normal<N: Effect>(self, normal: N) -> Box<dyn Kernel> {
        let c = self.contact;
        if is_rare(c) {
            return self.rare((normal, c.cohesion.map(|energy_density| Cohesion { energy_density })));
        }
        match (c.sliding_friction, c.rolling_resistance) {
            (None, _) => self.common(normal),
            (Some(friction), None) => self.common((normal, self.sliding(friction))),
            (Some(friction), Some(resistance)) => {
                self.common((normal, (self.sliding(friction), RollingResistance { resistance })))
            }
        }
    }

    /// What is offered in every precision.
    fn common<E: Effect>(self, effects: E) -> Box<dyn Kernel> {
        match self.precision {
            Precision::Double => Box::new(effects),
            Precision::Mixed => Box::new(Narrow::<E, f64>::new(effects)),
            Precision::Single => Box::new(Narrow::<E, f32>::new(effects)),
        }
    }

    fn rare<N: Effect>(self, normal: N) -> Box<dyn Kernel> {
        let c = self.contact;
        let Some(at_rest) = c.sliding_friction else { return Box::new(normal) };
        let friction = match c.weakening {
            Some(w) => Friction::Weakening(Weakening { at_rest, sliding: w.dynamic, speed: w.speed }),
            None => Friction::Constant(at_rest),
        };
        let rubbing = (normal, self.sliding(friction));
        match (c.rolling_resistance, c.rolling_model) {
            (None, _) => self.twisting(rubbing),
            (Some(resistance), RollingModel::Spring) => {
                self.twisting((rubbing, RollingResistance { resistance }))
            }
            (Some(resistance), RollingModel::Constant) => {
                self.twisting((rubbing, ConstantRolling { resistance, yielding: self.ease.bodies }))
            }
        }
    }

    fn twisting<E: Effect>(self, so_far: E) -> Box<dyn Kernel> {
        let stiffness_ratio = tangential_ratio(self.contact, self.elastic);
        match self.contact.twisting_resistance {
            Some(resistance) => {
                let yielding = self.ease.springs;
                Box::new((so_far, TwistingResistance { resistance, stiffness_ratio, yielding }))
            }
            None => Box::new(so_far),
        }
    }

    fn sliding<C: Coefficient>(self, friction: C) -> SlidingFriction<C> {
        let stiffness_ratio = tangential_ratio(self.contact, self.elastic);
        let damping_ratio = damping_ratio(self.contact.restitution);
        SlidingFriction { friction, stiffness_ratio, damping_ratio, yielding: self.ease.springs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explain::parts;
    use crate::setup::Weakening as Weakens;

    /// Every contact that a scene can ask for.
    fn contacts() -> Vec<Contact> {
        let hooke = Law::Hooke { stiffness: 1e4, tangential_ratio: None };
        let laws = [hooke, Law::Hertz, Law::Jkr { work_of_adhesion: 1.0 }];
        let mut all: Vec<Contact> = laws.map(|law| Contact::new((0, 0), law, 0.5)).to_vec();
        let mut also = |change: fn(&mut Contact)| {
            let mut more = all.clone();
            more.iter_mut().for_each(change);
            all.extend(more);
        };
        also(|c| c.cohesion = Some(1e3).filter(|_| !matches!(c.law, Law::Jkr { .. })));
        also(|c| c.sliding_friction = Some(0.5));
        also(|c| c.weakening = c.sliding_friction.map(|mu| Weakens { dynamic: 0.5 * mu, speed: 0.1 }));
        also(|c| c.rolling_resistance = c.sliding_friction);
        also(|c| c.rolling_model = RollingModel::Constant);
        also(|c| c.twisting_resistance = c.sliding_friction);
        all
    }

    #[test]
    fn kernels_take_the_memory_of_their_effects_and_no_more() {
        let material = Material { name: "a".to_owned(), density: 1e3, young: 1e6, poisson: 0.3 };
        let ease = Ease { bodies: 1.0, springs: 1.0 };
        for c in contacts() {
            let kernel = compose(&c, Elastic::of(&material, &material), Precision::Double, ease);
            let bytes: usize = parts(&c).iter().map(|p| p.bytes).sum();
            assert_eq!(8 * kernel.columns(), bytes, "{c:?}");
            assert_eq!(kernel.rotates(), c.sliding_friction.is_some(), "{c:?}");
            let couples = c.rolling_resistance.is_some() || c.twisting_resistance.is_some();
            assert_eq!(kernel.couples(), couples, "{c:?}");
            // Vectors change their sign when i and j change places, numbers do not.
            let flips = (0..kernel.columns()).filter(|&k| kernel.flips(k)).count();
            assert_eq!(flips, kernel.columns() / 3 * 3, "{c:?}");
        }
    }
}
