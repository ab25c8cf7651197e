//! When bonds break: LAMMPS adds the shares of four loads, we compare two stresses with two strengths.
//!
//! ```text
//! LAMMPS   F_n/F_nc + F_s/F_sc + |M_b|/M_bc + |M_t|/M_tc ≥ 1               M_b: half-way between the centres
//! here     σ = F_n/A + |M| r/I > σ_c     or     τ = F_s/A + |M_t| r/J > τ_c − tan φ F_n/A
//!          |M| = max |M_b ± ½ L n × F_s|: at the worse end
//!
//! τ_c alone    F_sc = τ_c A    M_tc = τ_c J/r    F_nc = τ_c A/tan φ        the same
//! σ_c alone    F_nc = σ_c A    M_bc = σ_c I/r    F_sc = 2 M_bc/L           the same where both moments are parallel; else LAMMPS breaks it earlier, from 1/√2 of the load
//! both         F_nc, M_bc of σ_c    M_tc of τ_c    F_sc the lower one      each load alone does the same; together LAMMPS breaks it earlier, and under pressure later
//! ```

use crate::error::Refusal;
use dem::setup::{Bond, Setup};
use std::f64::consts::PI;

/// Force [N] and moment [N·m] that no bond reaches.
const NEVER: f64 = 1e100;

/// Whether a bond of this σ_c, τ_c [Pa] and tan φ can break.
pub fn can_break([tension, shear, _]: &[f64; 3]) -> bool {
    tension.is_finite() || shear.is_finite()
}

/// Strengths that LAMMPS has only nearly.
pub fn bendable(setup: &Setup) -> Vec<Refusal> {
    let of = |(k, law): (usize, &Bond)| {
        let both = law.strength.shear.is_finite();
        let why = match both {
            true => {
                "LAMMPS adds the shares of tension, shear, bending and twist in their strengths: a bond breaks by each alone as here, by several earlier, and under pressure later"
            }
            false => {
                "LAMMPS adds the moments of bending and of shear by their sizes: where they are not in one plane, a bond breaks earlier, from 71 % of the load"
            }
        };
        let nearest =
            if both { "leave one strength out, or use dem-run" } else { "use dem-run, or shear_strength" };
        law.strength
            .tension
            .is_finite()
            .then(|| Refusal::new(format!("tensile strength of bond.{k}"), why, nearest))
    };
    setup.bonds.iter().enumerate().filter_map(of).collect()
}

/// F_nc, F_sc, M_tc, M_bc of a bond of length L and radius r [m], with σ_c, τ_c [Pa] and tan φ.
pub fn limits([length, radius]: [f64; 2], [tension, shear, friction]: [f64; 3]) -> [f64; 4] {
    let area = PI * radius * radius;
    let inertia = 0.25 * area * radius * radius;
    let (bending, twist) = (tension * inertia / radius, shear * 2.0 * inertia / radius);
    let along = if tension.is_finite() { tension * area } else { shear * area / friction };
    // No load is 0 times infinite.
    [along, (2.0 * bending / length).min(shear * area), twist, bending]
        .map(|limit| limit.clamp(1.0 / NEVER, NEVER))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    const LENGTH: f64 = 8e-3;
    const RADIUS: f64 = 3e-3;
    const ALONG: Vec3 = Vec3::new(0.0, 0.0, 1.0);

    /// Tension [N], shear [N] and bending [N·m] across z, and twist [N·m].
    type Loads = (f64, Vec3, Vec3, f64);

    /// What LAMMPS compares with 1.
    fn sum((tension, shear, bending, twist): Loads, strength: [f64; 3]) -> f64 {
        let [n, s, t, b] = limits([LENGTH, RADIUS], strength);
        tension / n + shear.norm() / s + bending.norm() / b + twist / t
    }

    /// σ and τ less the friction [Pa], as [`dem`] has them.
    fn stresses((tension, shear, bending, twist): Loads, friction: f64) -> [f64; 2] {
        let area = PI * RADIUS * RADIUS;
        let inertia = 0.25 * area * RADIUS * RADIUS;
        let arm = ALONG.cross(&shear) * (0.5 * LENGTH);
        let most = (bending + arm).norm().max((bending - arm).norm());
        let tau = shear.norm() / area + twist * RADIUS / (2.0 * inertia);
        [tension / area + most * RADIUS / inertia, tau + friction * tension / area]
    }

    /// Loads of all directions.
    fn loads() -> impl Iterator<Item = Loads> {
        let part = |k: u32, factor: u32| f64::from(k * factor % 101) / 50.5 - 1.0;
        (1..100).map(move |k| {
            let across = |a, b, size| Vec3::new(part(k, a), part(k, b), 0.0) * size;
            (part(k, 17).abs(), across(29, 37, 0.5), across(43, 53, 2e-3), part(k, 71).abs() * 1e-3)
        })
    }

    #[test]
    fn shear_alone_is_the_same_criterion() {
        for of in loads() {
            let (tension, shear, bending, twist) = of;
            for (friction, tension) in [(0.0, tension), (0.4, tension), (0.4, -tension)] {
                let of = (tension, shear, bending, twist);
                let (found, expected) =
                    (sum(of, [f64::INFINITY, 3e4, friction]), stresses(of, friction)[1] / 3e4);
                assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{found} {expected}");
            }
        }
    }

    #[test]
    fn tension_alone_is_the_same_in_one_plane_and_breaks_earlier_in_two() {
        let strength = [2e5, f64::INFINITY, 0.0];
        let mut worst = 1.0f64;
        for (tension, shear, bending, twist) in loads() {
            let ours = |bending| stresses((tension, shear, bending, twist), 0.0)[0] / strength[0];
            let plane = ALONG.cross(&shear).normalize() * bending.norm();
            let found = sum((tension, shear, plane, twist), strength);
            assert!((found / ours(plane) - 1.0).abs() < 1e-12, "{found}");
            let earlier = sum((tension, shear, bending, twist), strength) / ours(bending);
            assert!((1.0 - 1e-12..2f64.sqrt()).contains(&earlier), "{earlier}");
            worst = worst.max(earlier);
        }
        assert!(worst > 1.1, "{worst}");
    }

    #[test]
    fn with_both_each_load_alone_is_the_same() {
        let (strength, none) = ([2e5, 3e4, 0.0], Vec3::zeros());
        for (tension, shear, bending, twist) in loads() {
            for of in [
                (tension, none, none, 0.0),
                (0.0, shear, none, 0.0),
                (0.0, none, bending, 0.0),
                (0.0, none, none, twist),
            ] {
                let [sigma, tau] = stresses(of, 0.0);
                let ours = (sigma / strength[0]).max(tau / strength[1]);
                assert!((sum(of, strength) - ours).abs() < 1e-12 * ours, "{of:?}");
            }
        }
    }
}
