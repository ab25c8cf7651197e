//! What a replay writes: rows in the order of their generation, and watermarks.

use super::pairs::PairRows;
use super::replayer::Replayer;
use crate::StageError;
use crate::outlet::crossing::CrossingRow;
use crate::outlet::{bond, contact, crossing};
use geom::Shown;
use record::{FRAME, RecordError, Watermark, nanoseconds, topic};
use std::io::Write;

impl<W: Write> Replayer<'_, W> {
    /// No row that has not been read is generated before this time [s]; nor is any row of the next replay.
    pub(super) fn bound(&self) -> f64 {
        let next = match (self.held.first(), self.what.period) {
            (Some((first, _)), Some(period)) => begins(first, period, 1),
            _ => f64::INFINITY,
        };
        next.min(self.read_until()) - self.generation.lead()
    }

    /// Up to when the record has been read, in the times of the stream [s].
    fn read_until(&self) -> f64 {
        self.start.map_or(f64::NEG_INFINITY, |start| self.reached() - start)
    }

    /// Writes the last watermark: the end of the record. What would have been generated before it and crossed after it is not known and never comes.
    pub(super) fn end(&mut self) -> Result<(), StageError> {
        let later = self.done.period.map_or(0.0, |period| period * f64::from(self.what.repeat.max(1) - 1));
        let end = self.read_until() + later;
        self.watermark(end.max(self.done.last))
    }

    /// Writes that no row follows that is generated before `until` [s].
    pub(super) fn watermark(&mut self, until: f64) -> Result<(), StageError> {
        // Before the first crossing there is no 0 to count from.
        if until >= 0.0 {
            let message = Watermark { until }.to_json();
            self.writer.bytes(topic::WATERMARK, "json", nanoseconds(until), &message)?;
        }
        Ok(self.writer.flush_chunk()?)
    }

    /// Replays the record again, as often as is asked for.
    pub(super) fn again(&mut self) -> Result<(), StageError> {
        (self.done.copies, self.done.replays) = (self.what.copies.count, self.what.repeat.max(1));
        let (Some((first, _)), Some((last, _))) = (self.held.first(), self.held.last()) else {
            return Ok(());
        };
        let period = self.what.period.unwrap_or(self.reached() - self.start.unwrap_or(0.0));
        let length = last.time - first.time;
        if period < length {
            let (period, length) = (Shown(period), Shown(length));
            let why = format!(
                "--period {period} s is shorter than the record, {length} s from the first grain to the last"
            );
            let cure = "use a longer one, or superpose copies (--copies with --copy-delay)";
            return Err(RecordError::new(&self.name, why, cure).into());
        }
        self.done.period = Some(period);
        let held = std::mem::take(&mut self.held);
        for replay in 1..self.what.repeat {
            let start = begins(&held[0].0, period, replay);
            let lead = self.generation.lead();
            self.send(start - lead)?;
            self.watermark(start - lead)?;
            for (row, partners) in &held {
                let time = begins(row, period, replay);
                self.enter(CrossingRow { time, ..*row }, partners.clone(), replay)?;
                self.send(time - lead)?;
            }
        }
        Ok(())
    }

    /// Writes the rows that are generated at a time [s] or before.
    pub(super) fn send(&mut self, bound: f64) -> Result<(), StageError> {
        let (mut rows, mut pairs) = (Vec::new(), PairRows::default());
        while let Some(one) = self.queue.next_until(bound) {
            let members = self.members(&one.row);
            let row = self.merge.pass(&self.name, one.clone(), members)?;
            match self.recorded() {
                true => pairs.add(&one, &row),
                false => self.pairs.complete(&one, &row, members, &mut pairs),
            }
            rows.push(row);
        }
        if let Some(last) = pairs.contacts.last() {
            let table = contact::to_table(&pairs.contacts);
            self.writer.points(topic::CROSSING_CONTACTS, nanoseconds(last.time), FRAME, table)?;
        }
        if let Some(last) = pairs.bonds.last() {
            let table = bond::to_table(&pairs.bonds);
            self.writer.points(topic::CROSSING_BONDS, nanoseconds(last.time), FRAME, table)?;
        }
        if let Some(last) = rows.last() {
            self.done.particles += rows.len() as u64;
            self.done.last = last.time;
            self.writer.points(topic::CROSSINGS, nanoseconds(last.time), FRAME, crossing::to_table(&rows))?;
        }
        Ok(())
    }
}

/// When a row of the record enters in a replay of it [s].
fn begins(row: &CrossingRow, period: f64, replay: u32) -> f64 {
    row.time + period * f64::from(replay)
}
