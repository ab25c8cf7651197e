//! What a wall follows: a force, or a stress on an area that other walls bound.

use geom::Vec3;
use serde::{Deserialize, Serialize};

/// A force that a wall follows ([`crate::passes::servo`] says how).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Servo {
    /// Which way the wall pushes [–].
    pub direction: Vec3,
    /// What it follows: a force of the wall on the particles along `direction` [N], or a stress on `area` [Pa].
    pub target: Target,
    /// Two lengths whose product is the area that the stress acts on; `None`: the target is a force.
    pub area: Option<[Length; 2]>,
    /// Largest speed [m/s].
    pub speed_limit: f64,
}

impl Servo {
    /// A constant force [N].
    pub fn force(direction: Vec3, force: f64, speed_limit: f64) -> Servo {
        Servo { direction, target: Target::constant(force), area: None, speed_limit }
    }
}

/// A side of an area.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Length {
    /// This length [m].
    Fixed(f64),
    /// The distance of two planes, walls by index, as they move.
    Between(usize, usize),
}

/// A number over time: linear between its rows, constant before the first and after the last one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Time [s] and value, in the order of time; at least one.
    rows: Vec<[f64; 2]>,
}

impl Target {
    /// The same at all times.
    pub fn constant(value: f64) -> Target {
        Target { rows: vec![[0.0, value]] }
    }

    /// Of rows (time [s], value); `None` without a row, or where times do not increase or a number is not finite.
    pub fn new(rows: Vec<[f64; 2]>) -> Option<Target> {
        let finite = rows.iter().flatten().all(|x| x.is_finite());
        let ordered = rows.windows(2).all(|w| w[0][0] < w[1][0]);
        (finite && ordered && !rows.is_empty()).then_some(Target { rows })
    }

    /// Its rows: time [s] and value.
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.rows
    }

    /// Its value at `time` [s].
    pub fn at(&self, time: f64) -> f64 {
        let next = self.rows.partition_point(|row| row[0] <= time);
        let (Some(&before), Some(&after)) = (next.checked_sub(1).map(|k| &self.rows[k]), self.rows.get(next))
        else {
            let end = if next == 0 { self.rows.first() } else { self.rows.last() };
            return end.map_or(0.0, |row| row[1]);
        };
        before[1] + (after[1] - before[1]) * ((time - before[0]) / (after[0] - before[0]))
    }
}
