//! From the crossings of a run to an inlet stream, also while the run is still being written.
//!
//! [`replay`] opens the files of the run ([`run_file`], [`head`]) and gives their events to the [`replayer`]. Each crossing gets the state in
//! which it is generated ([`generation`]), waits in the [`queue`] for those that are generated before it, is merged with copies
//! ([`merge`]), and is written with its contacts and bonds ([`pairs`], [`send`]).

mod copies;
mod frame;
mod generation;
mod head;
mod merge;
mod pairs;
mod queue;
mod replayer;
mod run_file;
mod send;

pub use copies::Copies;
pub use frame::Frame;

use crate::StageError;
use dem::setup::ZoneMotion;
use geom::Plane;
use record::Map;
use replayer::Replayer;
use scene::input::Source;
use serde::Serialize;
use std::io::Write;
use stream::mcap::{Provenance, StreamOptions, Writer};

/// What is replayed, and where.
#[derive(Debug, Clone, Default)]
pub struct Replay {
    /// Calculation plane; absent: the storage plane of the run.
    pub at: Option<Plane>,
    /// L2 [m]; absent: the run's L1.
    pub length: Option<f64>,
    /// Only crossings at this time or later [s]; it becomes time 0.
    pub from: Option<f64>,
    /// Only crossings before this time [s].
    pub until: Option<f64>,
    /// Whether times stay as recorded; otherwise the first crossing becomes time 0.
    pub keep_times: bool,
    /// Which storage plane of the run.
    pub outlet: u16,
    /// Where intervals and positions are those that were recorded.
    pub intervals: Intervals,
    /// How the times of passages are counted.
    pub passage: Passage,
    /// Motion in the zone; absent: that of the run.
    pub motion: Option<ZoneMotion>,
    /// T of [`Intervals::Both`] [s]; absent: what the first one needs for the length of the zone.
    pub ahead: Option<f64>,
    /// A turn and shift of the record; absent: none.
    pub frame: Option<Frame>,
    /// Superposed copies.
    pub copies: Copies,
    /// How often the record is replayed, one after the other; 0 is once. Then it is held in memory.
    pub repeat: u32,
    /// Time between the starts of replays [s]; absent: how long the record is.
    pub period: Option<f64>,
    /// First of new ids; absent: new ids only where ids are not unique.
    pub first_id: Option<u32>,
}

/// Where the recorded intervals and in-plane positions are kept.
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

/// How the time at which a particle passes the storage plane is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Passage {
    /// As the instant within its step.
    #[default]
    Time,
    /// In whole time steps of the run, to the end of the step in which it passes.
    Steps,
}

impl Replay {
    /// Whether the record at a time [s] is replayed.
    fn holds(&self, time: f64) -> bool {
        self.from.is_none_or(|from| time >= from) && self.until.is_none_or(|until| time < until)
    }

    /// The first option that does not go with recorded paths.
    fn off_path(&self) -> Option<&'static str> {
        let asked = [
            (self.at.is_some(), "--at"),
            (self.length.is_some(), "--length"),
            (self.ahead.is_some(), "--ahead"),
            (self.intervals == Intervals::Generation, "--intervals generation"),
            (self.passage == Passage::Steps, "--passage steps"),
            (self.copies.count > 1, "--copies"),
            (self.repeat > 1, "--repeat"),
            (self.first_id.is_some(), "--first-id"),
        ];
        asked.iter().find(|a| a.0).map(|a| a.1)
    }

    /// The record [`record::metadata::REPLAY`].
    fn to_map(&self) -> Map {
        let (copies, shift) = (&self.copies, self.copies.shift);
        let mut map = Map::from([
            ("copies".to_owned(), copies.count.to_string()),
            ("replays".to_owned(), self.repeat.max(1).to_string()),
        ]);
        if self.passage == Passage::Steps {
            map.insert("passage".to_owned(), "whole time steps of the run".to_owned());
        }
        if copies.count > 1 {
            let what = "superposed copies of one record: the rate is scaled, but grains do not flow as they would at that rate";
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
    /// Particles that are generated more than [`FAR`] lengths of the zone before the calculation plane.
    pub far: u64,
    /// How far before it the farthest is generated [m].
    pub farthest: f64,
    /// Along recorded paths: particles that are in the inner half of the zone when what is replayed begins.
    pub in_zone: u64,
}

/// Lengths of a zone before its calculation plane from which on a particle comes in oddly far away [–].
pub const FAR: f64 = 10.0;

/// Passes the crossings of a run on as an inlet stream, each as soon as it is read. A run that was stopped and resumed is several files
/// (`runs`, with their names), in the order of their times: of each counts what lies before the next begins.
///
/// # Errors
/// A stream that is not a run with an outlet, breaks off, or was stopped before its end; a run that begins later than what is asked for,
/// or files that do not follow each other; a length that is too short.
pub fn replay<W: Write>(
    runs: Vec<(String, Source)>,
    what: &Replay,
    out: W,
    (mut provenance, how): (Provenance, StreamOptions<W>),
) -> Result<(Replayed, W), StageError> {
    let (mut runs, head) = run_file::open(runs, what)?;
    provenance.inputs.extend(runs.iter().filter_map(|r| r.scene.clone()));
    let mut writer = Writer::compressed(out, &provenance, how)?;
    head.write(what, &mut writer)?;
    let start = if what.keep_times { Some(0.0) } else { what.from };
    let mut replayer = Replayer::new(what, head, start, writer);
    for k in 0..runs.len() {
        let limit = runs.get(k + 1).map_or(f64::INFINITY, |next| next.begins);
        replayer.begin(&runs[k].name, limit);
        while let Some(event) = runs[k].next().transpose()? {
            if replayer.pass(event)? {
                break;
            }
        }
        if replayer.enough() {
            break;
        }
        if k + 1 < runs.len() && !replayer.over() {
            return Err(runs[k].gap(&runs[k + 1], replayer.known).into());
        }
    }
    if let (Some(stop), Some(last)) = (&replayer.stopped, runs.last()) {
        // The stream has no end record: readers downstream must not take it for whole.
        replayer.writer.flush_chunk()?;
        return Err(replayer::was_stopped(stop, &last.name).into());
    }
    replayer.again()?;
    replayer.send(f64::INFINITY)?;
    replayer.end()?;
    // The reader downstream may go on; whether the run is whole is checked after that.
    let out = replayer.writer.finish()?;
    if let Some(last) = runs.last_mut() {
        while last.next().transpose()?.is_some() {}
    }
    replayer.done.start = replayer.start.unwrap_or(0.0);
    replayer.done.ahead = replayer.generation.ahead();
    Ok((replayer.done, out))
}
