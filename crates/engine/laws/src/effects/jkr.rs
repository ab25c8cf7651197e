//! JKR (`law = "jkr"`): elastic spheres that adhere, with a dashpot.
//!
//! ```text
//! δ = a²/R* − √(2π w a/E*),   F = 4 E* a³/3R* − √(8π w E* a³)          w: work of adhesion [J/m²], a: radius of contact
//! made at δ = 0, where F jumps to −4/3 π w R*; broken at δ = −δ_c, where F = −5/6 π w R*
//! strongest pull F_po = 3/2 π w R*
//!
//! a = a_c y²,  a_c³ = π w R*²/8E*,  δ_c = 3 a_c²/R*:
//! δ R*/a_c² = y⁴ − 4y,   F = π w R* (y⁶/6 − y³),   E = 4π w a_c² (y¹⁰/60 − y⁷/6 + y⁴/4 − 1/10)
//! y = 1 + u:  u² (u² + 4u + 6) = δ R*/a_c² + 3         u = 0 at the break; four steps of Newton from within 7 %
//! Fₙ = F + c δ̇,   c = γ √(5/6) √(S m*),  S = 2 E* a      S is also what friction takes its stiffness from: k_t = 8 G* a
//! ```
//!
//! Johnson, Kendall & Roberts (1971), Proc. R. Soc. A 324, doi:10.1098/rspa.1971.0141; the quartic for a: Parteli et al.
//! (2014), Sci. Rep. 4, doi:10.1038/srep06227. Deviation: solved in u, where the root stays simple up to the break, by Newton
//! and without cube roots. w is the energy it takes to part a square metre: γ_i + γ_j − γ_ij, twice the surface energy where
//! both are alike. Friction is capped by F_n + 2 F_po: Thornton (1991), J. Phys. D 24, doi:10.1088/0022-3727/24/11/007.
//!
//! A cycle of making and breaking takes W = 4π w a_c² (0.1 + 0.15 · 4^(4/3)) = 7.09 (w⁵ R*⁴/E*²)^(1/3) (Thornton & Ning (1998),
//! Powder Technology 99, doi:10.1016/S0032-5910(98)00099-0), besides the dashpot: with e = 1 a grain rebounds at √(v² − 2W/m*), and
//! sticks below √(2W/m*). e is the restitution of the same contact without adhesion. E is counted from the break, and the ledger
//! books all of W when contact is made. On a triangle mesh each triangle is a contact of its own: a grain that rolls over a seam
//! while it is pulled comes free there, and the ledger books W again.

use super::numbers::numbers;
use super::{
    Contact, ContactEffect, ContactLaw, Damping, Description, Effect, Elastic, Field, Key, Kind, Model,
    NormalLaw, OverlapLimit, Pair, RESTITUTION, Range, Response, Slot,
};
use crate::simd::{Lane, cube_root};
use core::f64::consts::PI;

const WORK_OF_ADHESION: Key = Key {
    name: "work_of_adhesion",
    unit: "J/m²",
    range: Range::UpTo(1e9),
    required: true,
    example: "0.1",
    doc: "w: energy that parts a square metre of contact, twice the surface energy where both are of one material",
};

/// What the program knows of it.
pub const DESCRIPTION: Description = Description {
    name: "jkr",
    doc: "elastic spheres that adhere (Johnson, Kendall, Roberts): contact is made at touch and breaks at a gap; strongest pull 3/2 π w R*",
    slot: Slot::Normal,
    model: Some(Model { key: "law", value: "jkr", default: false }),
    keys: &[WORK_OF_ADHESION, RESTITUTION],
    history: &[Field {
        name: "held",
        kind: Kind::Scalar,
        unit: "m",
        doc: "a_c, the radius of contact at the break, once contact is made",
    }],
    excludes: Some((Slot::Cohesion, "law = \"jkr\" adheres by itself")),
    idle: |law| law.number("work_of_adhesion") == Some(0.0),
    instead: Some("hertz"),
    normal: Some(NormalLaw {
        stiffest,
        reach,
        nominal: |_| 1.0,
        unloaded_overlap,
        stiffens: true,
        yields: false,
    }),
    ..Description::PLAIN
};

fn undamped(law: &ContactLaw, elastic: Elastic) -> Jkr {
    let work_of_adhesion = law.number("work_of_adhesion").unwrap_or(f64::NAN);
    Jkr::with_modulus(elastic.modulus, work_of_adhesion, Damping::NONE)
}

/// 2 E* a.
fn stiffest(law: &ContactLaw, elastic: Elastic, at: OverlapLimit) -> f64 {
    let last = undamped(law, elastic).last_radius(at.radius);
    let spread = Jkr::spread(at.overlap(), at.radius, last);
    2.0 * elastic.modulus * last * (spread * spread)
}

/// δ_c.
fn reach(law: &ContactLaw, elastic: Elastic, radius: f64) -> f64 {
    Jkr::last_gap(radius, undamped(law, elastic).last_radius(radius))
}

/// 2·6^(1/3) (π w/8E* r)^(2/3).
fn unloaded_overlap(law: &ContactLaw, elastic: Elastic, _: f64, [smallest, _]: [f64; 2]) -> f64 {
    let work_of_adhesion = law.number("work_of_adhesion").unwrap_or(f64::NAN);
    let root = libm::cbrt(PI * work_of_adhesion / (8.0 * elastic.modulus * smallest));
    2.0 * libm::cbrt(6.0) * root * root
}

/// Steps of Newton: 7 % → 0.7 % → 5e-5 → 4e-9 → rounding.
const NEWTON: usize = 4;
/// W over 4π w a_c² [–].
const CYCLE: f64 = 0.1 + 0.15 * 6.349_604_207_872_798;

/// Johnson, Kendall and Roberts' law with a dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jkr {
    /// E* [Pa].
    pub modulus: f64,
    /// w [J/m²].
    pub work_of_adhesion: f64,
    /// a_c for R* = 1 m, (πw/8E*)^(1/3) [m^(1/3)].
    scale: f64,
    /// γ √(5/6), γ as for [`super::Hooke`].
    pub damping: Damping,
}

impl Jkr {
    /// Of E* [Pa], w [J/m²] and γ √(5/6).
    pub fn with_modulus(modulus: f64, work_of_adhesion: f64, damping: Damping) -> Jkr {
        let scale = libm::cbrt(PI * work_of_adhesion / (8.0 * modulus));
        Jkr { modulus, work_of_adhesion, scale, damping }
    }

    /// a_c [m], the radius of contact at the break.
    #[inline(always)]
    pub fn last_radius<R: Lane>(&self, radius: R) -> R {
        R::splat(self.scale) * cube_root(radius * radius)
    }

    /// δ_c [m], the gap at which contact breaks.
    #[inline(always)]
    pub fn last_gap<R: Lane>(radius: R, last_radius: R) -> R {
        R::splat(3.0) * last_radius * last_radius / radius
    }

    /// √(a/a_c) [–] at an overlap [m].
    #[inline(always)]
    pub fn spread<R: Lane>(overlap: R, radius: R, last_radius: R) -> R {
        let number = R::splat;
        let tiny = number(1e-300);
        let beyond = overlap * radius / (last_radius * last_radius).max(tiny) + number(3.0);
        let square = beyond.max(number(0.0));
        let root = square.sqrt();
        let far = root / (number(6.0) + root).sqrt();
        let mut u = root / (number(6.0) + far * (number(4.0) + far)).sqrt();
        for _ in 0..NEWTON {
            let miss = u * u * (u * (u + number(4.0)) + number(6.0)) - square;
            let slope = number(4.0) * u * (u * (u + number(3.0)) + number(3.0));
            u = u - miss / slope.max(tiny);
        }
        number(1.0) + u
    }
}

impl ContactEffect for Jkr {
    const DESCRIPTIONS: &'static [&'static Description] = &[&DESCRIPTION];

    fn new(pair: &Pair) -> Jkr {
        Jkr { damping: pair.damping.scaled((5.0f64 / 6.0).sqrt()), ..undamped(pair.law, pair.elastic) }
    }
}

impl Effect for Jkr {
    /// a_c [m]; 0 where no contact is made.
    type History<R: Lane> = R;
    const REACHES: bool = true;

    #[inline(always)]
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, made: &mut R, response: &mut Response<R>) {
        let (number, r) = (R::splat, contact.radius);
        let new = R::select(made.gt(number(0.0)), number(0.0), number(1.0));
        if R::any(R::both(contact.touching, new.gt(number(0.0)))) {
            *made = R::select(new.gt(number(0.0)), self.last_radius(r), *made);
        }
        let last = *made;
        let y = Self::spread(contact.overlap, r, last);
        let cube = y * y * y;
        let pull = number(PI * self.work_of_adhesion) * r * contact.share;
        let elastic = pull * cube * (cube / number(6.0) - number(1.0));
        let s = number(2.0 * self.modulus) * last * y * y * contact.share;
        response.impedance = (s * contact.mass).sqrt();
        let pace = s * contact.inverse_mass;
        let c = self.damping.of(pace, contact.partial) * response.impedance;
        let damping = c * contact.approach;
        response.normal = response.normal + (elastic + damping);
        response.pressing = response.normal + number(3.0) * pull;
        response.stiffness = s;
        let before = Self::spread(contact.before, r, last);
        response.stiffness_before = contact.share_before * before * before / (y * y);
        let unit = number(4.0 * PI * self.work_of_adhesion) * last * last * contact.share;
        let held = Self::spread(contact.present, r, last);
        let cube = held * held * held;
        let stored =
            cube * held * (cube * (cube / number(60.0) - number(1.0 / 6.0)) + number(0.25)) - number(0.1);
        response.elastic = response.elastic + unit * stored;
        let dissipated = damping * contact.approach * dt * self.damping.dissipates(pace);
        response.dissipate(DESCRIPTION.slot, dissipated);
        response.lost = response.lost + number(CYCLE) * new * unit;
    }

    #[inline(always)]
    fn reach<R: Lane>(&self, radius: R, made: &R) -> R {
        Self::last_gap(radius, *made)
    }
}

numbers!(Jkr { modulus: f64, work_of_adhesion: f64, scale: f64, damping: Damping });
