//! What a `[[bond]]` asks of the engine.

use crate::check::Check;
use crate::error::Result;
use crate::keys::Bond;
use dem::setup::{self, Material};

/// Bonds of a scene, whose materials are known by name.
///
/// # Errors
/// An unknown material, "*", or two entries for one pair.
pub(super) fn resolve(check: &Check, entries: &[Bond], materials: &[Material]) -> Result<Vec<setup::Bond>> {
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
        let between = (between[0].min(between[1]), between[0].max(between[1]));
        if let Some(first) = found.iter().position(|f| f.between == between) {
            let why = format!("bond.{first} is between these two materials already");
            let value = format!("{:?}", b.between);
            return Err(check.wrong(&format!("bond.{i}.between"), value, &why, "take one of them out"));
        }
        found.push(setup::Bond {
            between,
            gap: b.gap,
            radius_ratio: b.radius_ratio.unwrap_or(1.0),
            young: b.young,
            shear_modulus: 0.5 * b.young / (1.0 + b.poisson),
            tensile_strength: b.tensile_strength.unwrap_or(f64::INFINITY),
            shear_strength: b.shear_strength.unwrap_or(f64::INFINITY),
            damping: b.damping.unwrap_or(0.0),
        });
    }
    Ok(found)
}
