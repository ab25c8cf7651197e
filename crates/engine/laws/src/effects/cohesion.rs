//! Cohesion (`cohesion = "sjkr"`): a pull proportional to the area of contact, added to the force of Hooke or Hertz.
//!
//! ```text
//! F_n ← F_n − C A(δ)          C: cohesion energy density [J/m³]
//! A = π a²,  a² = (S−d)(S+d)(d²−(r_i−r_j)²) / 4d²,     d = S − δ,  S = r_i + r_j     the circle in which the spheres meet
//! E = −C V,  V = π δ² (12 R* − 4 δ + δ²/S) / (12 (1 − δ/S))                         their common volume: dV/dδ = A
//! at a flat wall 1/S = 0:  A = π δ (2r − δ),  V = π δ² (3r − δ)/3
//! ```
//!
//! "Simplified JKR" of LIGGGHTS (`cohesion sjkr`; Kloss, Goniva, Hager, Amberger & Pirker (2012), Prog. Comput. Fluid Dyn. 12,
//! doi:10.1504/PCFD.2012.047457), with the same area. To first order A = 2π R* δ: grains that bear no load rest at
//! δ = (9π²/4) (C/E*)² R* with Hertz, and with Hooke touch, as long as C < k/2πR*. Conservative: no hysteresis, no pull
//! beyond δ = 0; the restitution of the contact is that of its dashpot without cohesion. The pull does not cap
//! friction (as LIGGGHTS without `tangential_reduce`): grains rub by what presses them together.
//! Comes after the normal law, before friction.

use super::numbers::numbers;
use super::{Contact, ContactEffect, Description, Effect, Key, Model, Pair, Range, Response, Slot};
use crate::simd::Lane;
use core::f64::consts::PI;

/// C.
pub const ENERGY_DENSITY: Key = Key {
    name: "cohesion_energy_density",
    unit: "J/m³",
    range: Range::UpTo(1e15),
    required: true,
    example: "1e4",
    doc: "C: pull over the area of contact",
};

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "cohesion",
    doc: "a pull of `cohesion_energy_density` × the area of contact, added to the normal law",
    slot: Slot::Cohesion,
    model: Some(Model { key: "cohesion", value: "sjkr", default: false }),
    keys: &[ENERGY_DENSITY],
    idle: |law| law.number("cohesion_energy_density") == Some(0.0),
    ..Description::PLAIN
};

/// A pull proportional to the area of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cohesion {
    /// C [J/m³].
    pub energy_density: f64,
}

impl ContactEffect for Cohesion {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> Cohesion {
        Cohesion { energy_density: pair.number("cohesion_energy_density") }
    }
}

impl Effect for Cohesion {
    type History<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, _: R, _: &mut (), response: &mut Response<R>) {
        let number = R::splat;
        let delta = contact.overlap.max(number(0.0));
        let share = delta * contact.curvature;
        let rest = number(1.0) - share;
        let inner = delta * share;
        // a² and V, in R*, δ and δ/S alone, so that a flat wall needs no separate case.
        let square =
            delta * (number(4.0) * contact.radius - number(2.0) * delta + inner) * (number(2.0) - share)
                / (number(4.0) * rest * rest);
        response.normal = response.normal - number(self.energy_density * PI) * square * contact.share;
        let delta = contact.present.max(number(0.0));
        let share = delta * contact.curvature;
        let rest = number(1.0) - share;
        let inner = delta * share;
        let volume =
            number(PI / 12.0) * delta * delta * (number(12.0) * contact.radius - number(4.0) * delta + inner)
                / rest;
        response.elastic = response.elastic - number(self.energy_density) * volume * contact.share;
    }
}

numbers!(Cohesion { energy_density: f64 });
