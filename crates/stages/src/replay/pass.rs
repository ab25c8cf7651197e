//! One replay on its way: what has come in and not yet gone out.

use super::copies::Merge;
use super::head::Head;
use super::order::{Generated, Known, Order};
use super::recall::Recall;
use super::start::Starts;
use super::{FAR, Replay, Replayed};
use crate::crossings::{self, CROSSINGS, Passage, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::links::{self, LINKS, Linking};
use crate::paths::{self, PATHS, Waypoint};
use crate::run::{LOG, RunError};
use crate::schedule::nanoseconds;
use crate::touches::{self, TOUCHES, Touching};
use dem::setup::{Link, Memory, ZoneMotion};
use geom::Shown;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::io::Write;
use stream::Table;
use stream::mcap::{Event, Writer};

/// The record as it passes.
pub(super) struct Passing<'a> {
    /// Of the part that is read.
    name: String,
    /// What is later belongs to the next part [s].
    limit: f64,
    what: &'a Replay,
    head: Head,
    /// Time of the record at which the stream begins [s], once that is known.
    pub(super) start: Option<f64>,
    pub(super) starts: Starts,
    order: Order,
    merge: Merge,
    /// The record, where it is replayed more than once.
    held: Vec<(Passage, Known)>,
    /// What contacts remember of those that pass in the rows that come next, by their id.
    touches: BTreeMap<u32, Vec<Memory>>,
    /// And their bonds.
    links: BTreeMap<u32, Vec<Link>>,
    recall: Recall,
    pub(super) done: Replayed,
    /// Watermark of the run [s].
    known: f64,
    /// Whether who is amid the zone at the beginning was looked for.
    amid_seen: bool,
    /// The run's word that it did not come to its end.
    pub(super) stopped: Option<Logged>,
}

/// A message of the topic `/log`.
#[derive(Deserialize)]
pub(super) struct Logged {
    /// [s].
    time: f64,
    kind: String,
    text: String,
}

impl Logged {
    /// That a run did not come to its end.
    pub(super) fn told(&self, run: &str) -> SceneError {
        // A guard says the time itself.
        let said = self.text.starts_with("t = ");
        let time = if said { String::new() } else { format!("t = {} s: ", Shown(self.time)) };
        let why = format!("the run was stopped at {time}{}", self.text);
        let cure =
            "go on with dem-run --resume and give both runs, or take what lies before the stop with --until";
        SceneError::file(run, why, cure)
    }
}

impl<'a> Passing<'a> {
    /// Nothing has passed yet; `start` is where the stream begins in the record [s], or the first passage.
    pub(super) fn new(what: &'a Replay, head: Head, start: Option<f64>) -> Passing<'a> {
        Passing {
            name: String::new(),
            limit: f64::INFINITY,
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
            amid_seen: false,
            stopped: None,
        }
    }

    /// The next part begins, of which all counts that is no later than `limit` [s].
    pub(super) fn begin(&mut self, name: &str, limit: f64) {
        (self.name, self.limit, self.stopped) = (name.to_owned(), limit, None);
    }

    /// Whether all of a part that counts was read.
    pub(super) fn over(&self) -> bool {
        self.known >= self.limit
    }

    /// Up to when the record is known [s].
    pub(super) fn known(&self) -> f64 {
        self.known
    }

    /// The like of what is replayed [s].
    fn reached(&self) -> f64 {
        self.what.until.map_or(self.known, |until| until.min(self.known))
    }

    /// Whether all that is replayed was read.
    pub(super) fn enough(&self) -> bool {
        self.what.until.is_some_and(|until| self.known > until)
    }

    fn know(&mut self, time: f64) {
        self.known = self.known.max(time.min(self.limit));
    }

    /// Passes an event on; whether nothing more of this part counts.
    pub(super) fn pass<W: Write>(&mut self, event: Event, writer: &mut Writer<W>) -> Result<bool, RunError> {
        match event {
            Event::Points { topic, table, .. } if topic == TOUCHES => {
                for Touching { memory, .. } in touches::from_table(&self.name, &table)? {
                    self.touches.entry(memory.id).or_default().push(memory);
                }
                Ok(false)
            }
            Event::Points { topic, table, .. } if topic == LINKS => {
                for Linking { link, .. } in links::from_table(&self.name, &table)? {
                    self.links.entry(link.id).or_default().push(link);
                }
                Ok(false)
            }
            Event::Points { topic, table, .. } if topic == CROSSINGS => {
                let rows = crossings::from_table(&self.name, &table, self.head.materials.len())?;
                for row in rows {
                    self.know(row.time);
                    self.take(row)?;
                }
                // Of rows of other outlets and times.
                self.touches.clear();
                self.links.clear();
                self.send(self.bound(), writer)?;
                Ok(self.over())
            }
            Event::Points { topic, table, .. } if topic == PATHS && self.recorded() => {
                self.take_paths(&table, writer)?;
                Ok(false)
            }
            Event::Bytes { topic, data, .. } if topic == WATERMARK => {
                self.know(Watermark::read(&self.name, &data)?.until);
                self.send(self.bound(), writer)?;
                self.promise(self.bound(), writer)?;
                Ok(self.over() || self.enough())
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
        let known = self.reached();
        let next = match (self.held.first(), self.what.period) {
            (Some((first, _)), Some(period)) => begins(first, period, 1),
            _ => f64::INFINITY,
        };
        self.start.map_or(f64::NEG_INFINITY, |start| next.min(known - start)) - self.starts.lead()
    }

    /// Tells that nothing follows the record, which reaches so far.
    pub(super) fn promise_end<W: Write>(&mut self, writer: &mut Writer<W>) -> Result<(), RunError> {
        let later = self.done.period.map_or(0.0, |period| period * f64::from(self.what.repeat.max(1) - 1));
        let known = self.reached();
        let end = self.start.map_or(f64::NEG_INFINITY, |start| known - start) + later - self.starts.lead();
        self.promise(end.max(self.done.last), writer)
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
        if row.outlet != self.what.outlet || row.time > self.limit || !self.what.holds(row.time) {
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
        let mut rows = paths::from_table(&self.name, table, self.head.materials.len())?;
        let counts = |time: f64| time <= self.limit && self.what.holds(time);
        rows.retain(|r| self.what.outlet == r.passage.outlet && counts(r.passage.time));
        self.look_amid(&rows);
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

    /// Who is well within the zone when what is replayed begins appears there among others.
    fn look_amid(&mut self, rows: &[Waypoint]) {
        let zone = &self.head.gate.zone;
        let Some(begins) = self.what.from.filter(|_| !self.amid_seen) else { return };
        for Waypoint { passage, gone } in rows {
            if passage.time > begins + self.head.gate.samples.unwrap_or(0.0) {
                self.amid_seen = true;
                return;
            }
            let place =
                self.what.frame.map_or(passage.particle.position, |f| f.point(&passage.particle.position));
            let past = zone.past(&place, passage.particle.radius);
            self.done.amid += u64::from(!gone && past > -0.5 * zone.length && past < 0.0);
        }
    }

    /// A passage as it enters, with its copies.
    fn enter(&mut self, row: Passage, known: Known, replay: u32) -> Result<(), SceneError> {
        if self.recorded() {
            self.order.put(Generated { row, copy: (0, 0), known });
            return Ok(());
        }
        for (copy, mut row) in self.what.copies.of(row) {
            row.time += self.starts.place(&self.name, &mut row)?;
            let past = self.head.gate.zone.past(&row.particle.position, row.particle.radius);
            self.done.near += u64::from(-past <= 2.0 * self.head.widest);
            self.done.far += u64::from(-past > FAR * self.head.gate.zone.length);
            self.done.farthest = self.done.farthest.max(-past);
            self.order.put(Generated { row, copy: (copy, replay), known: known.clone() });
        }
        Ok(())
    }

    /// Replays the record again, as often as is asked for.
    pub(super) fn again<W: Write>(&mut self, writer: &mut Writer<W>) -> Result<(), RunError> {
        (self.done.copies, self.done.replays) = (self.what.copies.count, self.what.repeat.max(1));
        let (Some((first, _)), Some((last, _))) = (self.held.first(), self.held.last()) else {
            return Ok(());
        };
        let end = self.reached();
        let period = self.what.period.unwrap_or(end - self.start.unwrap_or(0.0));
        if period < last.time - first.time {
            let why = format!(
                "--period {} s is shorter than the record, {} s from the first grain to the last",
                Shown(period),
                Shown(last.time - first.time)
            );
            return Err(SceneError::file(
                &self.name,
                why,
                "use a longer one, or superpose copies (--copies with --copy-delay)",
            )
            .into());
        }
        self.done.period = Some(period);
        let held = std::mem::take(&mut self.held);
        for replay in 1..self.what.repeat {
            let start = begins(&held[0].0, period, replay);
            let lead = self.starts.lead();
            self.send(start - lead, writer)?;
            self.promise(start - lead, writer)?;
            for (row, known) in &held {
                let time = begins(row, period, replay);
                self.enter(Passage { time, ..*row }, known.clone(), replay)?;
                self.send(time - lead, writer)?;
            }
        }
        Ok(())
    }

    /// Writes what is generated at a time or before.
    pub(super) fn send<W: Write>(&mut self, bound: f64, writer: &mut Writer<W>) -> Result<(), RunError> {
        let (mut rows, mut told, mut bonded) = (Vec::new(), Vec::new(), Vec::new());
        while let Some(one) = self.order.next_until(bound) {
            let members = self.members(&one.row);
            let row = self.merge.pass(&self.name, one.clone(), members)?;
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
