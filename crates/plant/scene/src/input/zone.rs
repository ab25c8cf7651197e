//! The zone of a cut in records, so that both stages agree where it is and how particles cross it.

use crate::error::{Result, SceneError};
use dem::setup::{Zone, ZoneMotion, ZoneTest};
use geom::Vec3;
use record::Map;
use serde::{Deserialize, Serialize};

/// A zone, and what else both stages must have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ZoneRecord {
    /// Its plane and length, the motion in it, and which point of a particle crosses its planes.
    #[serde(flatten)]
    pub zone: Zone,
    /// Acceleration of free fall [m/s²] where it was recorded.
    #[serde(default)]
    pub gravity: Option<Vec3>,
    /// Mark of the plant upstream, which stage-split writes.
    #[serde(default)]
    pub plant: Option<String>,
    /// Time between samples of recorded paths [s].
    #[serde(default)]
    pub samples: Option<f64>,
}

impl ZoneRecord {
    /// The record.
    pub fn to_map(&self) -> Map {
        let zone = &self.zone;
        let mut map = Map::from([
            ("plane".to_owned(), zone.plane.to_string()),
            ("length".to_owned(), zone.length.to_string()),
            ("motion".to_owned(), zone.motion.name().to_owned()),
            ("test".to_owned(), zone.test.name().to_owned()),
        ]);
        map.extend(self.gravity.map(|g| ("gravity".to_owned(), format!("{},{},{}", g.x, g.y, g.z))));
        map.extend(self.plant.clone().map(|plant| ("plant".to_owned(), plant)));
        map.extend(self.samples.map(|time| ("samples".to_owned(), time.to_string())));
        map
    }

    /// From a record; keys that older versions did not write have the defaults of these versions.
    ///
    /// # Errors
    /// A key that is missing or wrong.
    pub fn from_map(stream: &str, record: &str, map: &Map) -> Result<ZoneRecord> {
        let text = |key: &str| map.get(key).map_or("", String::as_str);
        let wrong = |key: &str, why: String| {
            let why = format!("record '{record}': {key} = {}: {why}", text(key));
            SceneError::file(stream, why, "run stage-replay again")
        };
        let number = |key: &str| record::positive(stream, record, map, key);
        let unknown = |key: &str| wrong(key, "is not known to this version".to_owned());
        let plane = text("plane").parse();
        let plane = plane.map_err(|e: geom::plane::PlaneError| wrong("plane", e.to_string()))?;
        let motion = named(map.get("motion"), &ZoneMotion::ALL, ZoneMotion::name);
        let motion = motion.ok_or_else(|| unknown("motion"))?;
        let test = named(map.get("test"), &ZoneTest::ALL, ZoneTest::name).ok_or_else(|| unknown("test"))?;
        let vector =
            |text: &String| vector(text).ok_or_else(|| wrong("gravity", "wanted: three numbers".to_owned()));
        let gravity = map.get("gravity").map(vector).transpose()?;
        let zone = Zone { plane, length: number("length")?, motion, test, when_blocked: None };
        let samples = map.contains_key("samples").then(|| number("samples")).transpose()?;
        Ok(ZoneRecord { zone, gravity, plant: map.get("plant").cloned(), samples })
    }
}

/// The one that has this name, or the default where none is given.
fn named<T: Copy + Default>(name: Option<&String>, all: &[T], of: fn(T) -> &'static str) -> Option<T> {
    name.map_or(Some(T::default()), |name| all.iter().copied().find(|one| of(*one) == name))
}

/// Three numbers with commas between.
fn vector(text: &str) -> Option<Vec3> {
    let numbers: Vec<f64> = text.split(',').map(str::parse).collect::<Result<_, _>>().ok()?;
    <[f64; 3]>::try_from(numbers).ok().map(Vec3::from)
}
