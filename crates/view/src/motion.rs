//! Where a wall is that moves as one rigid body.
//!
//! ```text
//! x(t) = c + R(Ω τ)(x₀ − c) + v τ + a sin(2π f τ) d,   τ = min(max(t, from), until) − from
//! ```
//!
//! The engine has its own; this one is for showing what a run says about its walls.

use geom::Vec3;
use serde_json::Value;
use std::f64::consts::PI;
use stream::{Table, Values};

/// Rigid motion: a turn about a fixed axis, then a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// v [m/s].
    pub velocity: Vec3,
    /// Ω, axis times rate [rad/s].
    pub turn: Vec3,
    /// c, a point of the axis [m].
    pub through: Vec3,
    /// a d, amplitude and direction of the vibration [m].
    pub amplitude: Vec3,
    /// f [Hz].
    pub frequency: f64,
    /// When it starts to move [s].
    pub start: f64,
    /// When it stops, where it is then [s]; ∞: never.
    pub stop: f64,
}

impl Default for Motion {
    /// At rest.
    fn default() -> Motion {
        let zero = Vec3::zeros();
        let (frequency, start, stop) = (0.0, 0.0, f64::INFINITY);
        Motion { velocity: zero, turn: zero, through: zero, amplitude: zero, frequency, start, stop }
    }
}

impl Motion {
    /// The motion that a run writes of a wall; none when a number is missing or not finite.
    pub fn of(json: &Value) -> Option<Motion> {
        Some(Motion {
            velocity: vector(&json["velocity"])?,
            turn: vector(&json["turn"])?,
            through: vector(&json["through"])?,
            amplitude: vector(&json["amplitude"])?,
            frequency: json["frequency"].as_f64()?,
            start: json["from"].as_f64().unwrap_or(0.0),
            stop: json["until"].as_f64().unwrap_or(f64::INFINITY),
        })
    }

    /// Whether anything moves.
    pub fn moves(&self) -> bool {
        let still = |v: &Vec3| *v == Vec3::zeros();
        !(still(&self.velocity) && still(&self.turn) && (still(&self.amplitude) || self.frequency == 0.0))
    }

    /// Takes a point from where it is at t = 0 to where it is at `time` [s].
    pub fn to(&self, time: f64) -> impl Fn(Vec3) -> Vec3 {
        let time = self.since(time);
        let (turned, through, shift) = (self.turned(time), self.through, self.shift(time));
        move |home| through + turned(home - through) + shift
    }

    /// Takes a point from where it is at `time` [s] to where it is at t = 0.
    pub fn from(&self, time: f64) -> impl Fn(Vec3) -> Vec3 {
        let time = self.since(time);
        let (turned, through, shift) = (self.turned(-time), self.through, self.shift(time));
        move |place| through + turned(place - shift - through)
    }

    /// A table of spheres that are at their places at t = 0, as they are at `time` [s].
    pub fn place(&self, home: &Table, time: f64) -> Table {
        moved(home, self.to(time))
    }

    /// A table of spheres that are at their places at `time` [s], as they are at t = 0.
    pub fn home(&self, placed: &Table, time: f64) -> Table {
        moved(placed, self.from(time))
    }

    /// τ: how long it has moved at `time` [s].
    fn since(&self, time: f64) -> f64 {
        time.max(self.start).min(self.stop) - self.start
    }

    /// v t + a sin(2π f t) d [m].
    fn shift(&self, time: f64) -> Vec3 {
        self.velocity * time + self.amplitude * libm::sin(2.0 * PI * self.frequency * time)
    }

    /// R(Ω t), by Rodrigues' formula.
    fn turned(&self, time: f64) -> impl Fn(Vec3) -> Vec3 + use<> {
        let rate = self.turn.norm();
        let axis = if rate > 0.0 { self.turn / rate } else { Vec3::zeros() };
        let (sin, cos) = (libm::sin(rate * time), libm::cos(rate * time));
        move |v| {
            if rate > 0.0 { v * cos + axis.cross(&v) * sin + axis * (axis.dot(&v) * (1.0 - cos)) } else { v }
        }
    }
}

/// A table of spheres, each taken to another place; a table without places stays as it is.
fn moved(table: &Table, place: impl Fn(Vec3) -> Vec3) -> Table {
    let mut table = table.clone();
    let axes = ["x", "y", "z"].map(|name| table.get(name).map(Values::to_f64));
    let [Some(x), Some(y), Some(z)] = axes else { return table };
    let places: Vec<Vec3> = (0..x.len()).map(|i| place(Vec3::new(x[i], y[i], z[i]))).collect();
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        // A column as long as the one it replaces always fits.
        let _ = table.replace(name, Values::F64(places.iter().map(|p| p[k]).collect()));
    }
    table
}

/// Three finite numbers.
pub(crate) fn vector(json: &Value) -> Option<Vec3> {
    let numbers: Vec<f64> = json.as_array()?.iter().filter_map(Value::as_f64).collect();
    (numbers.len() == 3 && json.as_array()?.len() == 3).then(|| Vec3::from_column_slice(&numbers))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drum() -> Motion {
        Motion {
            velocity: Vec3::new(0.0, 0.0, 1.0),
            turn: Vec3::new(0.0, 0.0, 0.5 * PI),
            through: Vec3::new(1.0, 0.0, 0.0),
            amplitude: Vec3::new(0.0, 0.0, 0.25),
            frequency: 0.25,
            ..Motion::default()
        }
    }

    #[test]
    fn a_quarter_turn_a_shift_and_the_crest_of_a_vibration() {
        let place = drum().to(1.0)(Vec3::new(2.0, 0.0, 0.0));
        assert!((place - Vec3::new(1.0, 1.0, 1.25)).norm() < 1e-12, "{place}");
    }

    #[test]
    fn the_way_back_ends_where_the_way_there_began() {
        let home = Vec3::new(0.3, -0.7, 2.0);
        assert!((drum().from(0.37)(drum().to(0.37)(home)) - home).norm() < 1e-12);
        assert!(drum().moves() && !Motion::default().moves());
    }
}
