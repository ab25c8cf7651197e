//! An inlet stream: recorded particles that are read as the run needs them.

use super::Arrival;
use super::announced;
use super::paths::Paths;
use crate::order::Order;
use crate::outlet::bond::{self, BondRow};
use crate::outlet::contact::{self, ContactRow};
use crate::outlet::crossing::{self, CrossingRow};
use crate::outlet::path;
use dem::setup::{Entry, EntryClump, Guide, Sample, ZoneMotion};
use record::{RecordError, Watermark, metadata, topic};
use scene::input::ZoneRecord;
use scene::plan::PlannedInlet;
use scene::{Result, SceneError};
use std::collections::VecDeque;
use stream::mcap::Event;

/// A record whose last crossing comes after this share of it still had a flow at its end [–].
const STILL_FLOWS: f64 = 0.9;

/// A stream of recorded particles.
pub struct InletStream {
    plan: PlannedInlet,
    crossings: VecDeque<CrossingRow>,
    contacts: VecDeque<ContactRow>,
    bonds: VecDeque<BondRow>,
    paths: Paths,
    /// Arrivals that were made and not given.
    made: VecDeque<Arrival>,
    /// All rows before this time have been read [s]; ∞ at the end of the stream.
    known: f64,
    /// Times that the stream has reached.
    order: Order,
    /// When the last of the crossings that were read is at the plane [s].
    last: f64,
    /// The last watermark that a later row, watermark or the end of the stream has not contradicted [s].
    confirmed: f64,
    /// Why the stream broke off, where what was needed of it had been read.
    broken: Option<SceneError>,
}

impl InletStream {
    /// A stream whose head was read.
    ///
    /// # Errors
    /// A first message that is wrong.
    pub fn new(mut plan: PlannedInlet) -> Result<InletStream> {
        let first = plan.source.first.take();
        let mut stream = InletStream {
            plan,
            crossings: VecDeque::new(),
            contacts: VecDeque::new(),
            bonds: VecDeque::new(),
            paths: Paths::default(),
            made: VecDeque::new(),
            known: f64::NEG_INFINITY,
            order: Order::default(),
            last: f64::NEG_INFINITY,
            confirmed: f64::NEG_INFINITY,
            broken: None,
        };
        first.map_or(Ok(()), |event| stream.take(event))?;
        Ok(stream)
    }

    /// Its name, for messages.
    pub fn name(&self) -> &str {
        &self.plan.source.name
    }

    /// Time between samples of recorded paths [s]; 0 without any.
    pub fn samples(&self) -> f64 {
        self.plan.source.zone.as_ref().and_then(|zone| zone.samples).unwrap_or(0.0)
    }

    /// The next arrival whose time is at most `time` [s]; waits until the stream has passed it.
    ///
    /// # Errors
    /// A stream that breaks off, or is out of order.
    pub fn next_until(&mut self, time: f64) -> Result<Option<Arrival>> {
        loop {
            if let Some(arrival) = self.made.pop_front() {
                return Ok(Some(arrival));
            }
            let crossing = self.crossings.front().map(|row| row.time);
            let sample = self.paths.rows.front().map(|row| row.row.time);
            let crosses = crossing.is_some_and(|c| sample.is_none_or(|s| c <= s));
            // Rows of two topics come in the order of their times only up to the watermark.
            let sure = |t: f64| !self.recorded() || t <= self.known;
            match if crosses { crossing } else { sample } {
                Some(t) if t <= time && sure(t) => {
                    if crosses {
                        self.cross()
                    } else {
                        self.sample()
                    }
                    continue;
                }
                Some(_) if !self.recorded() => return Ok(None),
                None if self.known == f64::INFINITY && !self.paths.present.is_empty() => {
                    self.made.extend(self.paths.end());
                    continue;
                }
                _ if self.confirmed > time || self.confirmed == f64::INFINITY => return Ok(None),
                _ => {}
            }
            self.read()?;
        }
    }

    /// Reads the next event.
    fn read(&mut self) -> Result<()> {
        if let Some(error) = self.broken.take() {
            return Err(error);
        }
        match self.plan.source.reader.next() {
            None => (self.known, self.confirmed) = (f64::INFINITY, f64::INFINITY),
            Some(Ok(event)) => self.take(event)?,
            Some(Err(e)) => {
                let error = SceneError::content(self.name(), "an inlet", e);
                if self.confirmed >= self.known {
                    return Err(error);
                }
                // What the last watermark vouches for has been read.
                (self.confirmed, self.broken) = (self.known, Some(error));
            }
        }
        Ok(())
    }

    /// Reads a file on to its end, after a run that stopped before: a watermark that was too late has hidden particles.
    ///
    /// # Errors
    /// Rows or watermarks that are out of order. What breaks off is none: nothing of it was needed.
    pub fn check_rest(&mut self) -> Result<()> {
        if !self.plan.source.file || self.broken.is_some() {
            return Ok(());
        }
        while let Some(Ok(event)) = self.plan.source.reader.next() {
            self.take(event)?;
            self.drop_read();
        }
        Ok(())
    }

    /// Reads a file as a run until `time` [s] would, and on to its end; of a pipe nothing, which can be read only once.
    ///
    /// # Errors
    /// As [`InletStream::next_until`] and [`InletStream::check_rest`].
    pub fn check(&mut self, time: f64) -> Result<()> {
        while self.plan.source.file && self.next_until(time)?.is_some() {}
        self.check_rest()
    }

    /// Forgets what was read.
    fn drop_read(&mut self) {
        self.crossings.clear();
        self.contacts.clear();
        self.bonds.clear();
        self.paths.rows.clear();
    }

    /// Time at which the stream ended while particles still came in [s].
    pub fn ended(&self) -> Option<f64> {
        let watermark = self.order.watermark();
        // Without watermarks the last crossing is all that is known.
        let last = self.last.max(self.order.last());
        let flows = self.known == f64::INFINITY && last > STILL_FLOWS * watermark;
        flows.then_some(watermark.max(last))
    }

    /// When the particle of a row is at the plane [s]: a prescribed motion brings it there.
    fn passes(&self, row: &CrossingRow) -> f64 {
        let Some(ZoneRecord { zone, gravity, .. }) = &self.plan.source.zone else { return row.time };
        let (at, velocity) = (&row.particle.position, &row.particle.velocity);
        let past = zone.past(at, row.particle.radius);
        row.time + zone.arrives_after(past, velocity, &gravity.unwrap_or_default()).unwrap_or(0.0)
    }

    fn recorded(&self) -> bool {
        self.plan.source.zone.as_ref().is_some_and(|z| z.zone.motion == ZoneMotion::Recorded)
    }

    /// Makes the arrivals of the next crossing.
    fn cross(&mut self) {
        let Some(row) = self.crossings.pop_front() else { return };
        let (id, time) = (row.particle.id, row.time);
        let entry = self.entry(&row);
        if self.paths.present.remove(&id).is_none() {
            self.made.push_back(Arrival::Enter(entry));
        }
        while let Some(c) = self.contacts.pop_front_if(|c| c.time <= time) {
            self.made.push_back(Arrival::History { time, pair: c.pair });
        }
        while let Some(b) = self.bonds.pop_front_if(|b| b.time <= time) {
            self.made.push_back(Arrival::Bond { time, bond: b.bond });
        }
        if self.recorded() {
            self.paths.crossed.insert(id, time);
            let guide = Guide::Free(Sample::of(&entry));
            self.made.push_back(Arrival::Guide { time, id, guide });
        }
    }

    /// Makes the arrival of the next sample of a path.
    fn sample(&mut self) {
        let Some(row) = self.paths.rows.pop_front() else { return };
        let entry = self.entry(&row.row);
        self.made.extend(self.paths.sample(&row, entry));
    }

    /// A row with the indices of the scene.
    fn entry(&self, row: &CrossingRow) -> Entry {
        let mut particle = row.particle;
        particle.material = self.plan.materials[particle.material as usize];
        let shape = |c: EntryClump| EntryClump { shape: self.plan.shapes[c.shape as usize], ..c };
        let clump = row.clump.map(|c| shape(c.0));
        Entry {
            time: row.time,
            inlet: self.plan.inlet,
            particle,
            clump,
            turn: row.turn,
            cluster: row.cluster,
        }
    }

    fn take(&mut self, event: Event) -> Result<()> {
        let (source, materials) = (&self.plan.source, self.plan.materials.len());
        let name = &source.name;
        match event {
            Event::Points { topic, table, .. } if topic == topic::CROSSINGS => {
                for row in crossing::from_table(name, &table, materials)? {
                    self.order.take_crossing(name, row.particle.id, row.time)?;
                    announced::check(source, &row)?;
                    self.last = self.last.max(self.passes(&row));
                    self.confirmed = self.known;
                    self.crossings.push_back(row);
                }
            }
            Event::Points { topic, table, .. } if topic == topic::CROSSING_CONTACTS => {
                self.contacts.extend(contact::from_table(name, &table)?);
            }
            Event::Points { topic, table, .. } if topic == topic::CROSSING_BONDS => {
                if source.bonds.is_none() {
                    let (topic, record) = (topic::CROSSING_BONDS, metadata::BONDS);
                    let why = format!("has bonds ({topic}), but no record '{record}'");
                    return Err(RecordError::new(name, why, "write the stream again").into());
                }
                self.bonds.extend(bond::from_table(name, &table)?);
            }
            Event::Points { topic, table, .. } if topic == topic::PATHS && self.recorded() => {
                for row in path::from_table(name, &table, materials)? {
                    self.order.take_sample(name, row.row.particle.id, row.row.time)?;
                    announced::check(source, &row.row)?;
                    self.confirmed = self.known;
                    self.paths.rows.push_back(row);
                }
            }
            Event::Bytes { topic, data, .. } if topic == topic::WATERMARK => {
                let until = Watermark::read(name, &data)?.until;
                self.order.take_watermark(name, until)?;
                (self.confirmed, self.known) = (self.known, until);
            }
            _ => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outlet::path::PathRow;
    use dem::setup::{Particle, Zone, ZoneTest};
    use geom::Vec3;
    use record::{Map, Sizes};
    use scene::Input;
    use scene::input::ZoneRecord;
    use stream::mcap::{Provenance, Writer};

    fn row(time: f64) -> CrossingRow {
        let (position, velocity) = (Vec3::new(0.0, 0.0, 0.01 - time), Vec3::new(0.0, 0.0, -1.0));
        let particle = Particle { id: 1, material: 0, radius: 0.01, position, velocity, spin: Vec3::zeros() };
        CrossingRow { time, outlet: 0, particle, contacts: 0, clump: None, turn: None, cluster: 0 }
    }

    /// Samples and the crossing of one particle along a recorded path.
    fn stream(samples: &[f64], crosses: f64) -> InletStream {
        let mut writer = Writer::new(Vec::new(), &Provenance::default()).unwrap();
        let one = |value: &str| Map::from([("0".to_owned(), value.to_owned())]);
        let plane = "0,0,0,0,0,-1".parse().unwrap();
        let zone = Zone {
            plane,
            length: 0.03,
            motion: ZoneMotion::Recorded,
            test: ZoneTest::Centre,
            when_blocked: None,
        };
        let zone = ZoneRecord { zone, gravity: None, plant: None, samples: Some(0.1) };
        writer.metadata(metadata::MATERIALS, one(r#"{"name":"m","density":1000.0}"#)).unwrap();
        writer.metadata(metadata::SIZES, Sizes { smallest: 0.01, largest: 0.01 }.to_map()).unwrap();
        writer.metadata(metadata::INLET, zone.to_map()).unwrap();
        let sample = |&time: &f64| PathRow { row: row(time), gone: false };
        let samples: Vec<PathRow> = samples.iter().map(sample).collect();
        writer.points(topic::PATHS, 0, "world", path::to_table(&samples)).unwrap();
        writer.points(topic::CROSSINGS, 0, "world", crossing::to_table(&[row(crosses)])).unwrap();
        let bytes = writer.finish().unwrap();
        match Input::open("in", Box::new(std::io::Cursor::new(bytes))).unwrap() {
            Input::Inlet(source) => {
                let plan = PlannedInlet { source: *source, inlet: 0, materials: vec![0], shapes: Vec::new() };
                InletStream::new(plan).unwrap()
            }
            Input::Walls(_) => panic!("an inlet"),
        }
    }

    /// Its arrivals: E enters, A is at a sample, F is free.
    fn items(samples: &[f64], crosses: f64) -> String {
        let mut stream = stream(samples, crosses);
        let mut found = String::new();
        while let Some(item) = stream.next_until(f64::INFINITY).unwrap() {
            found.push(match item {
                Arrival::Enter(_) => 'E',
                Arrival::Guide { guide: Guide::At(_), .. } => 'A',
                Arrival::Guide { guide: Guide::Free(_), .. } => 'F',
                Arrival::Guide { guide: Guide::Gone, .. } => 'G',
                Arrival::History { .. } => 'R',
                Arrival::Bond { .. } => 'B',
            });
        }
        found
    }

    /// A crossing a rounding before a sample of the same instant: the particle comes in once.
    #[test]
    fn a_crossing_at_the_time_of_a_sample_is_one_particle() {
        let sample = 0.30000000000000004;
        for crosses in [sample, 0.3, 0.3 - 1e-16] {
            assert_eq!(items(&[0.1, 0.2, sample], crosses), "EAF", "{crosses:?}");
            assert_eq!(items(&[sample], crosses), "EF", "{crosses:?}");
        }
        assert_eq!(items(&[0.1, 0.2], 0.3), "EAF");
        // Another particle of the same id is not a rounding: the engine refuses the second.
        assert_eq!(items(&[0.1, 0.4], 0.3), "EFEG");
    }
}
