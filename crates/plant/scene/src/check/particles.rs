//! Checks of where particles come from: `[[particles]]`, `[[fill]]`, `[[insert]]`.

use super::Check;
use crate::error::Result;
use crate::keys::{Fill, GrainKeys, Insert, SceneKeys};

/// Whether every size names its material.
fn has_materials(sizes: Option<&toml::Value>) -> bool {
    let named = |row: &toml::Value| row.as_array().is_some_and(|cells| cells.len() == 3);
    sizes.and_then(toml::Value::as_array).is_some_and(|rows| !rows.is_empty() && rows.iter().all(named))
}

impl Check<'_> {
    /// `[[particles]]`, `[[fill]]` and `[[insert]]`.
    pub(super) fn particles(&self, m: &SceneKeys) -> Result<()> {
        for (i, p) in m.particles.iter().enumerate() {
            self.lengths(&format!("particles.{i}"), p.scale, p.units.as_deref())?;
            if p.cluster.is_some() && (p.fixed || p.clump.is_some()) {
                let why = "only spheres that move are bonded";
                return Err(self.wrong(&format!("particles.{i}.cluster"), "(given)", why, "take it out"));
            }
            if p.materials.is_some() && (p.material.is_some() || p.clump.is_some()) {
                let (why, cure) = ("one material for all is given, too", "leave one of them out");
                return Err(self.wrong(&format!("particles.{i}.materials"), "(given)", why, cure));
            }
            let Some(clump) = p.clump.as_ref().filter(|_| p.fixed) else { continue };
            let why = format!("grains of a clump ({clump}) cannot be fixed");
            let cure = "take it out, or give spheres as wall spheres ([[wall]] source)";
            return Err(self.wrong(&format!("particles.{i}.fixed"), "true", &why, cure));
        }
        m.fill.iter().enumerate().try_for_each(|(i, f)| self.fill(&format!("fill.{i}"), f))?;
        m.insert.iter().enumerate().try_for_each(|(i, f)| self.insert(&format!("insert.{i}"), f))
    }

    /// Spheres have material and diameter, clumps a name and perhaps a scale.
    fn particle(&self, entry: &str, given: &GrainKeys) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let (diameter, material) = (given.diameter.is_some(), given.material.is_some());
        if given.by.is_some() && given.sizes.is_none() {
            let why = "only shares of sizes are by mass or number";
            let cure = if given.clump.is_some() { "take it out" } else { "take it out, or give sizes" };
            return Err(self.wrong(&key("by"), "(given)", why, cure));
        }
        if given.clump.is_some() {
            let keys = [("material", material), ("diameter", diameter), ("sizes", given.sizes.is_some())];
            if let Some((name, _)) = keys.iter().find(|k| k.1) {
                let cure = "take it out, or use scale";
                return Err(self.wrong(&key(name), "(given)", "a clump has its own", cure));
            }
            return Ok(());
        }
        let kinds = [("diameter", diameter), ("sizes", given.sizes.is_some())];
        if !(diameter || given.sizes.is_some()) {
            let (value, why) = ("(without diameter)", "diameter is missing");
            return Err(self.wrong(entry, value, why, "add it, or sizes, or the name of a clump"));
        }
        self.one_of(entry, &kinds)?;
        if material && has_materials(given.sizes) {
            let cure = "take it out, or the materials out of sizes";
            return Err(self.wrong(&key("material"), "(given)", "each of sizes names another one", cure));
        }
        if !material && !has_materials(given.sizes) {
            let (value, why) = ("(without material)", "material is missing");
            return Err(self.wrong(entry, value, why, "add it, or the name of a clump"));
        }
        if given.scale.is_some() {
            let cure = "use diameter, or add clump = \"…\"";
            return Err(self.wrong(&key("scale"), "(given)", "only clumps have a scale", cure));
        }
        if let Some(diameter) = given.diameter.filter(|diameter| diameter.high > 100.0) {
            let value = format!("{} m", diameter.high);
            let cure = "lengths are in metres: 5 mm is 0.005";
            return Err(self.wrong(&key("diameter"), value, "is larger than 100 m", cure));
        }
        Ok(())
    }

    fn fill(&self, entry: &str, f: &Fill) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        self.particle(entry, &f.grains())?;
        let amounts =
            [("mass", f.mass.is_some()), ("count", f.count.is_some()), ("lattice", f.lattice.is_some())];
        self.one_of(entry, &amounts)?;
        if f.clump.is_some() && f.cluster.is_some() {
            let (why, cure) = ("rigid clumps are not bonded", "take it out, or place spheres");
            return Err(self.wrong(&key("cluster"), "(given)", why, cure));
        }
        if f.lattice.is_some()
            && (f.clump.is_some() || f.diameter.is_none_or(|diameter| diameter.low != diameter.high))
        {
            let (why, cure) = ("a lattice is made of equal spheres", "give one 'diameter'");
            return Err(self.wrong(&key("lattice"), "(given)", why, cure));
        }
        Ok(())
    }

    fn insert(&self, entry: &str, f: &Insert) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        self.particle(entry, &f.grains())?;
        self.one_of(entry, &[("rate", f.rate.is_some()), ("rate_count", f.rate_count.is_some())])?;
        if f.mass.is_some() && f.count.is_some() {
            self.one_of(entry, &[("mass", true), ("count", true)])?;
        }
        self.until(&key("until"), f.until, f.from)?;
        self.repeat(entry, f.repeat, f.from, f.until, f.mass.is_some() || f.count.is_some())?;
        match f.times {
            Some(n) if f.repeat.is_none() => {
                let why = "says how often it opens, but not when";
                Err(self.wrong(&key("times"), n, why, &format!("add {entry}.repeat, or take it out")))
            }
            _ => Ok(()),
        }
    }
}
