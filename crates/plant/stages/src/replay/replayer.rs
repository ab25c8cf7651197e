//! One replay in progress: what has been read and is not yet written.

use super::generation::Generation;
use super::head::Head;
use super::merge::Merge;
use super::pairs::Pairs;
use super::queue::{Generated, Origin, Partners, Queue};
use super::{FAR, Passage, Replay, Replayed};
use crate::StageError;
use crate::order::Order;
use crate::outlet::contact::{self, ContactRow};
use crate::outlet::crossing::{self, CrossingRow};
use crate::outlet::path::{self, PathRow};
use crate::outlet::{bond, bond::BondRow};
use dem::setup::{CrossingBond, PairHistory, ZoneMotion};
use geom::Shown;
use record::{FRAME, LogMessage, StopCause, Watermark, nanoseconds, topic};
use scene::{Result, SceneError};
use std::collections::BTreeMap;
use std::io::Write;
use stream::Table;
use stream::mcap::{Event, Writer};

/// The record as it passes.
pub(super) struct Replayer<'a, W: Write> {
    pub(super) writer: Writer<W>,
    /// Name of the file that is read.
    pub(super) name: String,
    /// Time from which on the next file counts [s].
    limit: f64,
    pub(super) what: &'a Replay,
    pub(super) head: Head,
    /// Time of the record at which the stream begins [s], once that is known.
    pub(super) start: Option<f64>,
    pub(super) generation: Generation,
    pub(super) queue: Queue,
    pub(super) merge: Merge,
    /// The record, where it is replayed more than once.
    pub(super) held: Vec<(CrossingRow, Partners)>,
    /// Contact histories of the rows that come next, by particle.
    contacts: BTreeMap<u32, Vec<PairHistory>>,
    /// Bonds of the rows that come next, by particle.
    bonds: BTreeMap<u32, Vec<CrossingBond>>,
    pub(super) pairs: Pairs,
    pub(super) done: Replayed,
    /// Up to when the record is known: the watermark of the run [s].
    pub(super) known: f64,
    /// Times that the file has reached.
    order: Order,
    /// Whether particles inside the zone at the start were counted.
    inside_counted: bool,
    /// The message of a run that was stopped before its end.
    pub(super) stopped: Option<LogMessage>,
}

/// The error of a run that was stopped before its end.
pub(super) fn was_stopped(message: &LogMessage, run: &str) -> SceneError {
    // The text of a guard or a device begins with the time.
    let has_time = matches!(message.stop, Some(StopCause::Guard { .. } | StopCause::Device));
    let time = if has_time { String::new() } else { format!("t = {} s: ", Shown(message.time)) };
    let why = format!("the run was stopped at {time}{}", message.text);
    let cure = "continue it with dem-run --resume and give both runs, or replay the part before the stop with --until";
    SceneError::file(run, why, cure)
}

impl<'a, W: Write> Replayer<'a, W> {
    /// Nothing has been read yet; `start` is where the stream begins in the record [s], or the first crossing.
    pub(super) fn new(
        what: &'a Replay,
        head: Head,
        start: Option<f64>,
        writer: Writer<W>,
    ) -> Replayer<'a, W> {
        Replayer {
            writer,
            name: String::new(),
            limit: f64::INFINITY,
            what,
            start,
            generation: Generation::new(&head, what),
            queue: Queue::default(),
            merge: Merge::new(&head, what),
            held: Vec::new(),
            contacts: BTreeMap::new(),
            bonds: BTreeMap::new(),
            pairs: Pairs::default(),
            head,
            done: Replayed::default(),
            known: 0.0,
            order: Order::default(),
            inside_counted: false,
            stopped: None,
        }
    }

    /// The next file begins; of it counts what is no later than `limit` [s].
    pub(super) fn begin(&mut self, name: &str, limit: f64) {
        (self.name, self.limit, self.stopped) = (name.to_owned(), limit, None);
        self.order = Order::default();
    }

    /// Whether all of a file that counts was read.
    pub(super) fn over(&self) -> bool {
        self.known >= self.limit
    }

    /// Up to when what is replayed is known [s].
    pub(super) fn reached(&self) -> f64 {
        self.what.until.map_or(self.known, |until| until.min(self.known))
    }

    /// Whether all that is replayed was read.
    pub(super) fn enough(&self) -> bool {
        self.what.until.is_some_and(|until| self.known > until)
    }

    fn know(&mut self, time: f64) {
        self.known = self.known.max(time.min(self.limit));
    }

    pub(super) fn recorded(&self) -> bool {
        self.head.zone.zone.motion == ZoneMotion::Recorded
    }

    /// Passes an event on; whether nothing more of this file counts.
    pub(super) fn pass(&mut self, event: Event) -> Result<bool, StageError> {
        match event {
            Event::Points { topic, table, .. } => self.pass_table(&topic, &table),
            Event::Bytes { topic, data, .. } if topic == topic::WATERMARK => {
                let until = Watermark::read(&self.name, &data)?.until;
                self.order.take_watermark(&self.name, until)?;
                self.know(until);
                self.send(self.bound())?;
                self.watermark(self.bound())?;
                Ok(self.over() || self.enough())
            }
            Event::Bytes { topic, data, .. } if topic == topic::LOG => {
                self.stopped = self.stopped.take().or_else(|| LogMessage::read_stop(&data));
                Ok(false)
            }
            _ => Ok(false),
        }
    }

    fn pass_table(&mut self, topic: &str, table: &Table) -> Result<bool, StageError> {
        match topic {
            topic::CROSSING_CONTACTS => {
                for ContactRow { pair, .. } in contact::from_table(&self.name, table)? {
                    self.contacts.entry(pair.id).or_default().push(pair);
                }
            }
            topic::CROSSING_BONDS => {
                for BondRow { bond, .. } in bond::from_table(&self.name, table)? {
                    self.bonds.entry(bond.id).or_default().push(bond);
                }
            }
            topic::CROSSINGS => {
                for row in crossing::from_table(&self.name, table, self.head.materials.len())? {
                    self.order.take_crossing(&self.name, row.particle.id, row.time)?;
                    self.know(row.time);
                    self.take(row)?;
                }
                // Those that are left belong to rows of other outlets and times.
                self.contacts.clear();
                self.bonds.clear();
                self.send(self.bound())?;
                return Ok(self.over());
            }
            topic::PATHS if self.recorded() => self.take_paths(table)?,
            _ => {}
        }
        Ok(false)
    }

    /// Adds a row of the record, where it belongs to what is replayed.
    fn take(&mut self, mut row: CrossingRow) -> Result<()> {
        if !self.counts(&row) {
            return Ok(());
        }
        let partners = self.partners(&row);
        self.rebase(&mut row);
        if self.what.repeat > 1 {
            self.held.push((row, partners.clone()));
        }
        self.enter(row, partners, 0)
    }

    /// Whether a row belongs to what is replayed.
    fn counts(&self, row: &CrossingRow) -> bool {
        row.outlet == self.what.outlet && !(row.time > self.limit) && self.what.holds(row.time)
    }

    /// A row in the frame and the times of the stream.
    fn rebase(&mut self, row: &mut CrossingRow) {
        if let Some(frame) = &self.what.frame {
            frame.row(row);
        }
        if self.what.passage == Passage::Steps {
            row.time = self.head.step * (row.time / self.head.step).ceil();
        }
        row.time -= *self.start.get_or_insert(row.time);
        row.outlet = 0;
    }

    /// Contacts and bonds of a row.
    fn partners(&mut self, row: &CrossingRow) -> Partners {
        let first = row.particle.id;
        let ids = (0..self.members(row)).map(|k| first.wrapping_add(k));
        let mut contacts: Vec<PairHistory> =
            ids.filter_map(|id| self.contacts.remove(&id)).flatten().collect();
        if let Some(frame) = &self.what.frame {
            contacts.iter_mut().for_each(|m| m.history = frame.history(&m.history));
        }
        // Bonds are recorded in a frame that turns with their particles.
        let bonds = self.bonds.remove(&first).unwrap_or_default();
        Partners { contacts: contacts.into(), bonds: bonds.into() }
    }

    /// Number of spheres of a row.
    pub(super) fn members(&self, row: &CrossingRow) -> u32 {
        row.clump.map_or(1, |(c, _)| self.head.members.get(c.shape as usize).copied().unwrap_or(1))
    }

    /// Passes on samples of paths.
    fn take_paths(&mut self, table: &Table) -> Result<(), StageError> {
        let mut rows = path::from_table(&self.name, table, self.head.materials.len())?;
        for PathRow { row, .. } in &rows {
            self.order.take_sample(&self.name, row.particle.id, row.time)?;
        }
        rows.retain(|r| self.counts(&r.row));
        self.count_inside(&rows);
        rows.iter_mut().for_each(|r| self.rebase(&mut r.row));
        if let Some(last) = rows.last() {
            self.writer.points(topic::PATHS, nanoseconds(last.row.time), FRAME, path::to_table(&rows))?;
        }
        Ok(())
    }

    /// Counts particles in the inner half of the zone when what is replayed begins: they appear among others.
    fn count_inside(&mut self, rows: &[PathRow]) {
        let zone = &self.head.zone.zone;
        let Some(begins) = self.what.from.filter(|_| !self.inside_counted) else { return };
        for PathRow { row, gone } in rows {
            if row.time > begins + self.head.zone.samples.unwrap_or(0.0) {
                self.inside_counted = true;
                return;
            }
            let place = self.what.frame.map_or(row.particle.position, |f| f.point(&row.particle.position));
            let past = zone.past(&place, row.particle.radius);
            self.done.in_zone += u64::from(!gone && past > -0.5 * zone.length && past < 0.0);
        }
    }

    /// Queues a row, with its copies.
    pub(super) fn enter(&mut self, row: CrossingRow, partners: Partners, replay: u32) -> Result<()> {
        if self.recorded() {
            self.queue.put(Generated { row, origin: Origin::default(), partners });
            return Ok(());
        }
        for (copy, mut row) in self.what.copies.of(row) {
            row.time += self.generation.place(&self.name, &mut row)?;
            let zone = &self.head.zone.zone;
            let past = zone.past(&row.particle.position, row.particle.radius);
            self.done.near += u64::from(-past <= 2.0 * self.head.widest);
            self.done.far += u64::from(-past > FAR * zone.length);
            self.done.farthest = self.done.farthest.max(-past);
            let origin = Origin { copy, replay };
            self.queue.put(Generated { row, origin, partners: partners.clone() });
        }
        Ok(())
    }
}
