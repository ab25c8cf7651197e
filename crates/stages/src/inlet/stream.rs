//! An inlet stream: recorded particles that are read as the run needs them.

use crate::clump_info::{ClumpInfo, SLACK};
use crate::crossings::{self, CROSSINGS, Passage, Sizes, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::feeds::Item;
use crate::gate::Gate;
use crate::input::Said;
use crate::links::{self, BONDS, LINKS, Linking};
use crate::material_info::MaterialInfo;
use crate::paths::{self, PATHS, Waypoint};
use crate::touches::{self, TOUCHES, Touching};
use dem::setup::{Entry, EntryBonds, EntryClump, Guide, Sample, ZoneMotion};
use geom::{Plane, Shown};
use std::collections::{BTreeMap, VecDeque};
use std::io::Read;
use stream::mcap::{Event, Reader};

/// Bytes of a file or a pipe.
pub type Source = Box<dyn Read + Send>;

/// Name of the metadata record that an inlet stream has.
pub const INLET: &str = "inlet";

/// Grains that come in after this share of a record came until its end.
const STILL: f64 = 0.9;

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
    /// Whether all that it brings are clumps.
    pub(crate) only_clumps: bool,
    /// What it says of its materials, by index.
    pub materials: Vec<MaterialInfo>,
    /// What it says of its clumps, by index.
    pub(crate) clumps: Vec<ClumpInfo>,
    /// The bonds it can bring.
    pub(crate) bonds: Option<EntryBonds>,
    /// Material of the scene for each of the stream's.
    pub(crate) to_scene: Vec<u16>,
    /// Clump of the scene for each of the stream's.
    pub(crate) to_shapes: Vec<u32>,
    pub(crate) inlet: u32,
    reader: Reader<Source>,
    pending: VecDeque<Passage>,
    /// What contacts of those that come have to remember.
    touches: VecDeque<Touching>,
    /// Which of those that come are bonded.
    links: VecDeque<Linking>,
    /// All passages before this time have been read [s].
    known: f64,
    /// What the stream itself says of that: it does not say ∞ at its end [s].
    told: f64,
    last: f64,
    paths: Paths,
}

/// What is known of recorded paths.
#[derive(Default)]
struct Paths {
    waypoints: VecDeque<Waypoint>,
    /// Who is on its way in, and when it was seen last [s].
    present: BTreeMap<u32, f64>,
    /// Who has just passed, and when [s].
    passed: BTreeMap<u32, f64>,
    /// Items that were made and not given.
    made: VecDeque<Item>,
    last: f64,
}

impl InletStream {
    /// A stream whose metadata was read up to `first`, its first message.
    pub(crate) fn new(
        name: &str,
        reader: Reader<Source>,
        sizes: Sizes,
        Said { gate, materials, clumps, only_clumps, bonds, .. }: Said,
        first: Option<Event>,
    ) -> Result<InletStream, SceneError> {
        let mut stream = InletStream {
            name: name.to_owned(),
            gate,
            sizes,
            only_clumps,
            to_scene: (0..materials.len() as u16).collect(),
            to_shapes: (0..clumps.len() as u32).collect(),
            materials,
            clumps,
            bonds,
            inlet: 0,
            reader,
            pending: VecDeque::new(),
            touches: VecDeque::new(),
            links: VecDeque::new(),
            known: f64::NEG_INFINITY,
            told: f64::NEG_INFINITY,
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

    /// Up to when the stream told what comes in [s], where it has ended, and the last grains came in shortly before.
    pub(crate) fn ended(&self) -> Option<f64> {
        let last = self.last.max(self.paths.last);
        (self.known == f64::INFINITY && last > STILL * self.told).then_some(self.told)
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
            while let Some(t) = self.touches.pop_front_if(|t| t.time <= time) {
                self.paths.made.push_back(Item::Remember { time, memory: t.memory });
            }
            while let Some(l) = self.links.pop_front_if(|l| l.time <= time) {
                self.paths.made.push_back(Item::Link { time, link: l.link });
            }
            if self.recorded() {
                self.paths.passed.insert(id, time);
                self.paths.made.push_back(Item::Guide { time, id, guide: Guide::Free(self.sample(passage)) });
            }
            return;
        }
        let Some(Waypoint { passage, gone }) = self.paths.waypoints.pop_front() else { return };
        let (id, time) = (passage.particle.id, passage.time);
        // A passage at the very time of a sample may come before it, by rounding: the sample says nothing new.
        let same = |t: f64| time - t <= 4.0 * f64::EPSILON * time.abs();
        self.paths.passed.retain(|_, t| same(*t));
        if self.paths.passed.contains_key(&id) {
            return;
        }
        let known = if gone { self.paths.present.remove(&id) } else { self.paths.present.insert(id, time) };
        match (known, gone) {
            (None, true) => {}
            (None, false) => self.paths.made.push_back(Item::Enter(self.entry(passage))),
            (Some(_), true) => self.paths.made.push_back(Item::Guide { time, id, guide: Guide::Gone }),
            (Some(_), false) => {
                self.paths.made.push_back(Item::Guide { time, id, guide: Guide::At(self.sample(passage)) });
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
        let shape = |c: EntryClump| EntryClump { shape: self.to_shapes[c.shape as usize], ..c };
        let clump = passage.clump.map(|c| shape(c.0));
        Entry { time: passage.time, inlet: self.inlet, particle, clump, turn: passage.turn }
    }

    fn sample(&self, passage: Passage) -> Sample {
        Sample::of(&self.entry(passage))
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
            Event::Points { topic, table, .. } if topic == TOUCHES => {
                self.touches.extend(touches::from_table(&self.name, &table)?);
            }
            Event::Points { topic, table, .. } if topic == LINKS => {
                if self.bonds.is_none() {
                    let why = format!("has bonds ({LINKS}), which no record '{BONDS}' announces");
                    return Err(SceneError::file(&self.name, why, "write the stream again"));
                }
                self.links.extend(links::from_table(&self.name, &table)?);
            }
            Event::Points { topic, table, .. } if topic == PATHS && self.recorded() => {
                for way in paths::from_table(&self.name, &table, self.materials.len())? {
                    self.in_time(&way.passage, self.paths.last)?;
                    self.announced(&way.passage)?;
                    self.paths.last = way.passage.time;
                    self.paths.waypoints.push_back(way);
                }
            }
            Event::Bytes { topic, data, .. } if topic == WATERMARK => {
                self.told = self.told.max(Watermark::read(&self.name, &data)?.until);
                self.known = self.known.max(self.told);
            }
            _ => {}
        }
        Ok(())
    }

    fn check(&self, passage: &Passage) -> Result<(), SceneError> {
        self.in_time(passage, self.last)?;
        self.announced(passage)
    }

    /// Refuses what the records do not announce.
    fn announced(&self, passage: &Passage) -> Result<(), SceneError> {
        let id = passage.particle.id;
        if let Some((clump, _)) = passage.clump {
            let scales = self.clumps.get(clump.shape as usize).and_then(|info| info.scales);
            return match scales {
                Some((low, high))
                    if low * (1.0 - SLACK) <= clump.scale && clump.scale <= high * (1.0 + SLACK) =>
                {
                    Ok(())
                }
                _ => {
                    let why = format!("clump {id} has shape {} and scale {}", clump.shape, clump.scale);
                    let why = format!("{why}, which its record 'clumps' does not announce");
                    Err(SceneError::file(&self.name, why, "write the stream again"))
                }
            };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Input;
    use crate::material_info::MATERIALS;
    use dem::setup::{Particle, Zone, ZoneTest};
    use geom::Vec3;
    use stream::mcap::{Provenance, Writer};

    fn passage(time: f64) -> Passage {
        let (position, velocity) = (Vec3::new(0.0, 0.0, 0.01 - time), Vec3::new(0.0, 0.0, -1.0));
        let particle = Particle { id: 1, material: 0, radius: 0.01, position, velocity, spin: Vec3::zeros() };
        Passage { time, outlet: 0, particle, contacts: 0, clump: None, turn: None }
    }

    /// Samples and one passage of a grain along a recorded path.
    fn stream(samples: &[f64], passes: f64) -> InletStream {
        let mut writer = Writer::new(Vec::new(), &Provenance::default()).unwrap();
        let one = |value: &str| BTreeMap::from([("0".to_owned(), value.to_owned())]);
        let plane = "0,0,0,0,0,-1".parse().unwrap();
        let zone = Zone { plane, length: 0.03, motion: ZoneMotion::Recorded, test: ZoneTest::Centre };
        let gate = Gate { zone, gravity: None, plant: None, samples: Some(0.1) };
        writer.metadata(MATERIALS, one(r#"{"name":"m","density":1000.0}"#)).unwrap();
        writer.metadata(crossings::SIZES, Sizes { smallest: 0.01, largest: 0.01 }.to_map()).unwrap();
        writer.metadata(INLET, gate.to_map()).unwrap();
        let way = |&time: &f64| Waypoint { passage: passage(time), gone: false };
        let ways: Vec<Waypoint> = samples.iter().map(way).collect();
        writer.points(PATHS, 0, "world", paths::to_table(&ways)).unwrap();
        writer.points(CROSSINGS, 0, "world", crossings::to_table(&[passage(passes)])).unwrap();
        let bytes = writer.finish().unwrap();
        match Input::open("in", Box::new(std::io::Cursor::new(bytes))).unwrap() {
            Input::Inlet(stream) => *stream,
            Input::Walls(_) => panic!("an inlet"),
        }
    }

    /// What comes of it: E enters, A is at a sample, F is free.
    fn items(samples: &[f64], passes: f64) -> String {
        let mut stream = stream(samples, passes);
        let mut found = String::new();
        while let Some(item) = stream.next_until(f64::INFINITY).unwrap() {
            found.push(match item {
                Item::Enter(_) => 'E',
                Item::Guide { guide: Guide::At(_), .. } => 'A',
                Item::Guide { guide: Guide::Free(_), .. } => 'F',
                Item::Guide { guide: Guide::Gone, .. } => 'G',
                Item::Remember { .. } => 'R',
                Item::Link { .. } => 'L',
            });
        }
        found
    }

    /// A passage a rounding before a sample of the same instant: the grain comes in once.
    #[test]
    fn a_passage_at_the_time_of_a_sample_is_one_grain() {
        let sample = 0.30000000000000004;
        for passes in [sample, 0.3, 0.3 - 1e-16] {
            assert_eq!(items(&[0.1, 0.2, sample], passes), "EAF", "{passes:?}");
            assert_eq!(items(&[sample], passes), "EF", "{passes:?}");
        }
        assert_eq!(items(&[0.1, 0.2], 0.3), "EAF");
        // Another grain of the same id is no rounding: whoever takes both refuses the second.
        assert_eq!(items(&[0.1, 0.4], 0.3), "EFEG");
    }
}
