//! Bonds of beams that do not break: `bond_style bpm/rotational`, a type for each set of coefficients.
//!
//! ```text
//! U = ½ k_r (r − L)² + ½ k_s γ² + ½ k_b β² + ½ k_t φ²       at small angles, on both engines: γ where the halves meet, half-way between the centres
//! k_r = E A/L   k_s = 12 E I/L³   k_b = E I/L   k_t = G J/L       A = π r²   I = A r²/4   J = 2 I
//! γ_n = λ k_r   γ_s = λ k_s   γ_r = 2 λ k_b/L   γ_t = 2 λ k_t     dashpots: λ = γ over the largest frequency of the two grains alone
//! ```
//!
//! Wang (2009), Acta Geotechnica 4, doi:10.1007/s11440-008-0072-1, is what LAMMPS has. It measures bending and twist by angles, we by sines.

use crate::data::number_of;
use crate::error::{LammpsError, Result};
use crate::law::Target;
use crate::refusal::Refusal;
use dem::setup::bond::cluster_of;
use dem::setup::{Bond, BondKind, Particle, Setup};
use dem::{BondState, Simulation};
use run::RunError;
use scene::SceneError;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::io::{self, Write};

/// Force [N] and moment [N·m] that no bond reaches.
const NEVER: f64 = 1e100;

/// What LAMMPS cannot do with bonds.
pub fn refused(setup: &Setup, target: Target) -> Vec<Refusal> {
    let mut all = Vec::new();
    if setup.bonds.is_empty() {
        return all;
    }
    let mut refuse = |what: &str, why: String, nearest: &str| all.push(Refusal::new(what, why, nearest));
    if !target.version.has_bonds() {
        let why = format!("LAMMPS of {} has no bonds that keep their shape", target.version);
        refuse("bond", why, "use a LAMMPS of 2025 with the package BPM, such as PyPI's (--lmp), or dem-run");
    }
    for (k, law) in setup.bonds.iter().enumerate() {
        if !matches!(law.kind, BondKind::Beam { .. }) {
            let why = "bonds of LAMMPS have their section half-way between the centres".to_owned();
            refuse(&format!("bond.{k}.kind"), why, "use kind = \"beam\", or dem-run");
        }
        if law.strength.tension.is_finite() || law.strength.shear.is_finite() {
            let why =
                "LAMMPS breaks a bond by the sum of its four loads, not by tension or by shear".to_owned();
            refuse(&format!("strength of bond.{k}"), why, "leave strengths out, or use dem-run");
        }
        if law.at > 0.0 {
            let why = "bonds of LAMMPS are there from the start".to_owned();
            refuse(&format!("bond.{k}.at"), why, "leave it out, or use dem-run");
        }
    }
    let replaces = |law: &Bond| law.replaces_contact;
    if setup.bonds.iter().any(replaces) && !setup.bonds.iter().all(replaces) {
        let why = "LAMMPS has one answer for all bonds".to_owned();
        refuse("bond.replaces_contact", why, "give all bonds the same");
    }
    let whole = "crossings of LAMMPS have no bonds".to_owned();
    if setup.entry_bonds.is_some() || !setup.outlets.is_empty() {
        refuse("bonds through a cut", whole, "use dem-run for this stage");
    }
    if crate::clumps::any(setup) {
        let why = "spheres that turn by themselves and rigid bodies are not written together".to_owned();
        refuse("bonds with clumps", why, "use one of them, or dem-run");
    }
    all
}

/// The bonds of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bonds {
    /// Type, from 1, and the ids of both grains.
    pairs: Vec<(usize, [u32; 2])>,
    /// Coefficients of each type, in the order of LAMMPS.
    kinds: Vec<[f64; 12]>,
    /// Length of the longest [m].
    longest: f64,
    replaces_contact: bool,
}

impl Bonds {
    /// Those that the engine makes at the start.
    ///
    /// # Errors
    /// What the engine refuses.
    pub fn of(setup: &Setup, name: &str) -> Result<Bonds> {
        let mut bonds = Bonds::default();
        if setup.bonds.is_empty() {
            return Ok(bonds);
        }
        let mut engine = Simulation::new(setup.clone()).map_err(RunError::from)?;
        let made = engine.bonds().map_err(|halt| {
            let why = scene::advice::explain_halt(&halt);
            LammpsError::Scene(SceneError::file(name, why, "place grains so that they overlap less"))
        })?;
        let mut sorted: Vec<&Particle> = setup.particles.iter().collect();
        sorted.sort_unstable_by_key(|p| p.id);
        let mut known: HashMap<[u64; 12], usize> = HashMap::new();
        for bond in made {
            let ends = bond.ids.map(|id| found(&sorted, id));
            let numbers = match ends {
                [Some(a), Some(b)] => {
                    law(setup, &bond, [a, b]).and_then(|law| coefficients(setup, law, &bond, [a, b]))
                }
                _ => None,
            };
            let numbers = numbers.ok_or_else(|| {
                let why =
                    format!("grains {} and {}: no [[bond]] has made their bond", bond.ids[0], bond.ids[1]);
                LammpsError::Scene(SceneError::file(name, &why, "use dem-run"))
            })?;
            let kind = *known.entry(numbers.map(f64::to_bits)).or_insert_with(|| {
                bonds.kinds.push(numbers);
                bonds.kinds.len()
            });
            bonds.pairs.push((kind, bond.ids));
            bonds.longest = bonds.longest.max(bond.size[0]);
        }
        bonds.replaces_contact = setup.bonds.iter().all(|law| law.replaces_contact);
        Ok(bonds)
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        !self.pairs.is_empty()
    }

    /// How far LAMMPS must look for the other end of a bond [m].
    pub fn extent(&self) -> f64 {
        2.0 * self.longest
    }

    /// How many bonds and types there are, for the head of the data file.
    pub fn counts(&self) -> String {
        format!("{} bonds\n{} bond types\n", self.pairs.len(), self.kinds.len())
    }

    /// Writes style and coefficients, as commands after the data are read.
    ///
    /// # Errors
    /// A write that fails.
    pub fn commands(&self, out: &mut impl Write) -> io::Result<()> {
        let (how, pairs) = match self.replaces_contact {
            true => ("", "lj 0 1 1 coul 1 1 1"),
            false => ("overlay/pair yes ", "lj/coul 1 1 1"),
        };
        writeln!(out, "bond_style bpm/rotational {how}smooth no break no\nspecial_bonds {pairs}")?;
        writeln!(out, "# type, k_r k_s [N/m], k_t k_b [N·m], limits that are not reached, dashpots")?;
        for (kind, numbers) in (1..).zip(&self.kinds) {
            write!(out, "bond_coeff {kind}")?;
            numbers.iter().try_for_each(|value| write!(out, " {value:?}"))?;
            writeln!(out)?;
        }
        Ok(())
    }

    /// Writes their section of the data file.
    ///
    /// # Errors
    /// A write that fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "\nBonds # number, type, both atoms\n")?;
        for (number, (kind, [a, b])) in (1..).zip(&self.pairs) {
            writeln!(out, "{number} {kind} {} {}", number_of(*a), number_of(*b))?;
        }
        Ok(())
    }
}

fn found<'a>(sorted: &[&'a Particle], id: u32) -> Option<&'a Particle> {
    sorted.binary_search_by_key(&id, |p| p.id).ok().map(|at| sorted[at])
}

/// The law that has made a bond: the first that fits, as in the engine.
fn law<'a>(setup: &'a Setup, bond: &BondState, [a, b]: [&Particle; 2]) -> Option<&'a Bond> {
    let clusters = [a, b].map(|p| cluster_of(&setup.clusters, p.id));
    // The length has fewer digits than the positions.
    let open = bond.size[0] * (1.0 - 1e-12) - a.radius - b.radius;
    setup.bonds.iter().find(|law| law.joins([a.material, b.material], clusters, open))
}

/// Coefficients of a bond in the order of LAMMPS; `None` unless it is a beam.
fn coefficients(setup: &Setup, law: &Bond, bond: &BondState, ends: [&Particle; 2]) -> Option<[f64; 12]> {
    let BondKind::Beam { young, shear_modulus } = law.kind else { return None };
    let [length, radius] = bond.size;
    let area = PI * radius * radius;
    let inertia = 0.25 * area * radius * radius;
    let bending = young * inertia / length;
    let shear = 12.0 * bending / (length * length);
    let [along, twist] = [young * area / length, shear_modulus * 2.0 * inertia / length];
    let mass = |p: &Particle| dem::mass(p.radius, setup.materials[p.material as usize].density);
    let per_mass: f64 = ends.iter().map(|p| 1.0 / mass(p)).sum();
    let per_inertia: f64 = ends.iter().map(|p| 2.5 / (mass(p) * p.radius * p.radius)).sum();
    let arm = 0.5 * length;
    let motions = [
        along * per_mass,
        shear * (per_mass + arm * arm * per_inertia),
        bending * per_inertia,
        twist * per_inertia,
    ];
    let lag = law.damping / motions.into_iter().fold(0.0, f64::max).sqrt();
    let dashpots = [along * lag, shear * lag, 2.0 * bending * lag / length, 2.0 * twist * lag];
    let [n, s, r, t] = dashpots;
    Some([along, shear, twist, bending, NEVER, NEVER, NEVER, NEVER, n, s, r, t])
}
