//! Checks of `[[bond]]`.

use super::Check;
use crate::error::Result;
use crate::keys::{Bond, BondKind, SceneKeys};

/// Largest angle of friction: tan φ is finite [rad].
const STEEPEST: f64 = 1.55;

impl Check<'_> {
    pub(super) fn bonds(&self, m: &SceneKeys) -> Result<()> {
        m.bond.iter().enumerate().try_for_each(|(i, bond)| self.bond(&format!("bond.{i}"), bond))
    }

    fn bond(&self, entry: &str, b: &Bond) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        self.within(&key("gap"), b.gap, 0.0, 100.0, "m")?;
        self.within(&key("at"), b.at, 0.0, dem::magnitudes("s")[1], "s")?;
        self.positive(&key("radius_ratio"), b.radius_ratio, "")?;
        self.within(&key("damping"), b.damping.unwrap_or(0.0), 0.0, 2.0, "")?;
        self.keys_of_kind(entry, b)?;
        match b.kind {
            BondKind::Beam => {
                self.all_of(entry, &[("young", b.young.is_some()), ("poisson", b.poisson.is_some())])?;
                self.positive(&key("young"), b.young, "Pa")?;
                b.poisson.map_or(Ok(()), |ratio| self.poisson(&key("poisson"), ratio))?;
            }
            BondKind::Parallel => self.springs(
                entry,
                b,
                [
                    ("normal_stiffness_per_area", b.normal_stiffness_per_area, "Pa/m"),
                    ("shear_stiffness_per_area", b.shear_stiffness_per_area, "Pa/m"),
                ],
            )?,
            BondKind::Contact => self.springs(
                entry,
                b,
                [
                    ("normal_stiffness", b.normal_stiffness, "N/m"),
                    ("shear_stiffness", b.shear_stiffness, "N/m"),
                ],
            )?,
        }
        b.moments.map_or(Ok(()), |share| self.within(&key("moments"), share, 0.0, 1.0, ""))?;
        self.bond_strength(entry, b)
    }

    /// Refuses keys that another kind of bond has.
    fn keys_of_kind(&self, entry: &str, b: &Bond) -> Result<()> {
        use BondKind::{Beam, Contact, Parallel};
        let of: [(&str, bool, &[BondKind]); 12] = [
            ("young", b.young.is_some(), &[Beam]),
            ("poisson", b.poisson.is_some(), &[Beam]),
            ("radius_ratio", b.radius_ratio.is_some(), &[Beam, Parallel]),
            ("modulus", b.modulus.is_some(), &[Parallel, Contact]),
            ("stiffness_ratio", b.stiffness_ratio.is_some(), &[Parallel, Contact]),
            ("normal_stiffness", b.normal_stiffness.is_some(), &[Contact]),
            ("shear_stiffness", b.shear_stiffness.is_some(), &[Contact]),
            ("normal_stiffness_per_area", b.normal_stiffness_per_area.is_some(), &[Parallel]),
            ("shear_stiffness_per_area", b.shear_stiffness_per_area.is_some(), &[Parallel]),
            ("moments", b.moments.is_some(), &[Parallel]),
            ("tensile_force", b.tensile_force.is_some(), &[Contact]),
            ("shear_force", b.shear_force.is_some(), &[Contact]),
        ];
        for (name, given, kinds) in of {
            if given && !kinds.contains(&b.kind) {
                let why = format!("a bond of kind \"{}\" does not have it", b.kind.name());
                let others =
                    kinds.iter().map(|k| format!("\"{}\"", k.name())).collect::<Vec<_>>().join(" or ");
                let cure = format!("take it out, or use kind = {others}");
                return Err(self.wrong(&format!("{entry}.{name}"), "(given)", &why, &cure));
            }
        }
        Ok(())
    }

    /// Two stiffnesses, or a modulus and a ratio.
    fn springs(&self, entry: &str, b: &Bond, given: [(&str, Option<f64>, &str); 2]) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let [normal, shear] = given;
        self.one_of(entry, &[("modulus", b.modulus.is_some()), (normal.0, normal.1.is_some())])?;
        if b.modulus.is_some() {
            if shear.1.is_some() {
                let (why, cure) = ("'modulus' and 'stiffness_ratio' say it already", "take it out");
                return Err(self.wrong(&key(shear.0), "(given)", why, cure));
            }
            self.all_of(entry, &[("stiffness_ratio", b.stiffness_ratio.is_some())])?;
        } else {
            if b.stiffness_ratio.is_some() {
                let (why, cure) = ("it goes with 'modulus'", "take it out");
                return Err(self.wrong(&key("stiffness_ratio"), "(given)", why, cure));
            }
            self.all_of(entry, &[(shear.0, shear.1.is_some())])?;
        }
        self.positive(&key("modulus"), b.modulus, "Pa")?;
        self.positive(&key("stiffness_ratio"), b.stiffness_ratio, "")?;
        given.iter().try_for_each(|(name, value, unit)| self.positive(&key(name), *value, unit))
    }

    fn bond_strength(&self, entry: &str, b: &Bond) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let given = [
            ("tensile_strength", b.tensile_strength, "Pa"),
            ("shear_strength", b.shear_strength, "Pa"),
            ("tensile_force", b.tensile_force, "N"),
            ("shear_force", b.shear_force, "N"),
        ];
        for (name, value, unit) in given {
            let most = dem::magnitudes(unit)[1];
            value.map_or(Ok(()), |v| self.within(&key(name), v, 0.0, most, unit))?;
        }
        let [pulled, sheared, pulled_by, sheared_by] = given.map(|g| g.1.is_some());
        if (pulled || sheared) && (pulled_by || sheared_by) {
            let (why, cure) = ("strengths are stresses or forces, not both", "give both in one unit");
            let name = if pulled_by { "tensile_force" } else { "shear_force" };
            return Err(self.wrong(&key(name), "(given)", why, cure));
        }
        if let Some(ratio) = b.strength_ratio {
            self.positive(&key("strength_ratio"), ratio, "")?;
            let tension = [("tensile_strength", pulled), ("tensile_force", pulled_by)];
            let shear = [("shear_strength", sheared), ("shear_force", sheared_by)];
            self.one_of(&key("strength_ratio"), &[tension, shear].concat())?;
        }
        let breaks = pulled || sheared || pulled_by || sheared_by;
        let steep = b.friction_angle.unwrap_or(0.0);
        self.within(&key("friction_angle"), steep, 0.0, STEEPEST, "rad")?;
        if b.friction_angle.is_some() && !(sheared || sheared_by || b.strength_ratio.is_some()) {
            let (why, cure) =
                ("there is no shear strength that pressure could add to", "add one, or take it out");
            return Err(self.wrong(&key("friction_angle"), format!("{steep} rad"), why, cure));
        }
        self.spread(entry, b, breaks)
    }

    fn spread(&self, entry: &str, b: &Bond, breaks: bool) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        self.within(&key("deviation"), b.deviation.unwrap_or(0.0), 0.0, 1.0, "")?;
        b.weibull_modulus.map_or(Ok(()), |m| self.within(&key("weibull_modulus"), m, 0.1, 1e4, ""))?;
        self.positive(&key("reference_radius"), b.reference_radius, "m")?;
        let spreads = b.deviation.is_some() || b.weibull_modulus.is_some();
        if b.deviation.is_some() && b.weibull_modulus.is_some() {
            let (why, cure) = ("'weibull_modulus' says how strengths differ", "take one of them out");
            return Err(self.wrong(&key("deviation"), "(given)", why, cure));
        }
        let rules = [
            ("deviation", b.deviation.is_some(), breaks, "the bonds have no strength"),
            ("weibull_modulus", b.weibull_modulus.is_some(), breaks, "the bonds have no strength"),
            (
                "reference_radius",
                b.reference_radius.is_some(),
                b.weibull_modulus.is_some(),
                "it goes with 'weibull_modulus'",
            ),
            ("seed", b.seed.is_some(), spreads, "nothing is drawn without 'deviation' or 'weibull_modulus'"),
        ];
        for (name, given, allowed, why) in rules {
            if given && !allowed {
                return Err(self.wrong(&key(name), "(given)", why, "take it out"));
            }
        }
        Ok(())
    }

    /// All of several keys.
    fn all_of(&self, entry: &str, keys: &[(&str, bool)]) -> Result<()> {
        match keys.iter().find(|k| !k.1) {
            Some((name, _)) => Err(self.wrong(entry, "(without)", &format!("{name} is missing"), "add it")),
            None => Ok(()),
        }
    }
}

impl BondKind {
    fn name(self) -> &'static str {
        match self {
            BondKind::Beam => "beam",
            BondKind::Parallel => "parallel",
            BondKind::Contact => "contact",
        }
    }
}
