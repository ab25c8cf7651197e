//! From the crossings of a run to an inlet stream, also while the run is still being written (SYSTEMS B4).

use crate::crossings::{self, CROSSINGS, Passage, SIZES, Sizes, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::inlet::{INLET, Source, zone_to_map};
use crate::material_info::MATERIALS;
use crate::run::{LOG, OUTLETS, RunError};
use crate::schedule::nanoseconds;
use dem::setup::Zone;
use geom::{Plane, Shown};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
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
}

/// Where the recorded intervals and in-plane places are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Intervals {
    /// On the generation plane, as in the source document: the faster ones then catch up in the zone, so that
    /// grains of a dense flow may overlap when they are released.
    #[default]
    Generation,
    /// On the calculation plane too: every particle is generated the same time T before it arrives, v T before its
    /// recorded place; T is what the first one needs for the length of the zone.
    Both,
}

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Replayed {
    /// Particles.
    pub particles: u64,
    /// Recorded time that became 0 [s].
    pub start: f64,
    /// Passage time of the last one, from the new 0 [s].
    pub last: f64,
}

struct Head {
    materials: BTreeMap<String, String>,
    sizes: Sizes,
    zone: Zone,
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
    let head = head(name, records, what)?;
    let mut writer = Writer::compressed(out, &provenance, compression)?;
    writer.metadata(MATERIALS, head.materials.clone())?;
    writer.metadata(SIZES, head.sizes.to_map())?;
    writer.metadata(INLET, zone_to_map(&head.zone))?;
    let start = if what.keep_times { Some(0.0) } else { what.from };
    let mut passing = Passing {
        name,
        what,
        head,
        start,
        ahead: None,
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
    // The reader downstream may go on; whether the run is whole still matters.
    let out = writer.finish()?;
    for event in events {
        event.map_err(broken)?;
    }
    passing.done.start = passing.start.unwrap_or(0.0);
    Ok((passing.done, out))
}

fn head(
    name: &str,
    mut records: BTreeMap<String, BTreeMap<String, String>>,
    what: &Replay,
) -> Result<Head, SceneError> {
    let no_run = |record: &str| {
        let why = format!("has no record '{record}' before its first message");
        SceneError::file(name, why, "give a run that dem-run wrote")
    };
    if !records.contains_key(crate::input::SCENE) {
        return Err(no_run(crate::input::SCENE));
    }
    let Some(outlets) = records.remove(OUTLETS) else {
        let why = "is a run without [[outlet]], so that nothing was recorded";
        return Err(SceneError::file(name, why, "make its scene with stage-split --keep upstream"));
    };
    let Some(json) = outlets.get(&what.outlet.to_string()) else {
        let why = format!("has {} outlets, none with index {}", outlets.len(), what.outlet);
        return Err(SceneError::file(name, why, "--outlet 0 is the first"));
    };
    let wrong = |e| SceneError::file(name, format!("record '{OUTLETS}': {e}"), "run dem-run again");
    let recorded: Zone = serde_json::from_str(json).map_err(wrong)?;
    let sizes = Sizes::from_map(name, &records.remove(SIZES).ok_or_else(|| no_run(SIZES))?)?;
    let zone =
        Zone { plane: what.at.unwrap_or(recorded.plane), length: what.length.unwrap_or(recorded.length) };
    if zone.length.is_nan() || zone.length <= 2.0 * sizes.largest {
        let why = format!(
            "--length {} m is not above the largest diameter, {} m",
            Shown(zone.length),
            Shown(2.0 * sizes.largest)
        );
        return Err(SceneError::file(name, why, format!("use at least {} m", Shown(2.4 * sizes.largest))));
    }
    Ok(Head { materials: records.remove(MATERIALS).ok_or_else(|| no_run(MATERIALS))?, sizes, zone })
}

struct Passing<'a> {
    name: &'a str,
    what: &'a Replay,
    head: Head,
    start: Option<f64>,
    /// T of [`Intervals::Both`] [s].
    ahead: Option<f64>,
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
            Event::Points { topic, table, .. } if topic == CROSSINGS => {
                let rows = crossings::from_table(self.name, &table, self.head.materials.len())?;
                let rows: Vec<Passage> = rows.into_iter().filter_map(|row| self.moved(row)).collect();
                if let Some(last) = rows.last() {
                    self.done.particles += rows.len() as u64;
                    self.done.last = last.time;
                    writer.points(CROSSINGS, nanoseconds(last.time), "world", &crossings::to_table(&rows))?;
                }
                Ok(false)
            }
            Event::Bytes { topic, data, .. } if topic == WATERMARK => {
                self.known = Watermark::read(self.name, &data)?.until;
                // Before the first passage there is no 0 to count from.
                if let Some(until) = self.start.map(|start| self.known - start).filter(|t| *t >= 0.0) {
                    writer.bytes(WATERMARK, "json", nanoseconds(until), &Watermark { until }.to_json())?;
                }
                writer.flush_chunk()?;
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

    /// A passage as it enters: on the generation plane, in the new time.
    fn moved(&mut self, mut row: Passage) -> Option<Passage> {
        let early = self.what.from.is_some_and(|from| row.time < from);
        let late = self.what.until.is_some_and(|until| row.time >= until);
        if row.outlet != self.what.outlet || early || late {
            return None;
        }
        let zone = self.head.zone;
        row.particle.position = match self.what.intervals {
            Intervals::Generation => {
                let point = zone.plane.point - zone.plane.normal * zone.length;
                Plane { point, ..zone.plane }.project(&row.particle.position)
            }
            Intervals::Both => {
                let velocity = row.particle.velocity;
                let ahead = *self.ahead.get_or_insert(zone.length / velocity.dot(&zone.plane.normal));
                zone.plane.project(&row.particle.position) - velocity * ahead
            }
        };
        row.time -= *self.start.get_or_insert(row.time);
        row.outlet = 0;
        Some(row)
    }
}
