//! What each kind of bond makes of two particles: the numbers of one bond.
//!
//! ```text
//! beam       k_n = E A/L,   k_s = 12 E I/L³,   k_b = E I/L,   k_t = G J/L;   L between centres, section half-way
//! parallel   k_n A,  k_s A,  k_n I,  k_s J of springs per area; of a modulus k_n = E/(r_i + r_j);   section where the surfaces meet
//! contact    k_n,  k_s alone; of a modulus k_n = 2 E (r_i + r_j);   L is r_i + r_j at least: overlaps push as in a contact
//! A = π r², I = π r⁴/4, J = 2 I,   r = λ min(r_i, r_j)
//! ```

use crate::model::bonds::motions::frequency;
use crate::model::bonds::strength::strength;
use crate::setup::{Bond, BondKind, BondNumbers, BondSprings};
use geom::Vec3;
use nalgebra::UnitQuaternion;
use std::f64::consts::PI;

/// One end of a bond to be made.
#[derive(Debug, Clone, Copy)]
pub struct End {
    /// Id.
    pub id: u32,
    /// Radius [m].
    pub radius: f64,
    /// Mass [kg].
    pub mass: f64,
    /// How it has turned since turns are counted.
    pub turn: UnitQuaternion<f64>,
}

/// The bond that a law makes of two ends, `arm` from the second to the first [m].
pub fn numbers(law: &Bond, ends: [End; 2], arm: &Vec3) -> BondNumbers {
    let [a, b] = ends;
    let (distance, sum) = (arm.norm(), a.radius + b.radius);
    let radius = law.radius_ratio * a.radius.min(b.radius);
    let area = PI * radius * radius;
    let inertia = 0.25 * area * radius * radius;
    let (mut length, mut share, mut moments) = (distance, a.radius / sum, 1.0);
    let stiffness = match law.kind {
        BondKind::Beam { young, shear_modulus } => {
            share = 0.5;
            let bending = young * inertia / length;
            [
                young * area / length,
                12.0 * bending / (length * length),
                bending,
                shear_modulus * 2.0 * inertia / length,
            ]
        }
        BondKind::Parallel { springs, moments: counted } => {
            moments = counted;
            let [normal, shear] = springs.per(1.0 / sum);
            [normal * area, shear * area, normal * inertia, shear * 2.0 * inertia]
        }
        BondKind::Contact(springs) => {
            length = distance.max(sum);
            let [normal, shear] = springs.per(2.0 * sum);
            [normal, shear, 0.0, 0.0]
        }
    };
    let mut made = BondNumbers {
        axis: b.turn.inverse() * (arm / distance),
        reference: a.turn.inverse() * b.turn,
        size: [length, radius],
        share,
        stiffness,
        lag: 0.0,
        moments,
        at_ends: matches!(law.kind, BondKind::Beam { .. }),
        strength: strength(&law.strength, [a.id, b.id], radius),
        replaces_contact: law.replaces_contact,
    };
    if law.damping > 0.0 {
        made.lag = law.damping / frequency(&made, ends);
    }
    made
}

impl BondSprings {
    /// k_n and k_s; `per` is what makes k_n of a modulus.
    fn per(&self, per: f64) -> [f64; 2] {
        match *self {
            BondSprings::Given(both) => both,
            BondSprings::Modulus { modulus, ratio } => [modulus * per, modulus * per / ratio],
        }
    }
}
