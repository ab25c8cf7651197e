//! The path of chosen grains.
//!
//! ```text
//! way = |x − x_first|        from where the grain was first seen, in a straight line
//! ```

use crate::observer::OfFrame;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{Frame, MeasureError, Run};
use geom::Vec3;
use std::collections::BTreeMap;

/// Most grains that are followed: each is a row of every frame.
pub const MOST: usize = 1000;

/// Follows grains by their ids.
pub struct Track {
    /// Each with its first and its last position [m], once it was seen.
    grains: BTreeMap<u64, Option<[Vec3; 2]>>,
    fastest: f64,
    /// Smallest and largest id of any grain.
    known: [u64; 2],
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
        Ok(Track { grains, fastest: 0.0, known: [u64::MAX, 0] })
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
            let first = self.grains.get(&id).copied().flatten().map_or(x, |[first, _]| first);
            self.grains.insert(id, Some([first, x]));
            self.fastest = self.fastest.max(v.norm());
            let way = (x - first).norm();
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
        let ways = self.grains.values().flatten().map(|[first, last]| (last - first).norm());
        let summary = Summary::default()
            .with("grains", "", (self.grains.len() - unseen.len()) as f64)
            .with("way", "m", ways.clone().sum::<f64>() / ways.count().max(1) as f64)
            .with("largest_speed", "m/s", self.fastest);
        let note = format!("no frame holds the grains {}", unseen.join(", "));
        Ok((Vec::new(), if unseen.is_empty() { summary } else { summary.note(note) }))
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
