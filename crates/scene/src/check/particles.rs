//! Checks of where particles come from and leave: `[[fill]]`, `[[insert]]`, `[[outlet]]`, `[[inlet]]`.

use super::clumps::Given;
use super::{Check, Checked};
use crate::keys::{Fill, Insert, SceneKeys};

impl Check<'_> {
    /// `[[fill]]` and `[[insert]]`.
    pub(super) fn particles(&self, m: &SceneKeys) -> Checked {
        m.fill.iter().enumerate().try_for_each(|(i, f)| self.fill(&format!("fill.{i}"), f))?;
        m.insert.iter().enumerate().try_for_each(|(i, f)| self.insert(&format!("insert.{i}"), f))
    }

    fn fill(&self, entry: &str, f: &Fill) -> Checked {
        let key = |k: &str| format!("{entry}.{k}");
        let Fill { material, diameter, scale, .. } = f;
        let (diameter, scale, clump) = (*diameter, *scale, f.clump.is_some());
        self.particle(entry, &Given { material, diameter, clump, scale })?;
        self.positive_if(&key("mass"), f.mass, "kg")?;
        if f.count == Some(0) {
            return Err(self.wrong(&key("count"), "0", "no particle is asked for", "give at least 1"));
        }
        self.one_of(entry, &[("mass", f.mass.is_some()), ("count", f.count.is_some())])?;
        self.finite(&key("velocity"), &f.velocity, "m/s")
    }

    fn insert(&self, entry: &str, f: &Insert) -> Checked {
        let key = |k: &str| format!("{entry}.{k}");
        let Insert { material, diameter, scale, .. } = f;
        let (diameter, scale, clump) = (*diameter, *scale, f.clump.is_some());
        self.particle(entry, &Given { material, diameter, clump, scale })?;
        self.positive_if(&key("rate"), f.rate, "kg/s")?;
        self.positive_if(&key("rate_count"), f.rate_count, "1/s")?;
        self.one_of(entry, &[("rate", f.rate.is_some()), ("rate_count", f.rate_count.is_some())])?;
        self.finite(&key("velocity"), &f.velocity, "m/s")?;
        self.within(&key("from"), f.from, 0.0, f64::MAX, "s")?;
        if let Some(until) = f.until.filter(|u| !(*u > f.from)) {
            let value = format!("{until} s");
            return Err(self.wrong(&key("until"), value, "is not after 'from'", "give a later time"));
        }
        Ok(())
    }

    /// `[[outlet]]` and `[[inlet]]`.
    pub(super) fn zones(&self, m: &SceneKeys) -> Checked {
        for (i, o) in m.outlet.iter().enumerate() {
            self.length(&format!("outlet.{i}.length"), o.length)?;
            self.positive_if(&format!("outlet.{i}.samples"), o.samples, "s")?;
        }
        for (i, o) in m.inlet.iter().enumerate() {
            self.length(&format!("inlet.{i}.length"), o.length)?;
        }
        Ok(())
    }
}
