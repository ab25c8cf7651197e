//! A motion as a table over time: shift and angle, linear between the rows, constant after the last one.

use crate::Vec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Rates below this share of the largest are rest: rounding turns to and fro as well.
const NOISE: f64 = 1e-6;

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PathRow {
    /// Time since the motion started [s].
    pub time: f64,
    /// Shift, relative to the first row [m].
    pub shift: Vec3,
    /// Angle about the axis, relative to the first row [rad].
    pub angle: f64,
}

/// A table over time. The wall is where it is drawn until the time of the first row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Path {
    /// Axis of the angle, of length 1; 0: there is none.
    pub about: Vec3,
    rows: Vec<PathRow>,
}

/// Why rows are no path; `row` counts from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)]
pub enum PathError {
    #[error("{rows} rows: a motion needs two or more")]
    TooFew { rows: usize },
    #[error("row {}: t = {time} s: times begin at 0 or later", row + 1)]
    Negative { row: usize, time: f64 },
    #[error("row {}: t = {time} s is not after t = {before} s: the wall would be at two positions at one time", row + 1)]
    NotAfter { row: usize, time: f64, before: f64 },
    #[error("row {}: a value is not finite", row + 1)]
    NotFinite { row: usize },
}

/// Where a path is, and how fast.
pub(super) struct PathPoint {
    pub shift: Vec3,
    pub velocity: Vec3,
    pub angle: f64,
    pub spin: f64,
}

impl Path {
    /// Of rows in the order of time.
    ///
    /// # Errors
    /// Fewer than two rows, times that do not increase.
    pub fn new(about: Vec3, mut rows: Vec<PathRow>) -> Result<Path, PathError> {
        for (row, r) in rows.iter().enumerate() {
            if !(r.time.is_finite() && r.angle.is_finite() && r.shift.iter().all(|c| c.is_finite())) {
                return Err(PathError::NotFinite { row });
            }
            match row.checked_sub(1).map(|before| rows[before].time) {
                None if r.time < 0.0 => return Err(PathError::Negative { row, time: r.time }),
                Some(before) if r.time <= before => {
                    return Err(PathError::NotAfter { row, time: r.time, before });
                }
                _ => {}
            }
        }
        let [first, _, ..] = rows[..] else { return Err(PathError::TooFew { rows: rows.len() }) };
        for r in &mut rows {
            r.shift -= first.shift;
            r.angle -= first.angle;
        }
        Ok(Path { about: about.try_normalize(0.0).unwrap_or_default(), rows })
    }

    /// Its rows, relative to the first one.
    pub fn rows(&self) -> &[PathRow] {
        &self.rows
    }

    pub(super) fn last(&self) -> f64 {
        self.rows.last().map_or(0.0, |r| r.time)
    }

    /// Whether any two rows differ.
    pub fn moves(&self) -> bool {
        self.rows.iter().any(|r| r.shift != Vec3::zeros() || r.angle != 0.0)
    }

    /// The axis where it turns; 0 where it does not.
    pub fn axis(&self) -> Vec3 {
        if self.rows.iter().any(|r| r.angle != 0.0) { self.about } else { Vec3::zeros() }
    }

    pub(super) fn at(&self, time: f64) -> PathPoint {
        let next = self.rows.partition_point(|r| r.time <= time);
        let still = |r: Option<&PathRow>| {
            let (shift, angle) = r.map_or((Vec3::zeros(), 0.0), |r| (r.shift, r.angle));
            PathPoint { shift, velocity: Vec3::zeros(), angle, spin: 0.0 }
        };
        let (Some(before), Some(after)) = (next.checked_sub(1), self.rows.get(next)) else {
            return still(if next == 0 { None } else { self.rows.last() });
        };
        let before = &self.rows[before];
        let span = after.time - before.time;
        let (velocity, spin) = ((after.shift - before.shift) / span, (after.angle - before.angle) / span);
        let since = time - before.time;
        PathPoint {
            shift: before.shift + velocity * since,
            velocity,
            angle: before.angle + spin * since,
            spin,
        }
    }

    /// Largest speed [m/s] and rate of turning [rad/s].
    pub(super) fn fastest(&self) -> (f64, f64) {
        let of = |w: &[PathRow]| {
            let span = w[1].time - w[0].time;
            ((w[1].shift - w[0].shift).norm() / span, (w[1].angle - w[0].angle).abs() / span)
        };
        let largest = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.max(b.1));
        self.rows.windows(2).map(of).fold((0.0, 0.0), largest)
    }

    /// Frequency of its fastest motion to and fro [Hz], with half a period from one reversal to the next; 0: it reverses once at most.
    pub(super) fn vibration(&self) -> f64 {
        let shifts = [0, 1, 2].map(|axis| self.rates(|r| r.shift[axis]));
        let fastest = |rates: &[f64]| rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
        let most = shifts.iter().map(|rates| fastest(rates)).fold(0.0, f64::max);
        let angles = self.rates(|r| r.angle);
        let turning = fastest(&angles);
        let of_shifts = shifts.iter().map(|rates| self.reversals(rates, NOISE * most));
        let halves = of_shifts.chain([self.reversals(&angles, NOISE * turning)]);
        0.5 / halves.fold(f64::INFINITY, f64::min)
    }

    fn rates(&self, of: impl Fn(&PathRow) -> f64) -> Vec<f64> {
        self.rows.windows(2).map(|w| (of(&w[1]) - of(&w[0])) / (w[1].time - w[0].time)).collect()
    }

    /// Shortest time between two changes of the sign of a rate [s]; rates up to `noise` are rest. ∞ of fewer than two.
    fn reversals(&self, rates: &[f64], noise: f64) -> f64 {
        let (mut shortest, mut last, mut before) = (f64::INFINITY, None, 0.0);
        for (rate, row) in rates.iter().zip(&self.rows).filter(|(rate, _)| rate.abs() > noise) {
            if rate * before < 0.0 {
                shortest = last.map_or(shortest, |last| shortest.min(row.time - last));
                last = Some(row.time);
            }
            before = rate.signum();
        }
        shortest
    }

    /// Largest distance from where it begins [m].
    pub(super) fn farthest(&self) -> f64 {
        self.rows.iter().map(|r| r.shift.norm()).fold(0.0, f64::max)
    }
}
