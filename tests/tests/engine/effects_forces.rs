//! The parts of contact laws that conserve energy: force = dE/dδ, against their closed forms, and at their limits.

use dem::effects::{Cohesion, Damping, Effect, Hooke, Jkr, Response};
use dem::simd::V;
use grainpipe_tests::normals::{MODULUS, NORMALS, WORK, response, still};
use std::f64::consts::PI;

/// F = dE/dδ for every normal law, for a pair of unequal spheres and at a flat wall.
#[test]
fn force_is_the_slope_of_energy() {
    let (a, b) = (0.01f64, 0.004f64);
    for normal in NORMALS {
        for (radius, curvature) in [(a * b / (a + b), 1.0 / (a + b)), (a, 0.0)] {
            for overlap in [1e-6, 1e-5, 1e-4, 5e-4] {
                let at = |overlap| normal.response(&still(overlap, radius, curvature));
                let h = 1e-3 * overlap;
                let slope = (at(overlap + h).elastic - at(overlap - h).elastic) / (2.0 * h);
                let force = at(overlap).normal;
                let scale = at(overlap).pressing.abs();
                assert!(
                    (slope - force).abs() < 1e-5 * scale,
                    "{} at {overlap} m: {slope}, {force} N",
                    normal.name
                );
            }
        }
    }
}

/// The area is that of the circle in which the spheres meet, the energy their common volume, both by numerical integration.
#[test]
fn cohesion_is_energy_density_times_common_volume() {
    let (ri, rj, overlap) = (0.01f64, 0.006f64, 0.0005f64);
    let (sum, d) = (ri + rj, ri + rj - overlap);
    let contact = still(overlap, ri * rj / sum, 1.0 / sum);
    let got = response(Cohesion { energy_density: 1e5 }, &contact);
    // The circle lies at x from the centre of i.
    let x = (d * d + ri * ri - rj * rj) / (2.0 * d);
    let area = PI * (ri * ri - x * x);
    assert!((got.normal / (-1e5 * area) - 1.0).abs() < 1e-11, "{} N", got.normal);
    let cap = |r: f64, from: f64| {
        let h = (r - from) / 2e5;
        (0..200_000).map(|k| from + (k as f64 + 0.5) * h).map(|z| PI * (r * r - z * z) * h).sum::<f64>()
    };
    let volume = cap(ri, x) + cap(rj, d - x);
    assert!((got.elastic / (-1e5 * volume) - 1.0).abs() < 1e-8, "{} J", got.elastic);
    assert_eq!(got.pressing, 0.0, "cohesion does not press");
}

fn jkr() -> Jkr {
    Jkr::with_modulus(MODULUS, WORK, Damping::NONE)
}

/// Overlap and force of the closed form for a radius of contact a: δ = a²/R − √(2π w a/E*), F = 4E*a³/3R − √(8π w E* a³).
#[test]
fn jkr_follows_its_closed_form_from_the_break_to_deep_overlap() {
    for r in [1e-6, 1e-3, 0.01, 1.0f64] {
        let last = (PI * WORK * r * r / (8.0 * MODULUS)).cbrt();
        assert!((jkr().last_radius(r) / last - 1.0).abs() < 1e-14);
        for share in [1.001, 1.01, 1.1, 1.5, 2.0, 2.5198420997897464, 5.0, 50.0] {
            let a = share * last;
            let overlap = a * a / r - (2.0 * PI * WORK * a / MODULUS).sqrt();
            let force =
                4.0 * MODULUS * a.powi(3) / (3.0 * r) - (8.0 * PI * WORK * MODULUS * a.powi(3)).sqrt();
            let got = response(jkr(), &still(overlap, r, 0.0));
            // Near the break √(δ + δ_c) loses digits.
            let bound = 1e-11 * PI * WORK * r * share.powi(3).max(1.0) / (share - 1.0).min(1.0);
            assert!((got.normal - force).abs() < bound, "R {r}, a/a_c {share}: {} N, {force} N", got.normal);
            assert!((got.stiffness / (2.0 * MODULUS * a) - 1.0).abs() < 1e-8);
            assert!(
                (got.pressing - got.normal - 3.0 * PI * WORK * r).abs()
                    < 1e-12 * PI * WORK * r * share.powi(3)
            );
        }
    }
}

/// Strongest pull 3/2 π w R*; −4/3 π w R* where contact is made, −5/6 π w R* where it breaks, at −3 a_c²/R*.
#[test]
fn jkr_pulls_off_at_three_halves_pi_w_r() {
    let r = 0.005;
    let last = (PI * WORK * r * r / (8.0 * MODULUS)).cbrt();
    let gap = 3.0 * last * last / r;
    let force = |overlap: f64| response(jkr(), &still(overlap, r, 0.0)).normal;
    let pulls = (0..=100_000).map(|k| force(-gap * f64::from(k) / 1e5));
    let strongest = pulls.fold(0.0, f64::min);
    assert!((strongest / (-1.5 * PI * WORK * r) - 1.0).abs() < 1e-6, "{strongest} N");
    assert!((force(0.0) / (-4.0 / 3.0 * PI * WORK * r) - 1.0).abs() < 1e-12);
    assert!((force(-gap) / (-5.0 / 6.0 * PI * WORK * r) - 1.0).abs() < 1e-6);
    assert!((jkr().reach(r, &last) / gap - 1.0).abs() < 1e-14);
    assert_eq!(jkr().reach(r, &0.0), 0.0, "a contact that was not made does not reach");
}

/// The energy that the ledger books for a cycle is the area between the ways in and out, ∫ |F| dδ from −δ_c to 0 and the force at the
/// break times nothing: 7.09 (w⁵ R⁴/E*²)^(1/3) as Thornton & Ning have it.
#[test]
fn jkr_books_the_area_of_its_hysteresis() {
    let r = 0.005;
    let last = (PI * WORK * r * r / (8.0 * MODULUS)).cbrt();
    let gap = 3.0 * last * last / r;
    let n = 200_000;
    let force = |k: i32| response(jkr(), &still(-gap * (f64::from(k) + 0.5) / f64::from(n), r, 0.0)).normal;
    let area: f64 = (0..n).map(|k| -force(k) * gap / f64::from(n)).sum();
    let made = response(jkr(), &still(0.0, r, 0.0));
    assert!((made.lost / area - 1.0).abs() < 1e-6, "{} J, {area} J", made.lost);
    assert!(
        (made.elastic / -area - 1.0).abs() < 1e-6,
        "the energy at the making is that of the break less the area"
    );
    let published = 7.09 * (WORK.powi(5) * r.powi(4) / MODULUS.powi(2)).cbrt();
    assert!((area / published - 1.0).abs() < 1e-3, "{area} J, {published} J");
}

/// JKR becomes Hertz as w → 0.
#[test]
fn jkr_without_adhesion_is_hertz() {
    let weak = Jkr::with_modulus(MODULUS, 1e-15, Damping::NONE);
    let overlap = 1e-4;
    let hertz = 4.0 / 3.0 * MODULUS * 0.01f64.sqrt() * f64::powf(overlap, 1.5);
    let got = response(weak, &still(overlap, 0.01, 0.0));
    assert!((got.normal / hertz - 1.0).abs() < 1e-6, "{} N, {hertz} N", got.normal);
}

/// A spring under its cap: the couple is k φ, and the energy ½ k φ²; over it, μ R* F_n.
#[test]
fn twisting_is_a_spring_under_a_cap() {
    let twisting =
        dem::effects::TwistingResistance { resistance: 0.1, stiffness_ratio: 0.8, compliance: 1.0 };
    let normal = Hooke { stiffness: 1e4, damping: Damping::NONE };
    let twisted = |phi: f64| {
        let contact = still(1e-4, 0.01, 0.0);
        let mut response: Response<f64> = response(normal, &contact);
        let mut history = phi;
        twisting.apply(&contact, 1e-6, &mut history, &mut response);
        response
    };
    let k = 0.8 * 1e4 * 0.01 * 0.01;
    for phi in [1e-5, 1e-4, -5e-4] {
        let got = twisted(phi);
        assert!((got.torque.z / (-k * phi) - 1.0).abs() < 1e-12, "{} N·m", got.torque.z);
        assert!((got.elastic - 5e-5 - 0.5 * k * phi * phi).abs() < 1e-15);
    }
    assert!((twisted(1.0).torque.z + 0.1 * 0.01 * 1.0).abs() < 1e-15, "the cap is μ R* F_n");
}

/// Rolling of constant size: μ_r R* F_n whatever the speed; where it sticks never more than takes an eighth of the rolling in a step, less of a body
/// that yields more easily.
#[test]
fn constant_rolling_has_one_size_and_never_turns_rolling_round() {
    let couple = |spin: f64, compliance: f64, rolled: f64| {
        let rolling = dem::effects::ConstantRolling { resistance: 0.1, compliance };
        let mut contact = still(1e-4, 0.01, 0.0);
        contact.spin = V::new(spin, 0.0, 7.0);
        let mut response = response(Hooke { stiffness: 1e4, damping: Damping::NONE }, &contact);
        rolling.apply(&contact, 1e-6, &mut V::new(rolled, 0.0, 0.0), &mut response);
        assert!(
            (response.dissipated[2] + response.torque.x * spin * 1e-6).abs() < 1e-18,
            "what it takes is booked"
        );
        response.torque
    };
    for spin in [1000.0, 1e4, -1e6] {
        let couple = couple(spin, 1.0, 0.0);
        assert!((couple.x + 1e-3 * spin.signum()).abs() < 1e-15, "{}", couple.x);
        assert_eq!(couple.z, 0.0, "twisting is none of its business");
    }
    let most = 0.125 * 0.4 * 0.01 * 1e-4 / 1e-6;
    assert!((couple(1e-3, 1.0, 0.5).x + most * 1e-3).abs() < 1e-15);
    assert!((couple(1e-3, 16.0, -0.5).x + most / 16.0 * 1e-3).abs() < 1e-15);
    assert_eq!(couple(0.0, 1.0, 0.0).x, 0.0);
    // It ends within the step: the mean over it, of which this share is left.
    let left = 4e-7 * 1e-3 / 1e-6 + 0.5e-3;
    assert!((couple(1e-3, 1.0, 1.0).x + left).abs() < 1e-15, "{}", couple(1e-3, 1.0, 1.0).x);
}
