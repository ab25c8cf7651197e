//! An inlet stream: recorded particles that are read as the run needs them.

use crate::crossings::{self, CROSSINGS, Passage, Sizes, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::feeds::Item;
use crate::gate::Gate;
use crate::material_info::MaterialInfo;
use crate::paths::{self, PATHS, Waypoint};
use dem::setup::{Entry, Guide, Sample, ZoneMotion};
use geom::{Plane, Shown};
use std::collections::{BTreeMap, VecDeque};
use std::io::Read;
use stream::mcap::{Event, Reader};

/// Bytes of a file or a pipe.
pub type Source = Box<dyn Read + Send>;

/// Name of the metadata record that an inlet stream has.
pub const INLET: &str = "inlet";

/// A plane as the command line writes it.
pub fn plane_text(plane: &Plane) -> String {
    let (p, n) = (plane.point, plane.normal);
    format!("{},{},{},{},{},{}", p.x, p.y, p.z, n.x, n.y, n.z)
}

/// A stream of recorded particles.
pub struct InletStream {
    /// Its name, for messages.
    pub name: String,
    /// Its gate, when it tells.
    pub gate: Option<Gate>,
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
    paths: Paths,
}

/// What is known of recorded paths.
#[derive(Default)]
struct Paths {
    waypoints: VecDeque<Waypoint>,
    /// Who is on its way in, and when it was seen last [s].
    present: BTreeMap<u32, f64>,
    /// Items that were made and not given.
    made: VecDeque<Item>,
    last: f64,
}

impl InletStream {
    /// A stream whose metadata was read up to `first`, its first message.
    pub(crate) fn new(
        name: &str,
        reader: Reader<Source>,
        (gate, sizes): (Option<Gate>, Sizes),
        materials: Vec<MaterialInfo>,
        first: Option<Event>,
    ) -> Result<InletStream, SceneError> {
        let mut stream = InletStream {
            name: name.to_owned(),
            gate,
            sizes,
            to_scene: (0..materials.len() as u16).collect(),
            materials,
            inlet: 0,
            reader,
            pending: VecDeque::new(),
            known: f64::NEG_INFINITY,
            last: f64::NEG_INFINITY,
            paths: Paths::default(),
        };
        if let Some(event) = first {
            stream.take(event)?;
        }
        Ok(stream)
    }

    /// The next item whose time is at most `time` [s]; waits until the stream has told all of those.
    ///
    /// # Errors
    /// A stream that breaks off, or is out of order.
    pub(crate) fn next_until(&mut self, time: f64) -> Result<Option<Item>, SceneError> {
        loop {
            if let Some(item) = self.paths.made.pop_front() {
                return Ok(Some(item));
            }
            let passes = self.pending.front().map(|p| p.time);
            let passes_next = match (passes, self.paths.waypoints.front()) {
                (Some(passes), Some(way)) => passes <= way.passage.time,
                (passes, _) => passes.is_some(),
            };
            let next =
                if passes_next { passes } else { self.paths.waypoints.front().map(|w| w.passage.time) };
            // Rows of two topics come in the order of their times only up to what was promised.
            let sure = |t: f64| !self.recorded() || t <= self.known;
            match next {
                Some(t) if t <= time && sure(t) => {
                    self.make(passes_next);
                    continue;
                }
                Some(_) if !self.recorded() => return Ok(None),
                None if self.known == f64::INFINITY && !self.paths.present.is_empty() => {
                    self.vanish();
                    continue;
                }
                _ if self.known > time || self.known == f64::INFINITY => return Ok(None),
                _ => {}
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

    fn recorded(&self) -> bool {
        self.gate.as_ref().is_some_and(|g| g.zone.motion == ZoneMotion::Recorded)
    }

    /// Makes items of the next row of one of the topics.
    fn make(&mut self, passes: bool) {
        if passes {
            let Some(passage) = self.pending.pop_front() else { return };
            let (id, time) = (passage.particle.id, passage.time);
            let known = self.paths.present.remove(&id).is_some();
            if !known {
                self.paths.made.push_back(Item::Enter(self.entry(passage)));
            }
            if self.recorded() {
                self.paths.made.push_back(Item::Guide { time, id, guide: Guide::Free(sample(&passage)) });
            }
            return;
        }
        let Some(Waypoint { passage, gone }) = self.paths.waypoints.pop_front() else { return };
        let (id, time) = (passage.particle.id, passage.time);
        let known = if gone { self.paths.present.remove(&id) } else { self.paths.present.insert(id, time) };
        match (known, gone) {
            (None, true) => {}
            (None, false) => self.paths.made.push_back(Item::Enter(self.entry(passage))),
            (Some(_), true) => self.paths.made.push_back(Item::Guide { time, id, guide: Guide::Gone }),
            (Some(_), false) => {
                self.paths.made.push_back(Item::Guide { time, id, guide: Guide::At(sample(&passage)) });
            }
        }
    }

    /// The record has ended: who had not passed by then goes no farther.
    fn vanish(&mut self) {
        for (id, time) in std::mem::take(&mut self.paths.present) {
            self.paths.made.push_back(Item::Guide { time, id, guide: Guide::Gone });
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
            Event::Points { topic, table, .. } if topic == PATHS && self.recorded() => {
                for way in paths::from_table(&self.name, &table, self.materials.len())? {
                    self.in_time(&way.passage, self.paths.last)?;
                    self.paths.last = way.passage.time;
                    self.paths.waypoints.push_back(way);
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
        self.in_time(passage, self.last)?;
        let id = passage.particle.id;
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

    fn in_time(&self, passage: &Passage, last: f64) -> Result<(), SceneError> {
        let (time, id) = (passage.time, passage.particle.id);
        if time < last || time < self.known {
            let why = format!(
                "particle {id} passes at {} s, after {} s was told",
                Shown(time),
                Shown(last.max(self.known))
            );
            return Err(SceneError::file(
                &self.name,
                why,
                "crossings must come in time order: run stage-replay again",
            ));
        }
        Ok(())
    }
}

fn sample(passage: &Passage) -> Sample {
    let p = &passage.particle;
    Sample { time: passage.time, position: p.position, velocity: p.velocity, spin: p.spin }
}
