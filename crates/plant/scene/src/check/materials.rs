//! Checks of `[[material]]`.

use super::Check;
use crate::error::Result;
use crate::keys::SceneKeys;

/// Most materials: every pair of them has a law, of about 700 bytes.
const MOST: usize = 1000;

impl Check<'_> {
    pub(super) fn materials(&self, m: &SceneKeys) -> Result<()> {
        if m.material.len() > MOST {
            let (value, key) = (format!("\"{}\"", m.material[MOST].name), format!("material.{MOST}.name"));
            let why = format!("is one of {} materials, and {MOST} are the most", m.material.len());
            return Err(self.wrong(&key, value, &why, "leave out those that nothing is made of"));
        }
        for (i, material) in m.material.iter().enumerate() {
            let key = |k: &str| format!("material.{i}.{k}");
            if m.material[..i].iter().any(|o| o.name == material.name) {
                let cure = "give every material its own name";
                return Err(self.wrong(&key("name"), &material.name, "another material has this name", cure));
            }
            if material.name.is_empty() || material.name == "*" {
                let value = format!("\"{}\"", material.name);
                return Err(self.wrong(&key("name"), value, "is not a name", "name the material"));
            }
        }
        Ok(())
    }
}
