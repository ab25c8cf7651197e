//! A gate: a cut through a plant as records tell of it, so that both stages agree on where it is and how grains pass.

use crate::check::Check;
use crate::crossings;
use crate::error::SceneError;
use crate::inlet::plane_text;
use dem::setup::{Zone, ZoneMotion, ZoneTest};
use geom::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A zone, and what else both sides of it must have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gate {
    /// Where, how grains move in it, and what of them passes its planes.
    #[serde(flatten)]
    pub zone: Zone,
    /// Acceleration of free fall [m/s²] where it was recorded.
    #[serde(default)]
    pub gravity: Option<Vec3>,
    /// What the stage upstream was cut from; see [`crate::split`].
    #[serde(default)]
    pub plant: Option<String>,
    /// Time between samples of recorded paths [s].
    #[serde(default)]
    pub samples: Option<f64>,
}

impl Gate {
    /// The record.
    pub fn to_map(&self) -> BTreeMap<String, String> {
        let zone = &self.zone;
        let mut map = BTreeMap::from([
            ("plane".to_owned(), plane_text(&zone.plane)),
            ("length".to_owned(), zone.length.to_string()),
            ("motion".to_owned(), zone.motion.name().to_owned()),
            ("test".to_owned(), zone.test.name().to_owned()),
        ]);
        map.extend(self.gravity.map(|g| ("gravity".to_owned(), format!("{},{},{}", g.x, g.y, g.z))));
        map.extend(self.plant.clone().map(|plant| ("plant".to_owned(), plant)));
        map.extend(self.samples.map(|time| ("samples".to_owned(), time.to_string())));
        map
    }

    /// From a record; what older ones do not tell is as it was then.
    ///
    /// # Errors
    /// A key that is missing or wrong.
    pub fn from_map(stream: &str, record: &str, map: &BTreeMap<String, String>) -> Result<Gate, SceneError> {
        let length = crossings::number(stream, record, map, "length")?;
        let text = |key: &str| map.get(key).map_or("", String::as_str);
        let wrong = |key: &str, why: String| {
            let why = format!("record '{record}': {key} = {}: {why}", text(key));
            SceneError::file(stream, why, "run stage-replay again")
        };
        let plane =
            text("plane").parse().map_err(|e: geom::plane::PlaneError| wrong("plane", e.to_string()))?;
        let unknown = |key: &str| wrong(key, "is not known to this version".to_owned());
        let motion = match map.get("motion") {
            None => ZoneMotion::default(),
            Some(name) => named(&ZoneMotion::ALL, |m| m.name() == name).ok_or_else(|| unknown("motion"))?,
        };
        let test = match map.get("test") {
            None => ZoneTest::default(),
            Some(name) => named(&ZoneTest::ALL, |t| t.name() == name).ok_or_else(|| unknown("test"))?,
        };
        let gravity = match map.get("gravity") {
            None => None,
            Some(text) => {
                Some(vector(text).ok_or_else(|| wrong("gravity", "wanted: three numbers".to_owned()))?)
            }
        };
        let zone = Zone { plane, length, motion, test };
        let samples = match map.get("samples") {
            None => None,
            Some(_) => Some(crossings::number(stream, record, map, "samples")?),
        };
        Ok(Gate { zone, gravity, plant: map.get("plant").cloned(), samples })
    }

    /// Refuses a stream that was made for another gate than this one, of the entry `key` of a scene.
    pub(crate) fn fits(&self, check: &Check, key: &str, stream: &Gate, name: &str) -> Result<(), SceneError> {
        self.same_place(check, key, &stream.zone, name)?;
        let (here, there) = (&self.zone, &stream.zone);
        let refuse = |part: &str, value: &str, other: &str, cure: &str| {
            let why = format!("{name} was made for \"{other}\"");
            Err(check.wrong(&format!("{key}.{part}"), format!("\"{value}\""), &why, cure))
        };
        if here.motion != there.motion {
            let cure = format!("run stage-replay with --move {}, or leave the key out", here.motion.name());
            return refuse("motion", here.motion.name(), there.motion.name(), &cure);
        }
        if here.test != there.test {
            let cure = "run both stages with the same test, or leave the key out";
            return refuse("test", here.test.name(), there.test.name(), cure);
        }
        if let (Some(mine), Some(its)) = (&self.plant, &stream.plant)
            && mine != its
        {
            let cure = "give the record of the stage upstream of this one, cut both from one plant with stage-split, or leave the key out \
                        where another plant's flow is meant";
            return refuse("plant", mine, its, cure);
        }
        match (self.gravity, stream.gravity) {
            (Some(mine), Some(its))
                if here.motion == ZoneMotion::Ballistic && (mine - its).norm() > 1e-9 * its.norm() =>
            {
                let shown = |g: Vec3| format!("[{}, {}, {}] m/s²", g.x, g.y, g.z);
                let why = format!("{name} was made for a free fall of {}", shown(its));
                Err(check.wrong(
                    "gravity",
                    shown(mine),
                    &why,
                    "use the gravity of the stage upstream, or --move constant",
                ))
            }
            _ => Ok(()),
        }
    }

    fn same_place(&self, check: &Check, key: &str, stream: &Zone, name: &str) -> Result<(), SceneError> {
        let (scene, size) = (&self.zone, stream.length);
        let apart = stream.plane.signed_distance(&scene.plane.point).abs();
        let turned = (scene.plane.normal - stream.plane.normal).norm();
        if apart > 1e-6 * size.max(apart) && apart > 1e-3 * size || turned > 1e-6 {
            let why = format!("{name} was made for the plane {}", plane_text(&stream.plane));
            let value = plane_text(&scene.plane);
            return Err(check.wrong(
                &format!("{key}.plane"),
                value,
                &why,
                "run stage-replay with --at this plane",
            ));
        }
        if (scene.length - stream.length).abs() > 1e-9 * size {
            let why = format!("{name} was made for a length of {} m", stream.length);
            let cure = "run stage-replay with this --length, or use length = \"auto\"";
            return Err(check.wrong(&format!("{key}.length"), format!("{} m", scene.length), &why, cure));
        }
        Ok(())
    }
}

/// Three numbers with commas between.
fn vector(text: &str) -> Option<Vec3> {
    let numbers: Vec<f64> = text.split(',').map(str::parse).collect::<Result<_, _>>().ok()?;
    <[f64; 3]>::try_from(numbers).ok().map(Vec3::from)
}

/// The one of a few that is meant.
fn named<T: Copy>(all: &[T], is: impl Fn(&T) -> bool) -> Option<T> {
    all.iter().copied().find(|one| is(one))
}
