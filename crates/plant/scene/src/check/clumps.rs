//! Checks of `[[clump]]`.

use super::Check;
use crate::error::Result;
use crate::keys::{Clump, ClumpMass, ClumpMoments, SceneKeys};
use geom::Shown;

impl Check<'_> {
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
            let value = format!("[{}] m⁵", m.inertia.map(|term| Shown(term).to_string()).join(", "));
            let mut principal: [f64; 3] = values.into();
            principal.sort_by(f64::total_cmp);
            let [least, middle, most] = principal.map(Shown);
            let of =
                format!("no body has these moments: the principal ones are {least}, {middle} and {most} m⁵");
            let why = match principal[0] > 0.0 {
                true => format!("{of}, and the last is not below the sum of the other two"),
                false => format!("{of}, and the first is not above 0"),
            };
            let cure = "give xx, yy, zz, xy, xz, yz about the centre of mass, for density 1, as stone-clump writes them";
            return Err(self.wrong(&format!("{key}.inertia"), value, &why, cure));
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
        if c.mesh.is_some() && c.mass == ClumpMass::Sum {
            let why = "counts spheres one by one, and a mesh has its own volume";
            return Err(self.wrong(&key("mass"), "\"sum\"", why, "take it out"));
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
