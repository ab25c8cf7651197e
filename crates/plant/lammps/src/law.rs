//! A contact law as coefficients of `pair_style granular` and of `fix wall/gran granular`, which are written alike.
//!
//! ```text
//! hooke    F = k δ                 c = γ √(k m*)            hooke k x damping tsuji, P(x) = γ
//! hertz    F = 4/3 E* a δ          c = γ √(5/6) √(S m*)     hertz 4/3 E* x damping tsuji, P(x) = γ √(5/4)       S = 2 E* a
//! jkr      E = 2 E*, ν = 0 give 4/3 E*; energy w/2          the same damping
//! sliding  k_t = q k, or q S       c_t = γ √(k_t m*)        linear_history or mindlin_rescale/force with k_t or 2 q E* (per a) and c_t/c
//! rolling  k = 2.25 k_n μ_r²  (per R*²)                     sds; Hooke alone: its spring does not stiffen with δ
//! twisting k = k_t R*²                                      sds; Hooke alone
//! ```
//!
//! `mindlin_rescale/force` keeps the force of a spring that stiffens and the length of one that softens, as
//! [`dem::effects`] do. Rolling, twisting and moduli per length depend on sizes, for which LAMMPS has one number per pair of types: [`depends_on_size`].

use crate::damping::tsuji;
use crate::error::Refusal;
use crate::grain::Meeting;
use crate::version::Version;
use dem::effects::{Elastic, MODULI, damping_ratio, tangential_ratio};
use dem::setup::ContactLaw;

/// Whether coefficients of a law differ with the sizes of the two grains.
pub fn depends_on_size(law: &ContactLaw) -> bool {
    let given = |key: &str| law.number(key).is_some_and(|value| value > 0.0);
    let own_tangential = given("tangential_damping") && !given("normal_damping");
    MODULI.iter().any(|key| given(key))
        || given("rolling_resistance")
        || given("twisting_resistance")
        || own_tangential
}

/// The normal spring, and its dashpot.
struct Normal {
    words: String,
    /// S at δ, or its factor of a [N/m].
    stiffness: f64,
    /// Normal dashpot over √(S m*), or its value [–].
    dashpot: f64,
    linear: bool,
}

/// What coefficients are written for.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Version of LAMMPS.
    pub version: Version,
    /// Whether the nearest is taken where LAMMPS lacks something.
    pub nearest: bool,
}

/// Coefficients of a law; `meeting` is known where the two types have one size each. What the nearest stands for goes to `bent`.
///
/// # Errors
/// What LAMMPS cannot do.
pub fn coefficients(
    law: &ContactLaw,
    elastic: Elastic,
    meeting: Option<Meeting>,
    target: Target,
    bent: &mut Vec<Refusal>,
) -> Result<String, Refusal> {
    unknown(law)?;
    let mut normal = normal(law, elastic, meeting, target.version)?;
    let mut words = normal.words.clone();
    words += &sliding(law, elastic, meeting, &normal)?;
    let turns = ["rolling_resistance", "twisting_resistance"];
    for key in turns.into_iter().filter(|key| !normal.linear && law.number(key).is_some_and(|mu| mu > 0.0)) {
        let refusal = Refusal::new(
            key,
            "this spring of LAMMPS does not stiffen with the overlap",
            "use law = \"hooke\", or leave it out; --nearest makes it as stiff as at the overlap of an impact at 1 m/s",
        );
        if !target.nearest {
            return Err(refusal);
        }
        bent.push(refusal);
    }
    if !normal.linear {
        normal.stiffness = at_impact(elastic, meeting.unwrap_or(Meeting::UNKNOWN));
    }
    words += &rolling(law, meeting, &normal);
    words += &twisting(law, elastic, meeting, &normal);
    Ok(words)
}

/// S = 2 E* √(R* δ) [N/m] at the largest overlap of an elastic impact at 1 m/s, δ = (15 m* v²/(16 √R* E*))^(2/5).
fn at_impact(elastic: Elastic, meeting: Meeting) -> f64 {
    let Meeting { radius, mass, .. } = meeting;
    let overlap = (15.0 * mass / (16.0 * radius.sqrt() * elastic.modulus)).powf(0.4);
    2.0 * elastic.modulus * (radius * overlap).sqrt()
}

/// Refuses what has no counterpart.
fn unknown(law: &ContactLaw) -> Result<(), Refusal> {
    let refuse = |what: &str, why: &str, nearest: &str| Err(Refusal::new(what, why, nearest));
    match law.model("law") {
        Some("walton_braun") => {
            return refuse(
                "law = \"walton_braun\"",
                "LAMMPS has no spring that yields",
                "use law = \"hooke\"",
            );
        }
        Some("hooke" | "hertz" | "jkr") | None => {}
        Some(other) => {
            return refuse(&format!("law = \"{other}\""), "LAMMPS has no such law", "use law = \"hertz\"");
        }
    }
    if law.model("cohesion").is_some() && law.number("cohesion_energy_density") != Some(0.0) {
        return refuse(
            "cohesion = \"sjkr\"",
            "LAMMPS has no pull in proportion to the area",
            "use law = \"jkr\"",
        );
    }
    if law.model("rolling_model") == Some("constant")
        && law.number("rolling_resistance").is_some_and(|mu| mu > 0.0)
    {
        return refuse(
            "rolling_model = \"constant\"",
            "LAMMPS has no torque of one size",
            "use rolling_model = \"spring\" with law = \"hooke\"",
        );
    }
    if law.number("sliding_friction.static").is_some() {
        return refuse(
            "sliding_friction.static",
            "friction of LAMMPS does not weaken with speed",
            "give one sliding_friction",
        );
    }
    Ok(())
}

/// A linear law's k [N/m].
fn stiffness(law: &ContactLaw, meeting: Option<Meeting>) -> f64 {
    let number = |key: &str| law.number(key);
    let sizes = meeting.unwrap_or(Meeting::UNKNOWN);
    let by_length = number("contact_modulus").map(|e| 2.0 * e * sizes.length());
    let by_thickness = number("effective_modulus").map(|e| std::f64::consts::PI * e * sizes.thickness());
    by_length.or(by_thickness).or(number("stiffness")).unwrap_or(f64::NAN)
}

fn normal(
    law: &ContactLaw,
    elastic: Elastic,
    meeting: Option<Meeting>,
    version: Version,
) -> Result<Normal, Refusal> {
    let ratio = damping_ratio(law.number("restitution").unwrap_or(1.0));
    let dashpot = |ratio: f64| match ratio > 0.0 {
        true => (format!("{:?}", tsuji(ratio)), "tsuji"),
        false => ("0".to_owned(), "velocity"),
    };
    let modulus = elastic.modulus;
    if law.model("law") == Some("hooke") {
        let k = stiffness(law, meeting);
        let given = law.number("normal_damping");
        let (x, how) = given.map_or_else(|| dashpot(ratio), |eta| (format!("{eta:?}"), "velocity"));
        let words = format!("hooke {k:?} {x} damping {how}");
        return Ok(Normal { words, stiffness: k, dashpot: given.unwrap_or(ratio), linear: true });
    }
    let (x, how) = dashpot(ratio * 1.25f64.sqrt());
    let words = match law.model("law") {
        Some("jkr") => {
            if ratio > 0.0 && version.refuses_damped_jkr() {
                return Err(Refusal::new(
                    "restitution with law = \"jkr\"",
                    format!("LAMMPS of {version} has no such dashpot for cohesive laws"),
                    "use restitution = 1, or a LAMMPS of 2021 (Debian's)",
                ));
            }
            let w = law.number("work_of_adhesion").unwrap_or(0.0);
            format!("jkr {:?} {x} 0 {:?} damping {how}", 2.0 * modulus, 0.5 * w)
        }
        _ => format!("hertz {:?} {x} damping {how}", 4.0 / 3.0 * modulus),
    };
    let of_hertz = (5.0f64 / 6.0).sqrt();
    Ok(Normal { words, stiffness: 2.0 * modulus, dashpot: ratio * of_hertz, linear: false })
}

fn sliding(
    law: &ContactLaw,
    elastic: Elastic,
    meeting: Option<Meeting>,
    normal: &Normal,
) -> Result<String, Refusal> {
    let Some(mu) = law.number("sliding_friction").filter(|mu| *mu > 0.0) else {
        return Ok(" tangential linear_nohistory 0 0".to_owned());
    };
    let q = tangential_ratio(law, elastic);
    let alike = q.sqrt() * if normal.linear { 1.0 } else { (6.0f64 / 5.0).sqrt() };
    let eta_n = law.number("normal_damping");
    let share = match (law.number("tangential_damping"), eta_n) {
        (None, _) => alike,
        (Some(eta_t), Some(eta_n)) => eta_t / eta_n,
        (Some(0.0), None) => 0.0,
        (Some(_), None) if normal.dashpot == 0.0 => {
            return Err(Refusal::new(
                "tangential_damping",
                "the tangential dashpot of LAMMPS is a share of the normal one, and with restitution = 1 there is none",
                "leave it out, or give normal_damping",
            ));
        }
        (Some(_), None) if !normal.linear => {
            return Err(Refusal::new(
                "tangential_damping",
                "the tangential dashpot of LAMMPS is a share of the normal one, which changes with the overlap",
                "leave it out, or use law = \"hooke\"",
            ));
        }
        (Some(eta_t), None) => {
            let mass = meeting.unwrap_or(Meeting::UNKNOWN).mass;
            eta_t / (normal.dashpot * (normal.stiffness * mass).sqrt())
        }
    };
    let model = if normal.linear { "linear_history" } else { "mindlin_rescale/force" };
    Ok(format!(" tangential {model} {:?} {share:?} {mu:?}", q * normal.stiffness))
}

/// Share of critical damping of the springs of rotation [–].
const ETA: f64 = 0.3;

fn rolling(law: &ContactLaw, meeting: Option<Meeting>, normal: &Normal) -> String {
    let Some(mu) = law.number("rolling_resistance").filter(|mu| *mu > 0.0) else { return String::new() };
    let mass = meeting.unwrap_or(Meeting::UNKNOWN).mass;
    let damping = 2.0 * ETA * (2.25f64 * 1.4).sqrt() * mu * (normal.stiffness * mass).sqrt();
    format!(" rolling sds {:?} {damping:?} {mu:?}", 2.25 * normal.stiffness * mu * mu)
}

fn twisting(law: &ContactLaw, elastic: Elastic, meeting: Option<Meeting>, normal: &Normal) -> String {
    let Some(mu) = law.number("twisting_resistance").filter(|mu| *mu > 0.0) else { return String::new() };
    let Meeting { radius, mass, .. } = meeting.unwrap_or(Meeting::UNKNOWN);
    let stiffness = tangential_ratio(law, elastic) * normal.stiffness * radius * radius;
    let damping = 2.0 * ETA * (stiffness * 0.4 * mass * radius * radius).sqrt();
    format!(" twisting sds {stiffness:?} {damping:?} {:?}", mu * radius)
}
