//! Whether a recorded stream was made for the zone of an `[[inlet]]`.

use crate::error::Result;
use crate::input::{InletSource, ZoneRecord};
use crate::plan::builder::PlanBuilder;
use dem::setup::{Zone, ZoneMotion};
use geom::Vec3;

impl PlanBuilder<'_> {
    /// Refuses a stream that was made for another zone than that of the entry at `key`.
    pub(in crate::plan) fn same_zone(
        &self,
        key: &str,
        here: &ZoneRecord,
        stream: &InletSource,
    ) -> Result<()> {
        let Some(there) = &stream.zone else { return Ok(()) };
        let refuse = |key: &str, value: String, made_for: String, cure: &str| {
            let why = format!("{} was made for {made_for}", stream.name);
            Err(self.check.wrong(key, value, &why, cure))
        };
        let key = |part: &str| format!("{key}.{part}");
        let (mine, its) = (&here.zone, &there.zone);
        if !same_plane(mine, its) {
            let cure = "run stage-replay with --at this plane";
            return refuse(&key("plane"), mine.plane.to_string(), format!("the plane {}", its.plane), cure);
        }
        if (mine.length - its.length).abs() > 1e-9 * its.length {
            let cure = "run stage-replay with this --length, or use length = \"auto\"";
            let (value, made_for) = (format!("{} m", mine.length), format!("a length of {} m", its.length));
            return refuse(&key("length"), value, made_for, cure);
        }
        let quoted = |name: &str| format!("\"{name}\"");
        if mine.motion != its.motion {
            let cure = format!("run stage-replay with --move {}, or leave the key out", mine.motion.name());
            return refuse(&key("motion"), quoted(mine.motion.name()), quoted(its.motion.name()), &cure);
        }
        if mine.test != its.test {
            let cure = "run both stages with the same test, or leave the key out";
            return refuse(&key("test"), quoted(mine.test.name()), quoted(its.test.name()), cure);
        }
        if let (Some(mine), Some(its)) = (&here.plant, &there.plant)
            && mine != its
        {
            let cure = "give the record of the stage upstream of this one, cut both from one plant with stage-split, or leave the \
                        key out to use the flow of another plant";
            return refuse(&key("plant"), quoted(mine), quoted(its), cure);
        }
        let falls = mine.motion == ZoneMotion::Ballistic;
        if let (true, Some(mine), Some(its)) = (falls, here.gravity, there.gravity)
            && !((mine - its).norm() <= 1e-9 * its.norm())
        {
            let shown = |g: Vec3| format!("[{}, {}, {}] m/s²", g.x, g.y, g.z);
            let cure = "use the gravity of the stage upstream, or --move constant";
            return refuse("gravity", shown(mine), format!("a free fall of {}", shown(its)), cure);
        }
        Ok(())
    }
}

fn same_plane(here: &Zone, there: &Zone) -> bool {
    let apart = there.plane.signed_distance(&here.plane.point).abs();
    let turned = (here.plane.normal - there.plane.normal).norm();
    !(apart > 1e-3 * there.length || turned > 1e-6)
}
