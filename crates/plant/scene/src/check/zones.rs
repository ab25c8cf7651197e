//! Checks of `[[outlet]]`.

use super::Check;
use crate::error::Result;
use crate::keys::SceneKeys;
use dem::setup::ZoneMotion;

impl Check<'_> {
    /// Samples are of paths, which one motion alone records.
    pub(super) fn outlets(&self, m: &SceneKeys) -> Result<()> {
        for (i, outlet) in m.outlet.iter().enumerate() {
            let Some(samples) = outlet.samples.filter(|_| outlet.motion != ZoneMotion::Recorded) else {
                continue;
            };
            let why = format!(
                "is the time between samples of paths, and motion = \"{}\" records none",
                outlet.motion.name()
            );
            let cure = format!("add motion = \"{}\", or take it out", ZoneMotion::Recorded.name());
            return Err(self.wrong(&format!("outlet.{i}.samples"), format!("{samples} s"), &why, &cure));
        }
        Ok(())
    }
}
