//! Checks of where particles come from: `[[particles]]`, `[[fill]]`, `[[insert]]`.

use super::Check;
use crate::error::Result;
use crate::keys::{Fill, Insert, SceneKeys};

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

    fn fill(&self, entry: &str, f: &Fill) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        self.particle(entry, &f.grains())?;
        self.amount(entry, f.count)?;
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

    /// `count`, where it is given.
    fn amount(&self, entry: &str, count: Option<u64>) -> Result<()> {
        match count {
            Some(0) => {
                let (key, cure) = (format!("{entry}.count"), "give at least 1");
                Err(self.wrong(&key, "0", "no particle is asked for", cure))
            }
            _ => Ok(()),
        }
    }

    fn insert(&self, entry: &str, f: &Insert) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        self.particle(entry, &f.grains())?;
        self.one_of(entry, &[("rate", f.rate.is_some()), ("rate_count", f.rate_count.is_some())])?;
        self.amount(entry, f.count)?;
        if f.mass.is_some() && f.count.is_some() {
            self.one_of(entry, &[("mass", true), ("count", true)])?;
        }
        self.until(&key("until"), f.until, f.from)?;
        self.repeat(entry, f.repeat, f.from, f.until, f.mass.is_some() || f.count.is_some())?;
        match f.times {
            Some(0) => Err(self.wrong(&key("times"), "0", "nothing would be inserted", "give at least 1")),
            Some(n) if f.repeat.is_none() => {
                let why = "says how often it opens, but not when";
                Err(self.wrong(&key("times"), n, why, &format!("add {entry}.repeat, or take it out")))
            }
            _ => Ok(()),
        }
    }
}
