//! What is made of the crossings of a run, and what came of it.

use super::{Copies, Frame};
use dem::setup::ZoneMotion;
use geom::Plane;
use record::Map;
use serde::Serialize;

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
    pub(super) fn holds(&self, time: f64) -> bool {
        self.from.is_none_or(|from| time >= from) && self.until.is_none_or(|until| time < until)
    }

    /// The first option that does not go with recorded paths.
    pub(super) fn off_path(&self) -> Option<&'static str> {
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
    pub(super) fn to_map(&self) -> Map {
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
