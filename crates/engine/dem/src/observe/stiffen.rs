//! How stiff a contact must be to bear an approach that has passed the overlap guard.
//!
//! ```text
//! F = K δ^p,  S = dF/dδ,  p − 1 = log₂ S(δ)/S(δ/2),   U = S δ²/p(p + 1)           energy that is stored at δ
//! K'/K = (½ m* v² + U)/U · (δ/δ')^(p+1)                                     brought to rest at δ', without damping
//! ```

use crate::model::dense_walls::met;
use crate::model::limit::{contact_between, stiffest};
use crate::model::{Model, Stiffer};
use crate::setup::{Setup, Wall};
use laws::effects::{ContactLaw, Elastic, MODULI, Material, OverlapLimit, damping_ratios};

/// Share of the guard that the approach is to stay within [–].
const WITHIN: f64 = 0.8;

/// A contact that is too deep.
#[derive(Clone, Copy)]
pub struct DeepContact {
    /// Materials of both.
    pub between: (u16, u16),
    /// Radii [m]; of a flat wall 0.
    pub radii: [f64; 2],
    /// 1/m* [1/kg].
    pub inverse_mass: f64,
    /// Overlap [m].
    pub overlap: f64,
    /// Rate at which it grows [m/s].
    pub approach: f64,
}

/// A contact as a spring at some overlap.
struct Spring<'a> {
    law: &'a ContactLaw,
    materials: [&'a Material; 2],
    /// p of the module's head [–].
    power: f64,
    /// S [N/m].
    stiffness: f64,
    /// U [J].
    stored: f64,
}

impl<'a> Spring<'a> {
    /// Between two materials, R* and the smaller radius [m], at an overlap over the smaller radius.
    fn new(
        setup: &'a Setup,
        between: (u16, u16),
        (radius, smaller): (f64, f64),
        share: f64,
    ) -> Option<Spring<'a>> {
        let law = contact_between(setup, between.0, between.1).ok()?;
        let materials = [between.0, between.1].map(|m| &setup.materials[m as usize]);
        let elastic = Elastic::of(materials[0], materials[1]);
        let stiffness = |share: f64| stiffest(law, elastic, OverlapLimit { radius, smaller, share });
        let (s, half) = (stiffness(share), stiffness(0.5 * share));
        let (power, overlap) = (1.0 + libm::log2(s / half), share * smaller);
        let stored = s * overlap * overlap / (power * (power + 1.0));
        Some(Spring { law, materials, power, stiffness: s, stored })
    }

    /// γ, for an inverse mass [1/kg].
    fn damping_ratio(&self, inverse_mass: f64) -> f64 {
        let impedance = (self.stiffness / inverse_mass).sqrt();
        let [along, _] = damping_ratios(self.law, [impedance; 2]);
        along
    }

    /// What is to be so many times stiffer, for an approach [m/s].
    fn stiffer(&self, times: f64, speed: f64) -> Option<Stiffer> {
        let [a, b] = self.materials;
        let own = [("stiffness", "N/m"), (MODULI[0], "Pa"), (MODULI[1], "Pa")];
        let own = own.iter().find_map(|(key, unit)| Some((*key, *unit, self.law.number(key)?)));
        let (key, unit, of, value) = match own {
            Some((key, unit, k)) => (key, unit, format!("{}–{}", a.name, b.name), times * k),
            None => {
                let (of, young) = moduli(self.materials, times);
                ("young", "Pa", of, young)
            }
        };
        value.is_finite().then_some(Stiffer { speed, key, of, value, most: value, unit })
    }
}

/// The modulus [Pa] with which two materials are so many times stiffer against each other: of the softer one, or of both where it cannot be stiff enough.
fn moduli([a, b]: [&Material; 2], times: f64) -> (String, f64) {
    let yields = |m: &Material| 1.0 - m.poisson * m.poisson;
    let (soft, hard) = if b.young < a.young { (b, a) } else { (a, b) };
    let compliance = (yields(a) / a.young + yields(b) / b.young) / times;
    let alone = yields(soft) / (compliance - yields(hard) / hard.young);
    if a.name != b.name && alone > 0.0 && alone <= hard.young {
        (soft.name.clone(), alone)
    } else if a.name == b.name {
        (a.name.clone(), times * a.young)
    } else {
        (format!("{} and {}", a.name, b.name), (yields(a) + yields(b)) / compliance)
    }
}

/// What would bear a contact that has passed the guard, and the hardest impact of its `neighbours` at the fastest approach among them; `None` where
/// the law says nothing of that.
pub fn stiffer(
    model: &Model,
    deep: &DeepContact,
    neighbours: impl Iterator<Item = DeepContact> + Clone,
) -> Option<Stiffer> {
    let this = bears(model, deep)?;
    let fastest = neighbours.clone().map(|near| near.approach).fold(deep.approach, f64::max);
    let all = neighbours.filter_map(|near| bears(model, &DeepContact { approach: fastest, ..near }));
    let most =
        all.filter(|s| s.key == this.key && s.of == this.of).map(|s| s.value).fold(this.value, f64::max);
    Some(Stiffer { most, ..this })
}

/// The modulus or stiffness that would bear a contact.
fn bears(model: &Model, deep: &DeepContact) -> Option<Stiffer> {
    let [a, b] = deep.radii;
    let (radius, smaller) = if b == 0.0 { (a, a) } else { (a * b / (a + b), a.min(b)) };
    let limit = WITHIN * model.setup.guards.overlap;
    // What does not touch yet has nothing stored: its spring is that at the limit.
    let share = if deep.overlap > 0.0 { deep.overlap / smaller } else { limit };
    let spring = Spring::new(&model.setup, deep.between, (radius, smaller), share)?;
    let speed = deep.approach.max(0.0);
    let stored = if deep.overlap > 0.0 { spring.stored } else { 0.0 };
    let energy = stored + 0.5 * speed * speed / deep.inverse_mass;
    let closer = libm::pow(share / limit, spring.power + 1.0);
    spring.stiffer(energy / spring.stored * closer, speed)
}

/// A first impact on a wall that the overlap guard would stop.
#[derive(Debug, Clone, PartialEq)]
pub struct DeepImpact {
    /// Radius of the grain [m].
    pub radius: f64,
    /// Overlap over the smaller radius [–].
    pub share: f64,
    /// What would bear it.
    pub stiffer: Stiffer,
}

/// Share of the energy of an approach that a linear spring with a dashpot of ratio γ holds where it is deepest: exp(−2 q atan(1/q)), q = h/√(1 − h²),
/// h = γ/2, so that q = −ln e/π.
fn left_at_depth(gamma: f64) -> f64 {
    let half = (0.5 * gamma).min(1.0);
    let q = half / (1.0 - half * half).sqrt();
    // q atan(1/q) → 1 for a contact that does not rebound.
    let turn = if q.is_finite() && q > 0.0 { q * libm::atan(1.0 / q) } else { f64::from(u8::from(q > 0.0)) };
    libm::exp(-2.0 * turn)
}

/// A sphere, or the sphere of a clump that meets a wall, and what it is slowed with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impacting {
    /// Index of its material.
    pub material: u16,
    /// Its radius [m].
    pub radius: f64,
    /// Mass of the whole [kg].
    pub mass: f64,
}

/// How deep an impact on a wall at a speed [m/s] along its normal is; `None` where the overlap guard bears it. Dampers count as that of a linear law.
pub fn deep_impact(setup: &Setup, wall: &Wall, grain: &Impacting, speed: f64) -> Option<DeepImpact> {
    let limit = setup.guards.overlap;
    let spring = Spring::new(setup, (grain.material, wall.material), met(wall, grain.radius), limit)?;
    let left = left_at_depth(spring.damping_ratio(1.0 / grain.mass));
    let times = left * 0.5 * speed * speed * grain.mass / spring.stored;
    let share = limit * libm::pow(times, 1.0 / (spring.power + 1.0));
    let stiffer = spring.stiffer(times * libm::pow(WITHIN, -spring.power - 1.0), speed)?;
    (times > 1.0).then_some(DeepImpact { radius: grain.radius, share, stiffer })
}
