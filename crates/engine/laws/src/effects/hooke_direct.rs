//! Hooke with numbers as specimens of soil and rock are calibrated with (`law = "hooke"`): a modulus instead of `stiffness`, a dashpot instead of `restitution`.
//!
//! ```text
//! contact_modulus E_c:      k = 2 E_c (r_i + r_j),              8 E_c r at a flat wall
//! effective_modulus E:      k = E π r_min² / (r_i + r_j),       E π r at a flat wall
//! normal_damping η_n:       c = η_n
//! ```
//!
//! With a modulus, a packing of grains is as stiff however large they are: its modulus is a share of E that its contacts and the tangential ratio set.
//! 2 E_c (r_i + r_j) is the scaling that specimens of soil and rock are calibrated with; in Potyondy & Cundall (2004),
//! doi:10.1016/j.ijrmms.2004.09.011, eq. (20), it is the stiffness of each of two equal particles, 4 E_c r, which give half of it in series: their E_c is twice the one here.
//! The second is a bar between the centres, as thick as the smaller grain. A flat wall is rigid: k is twice that of two grains of this radius.
//!
//! A dashpot that is given acts as it stands, whatever the masses: it is not matched to the time step, and the restitution of an impact follows from k, m* and η_n.

use super::damping::NORMAL_DAMPING;
use super::hooke::{self, STIFFNESS, TANGENTIAL_RATIO, TANGENTIAL_STIFFNESS};
use super::numbers::numbers;
use super::{
    Contact, ContactEffect, ContactLaw, Contradiction, Damping, Description, Effect, Elastic, Hooke, Key,
    NormalLaw, OverlapLimit, Pair, RESTITUTION, Range, Response,
};
use crate::simd::Lane;
use alloc::borrow::ToOwned as _;
use core::f64::consts::PI;

const CONTACT_MODULUS: Key = Key {
    name: "contact_modulus",
    unit: "Pa",
    range: Range::Positive,
    required: false,
    example: "1e8",
    doc: "E_c, instead of `stiffness`: k_n = 2 E_c (r_i + r_j), 8 E_c r at a flat wall",
};
const EFFECTIVE_MODULUS: Key = Key {
    name: "effective_modulus",
    unit: "Pa",
    range: Range::Positive,
    required: false,
    example: "1e8",
    doc: "E, instead of `stiffness`: k_n = E π r²/(r_i + r_j) with the smaller radius r, E π r at a flat wall",
};

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "hooke of a modulus or dashpot",
    doc: "linear spring and dashpot, of numbers given directly",
    keys: &[
        Key { required: false, ..STIFFNESS },
        CONTACT_MODULUS,
        EFFECTIVE_MODULUS,
        TANGENTIAL_RATIO,
        TANGENTIAL_STIFFNESS,
        Key { required: false, ..RESTITUTION },
        NORMAL_DAMPING,
    ],
    picked: |law| by_modulus(law) || law.number(NORMAL_DAMPING.name).is_some(),
    contradiction,
    every_precision: false,
    normal: Some(NormalLaw {
        stiffest,
        reach: |_, _, _| 0.0,
        nominal: |_| 1.0,
        unloaded_overlap,
        stiffens: false,
        yields: false,
    }),
    ..hooke::DESCRIPTION
};

/// Keys that give a stiffness by the size of the grains.
pub const MODULI: [&str; 2] = [CONTACT_MODULUS.name, EFFECTIVE_MODULUS.name];

/// Whether a law gives a modulus instead of a stiffness.
pub fn by_modulus(law: &ContactLaw) -> bool {
    MODULI.iter().any(|key| law.number(key).is_some())
}

/// Each of k_n, k_t and the dashpot is given once; k_t in N/m goes with a k_n in N/m.
fn contradiction(law: &ContactLaw) -> Option<Contradiction> {
    let wrong = |key, why: &str, cure| Some(Contradiction { key, why: why.to_owned(), cure });
    let given = |keys: &[&str]| keys.iter().filter(|key| law.number(key).is_some()).count();
    match given(&[RESTITUTION.name, NORMAL_DAMPING.name]) {
        0 => return wrong(RESTITUTION.name, "is missing: it makes the dashpot", "add it, or normal_damping"),
        1 => {}
        _ => {
            let why = "is given, and restitution, too: both say what the dashpot is";
            return wrong(NORMAL_DAMPING.name, why, "take one of them out");
        }
    }
    if given(&[STIFFNESS.name, MODULI[0], MODULI[1]]) > 1 {
        let why = "is one of stiffness, contact_modulus, effective_modulus, and two are given";
        return wrong(MODULI[0], why, "take the others out");
    }
    if by_modulus(law) && given(&[TANGENTIAL_STIFFNESS.name]) > 0 {
        let why = "is one number, where a modulus makes k_n a function of the radii";
        return wrong(TANGENTIAL_STIFFNESS.name, why, "give tangential_ratio");
    }
    hooke::contradiction(law)
}

/// The share of an overlap at which a wall counts as flat [–]: R* is the radius itself.
const FLAT: f64 = 1e-12;

/// S = k of the two radii, which R* and the smaller one tell.
fn stiffest(law: &ContactLaw, _: Elastic, at: OverlapLimit) -> f64 {
    let rest = 1.0 - at.radius / at.smaller;
    let length = if rest > FLAT { at.smaller / rest } else { f64::INFINITY };
    let Spring { constant, contact, effective } = Spring::of(law);
    if length.is_infinite() {
        return constant + (8.0 * contact + PI * effective) * at.smaller;
    }
    constant + 2.0 * contact * length + PI * effective * at.smaller * at.smaller / length
}

/// 0 as long as C < k/2πR* for every pair of radii: k/R* is 8 E_c at least, or π E times the ratio of the radii.
fn unloaded_overlap(law: &ContactLaw, _: Elastic, density: f64, [smallest, largest]: [f64; 2]) -> f64 {
    let Spring { constant, contact, effective } = Spring::of(law);
    let least = constant / largest + 8.0 * contact + PI * effective * smallest / largest;
    if density < least / (2.0 * PI) || density == 0.0 { 0.0 } else { f64::INFINITY }
}

/// What makes k: one of the three, the others are 0.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spring {
    /// k [N/m].
    constant: f64,
    /// E_c [Pa].
    contact: f64,
    /// E [Pa].
    effective: f64,
}

impl Spring {
    fn of(law: &ContactLaw) -> Spring {
        let [contact, effective] = MODULI.map(|key| law.number(key).unwrap_or(0.0));
        let constant = if by_modulus(law) { 0.0 } else { law.number(STIFFNESS.name).unwrap_or(f64::NAN) };
        Spring { constant, contact, effective }
    }
}

/// Linear spring of a modulus or stiffness, with a dashpot of a restitution or of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HookeDirect {
    spring: Spring,
    /// γ, where it is not η_n that is given.
    damping: Damping,
    /// η_n, or 0 [N s/m].
    dashpot: f64,
}

impl Effect for HookeDirect {
    type History<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, _: &mut (), response: &mut Response<R>) {
        let Spring { constant, contact: by_length, effective } = self.spring;
        let (smaller, round) = (contact.smaller, contact.curvature.gt(R::splat(0.0)));
        let length = R::splat(1.0) / contact.curvature.max(R::splat(R::TINY));
        let length = R::select(round, length, R::splat(4.0) * smaller);
        let thick = smaller * R::select(round, smaller * contact.curvature, R::splat(1.0));
        let k = R::splat(constant) + R::splat(2.0 * by_length) * length + R::splat(PI * effective) * thick;
        let k = k * contact.share;
        response.impedance = (k * contact.mass).sqrt();
        let pace = k * contact.inverse_mass;
        let of_ratio = self.damping.of(pace, contact.partial) * response.impedance;
        let c = of_ratio + R::splat(self.dashpot);
        hooke::spring_and_dashpot([k, c], self.damping.dissipates(pace), contact, dt, response);
    }
}

/// Either kind of linear spring; which, is a branch for each group of contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Linear {
    /// Of a stiffness and a restitution.
    Plain(Hooke),
    /// Of a modulus, or of a dashpot.
    Direct(HookeDirect),
}

impl ContactEffect for Linear {
    const DESCRIPTIONS: &'static [&'static Description] = &[&hooke::DESCRIPTION, &DESCRIPTION];

    fn new(pair: &Pair) -> Linear {
        if !(DESCRIPTION.picked)(pair.law) {
            return Linear::Plain(Hooke::new(pair));
        }
        let dashpot = pair.law.number(NORMAL_DAMPING.name);
        Linear::Direct(HookeDirect {
            spring: Spring::of(pair.law),
            damping: if dashpot.is_some() {
                Damping { dissipates: 1.0, ..Damping::NONE }
            } else {
                pair.damping
            },
            dashpot: dashpot.unwrap_or(0.0),
        })
    }
}

impl Effect for Linear {
    type History<R: Lane> = ();

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, history: &mut (), response: &mut Response<R>) {
        match self {
            Linear::Plain(hooke) => hooke.apply(contact, dt, history, response),
            Linear::Direct(hooke) => hooke.apply(contact, dt, history, response),
        }
    }
}

numbers!(Spring { constant: f64, contact: f64, effective: f64 });
numbers!(HookeDirect { spring: Spring, damping: Damping, dashpot: f64 });
numbers!(Linear: Plain(Hooke) or Direct(HookeDirect));
