//! Checks of `[[clump]]`, `[[body]]`, and of entries that name a clump.

use super::Check;
use crate::error::Result;
use crate::keys::{Clump, Diameter, SceneKeys};

/// Keys of an entry that makes spheres or clumps.
pub(super) struct Given<'a> {
    pub material: &'a str,
    pub diameter: Diameter,
    pub clump: &'a Option<String>,
    pub scale: Option<Diameter>,
}

impl Check<'_> {
    /// Spheres have material and diameter, clumps a name and perhaps a scale.
    pub(super) fn particle(&self, entry: &str, given: &Given) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let diameter = given.diameter != Diameter::default();
        let keys = [("material", !given.material.is_empty()), ("diameter", diameter)];
        if given.clump.is_some() {
            if let Some((name, _)) = keys.iter().find(|k| k.1) {
                let cure = "take it out, or use scale";
                return Err(self.wrong(&key(name), "(given)", "a clump has its own", cure));
            }
            return given.scale.map_or(Ok(()), |range| self.range(&key("scale"), range, ""));
        }
        if let Some((name, _)) = keys.iter().find(|k| !k.1) {
            let (value, why) = (format!("(without {name})"), format!("{name} is missing"));
            return Err(self.wrong(entry, value, &why, "add it, or the name of a clump"));
        }
        if given.scale.is_some() {
            let cure = "use diameter, or add clump = \"…\"";
            return Err(self.wrong(&key("scale"), "(given)", "only clumps have a scale", cure));
        }
        self.range(&key("diameter"), given.diameter, "m")?;
        if given.diameter.high > 100.0 {
            let value = format!("{} m", given.diameter.high);
            let cure = "lengths are in metres: 5 mm is 0.005";
            return Err(self.wrong(&key("diameter"), value, "is larger than 100 m", cure));
        }
        Ok(())
    }

    /// `[[clump]]` and `[[body]]`.
    pub(super) fn clumps(&self, m: &SceneKeys) -> Result<()> {
        for (i, c) in m.clump.iter().enumerate() {
            if c.name.is_empty() || m.clump[..i].iter().any(|o| o.name == c.name) {
                let (key, value) = (format!("clump.{i}.name"), format!("\"{}\"", c.name));
                return Err(self.wrong(&key, value, "is not a unique name", "name each clump differently"));
            }
            self.clump(&format!("clump.{i}"), c)?;
        }
        for (i, b) in m.body.iter().enumerate() {
            let key = |k: &str| format!("body.{i}.{k}");
            self.finite(&key("position"), &b.position, "m")?;
            self.finite(&key("velocity"), &b.velocity, "m/s")?;
            self.finite(&key("spin"), &b.spin, "rad/s")?;
            self.positive(&key("scale"), b.scale, "")?;
        }
        Ok(())
    }

    fn clump(&self, entry: &str, c: &Clump) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let kinds = [("spheres", c.spheres.is_some()), ("mesh", c.mesh.is_some())];
        self.one_of(entry, &kinds)?;
        self.positive(&key("scale"), c.scale, "")?;
        self.positive(&key("vertex_radius"), c.vertex_radius, "m")?;
        if c.mesh.is_some() != c.vertex_radius.is_some() {
            let why = "vertex_radius goes with mesh, and mesh with vertex_radius";
            return Err(self.wrong(entry, "(one of them)", why, "give both, or spheres"));
        }
        let spheres = c.spheres.as_deref().unwrap_or_default();
        if c.spheres.is_some() && spheres.is_empty() {
            let cure = "give [[x, y, z, radius], …]";
            return Err(self.wrong(&key("spheres"), "[]", "has no sphere", cure));
        }
        for (k, sphere) in spheres.iter().enumerate() {
            self.finite(&key(&format!("spheres.{k}")), &sphere[..3], "m")?;
            self.positive(&key(&format!("spheres.{k}")), sphere[3], "m")?;
        }
        Ok(())
    }
}
