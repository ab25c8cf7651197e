//! How stiff a contact must be to bear an approach that has passed the overlap guard.
//!
//! ```text
//! F = K δ^p,  S = dF/dδ,  p − 1 = log₂ S(δ)/S(δ/2),   U = S δ²/p(p + 1)           energy that is stored at δ
//! K'/K = (½ m* v² + U)/U · (δ/δ')^(p+1)                                     brought to rest at δ', without damping
//! ```

use crate::effects::{Elastic, OverlapLimit};
use crate::model::limit::{contact_between, stiffest};
use crate::model::{Model, Stiffer};

/// Share of the guard that the approach is to stay within [–].
const WITHIN: f64 = 0.8;

/// A contact that is too deep.
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

/// The modulus or stiffness that would bear it; `None` where the law says nothing of that.
pub fn stiffer(model: &Model, deep: &DeepContact) -> Option<Stiffer> {
    let [a, b] = deep.radii;
    let (radius, smaller) = if b == 0.0 { (a, a) } else { (a * b / (a + b), a.min(b)) };
    let law = contact_between(&model.setup, deep.between.0, deep.between.1).ok()?;
    let materials = [deep.between.0, deep.between.1].map(|m| &model.setup.materials[m as usize]);
    let elastic = Elastic::of(materials[0], materials[1]);
    let share = deep.overlap / smaller;
    let stiffness = |share: f64| stiffest(law, elastic, OverlapLimit { radius, smaller, share });
    let (s, half) = (stiffness(share), stiffness(0.5 * share));
    let power = 1.0 + libm::log2(s / half);
    let stored = s * deep.overlap * deep.overlap / (power * (power + 1.0));
    let speed = deep.approach.max(0.0);
    let energy = stored + 0.5 * speed * speed / deep.inverse_mass;
    let times = energy / stored * libm::pow(share / (WITHIN * model.setup.guards.overlap), power + 1.0);
    let softest = if materials[1].young < materials[0].young { materials[1] } else { materials[0] };
    let (key, unit, of, value) = match law.number("stiffness") {
        Some(k) => ("stiffness", "N/m", format!("{}–{}", materials[0].name, materials[1].name), k),
        None => ("young", "Pa", softest.name.clone(), softest.young),
    };
    let value = times * value;
    value.is_finite().then_some(Stiffer { speed, key, of, value, unit })
}
