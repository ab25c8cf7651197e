//! The path of chosen grains.
//!
//! ```text
//! way = |x − x_first|        from where the grain was first seen, in a straight line
//! ```
//!
//! In a periodic box x counts the periods that the grain has passed ([`crate::path`]).

use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::path::{Passage, unsure_note};
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{Frame, MeasureError, Run};
use geom::Vec3;
use std::collections::BTreeMap;

/// Most grains that are followed: each is a row of every frame.
pub const MOST: usize = 1000;

/// Follows grains by their ids.
pub struct Track {
    /// Each, once it was seen.
    grains: BTreeMap<u64, Option<Followed>>,
    fastest: f64,
    /// Ways through periodic faces that may be wrong by a period.
    unsure: u64,
    /// Smallest and largest id of any grain.
    known: [u64; 2],
}

/// A grain that was seen.
#[derive(Debug, Clone, Copy)]
struct Followed {
    /// Where it was first seen [m].
    first: Vec3,
    /// Time [s], position [m] and velocity [m/s] in the last frame that holds it.
    time: f64,
    state: (Vec3, Vec3),
    /// Periods [m] that it has passed.
    shift: Vec3,
}

impl Followed {
    fn new(time: f64, state: (Vec3, Vec3)) -> Followed {
        Followed { first: state.0, time, state, shift: Vec3::zeros() }
    }

    /// In the next frame, and whether the number of periods is sure.
    fn next(self, frame: &Frame, state: (Vec3, Vec3)) -> (Followed, bool) {
        let passage = Passage::new(&frame.periodic, [self.time, frame.time], self.state, state);
        let shift = self.shift + passage.shift;
        (Followed { time: frame.time, state, shift, ..self }, passage.sure)
    }

    /// How far it is from where it was first seen [m].
    fn way(&self) -> f64 {
        (self.state.0 + self.shift - self.first).norm()
    }
}

impl Track {
    /// Of the grains with these ids.
    ///
    /// # Errors
    /// More than [`MOST`] of them.
    pub fn new(ids: &[u64]) -> Result<Track, MeasureError> {
        let grains: BTreeMap<u64, _> = ids.iter().map(|id| (*id, None)).collect();
        if grains.len() > MOST {
            let cure = "follow at most 1000";
            let value = grains.len() as f64;
            return Err(MeasureError::Setting { what: "number of grains", value, unit: "", cure });
        }
        Ok(Track { grains, fastest: 0.0, unsure: 0, known: [u64::MAX, 0] })
    }
}

impl OfFrame for Track {
    fn heads(&self) -> Vec<Head> {
        let metres = ["x", "y", "z"].map(|name| (name, "m"));
        let speeds = ["vx", "vy", "vz", "speed"].map(|name| (name, "m/s"));
        Head::list(&[&[("time", "s"), ("id", "1")], &metres[..], &[("way", "m")], &speeds[..]].concat())
    }

    fn measure(&mut self, _: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let mut rows: BTreeMap<u64, usize> = BTreeMap::new();
        for (row, id) in frame.id.iter().enumerate() {
            self.known = [self.known[0].min(*id), self.known[1].max(*id)];
            if self.grains.contains_key(id) {
                rows.insert(*id, row);
            }
        }
        let mut found = Vec::new();
        for (id, row) in rows {
            let (x, v) = (frame.position[row], frame.velocity[row]);
            let (grain, sure) = match self.grains.get(&id).copied().flatten() {
                Some(grain) => grain.next(frame, (x, v)),
                None => (Followed::new(frame.time, (x, v)), true),
            };
            self.grains.insert(id, Some(grain));
            self.unsure += u64::from(!sure);
            self.fastest = self.fastest.max(v.norm());
            let way = grain.way();
            found.push(vec![frame.time, id as f64, x.x, x.y, x.z, way, v.x, v.y, v.z, v.norm()]);
        }
        Ok(found)
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let unseen: Vec<String> =
            self.grains.iter().filter(|(_, seen)| seen.is_none()).map(|(id, _)| id.to_string()).collect();
        if unseen.len() == self.grains.len() {
            return Err(MeasureError::NoSuchGrain { ids: unseen.join(", "), known: self.known });
        }
        let ways = self.grains.values().flatten().map(Followed::way);
        let summary = Summary::default()
            .with("grains", "", (self.grains.len() - unseen.len()) as f64)
            .with("way", "m", ways.clone().sum::<f64>() / ways.count().max(1) as f64)
            .with("largest_speed", "m/s", self.fastest);
        let note = format!("no frame holds the grains {}", unseen.join(", "));
        let summary = if unseen.is_empty() { summary } else { summary.note(note) };
        Ok((Vec::new(), unsure_note(self.unsure).into_iter().fold(summary, Summary::note)))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let of = |id: &u64| {
            let mine = rows.iter().filter(|row| row[1] == *id as f64);
            let points = mine.map(|row| [row[0], row[5]]).collect();
            Curve { name: format!("grain {id}"), points, look: Look::Line }
        };
        Chart::new("Way of grains").curves(
            "time [s]",
            "way [m]",
            self.grains.keys().take(8).map(of).collect(),
        )
    }
}

impl Measure for Track {
    const NAME: &'static str = "track";
    const HELP: &'static str = "Path and velocity of the grains with these ids";
    const ARGUMENT: ArgumentKind = ArgumentKind::Ids;
    const FRAMES: Frames = Frames::Every;

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let track = Track::new(asked.ids()?).map_err(|e| AskError::Usage(format!("--track: {e}")))?;
        Ok(Box::new(PerFrame::new(track)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodic::PeriodicBox;

    #[test]
    fn a_grain_is_followed_by_its_id_wherever_its_row_is() {
        let frame = |time: f64, id: Vec<u64>| Frame {
            time,
            position: id.iter().map(|id| Vec3::new(*id as f64, 0.0, 2.0 * time)).collect(),
            velocity: vec![Vec3::new(0.0, 0.0, 2.0); id.len()],
            radius: vec![0.1; id.len()],
            id,
            ..Frame::default()
        };
        let mut track = Track::new(&[7, 3, 9]).unwrap();
        let mut rows = track.measure(&Run::default(), &frame(0.0, vec![1, 7, 3])).unwrap();
        rows.extend(track.measure(&Run::default(), &frame(0.5, vec![3, 2])).unwrap());
        let short: Vec<[f64; 4]> = rows.iter().map(|r| [r[0], r[1], r[4], r[5]]).collect();
        assert_eq!(short, [[0.0, 3.0, 0.0, 0.0], [0.0, 7.0, 0.0, 0.0], [0.5, 3.0, 1.0, 1.0]]);
        let (_, summary) = track.end().unwrap();
        assert_eq!([summary.get("grains"), summary.get("way")], [Some(2.0), Some(0.5)]);
        let mut none = Track::new(&[8]).unwrap();
        assert!(none.measure(&Run::default(), &frame(0.0, vec![1, 7, 3])).unwrap().is_empty());
        assert_eq!(none.end().unwrap_err(), MeasureError::NoSuchGrain { ids: "8".into(), known: [1, 7] });
    }

    /// 1 m/s in a cell of 0.1 m: after ten frames of 0.03 s it is 0.3 m from the start, though it stands where it was.
    #[test]
    fn a_way_counts_the_periods_that_a_grain_has_passed() {
        let periodic = PeriodicBox { range: [Some((0.0, 0.1)), None, None] };
        let frame = |k: u32| Frame {
            time: 0.03 * f64::from(k),
            id: vec![0],
            position: vec![Vec3::new((0.01 + 0.03 * f64::from(k)) % 0.1, 0.0, 0.0)],
            velocity: vec![Vec3::x()],
            radius: vec![0.004],
            periodic,
            ..Frame::default()
        };
        let mut track = Track::new(&[0]).unwrap();
        let rows: Vec<Row> =
            (0..11).flat_map(|k| track.measure(&Run::default(), &frame(k)).unwrap()).collect();
        assert!((rows[10][5] - 0.3).abs() < 1e-9 && (rows[10][2] - 0.01).abs() < 1e-9, "{:?}", rows[10]);
        assert!(track.end().unwrap().1.notes.is_empty());
    }
}
