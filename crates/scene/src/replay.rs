//! From the crossings of a run to an inlet stream, also while the run is still being written (SYSTEMS B4).

mod copies;
mod frame;
mod head;
mod order;
mod recall;
mod start;

pub use copies::Copies;
pub use frame::Frame;

use crate::crossings::{self, CROSSINGS, Passage, SIZES, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::inlet::{INLET, Source};
use crate::links::{self, BONDS, LINKS, Linking};
use crate::material_info::MATERIALS;
use crate::paths::{self, PATHS, Waypoint};
use crate::run::{CLUMPS, LOG, RunError};
use crate::schedule::nanoseconds;
use crate::touches::{self, TOUCHES, Touching};
use copies::Merge;
use dem::setup::{Link, Memory, ZoneMotion};
use geom::{Plane, Shown};
use head::Head;
use order::{Generated, Known, Order};
use recall::Recall;
use serde::{Deserialize, Serialize};
use start::Starts;
use std::collections::BTreeMap;
use std::io::Write;
use stream::Table;
use stream::mcap::{Compression, Event, Provenance, Reader, Writer};

/// What is replayed, and where.
#[derive(Debug, Clone, Default)]
pub struct Replay {
    /// Calculation plane; absent: the storage plane of the run.
    pub at: Option<Plane>,
    /// L2 [m]; absent: the run's L1.
    pub length: Option<f64>,
    /// Only what passes at this time or later [s]; becomes time 0.
    pub from: Option<f64>,
    /// Only what passes before this time [s].
    pub until: Option<f64>,
    /// Whether times stay as recorded; otherwise the first passage becomes time 0.
    pub keep_times: bool,
    /// Which storage plane of the run.
    pub outlet: u16,
    /// Where intervals and places are those that were recorded.
    pub intervals: Intervals,
    /// Motion in the zone; absent: that of the run.
    pub motion: Option<ZoneMotion>,
    /// T of [`Intervals::Both`] [s]; absent: what the first one needs for the length of the zone.
    pub ahead: Option<f64>,
    /// The record seen from elsewhere; absent: as it was.
    pub frame: Option<Frame>,
    /// Superposed copies.
    pub copies: Copies,
    /// How often the record is replayed, one after the other; 0 is once. Then it is held in memory.
    pub repeat: u32,
    /// Time between the starts of replays [s]; absent: how long the record is.
    pub period: Option<f64>,
    /// Ids are given anew from here; absent: only where there are several of one.
    pub first_id: Option<u32>,
}

/// Where the recorded intervals and in-plane places are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Intervals {
    /// On the generation plane, as in the source document: the faster ones then catch up in the zone, so that
    /// grains of a dense flow may overlap when they are released. In free fall a particle that slowed down to nothing within the
    /// zone, going back, starts where it did: at its apex.
    #[default]
    Generation,
    /// On the calculation plane too: every particle is generated the same time T before it arrives, as far back on its path as it
    /// was then; in free fall no earlier than at its apex.
    Both,
}

/// Name of the metadata record that says what was made of the record.
pub const REPLAY: &str = "replay";

impl Replay {
    /// Whether what happens at a recorded time [s] is replayed.
    fn holds(&self, time: f64) -> bool {
        self.from.is_none_or(|from| time >= from) && self.until.is_none_or(|until| time < until)
    }

    /// What of it does not go with recorded paths.
    fn off_path(&self) -> Option<&'static str> {
        let asked = [
            (self.at.is_some(), "--at"),
            (self.length.is_some(), "--length"),
            (self.ahead.is_some(), "--ahead"),
            (self.copies.count > 1, "--copies"),
            (self.repeat > 1, "--repeat"),
            (self.first_id.is_some(), "--first-id"),
        ];
        asked.iter().find(|a| a.0).map(|a| a.1)
    }

    /// The record [`REPLAY`].
    fn to_map(&self) -> BTreeMap<String, String> {
        let (copies, shift) = (&self.copies, self.copies.shift);
        let mut map = BTreeMap::from([
            ("copies".to_owned(), copies.count.to_string()),
            ("replays".to_owned(), self.repeat.max(1).to_string()),
        ]);
        if copies.count > 1 {
            let what =
                "superposed copies of one record: a rate is scaled, the flow is not that of such a rate";
            map.insert("note".to_owned(), what.to_owned());
            map.insert("copy_shift".to_owned(), format!("{},{},{}", shift.x, shift.y, shift.z));
            map.insert("copy_delay".to_owned(), copies.delay.to_string());
        }
        map
    }
}

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Replayed {
    /// Particles.
    pub particles: u64,
    /// Recorded time that became 0 [s].
    pub start: f64,
    /// When the last one is generated, from the new 0 [s].
    pub last: f64,
    /// T of [`Intervals::Both`] [s].
    pub ahead: Option<f64>,
    /// Superposed copies of each recorded particle: above 1 a rate is scaled, and not a flow.
    pub copies: u32,
    /// Replays, one after the other.
    pub replays: u32,
    /// Time between their starts [s].
    pub period: Option<f64>,
    /// Particles that are generated nearer to the calculation plane than the largest diameter: they appear among what is there.
    pub near: u64,
}

/// Passes the crossings of a run on as an inlet stream, each as soon as it is read.
///
/// # Errors
/// A stream that is no run with an outlet, breaks off, or was stopped before its end; a length that is too short.
pub fn replay<W: Write>(
    name: &str,
    source: Source,
    what: &Replay,
    out: W,
    (mut provenance, compression): (Provenance, Compression),
) -> Result<(Replayed, W), RunError> {
    let mut reader = Reader::new(source);
    let broken = |e: stream::mcap::McapError| SceneError::Content {
        name: name.into(),
        wanted: "a run",
        source: e.into(),
    };
    let mut records = BTreeMap::new();
    let first = loop {
        match reader.next().transpose().map_err(broken)? {
            Some(Event::Metadata { name, map }) => drop(records.insert(name, map)),
            other => break other,
        }
    };
    if let Some(scene) =
        records.get(crate::input::SCENE).and_then(|r: &BTreeMap<String, String>| r.get("toml"))
    {
        provenance.inputs.push(("scene of the run".to_owned(), crate::sha256(scene)));
    }
    let head = head::head(name, records, what)?;
    let mut writer = Writer::compressed(out, &provenance, compression)?;
    writer.metadata(MATERIALS, head.materials.clone())?;
    writer.metadata(SIZES, head.sizes_record.clone())?;
    if !head.clumps_record.is_empty() {
        writer.metadata(CLUMPS, head.clumps_record.clone())?;
    }
    if !head.bonds_record.is_empty() {
        writer.metadata(BONDS, head.bonds_record.clone())?;
    }
    writer.metadata(REPLAY, what.to_map())?;
    // The last record: from it on, messages may come as late as a run upstream makes them.
    writer.metadata(INLET, head.gate.to_map())?;
    let start = if what.keep_times { Some(0.0) } else { what.from };
    let mut passing = Passing {
        name,
        what,
        start,
        starts: Starts::new(&head, what),
        order: Order::default(),
        merge: Merge::new(what, head.gate.zone, head.gate.gravity.unwrap_or_default(), head.widest),
        held: Vec::new(),
        touches: BTreeMap::new(),
        links: BTreeMap::new(),
        recall: Recall::default(),
        head,
        done: Replayed::default(),
        known: 0.0,
        stopped: None,
    };
    let mut events = first.map(Ok).into_iter().chain(reader.by_ref());
    for event in events.by_ref() {
        if passing.pass(event.map_err(broken)?, &mut writer)? {
            break;
        }
    }
    if let Some(stop) = passing.stopped {
        // What was recorded is passed on, but the stream has no end: what is downstream must not look whole.
        writer.flush_chunk()?;
        // A guard says the time itself.
        let said = stop.text.starts_with("t = ");
        let time = if said { String::new() } else { format!("t = {} s: ", Shown(stop.time)) };
        let why = format!("the run was stopped at {time}{}", stop.text);
        let cure = "go on with dem-run --resume, or take what lies before the stop with --until";
        return Err(SceneError::file(name, why, cure).into());
    }
    passing.again(&mut writer)?;
    passing.send(f64::INFINITY, &mut writer)?;
    // The reader downstream may go on; whether the run is whole still matters.
    let out = writer.finish()?;
    for event in events {
        event.map_err(broken)?;
    }
    passing.done.start = passing.start.unwrap_or(0.0);
    passing.done.ahead = passing.starts.ahead();
    Ok((passing.done, out))
}

struct Passing<'a> {
    name: &'a str,
    what: &'a Replay,
    head: Head,
    start: Option<f64>,
    starts: Starts,
    order: Order,
    merge: Merge,
    /// The record, where it is replayed more than once.
    held: Vec<(Passage, Known)>,
    /// What contacts remember of those that pass in the rows that come next, by their id.
    touches: BTreeMap<u32, Vec<Memory>>,
    /// And their bonds.
    links: BTreeMap<u32, Vec<Link>>,
    recall: Recall,
    done: Replayed,
    /// Watermark of the run [s].
    known: f64,
    /// The run's word that it did not come to its end.
    stopped: Option<Logged>,
}

/// A message of the topic `/log`.
#[derive(Deserialize)]
struct Logged {
    time: f64,
    kind: String,
    text: String,
}

impl Passing<'_> {
    /// Passes an event on; whether nothing more can follow.
    fn pass<W: Write>(&mut self, event: Event, writer: &mut Writer<W>) -> Result<bool, RunError> {
        match event {
            Event::Points { topic, table, .. } if topic == TOUCHES => {
                for Touching { memory, .. } in touches::from_table(self.name, &table)? {
                    self.touches.entry(memory.id).or_default().push(memory);
                }
                Ok(false)
            }
            Event::Points { topic, table, .. } if topic == LINKS => {
                for Linking { link, .. } in links::from_table(self.name, &table)? {
                    self.links.entry(link.id).or_default().push(link);
                }
                Ok(false)
            }
            Event::Points { topic, table, .. } if topic == CROSSINGS => {
                let rows = crossings::from_table(self.name, &table, self.head.materials.len())?;
                for row in rows {
                    self.known = self.known.max(row.time);
                    self.take(row)?;
                }
                // Of rows of other outlets and times.
                self.touches.clear();
                self.links.clear();
                self.send(self.bound(), writer)?;
                Ok(false)
            }
            Event::Points { topic, table, .. } if topic == PATHS && self.recorded() => {
                self.take_paths(&table, writer)?;
                Ok(false)
            }
            Event::Bytes { topic, data, .. } if topic == WATERMARK => {
                self.known = self.known.max(Watermark::read(self.name, &data)?.until);
                self.send(self.bound(), writer)?;
                self.promise(self.bound(), writer)?;
                Ok(self.what.until.is_some_and(|until| self.known > until))
            }
            Event::Bytes { topic, data, .. } if topic == LOG => {
                let logged = serde_json::from_slice::<Logged>(&data).ok();
                self.stopped = self.stopped.take().or(logged.filter(|l| l.kind == "stopped"));
                Ok(false)
            }
            _ => Ok(false),
        }
    }

    /// Nothing that has not been read is generated before this time [s]; nor is anything of the next replay.
    fn bound(&self) -> f64 {
        let known = self.what.until.map_or(self.known, |until| until.min(self.known));
        let next = match (self.held.first(), self.what.period) {
            (Some((first, _)), Some(period)) => begins(first, period, 1),
            _ => f64::INFINITY,
        };
        self.start.map_or(f64::NEG_INFINITY, |start| next.min(known - start))
    }

    /// Tells that nothing follows that is generated before `until` [s].
    fn promise<W: Write>(&self, until: f64, writer: &mut Writer<W>) -> Result<(), RunError> {
        // Before the first passage there is no 0 to count from.
        if until >= 0.0 {
            writer.bytes(WATERMARK, "json", nanoseconds(until), &Watermark { until }.to_json())?;
        }
        Ok(writer.flush_chunk()?)
    }

    /// A passage of the record, where it belongs to what is replayed.
    fn take(&mut self, mut row: Passage) -> Result<(), SceneError> {
        if row.outlet != self.what.outlet || !self.what.holds(row.time) {
            return Ok(());
        }
        let known = self.known_of(&row);
        if let Some(frame) = &self.what.frame {
            frame.passage(&mut row);
        }
        row.time -= *self.start.get_or_insert(row.time);
        row.outlet = 0;
        if self.what.repeat > 1 {
            self.held.push((row, known.clone()));
        }
        self.enter(row, known, 0)
    }

    /// What a passage knows of others.
    fn known_of(&mut self, row: &Passage) -> Known {
        let first = row.particle.id;
        let ids = (0..self.members(row)).map(|k| first.wrapping_add(k));
        let mut all: Vec<Memory> = ids.filter_map(|id| self.touches.remove(&id)).flatten().collect();
        if let Some(frame) = &self.what.frame {
            all.iter_mut().for_each(|m| m.springs = frame.springs(&m.springs));
        }
        // Bonds are told in a frame that turns with their grains.
        let links = self.links.remove(&first).unwrap_or_default();
        Known { touches: all.into(), links: links.into() }
    }

    /// Number of spheres of a passage.
    fn members(&self, row: &Passage) -> u32 {
        row.clump.map_or(1, |(c, _)| self.head.members.get(c.shape as usize).copied().unwrap_or(1))
    }

    fn recorded(&self) -> bool {
        self.head.gate.zone.motion == ZoneMotion::Recorded
    }

    /// Passes on where grains are on their way.
    fn take_paths<W: Write>(&mut self, table: &Table, writer: &mut Writer<W>) -> Result<(), RunError> {
        let mut rows = paths::from_table(self.name, table, self.head.materials.len())?;
        rows.retain(|r| self.what.outlet == r.passage.outlet && self.what.holds(r.passage.time));
        for Waypoint { passage, .. } in &mut rows {
            if let Some(frame) = &self.what.frame {
                frame.passage(passage);
            }
            passage.time -= *self.start.get_or_insert(passage.time);
            passage.outlet = 0;
        }
        if let Some(last) = rows.last() {
            writer.points(PATHS, nanoseconds(last.passage.time), "world", paths::to_table(&rows))?;
        }
        Ok(())
    }

    /// A passage as it enters, with its copies.
    fn enter(&mut self, row: Passage, known: Known, replay: u32) -> Result<(), SceneError> {
        if self.recorded() {
            self.order.put(Generated { row, copy: (0, 0), known });
            return Ok(());
        }
        for (copy, mut row) in self.what.copies.of(row) {
            row.time += self.starts.place(self.name, &mut row)?;
            let past = self.head.gate.zone.past(&row.particle.position, row.particle.radius);
            self.done.near += u64::from(-past <= 2.0 * self.head.widest);
            self.order.put(Generated { row, copy: (copy, replay), known: known.clone() });
        }
        Ok(())
    }

    /// Replays the record again, as often as is asked for.
    fn again<W: Write>(&mut self, writer: &mut Writer<W>) -> Result<(), RunError> {
        (self.done.copies, self.done.replays) = (self.what.copies.count, self.what.repeat.max(1));
        let (Some((first, _)), Some((last, _))) = (self.held.first(), self.held.last()) else {
            return Ok(());
        };
        let end = self.what.until.map_or(self.known, |until| until.min(self.known));
        let period = self.what.period.unwrap_or(end - self.start.unwrap_or(0.0));
        if period < last.time - first.time {
            let why = format!(
                "--period {} s is shorter than the record, {} s from the first grain to the last",
                Shown(period),
                Shown(last.time - first.time)
            );
            return Err(SceneError::file(
                self.name,
                why,
                "use a longer one, or superpose copies (--copies with --copy-delay)",
            )
            .into());
        }
        self.done.period = Some(period);
        let held = std::mem::take(&mut self.held);
        for replay in 1..self.what.repeat {
            let start = begins(&held[0].0, period, replay);
            self.send(start, writer)?;
            self.promise(start, writer)?;
            for (row, known) in &held {
                let time = begins(row, period, replay);
                self.enter(Passage { time, ..*row }, known.clone(), replay)?;
                self.send(time, writer)?;
            }
        }
        Ok(())
    }

    /// Writes what is generated at a time or before.
    fn send<W: Write>(&mut self, bound: f64, writer: &mut Writer<W>) -> Result<(), RunError> {
        let (mut rows, mut told, mut bonded) = (Vec::new(), Vec::new(), Vec::new());
        while let Some(one) = self.order.next_until(bound) {
            let members = self.members(&one.row);
            let row = self.merge.pass(self.name, one.clone(), members)?;
            let (touches, links) = self.recall.with(&one, &row, (members, self.recorded()));
            told.extend(touches);
            bonded.extend(links);
            rows.push(row);
        }
        if let Some(last) = told.last() {
            writer.points(TOUCHES, nanoseconds(last.time), "world", touches::to_table(&told))?;
        }
        if let Some(last) = bonded.last() {
            writer.points(LINKS, nanoseconds(last.time), "world", links::to_table(&bonded))?;
        }
        if let Some(last) = rows.last() {
            self.done.particles += rows.len() as u64;
            self.done.last = last.time;
            writer.points(CROSSINGS, nanoseconds(last.time), "world", crossings::to_table(&rows))?;
        }
        Ok(())
    }
}

/// When a passage of the record enters in a replay of it [s].
fn begins(row: &Passage, period: f64, replay: u32) -> f64 {
    row.time + period * f64::from(replay)
}
