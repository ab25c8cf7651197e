//! Checks of `[[clump]]`, `[[body]]`, and of entries that name a clump.

use super::Check;
use crate::error::Result;
use crate::keys::{Clump, ClumpMass, ClumpMoments, GrainKeys, SceneKeys};

/// Whether every size names its material.
fn has_materials(sizes: Option<&toml::Value>) -> bool {
    let named = |row: &toml::Value| row.as_array().is_some_and(|cells| cells.len() == 3);
    sizes.and_then(toml::Value::as_array).is_some_and(|rows| !rows.is_empty() && rows.iter().all(named))
}

impl Check<'_> {
    /// Spheres have material and diameter, clumps a name and perhaps a scale.
    pub(super) fn particle(&self, entry: &str, given: &GrainKeys) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let (diameter, material) = (given.diameter.is_some(), given.material.is_some());
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
        if given.by.is_some() && given.sizes.is_none() {
            let cure = "take it out, or give sizes";
            return Err(self.wrong(
                &key("by"),
                "(given)",
                "only shares of sizes are by mass or number",
                cure,
            ));
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

    /// `[[clump]]`.
    pub(super) fn clumps(&self, m: &SceneKeys) -> Result<()> {
        for (i, c) in m.clump.iter().enumerate() {
            if c.name.is_empty() || m.clump[..i].iter().any(|o| o.name == c.name) {
                let (key, value) = (format!("clump.{i}.name"), format!("\"{}\"", c.name));
                return Err(self.wrong(&key, value, "is not a unique name", "name each clump differently"));
            }
            self.clump(&format!("clump.{i}"), c)?;
        }
        Ok(())
    }

    /// A body: its principal moments obey J₁ + J₂ > J₃.
    fn moments(&self, key: &str, c: &Clump, m: &ClumpMoments) -> Result<()> {
        if c.spheres.is_none() || c.mass != ClumpMass::default() {
            let why = "gives the mass, which mesh and mass = \"sum\" give, too";
            return Err(self.wrong(key, "(given)", why, "leave one of them out"));
        }
        let values = m.tensor().symmetric_eigenvalues();
        if !(values.min() > 0.0 && values.sum() > 2.0 * values.max()) {
            let value = format!("{:?} m⁵", m.inertia);
            let cure = "give xx, yy, zz, xy, xz, yz about the centre of mass, for density 1, as stone-clump writes them";
            return Err(self.wrong(&format!("{key}.inertia"), value, "no body has these moments", cure));
        }
        Ok(())
    }

    fn clump(&self, entry: &str, c: &Clump) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let kinds = [("spheres", c.spheres.is_some()), ("mesh", c.mesh.is_some())];
        self.one_of(entry, &kinds)?;
        if c.mesh.is_some() != c.vertex_radius.is_some() {
            let why = "vertex_radius goes with mesh, and mesh with vertex_radius";
            return Err(self.wrong(entry, "(one of them)", why, "give both, or spheres"));
        }
        if let Some(faces) = c.faces.filter(|faces| c.mesh.is_none() || *faces < 4) {
            let (why, cure) = match c.mesh {
                None => ("thins a mesh, and there is none", "take it out, or give mesh"),
                Some(_) => {
                    ("no closed surface has so few", "give at least 4; 100 carry the shape of a stone")
                }
            };
            return Err(self.wrong(&key("faces"), faces.to_string(), why, cure));
        }
        let spheres = c.spheres.as_deref().unwrap_or_default();
        if c.spheres.is_some() && spheres.is_empty() {
            let cure = "give [[x, y, z, radius], …]";
            return Err(self.wrong(&key("spheres"), "[]", "has no sphere", cure));
        }
        if let Some(moments) = &c.moments {
            self.moments(&key("moments"), c, moments)?;
        }
        for (k, sphere) in spheres.iter().enumerate() {
            self.positive(&key(&format!("spheres.{k}")), sphere[3], "m")?;
        }
        Ok(())
    }
}
