//! The numbers of one bond as they are kept: three rows of eight, which lanes read as columns.
//!
//! | row | columns |
//! |---|---|
//! | 0 | direction x, y, z, length L, reference i, j, k, w |
//! | 1 | k_n, k_s, k_b, k_t, dashpots over springs, share w_i, 1 where moments count at the section, 1 where it replaces the contact |
//! | 2 | radius r, 1/A, β r/I, σ_c, τ_c, tan φ, β, – |
//!
//! 1/A and β r/I (twice β r/J) are kept so that no step divides.

use crate::model::BreakMode;
use crate::setup::BondNumbers;
use crate::setup::bond::resists;
use geom::Vec3;
use laws::simd::{Lane, Row, Turn, V};
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::PI;

/// The numbers of one bond.
pub type Springs = [Row; 3];

/// Packs the numbers of a bond.
pub fn packed(numbers: &BondNumbers) -> Springs {
    let BondNumbers { axis: n, reference, size: [length, radius], share, lag, moments, strength, .. } =
        *numbers;
    let ([k_n, k_s, k_b, k_t], [tension, shear, friction]) = (numbers.stiffness, strength);
    let area = PI * radius * radius;
    let flag = |holds: bool| f64::from(u8::from(holds));
    let q = reference.coords;
    [
        Row([n.x, n.y, n.z, length, q.x, q.y, q.z, q.w]),
        Row([k_n, k_s, k_b, k_t, lag, share, flag(!numbers.at_ends), flag(numbers.replaces_contact)]),
        Row([radius, 1.0 / area, moments * 4.0 / (area * radius), tension, shear, friction, moments, 0.0]),
    ]
}

/// The numbers again.
pub fn numbers(springs: &Springs) -> BondNumbers {
    let [Row([x, y, z, length, i, j, k, w]), Row([k_n, k_s, k_b, k_t, lag, share, at_section, _]), last] =
        *springs;
    let Row([radius, _, _, tension, shear, friction, moments, _]) = last;
    BondNumbers {
        axis: Vec3::new(x, y, z),
        reference: UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k)),
        size: [length, radius],
        share,
        stiffness: [k_n, k_s, k_b, k_t],
        lag,
        moments,
        at_ends: at_section == 0.0,
        strength: [tension, shear, friction],
        replaces_contact: replaces_contact(springs),
    }
}

/// Whether the two particles are not in contact as long as the bond holds.
pub fn replaces_contact(springs: &Springs) -> bool {
    springs[1][7] != 0.0
}

/// What breaks it at these stresses (tension at the rim, shear, mean tension) [Pa]: that which passes its strength by more.
pub fn breaks(springs: &Springs, [tension, shear, mean]: [f64; 3]) -> Option<BreakMode> {
    let Row([_, _, _, strength @ .., _, _]) = springs[2];
    let [most, resists] = resists(strength, mean);
    match (tension > most, shear > resists) {
        (false, false) => None,
        (true, true) if tension * resists < shear * most => Some(BreakMode::Shear),
        (true, _) => Some(BreakMode::Tension),
        (false, true) => Some(BreakMode::Shear),
    }
}

/// The numbers of some bonds, as lanes.
pub struct SpringLanes<R> {
    /// Direction from j to i when each was made, as j has turned since.
    pub axis: V<R>,
    /// From the turn of i to that of j when it was made.
    pub reference: Turn<R>,
    /// L [m].
    pub length: R,
    /// Springs against stretching and shear [N/m], bending and twist [N·m/rad].
    pub stiffness: [R; 4],
    /// Dashpots over springs [s].
    pub lag: R,
    /// w_i [–].
    pub share: R,
    /// 1 where moments count at the section, 0 where at the centres.
    pub at_section: R,
    /// 1/A [1/m²].
    pub per_area: R,
    /// β r/I [1/m³].
    pub rim: R,
    /// σ_c, τ_c [Pa], and tan φ [–].
    pub strength: [R; 3],
}

impl<R: Lane> SpringLanes<R> {
    /// From the columns of the three rows.
    #[inline(always)]
    pub fn of(columns: [[R; 8]; 3]) -> SpringLanes<R> {
        let [[x, y, z, length, i, j, k, w], [k_n, k_s, k_b, k_t, lag, share, at_section, _], last] = columns;
        let [_, per_area, rim, tension, shear, friction, ..] = last;
        SpringLanes {
            axis: V::new(x, y, z),
            reference: Turn::of([i, j, k, w]),
            length,
            stiffness: [k_n, k_s, k_b, k_t],
            lag,
            share,
            at_section,
            per_area,
            rim,
            strength: [tension, shear, friction],
        }
    }

    /// Whether any breaks at these stresses, as [`breaks`] has it.
    #[inline(always)]
    pub fn any_breaks(&self, [tension, shear, mean]: [R; 3]) -> bool {
        let [most, cohesion, friction] = self.strength;
        let resists = (cohesion - mean * friction).max(R::splat(0.0));
        R::any(tension.gt(most)) || R::any(shear.gt(resists))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_that_were_packed() {
        for (at_ends, replaces_contact) in [(true, false), (false, true)] {
            let bond = BondNumbers {
                axis: Vec3::new(0.6, 0.0, -0.8),
                reference: UnitQuaternion::new_unchecked(Quaternion::new(0.5, -0.5, 0.5, 0.5)),
                size: [0.02, 0.004],
                share: 0.3,
                stiffness: [7e3, 4e3, 0.03, 0.02],
                lag: 1e-3,
                moments: 0.7,
                at_ends,
                strength: [2.0, f64::INFINITY, 0.5],
                replaces_contact,
            };
            assert_eq!(numbers(&packed(&bond)), bond);
        }
    }

    #[test]
    fn what_passes_its_strength_by_more_breaks_it() {
        let mut springs = [Row([0.0; 8]); 3];
        springs[2] = Row([0.0, 0.0, 0.0, 2.0, 3.0, 0.5, 0.0, 0.0]);
        assert_eq!(breaks(&springs, [1.9, 2.9, 0.0]), None);
        assert_eq!(breaks(&springs, [2.1, 2.9, 0.0]), Some(BreakMode::Tension));
        assert_eq!(breaks(&springs, [2.1, 6.0, 0.0]), Some(BreakMode::Shear));
        // Pressure strengthens, tension weakens.
        assert_eq!(breaks(&springs, [0.0, 3.9, -2.0]), None);
        assert_eq!(breaks(&springs, [1.0, 2.6, 1.0]), Some(BreakMode::Shear));
        let lanes = SpringLanes::<f64>::of(springs.map(|row| row.0));
        for stress in [[1.9, 2.9, 0.0], [2.1, 2.9, 0.0], [0.0, 3.9, -2.0], [1.0, 2.6, 1.0]] {
            assert_eq!(lanes.any_breaks(stress), breaks(&springs, stress).is_some());
        }
    }
}
