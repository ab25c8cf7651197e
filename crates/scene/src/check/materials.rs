//! Checks of `[[material]]` and `[[bond]]`.

use super::{Check, Checked};
use crate::keys::SceneKeys;

impl Check<'_> {
    pub(super) fn materials(&self, m: &SceneKeys) -> Checked {
        for (i, material) in m.material.iter().enumerate() {
            let key = |k: &str| format!("material.{i}.{k}");
            if m.material[..i].iter().any(|o| o.name == material.name) {
                let why = "another material has this name";
                return Err(self.wrong(
                    &key("name"),
                    &material.name,
                    why,
                    "give every material its own name",
                ));
            }
            if material.name.is_empty() || material.name == "*" {
                return Err(self.wrong(
                    &key("name"),
                    format!("\"{}\"", material.name),
                    "is not a name",
                    "name the material",
                ));
            }
            self.positive_if(&key("density"), material.density, "kg/m³")?;
            self.positive(&key("young"), material.young, "Pa")?;
            self.poisson(&key("poisson"), material.poisson)?;
        }
        Ok(())
    }

    pub(super) fn bonds(&self, m: &SceneKeys) -> Checked {
        for (i, b) in m.bond.iter().enumerate() {
            let key = |k: &str| format!("bond.{i}.{k}");
            self.within(&key("gap"), b.gap, 0.0, 100.0, "m")?;
            self.positive_if(&key("radius_ratio"), b.radius_ratio, "")?;
            self.positive(&key("young"), b.young, "Pa")?;
            self.poisson(&key("poisson"), b.poisson)?;
            self.positive_if(&key("tensile_strength"), b.tensile_strength, "Pa")?;
            self.positive_if(&key("shear_strength"), b.shear_strength, "Pa")?;
            self.within(&key("damping"), b.damping.unwrap_or(0.0), 0.0, 2.0, "")?;
        }
        Ok(())
    }
}
