//! An inlet stream: recorded particles that are read as the run needs them.

use crate::crossings::{self, CROSSINGS, Passage, Sizes, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::material_info::MaterialInfo;
use dem::setup::{Entry, Zone};
use geom::{Plane, Shown};
use std::collections::{BTreeMap, VecDeque};
use std::io::Read;
use stream::mcap::{Event, Reader};

/// Bytes of a file or a pipe.
pub type Source = Box<dyn Read + Send>;

/// Name of the metadata record that an inlet stream has.
pub const INLET: &str = "inlet";

/// The record `inlet`: where the positions of the stream lie.
pub fn zone_to_map(zone: &Zone) -> BTreeMap<String, String> {
    BTreeMap::from([
        ("plane".to_owned(), plane_text(&zone.plane)),
        ("length".to_owned(), zone.length.to_string()),
    ])
}

/// A plane as the command line writes it.
pub fn plane_text(plane: &Plane) -> String {
    let (p, n) = (plane.point, plane.normal);
    format!("{},{},{},{},{},{}", p.x, p.y, p.z, n.x, n.y, n.z)
}

/// The zone in a record.
///
/// # Errors
/// A key that is missing or wrong.
pub fn zone_from_map(stream: &str, record: &str, map: &BTreeMap<String, String>) -> Result<Zone, SceneError> {
    let length = crossings::number(stream, record, map, "length")?;
    let text = map.get("plane").map_or("", String::as_str);
    let wrong = |e: geom::plane::PlaneError| {
        SceneError::file(stream, format!("record '{record}': plane = {text}: {e}"), "run the tool again")
    };
    Ok(Zone { plane: text.parse().map_err(wrong)?, length })
}

/// A stream of recorded particles.
pub struct InletStream {
    /// Its name, for messages.
    pub name: String,
    /// Its zone, when it tells.
    pub zone: Option<Zone>,
    /// The sizes it can bring.
    pub sizes: Sizes,
    /// What it says of its materials, by index.
    pub materials: Vec<MaterialInfo>,
    /// Material of the scene for each of the stream's.
    pub(crate) to_scene: Vec<u16>,
    pub(crate) inlet: u32,
    reader: Reader<Source>,
    pending: VecDeque<Passage>,
    /// All passages before this time have been read [s].
    known: f64,
    last: f64,
}

impl InletStream {
    /// A stream whose metadata was read up to `first`, its first message.
    pub(crate) fn new(
        name: &str,
        reader: Reader<Source>,
        (zone, sizes): (Option<Zone>, Sizes),
        materials: Vec<MaterialInfo>,
        first: Option<Event>,
    ) -> Result<InletStream, SceneError> {
        let mut stream = InletStream {
            name: name.to_owned(),
            zone,
            sizes,
            to_scene: (0..materials.len() as u16).collect(),
            materials,
            inlet: 0,
            reader,
            pending: VecDeque::new(),
            known: f64::NEG_INFINITY,
            last: f64::NEG_INFINITY,
        };
        if let Some(event) = first {
            stream.take(event)?;
        }
        Ok(stream)
    }

    /// The next particle whose time is at most `time` [s]; waits until the stream has told all of those.
    ///
    /// # Errors
    /// A stream that breaks off, or is out of order.
    pub(crate) fn next_until(&mut self, time: f64) -> Result<Option<Entry>, SceneError> {
        loop {
            if let Some(passage) = self.pending.front() {
                if passage.time > time {
                    return Ok(None);
                }
                let passage = *passage;
                self.pending.pop_front();
                return Ok(Some(self.entry(passage)));
            }
            if self.known > time || self.known == f64::INFINITY {
                return Ok(None);
            }
            match self.reader.next() {
                None => self.known = f64::INFINITY,
                Some(event) => {
                    let event = event.map_err(|e| SceneError::Content {
                        name: self.name.clone(),
                        wanted: "an inlet",
                        source: e.into(),
                    })?;
                    self.take(event)?;
                }
            }
        }
    }

    fn entry(&self, passage: Passage) -> Entry {
        let mut particle = passage.particle;
        particle.material = self.to_scene[particle.material as usize];
        Entry { time: passage.time, inlet: self.inlet, particle, clump: None }
    }

    fn take(&mut self, event: Event) -> Result<(), SceneError> {
        match event {
            Event::Points { topic, table, .. } if topic == CROSSINGS => {
                for passage in crossings::from_table(&self.name, &table, self.materials.len())? {
                    self.check(&passage)?;
                    self.last = passage.time;
                    self.pending.push_back(passage);
                }
            }
            Event::Bytes { topic, data, .. } if topic == WATERMARK => {
                self.known = self.known.max(Watermark::read(&self.name, &data)?.until);
            }
            _ => {}
        }
        Ok(())
    }

    fn check(&self, passage: &Passage) -> Result<(), SceneError> {
        let (time, id) = (passage.time, passage.particle.id);
        if time < self.last || time < self.known {
            let why = format!(
                "particle {id} passes at {} s, after {} s was told",
                Shown(time),
                Shown(self.last.max(self.known))
            );
            return Err(SceneError::file(
                &self.name,
                why,
                "crossings must come in time order: run stage-replay again",
            ));
        }
        let radius = passage.particle.radius;
        if radius < self.sizes.smallest || radius > self.sizes.largest {
            let range = format!("{} to {} m", Shown(self.sizes.smallest), Shown(self.sizes.largest));
            let why = format!(
                "particle {id} has a radius of {} m, outside the {range} of its record 'sizes'",
                Shown(radius)
            );
            return Err(SceneError::file(&self.name, why, "write the stream again"));
        }
        Ok(())
    }
}
