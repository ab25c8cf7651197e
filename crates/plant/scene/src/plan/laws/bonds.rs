//! What a `[[bond]]` asks of the engine.

use crate::check::Check;
use crate::error::Result;
use crate::keys::{self, Bond};
use dem::setup::{self, BondKind, BondSprings, BondStrength, Clusters, Material, Spread};

/// Bonds of a scene, whose materials are known by name.
///
/// # Errors
/// An unknown material, "*", or two entries for the same particles.
pub(in crate::plan) fn resolve(
    check: &Check,
    entries: &[Bond],
    materials: &[Material],
) -> Result<Vec<setup::Bond>> {
    let mut found: Vec<setup::Bond> = Vec::new();
    for (i, b) in entries.iter().enumerate() {
        let mut between = [0; 2];
        for (k, name) in b.between.iter().enumerate() {
            let key = format!("bond.{i}.between.{k}");
            if name == "*" {
                let why = "bonds are made between named materials";
                return Err(check.wrong(&key, "\"*\"", why, "name one"));
            }
            between[k] = check.material(&key, name, materials)?;
        }
        let bond = b.bond((between[0].min(between[1]), between[0].max(between[1])));
        let same =
            |f: &setup::Bond| f.between == bond.between && f.at == bond.at && meet(f.clusters, bond.clusters);
        if let Some(first) = found.iter().position(same) {
            let why = format!("bond.{first} is between these two materials already");
            let cure = "take one of them out, or give them other 'clusters' or another 'at'";
            return Err(check.wrong(&format!("bond.{i}.between"), format!("{:?}", b.between), &why, cure));
        }
        found.push(bond);
    }
    Ok(found)
}

/// Whether two entries may be of one pair.
fn meet(a: Clusters, b: Clusters) -> bool {
    a == b || a == Clusters::Any || b == Clusters::Any
}

impl Bond {
    fn bond(&self, between: (u16, u16)) -> setup::Bond {
        let made = setup::Bond::new(between, self.gap, self.kind());
        setup::Bond {
            clusters: match self.clusters {
                keys::Clusters::Same => Clusters::Same,
                keys::Clusters::Different => Clusters::Different,
                keys::Clusters::Any => Clusters::Any,
            },
            at: self.at,
            radius_ratio: self.radius_ratio.unwrap_or(1.0),
            strength: self.strength(),
            damping: self.damping.unwrap_or(0.0),
            replaces_contact: self.replaces_contact.unwrap_or(made.replaces_contact),
            ..made
        }
    }

    /// Checks have seen that the numbers are there.
    fn kind(&self) -> BondKind {
        let of = |number: Option<f64>| number.unwrap_or(f64::NAN);
        let springs = |given: [Option<f64>; 2]| match self.modulus {
            Some(modulus) => BondSprings::Modulus { modulus, ratio: of(self.stiffness_ratio) },
            None => BondSprings::Given(given.map(of)),
        };
        match self.kind {
            keys::BondKind::Beam => {
                let young = of(self.young);
                BondKind::Beam { young, shear_modulus: 0.5 * young / (1.0 + of(self.poisson)) }
            }
            keys::BondKind::Parallel => BondKind::Parallel {
                springs: springs([self.normal_stiffness_per_area, self.shear_stiffness_per_area]),
                moments: self.moments.unwrap_or(1.0),
            },
            keys::BondKind::Contact => {
                BondKind::Contact(springs([self.normal_stiffness, self.shear_stiffness]))
            }
        }
    }

    fn strength(&self) -> BondStrength {
        let forces = self.tensile_force.is_some() || self.shear_force.is_some();
        let (tension, shear) =
            (self.tensile_strength.or(self.tensile_force), self.shear_strength.or(self.shear_force));
        let ratio = self.strength_ratio;
        let other = |own: Option<f64>, from: Option<f64>| own.or(from).unwrap_or(f64::INFINITY);
        let spread = match (self.deviation, self.weibull_modulus) {
            (Some(deviation), _) if deviation != 0.0 => Spread::Normal { deviation },
            (_, Some(modulus)) => Spread::Weibull { modulus, reference_radius: self.reference_radius },
            _ => Spread::None,
        };
        BondStrength {
            tension: other(tension, shear.zip(ratio).map(|(shear, ratio)| shear * ratio)),
            shear: other(shear, tension.zip(ratio).map(|(tension, ratio)| tension / ratio)),
            friction: libm::tan(self.friction_angle.unwrap_or(0.0)),
            forces,
            spread,
            seed: self.seed.unwrap_or(0),
        }
    }
}
