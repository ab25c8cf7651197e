//! Where a grain was between two frames.
//!
//! ```text
//! x(τ) = (1 + 2τ)(1 − τ)² x₀ + τ(1 − τ)² h v₀ + τ²(3 − 2τ) x₁ − τ²(1 − τ) h v₁      0 ≤ τ ≤ 1, h = t₁ − t₀
//! ```
//!
//! The cubic with the positions and velocities of both frames (Hermite): exact in free fall, of order h⁴ where forces are
//! smooth. A motion forth and back between two frames is not seen.

use crate::{Frame, Run};
use geom::Vec3;
use std::collections::{HashMap, HashSet};

/// The way of a grain between two frames.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    start: Vec3,
    end: Vec3,
    /// h v₀ and h v₁ [m].
    ways: [Vec3; 2],
    /// t₀ and t₁ [s].
    times: [f64; 2],
}

impl Path {
    /// The way between two states (position [m], velocity [m/s]) at two times [s].
    pub fn new(times: [f64; 2], start: (Vec3, Vec3), end: (Vec3, Vec3)) -> Path {
        let h = times[1] - times[0];
        Path { start: start.0, end: end.0, ways: [start.1 * h, end.1 * h], times }
    }

    /// Position [m] at a share τ of the time between the frames.
    pub fn at(&self, tau: f64) -> Vec3 {
        let rest = 1.0 - tau;
        self.start * ((1.0 + 2.0 * tau) * rest * rest)
            + self.ways[0] * (tau * rest * rest)
            + self.end * (tau * tau * (3.0 - 2.0 * tau))
            - self.ways[1] * (tau * tau * rest)
    }

    /// Time [s] and position [m] of the change from one answer to the other, which the two ends must give, by halving.
    pub fn change(&self, holds: impl Fn(&Vec3) -> bool) -> (f64, Vec3) {
        let at_start = holds(&self.start);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if holds(&self.at(middle)) == at_start { &mut low } else { &mut high }) = middle;
        }
        (self.times[0] + high * (self.times[1] - self.times[0]), self.at(high))
    }
}

/// The frame before, by id.
#[derive(Debug, Default)]
pub struct PreviousFrame {
    time: Option<f64>,
    states: HashMap<u64, (Vec3, Vec3)>,
}

impl PreviousFrame {
    /// Time of the frame before [s].
    pub fn time(&self) -> Option<f64> {
        self.time
    }

    /// The way of grain `row` of the next frame since the frame before, when it was there; in a periodic box, the
    /// way that ends where the grain is, and with it, where the grain went through a face, the one that starts
    /// where the grain was.
    pub fn paths(&self, run: &Run, frame: &Frame, row: usize) -> Option<(Path, Option<Path>)> {
        let times = [self.time?, frame.time];
        let old = *self.states.get(frame.id.get(row)?)?;
        let new = (*frame.position.get(row)?, *frame.velocity.get(row)?);
        let way = run.way(&old.0, &new.0);
        let path = Path::new(times, (new.0 - way, old.1), new);
        // The same but for rounding, unless a face was passed.
        let passed = (new.0 - old.0 - way).amax() > 1e-6 * way.amax().max(new.0.amax());
        let other = passed.then(|| Path::new(times, old, (old.0 + way, new.1)));
        Some((if passed { path } else { Path::new(times, old, new) }, other))
    }

    /// Position [m] and velocity [m/s] of the grains that are not in the next frame any more, in no order.
    pub fn vanished(&self, frame: &Frame) -> impl Iterator<Item = (Vec3, Vec3)> + '_ {
        let here: HashSet<u64> = frame.id.iter().copied().collect();
        self.states.iter().filter(move |(id, _)| !here.contains(id)).map(|(_, state)| *state)
    }

    /// Replaces this frame by the next one.
    pub fn replace(&mut self, frame: &Frame) {
        self.time = Some(frame.time);
        self.states.clear();
        let states = frame.position.iter().copied().zip(frame.velocity.iter().copied());
        self.states.extend(frame.id.iter().copied().zip(states));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_fall_is_followed_exactly() {
        let g = Vec3::new(0.0, 0.0, -9.81);
        let state = |t: f64| (Vec3::new(t, 0.0, 0.5 * g.z * t * t), Vec3::new(1.0, 0.0, g.z * t));
        let path = Path::new([0.1, 0.5], state(0.1), state(0.5));
        assert!((path.at(0.25) - state(0.2).0).norm() < 1e-14);
        let (time, position) = path.change(|p| p.z < -0.5 * 9.81 * 0.09);
        assert!((time - 0.3).abs() < 1e-12 && (position.x - 0.3).abs() < 1e-12, "{time} {position}");
    }
}
