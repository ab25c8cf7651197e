//! From the crossings of a run to an inlet stream, also while the run is still being written (SYSTEMS B4).

mod copies;
mod frame;
mod head;
mod order;
mod part;
mod pass;
mod recall;
mod start;

pub use copies::Copies;
pub use frame::Frame;

use crate::inlet::Source;
use crate::run::RunError;
use dem::setup::ZoneMotion;
use geom::Plane;
use pass::Passing;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;
use stream::mcap::{How, Provenance, Writer};

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
    /// Particles that are generated more than [`FAR`] lengths of the zone before the calculation plane.
    pub far: u64,
    /// How far before it the farthest is generated [m].
    pub farthest: f64,
    /// Along recorded paths: particles that are in the inner half of the zone when what is replayed begins.
    pub amid: u64,
}

/// Lengths of a zone before its calculation plane from which on a particle comes in oddly far away [–].
pub const FAR: f64 = 10.0;

/// Passes the crossings of a run on as an inlet stream, each as soon as it is read. A run that was stopped and gone on with is several files
/// (`parts`, with their names), in the order of their times: of each counts what lies before the next begins.
///
/// # Errors
/// A stream that is no run with an outlet, breaks off, or was stopped before its end; a run that begins later than what is asked for, or
/// parts that do not follow each other; a length that is too short.
pub fn replay<W: Write>(
    parts: Vec<(String, Source)>,
    what: &Replay,
    out: W,
    (mut provenance, how): (Provenance, How<W>),
) -> Result<(Replayed, W), RunError> {
    let (mut parts, head) = part::open(parts, what)?;
    provenance.inputs.extend(parts.iter().filter_map(|p| p.scene.clone()));
    let mut writer = Writer::compressed(out, &provenance, how)?;
    head.write(what, &mut writer)?;
    let start = if what.keep_times { Some(0.0) } else { what.from };
    let mut passing = Passing::new(what, head, start);
    for k in 0..parts.len() {
        let limit = parts.get(k + 1).map_or(f64::INFINITY, |next| next.begins);
        passing.begin(&parts[k].name, limit);
        while let Some(event) = parts[k].next().transpose()? {
            if passing.pass(event, &mut writer)? {
                break;
            }
        }
        if passing.enough() {
            break;
        }
        if k + 1 < parts.len() && !passing.over() {
            return Err(parts[k].gap(&parts[k + 1], passing.known()).into());
        }
    }
    if let (Some(stop), Some(last)) = (&passing.stopped, parts.last()) {
        // What was recorded is passed on, but the stream has no end: what is downstream must not look whole.
        writer.flush_chunk()?;
        return Err(stop.told(&last.name).into());
    }
    passing.again(&mut writer)?;
    passing.send(f64::INFINITY, &mut writer)?;
    passing.promise_end(&mut writer)?;
    // The reader downstream may go on; whether the run is whole still matters.
    let out = writer.finish()?;
    if let Some(last) = parts.last_mut() {
        while last.next().transpose()?.is_some() {}
    }
    passing.done.start = passing.start.unwrap_or(0.0);
    passing.done.ahead = passing.starts.ahead();
    Ok((passing.done, out))
}
