//! Whether a recorded stream was made for the zone of an `[[inlet]]`.

use crate::check::Check;
use crate::error::SceneError;
use crate::input::ZoneRecord;
use dem::setup::{Zone, ZoneMotion};
use geom::Vec3;

/// A stream, and the entry of the scene that it enters by.
pub(super) struct SameZone<'a> {
    pub check: &'a Check<'a>,
    /// Key of the entry.
    pub key: &'a str,
    /// The zone of the entry.
    pub scene: &'a ZoneRecord,
    /// The zone that the stream was made for.
    pub stream: &'a ZoneRecord,
    /// Name of the stream.
    pub name: &'a str,
}

impl SameZone<'_> {
    /// Refuses a stream that was made for another zone.
    pub(super) fn check(&self) -> Result<(), SceneError> {
        self.same_place()?;
        let (here, there) = (&self.scene.zone, &self.stream.zone);
        if here.motion != there.motion {
            let cure = format!("run stage-replay with --move {}, or leave the key out", here.motion.name());
            return Err(self.other("motion", here.motion.name(), there.motion.name(), &cure));
        }
        if here.test != there.test {
            let cure = "run both stages with the same test, or leave the key out";
            return Err(self.other("test", here.test.name(), there.test.name(), cure));
        }
        match (&self.scene.plant, &self.stream.plant) {
            (Some(mine), Some(its)) if mine != its => {
                let cure = "give the record of the stage upstream of this one, cut both from one plant with stage-split, or leave the \
                            key out to use the flow of another plant";
                Err(self.other("plant", mine, its, cure))
            }
            _ => self.same_gravity(),
        }
    }

    /// The error of a key whose value is another one in the stream.
    fn other(&self, part: &str, value: &str, other: &str, cure: &str) -> SceneError {
        let why = format!("{} was made for \"{other}\"", self.name);
        self.check.wrong(&format!("{}.{part}", self.key), format!("\"{value}\""), &why, cure)
    }

    fn same_gravity(&self) -> Result<(), SceneError> {
        let (Some(mine), Some(its)) = (self.scene.gravity, self.stream.gravity) else { return Ok(()) };
        if self.scene.zone.motion != ZoneMotion::Ballistic || (mine - its).norm() <= 1e-9 * its.norm() {
            return Ok(());
        }
        let shown = |g: Vec3| format!("[{}, {}, {}] m/s²", g.x, g.y, g.z);
        let why = format!("{} was made for a free fall of {}", self.name, shown(its));
        let cure = "use the gravity of the stage upstream, or --move constant";
        Err(self.check.wrong("gravity", shown(mine), &why, cure))
    }

    fn same_place(&self) -> Result<(), SceneError> {
        let (name, key) = (self.name, self.key);
        let (scene, stream): (&Zone, &Zone) = (&self.scene.zone, &self.stream.zone);
        let size = stream.length;
        let apart = stream.plane.signed_distance(&scene.plane.point).abs();
        let turned = (scene.plane.normal - stream.plane.normal).norm();
        if apart > 1e-6 * size.max(apart) && apart > 1e-3 * size || turned > 1e-6 {
            let why = format!("{name} was made for the plane {}", stream.plane);
            let cure = "run stage-replay with --at this plane";
            return Err(self.check.wrong(&format!("{key}.plane"), scene.plane, &why, cure));
        }
        if (scene.length - stream.length).abs() > 1e-9 * size {
            let why = format!("{name} was made for a length of {} m", stream.length);
            let cure = "run stage-replay with this --length, or use length = \"auto\"";
            let value = format!("{} m", scene.length);
            return Err(self.check.wrong(&format!("{key}.length"), value, &why, cure));
        }
        Ok(())
    }
}
