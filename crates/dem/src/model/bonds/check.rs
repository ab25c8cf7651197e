//! Bonds that are refused.

use crate::model::check::within;
use crate::model::error::SetupError;
use crate::setup::{Bond, Setup};

/// Refuses numbers that make no beam, and scenes in which bonds are not followed.
pub fn check(setup: &Setup) -> Result<(), SetupError> {
    for bond in &setup.bonds {
        let last = bond.between.0.max(bond.between.1);
        within(
            "bond: between",
            last.into(),
            "[–]",
            (last as usize) < setup.materials.len(),
            "the scene's materials",
        )?;
        let at = |key: &str| format!("bond {}: {key}", name(setup, bond));
        let positive =
            |key: &str, x: f64, unit, range| within(at(key), x, unit, x > 0.0 && x.is_finite(), range);
        let (gap, damping) = (bond.gap, bond.damping);
        within(at("gap"), gap, "m", gap >= 0.0 && gap.is_finite(), "gap ≥ 0")?;
        positive("radius_ratio", bond.radius_ratio, "[–]", "radius_ratio > 0")?;
        positive("young", bond.young, "Pa", "young > 0")?;
        positive("shear_modulus", bond.shear_modulus, "Pa", "shear_modulus > 0")?;
        let strengths =
            [("tensile_strength", bond.tensile_strength), ("shear_strength", bond.shear_strength)];
        for (key, x) in strengths {
            within(at(key), x, "Pa", x > 0.0, "strengths > 0")?;
        }
        within(at("damping"), damping, "[–]", (0.0..=2.0).contains(&damping), "0 ≤ damping ≤ 2")?;
    }
    let apart = [(!setup.clumps.shapes.is_empty(), "clumps"), (setup.sleep.is_some(), "[sleep]")];
    match apart.iter().find(|a| a.0) {
        Some(with) if !setup.bonds.is_empty() => Err(SetupError::BondWith(with.1)),
        _ => Ok(()),
    }
}

pub fn name(setup: &Setup, bond: &Bond) -> String {
    let name = |m: u16| setup.materials[m as usize].name.as_str();
    format!("{}–{}", name(bond.between.0), name(bond.between.1))
}
