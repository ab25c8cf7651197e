//! Bonds of beams: `bond_style bpm/rotational`, a type for each set of coefficients. When they break is in [`crate::breaking`].
//!
//! ```text
//! U = ½ k_r (r − L)² + ½ k_s γ² + ½ k_b β² + ½ k_t φ²       at small angles, on both engines: γ where the halves meet, half-way between the centres
//! k_r = E A/L   k_s = 12 E I/L³   k_b = E I/L   k_t = G J/L       A = π r²   I = A r²/4   J = 2 I
//! γ_n = λ k_r   γ_s = λ k_s   γ_r = 2 λ k_b/L   γ_t = 2 λ k_t     dashpots: λ = γ over the largest frequency of the two grains alone
//! ```
//!
//! Wang (2009), Acta Geotechnica 4, doi:10.1007/s11440-008-0072-1, is what LAMMPS has. It measures bending and twist by angles, we by sines.

use crate::breaking;
use crate::error::Refusal;
use crate::error::Result;
use crate::law::Target;
use crate::places::number_of;
use dem::setup::{Bond, BondKind, BondNumbers, Setup};
use run::RunError;
use std::collections::HashMap;
use std::io::{self, Write};

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
    /// Ids of both grains, the lower first, and what joins them.
    pub made: Vec<([u32; 2], BondNumbers)>,
    /// The type of each, from 1.
    types: Vec<usize>,
    /// Coefficients of each type, in the order of LAMMPS.
    kinds: Vec<[f64; 12]>,
    /// Length of the longest [m].
    longest: f64,
    replaces_contact: bool,
    breaks: bool,
}

impl Bonds {
    /// Those that are there at the start.
    ///
    /// # Errors
    /// What the engine refuses.
    pub fn of(setup: &Setup) -> Result<Bonds> {
        let mut bonds = Bonds::default();
        if setup.bonds.is_empty() {
            return Ok(bonds);
        }
        let mut known: HashMap<[u64; 12], usize> = HashMap::new();
        for (ids, bond) in dem::bonds_at_start(setup).map_err(RunError::from)? {
            let numbers = coefficients(&bond);
            let kind = *known.entry(numbers.map(f64::to_bits)).or_insert_with(|| {
                bonds.kinds.push(numbers);
                bonds.kinds.len()
            });
            bonds.types.push(kind);
            bonds.made.push((ids, bond));
            bonds.longest = bonds.longest.max(bond.size[0]);
            bonds.breaks |= breaking::can_break(&bond.strength);
        }
        bonds.replaces_contact = setup.bonds.iter().all(|law| law.replaces_contact);
        Ok(bonds)
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        !self.made.is_empty()
    }

    /// How far LAMMPS must look for the other end of a bond [m].
    pub fn extent(&self) -> f64 {
        2.0 * self.longest
    }

    /// How many bonds and types there are, for the head of the data file.
    pub fn counts(&self) -> String {
        format!("{} bonds\n{} bond types\n", self.made.len(), self.kinds.len())
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
        let breaks = if self.breaks { "yes" } else { "no" };
        writeln!(out, "bond_style bpm/rotational {how}smooth no break {breaks}\nspecial_bonds {pairs}")?;
        writeln!(
            out,
            "# type, k_r k_s [N/m], k_t k_b [N·m], F_n F_s [N] M_t M_b [N·m] that break it, dashpots"
        )?;
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
        for ((number, kind), ([a, b], _)) in (1..).zip(&self.types).zip(&self.made) {
            writeln!(out, "{number} {kind} {} {}", number_of(*a), number_of(*b))?;
        }
        Ok(())
    }
}

/// Coefficients of a bond in the order of LAMMPS.
fn coefficients(bond: &BondNumbers) -> [f64; 12] {
    let [along, shear, bending, twist] = bond.stiffness;
    let lag = bond.lag;
    let [n, s, t, b] = breaking::limits(bond.size, bond.strength);
    let [rolling, twisting] = [2.0 * bending * lag / bond.size[0], 2.0 * twist * lag];
    [along, shear, twist, bending, n, s, t, b, along * lag, shear * lag, rolling, twisting]
}
