//! Checks of `[[bond]]`.

use super::Check;
use crate::error::Result;
use crate::keys::{Bond, BondKind, SceneKeys};

impl Check<'_> {
    pub(super) fn bonds(&self, m: &SceneKeys) -> Result<()> {
        m.bond.iter().enumerate().try_for_each(|(i, bond)| self.bond(&format!("bond.{i}"), bond))
    }

    fn bond(&self, entry: &str, b: &Bond) -> Result<()> {
        self.keys_of_kind(entry, b)?;
        match b.kind {
            BondKind::Beam => {
                self.all_of(entry, &[("young", b.young.is_some()), ("poisson", b.poisson.is_some())])?;
            }
            BondKind::Parallel => self.springs(
                entry,
                b,
                [
                    ("normal_stiffness_per_area", b.normal_stiffness_per_area.is_some()),
                    ("shear_stiffness_per_area", b.shear_stiffness_per_area.is_some()),
                ],
            )?,
            BondKind::Contact => self.springs(
                entry,
                b,
                [
                    ("normal_stiffness", b.normal_stiffness.is_some()),
                    ("shear_stiffness", b.shear_stiffness.is_some()),
                ],
            )?,
        }
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
    fn springs(&self, entry: &str, b: &Bond, given: [(&str, bool); 2]) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let [normal, shear] = given;
        self.one_of(entry, &[("modulus", b.modulus.is_some()), normal])?;
        if b.modulus.is_some() {
            if shear.1 {
                let (why, cure) = ("'modulus' and 'stiffness_ratio' say it already", "take it out");
                return Err(self.wrong(&key(shear.0), "(given)", why, cure));
            }
            self.all_of(entry, &[("stiffness_ratio", b.stiffness_ratio.is_some())])?;
        } else {
            if b.stiffness_ratio.is_some() {
                let (why, cure) = ("it goes with 'modulus'", "take it out");
                return Err(self.wrong(&key("stiffness_ratio"), "(given)", why, cure));
            }
            self.all_of(entry, &[shear])?;
        }
        Ok(())
    }

    fn bond_strength(&self, entry: &str, b: &Bond) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let [pulled, sheared] = [b.tensile_strength.is_some(), b.shear_strength.is_some()];
        let [pulled_by, sheared_by] = [b.tensile_force.is_some(), b.shear_force.is_some()];
        if (pulled || sheared) && (pulled_by || sheared_by) {
            let (why, cure) = ("strengths are stresses or forces, not both", "give both in one unit");
            let name = if pulled_by { "tensile_force" } else { "shear_force" };
            return Err(self.wrong(&key(name), "(given)", why, cure));
        }
        if b.strength_ratio.is_some() {
            let tension = [("tensile_strength", pulled), ("tensile_force", pulled_by)];
            let shear = [("shear_strength", sheared), ("shear_force", sheared_by)];
            self.one_of(&key("strength_ratio"), &[tension, shear].concat())?;
        }
        let breaks = pulled || sheared || pulled_by || sheared_by;
        // 0 asks for nothing, so that a sweep may begin there.
        let steep = b.friction_angle.unwrap_or(0.0);
        if steep != 0.0 && !(sheared || sheared_by || b.strength_ratio.is_some()) {
            let (why, cure) =
                ("there is no shear strength that pressure could add to", "add one, or take it out");
            return Err(self.wrong(&key("friction_angle"), format!("{steep} rad"), why, cure));
        }
        self.spread(entry, b, breaks)
    }

    fn spread(&self, entry: &str, b: &Bond, breaks: bool) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let spreads = b.deviation.is_some() || b.weibull_modulus.is_some();
        if b.deviation.is_some() && b.weibull_modulus.is_some() {
            let (why, cure) = ("'weibull_modulus' says how strengths differ", "take one of them out");
            return Err(self.wrong(&key("deviation"), "(given)", why, cure));
        }
        let rules = [
            (
                "deviation",
                b.deviation.is_some_and(|deviation| deviation != 0.0),
                breaks,
                "the bonds have no strength",
            ),
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
