//! Where a grain was between two frames.
//!
//! ```text
//! x(τ) = (1 + 2τ)(1 − τ)² x₀ + τ(1 − τ)² h v₀ + τ²(3 − 2τ) x₁ − τ²(1 − τ) h v₁      0 ≤ τ ≤ 1, h = t₁ − t₀
//! ```
//!
//! The cubic with the positions and velocities of both frames (Hermite): exact in free fall, of order h⁴ where forces are
//! smooth. A motion forth and back between two frames is not seen.
//!
//! In a periodic box the frames hold the image in the box. The way is the one that comes nearest to h (v₀ + v₁)/2, by any number of periods; where it
//! differs from that by more than a quarter of a period, it is not sure.

use crate::Frame;
use crate::periodic::PeriodicBox;
use geom::{Plane, Vec3, counted};
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

    /// Times of its ends [s].
    pub fn times(&self) -> [f64; 2] {
        self.times
    }

    /// Position [m] at a share τ of the time between the frames.
    pub fn at(&self, tau: f64) -> Vec3 {
        let rest = 1.0 - tau;
        self.start * ((1.0 + 2.0 * tau) * rest * rest)
            + self.ways[0] * (tau * rest * rest)
            + self.end * (tau * tau * (3.0 - 2.0 * tau))
            - self.ways[1] * (tau * tau * rest)
    }

    /// Corners of a box around it [m].
    fn bounds(&self) -> (Vec3, Vec3) {
        // Control points of the cubic.
        let near = [self.start + self.ways[0] / 3.0, self.end - self.ways[1] / 3.0, self.end];
        near.iter().fold((self.start, self.start), |(low, high), p| (low.inf(p), high.sup(p)))
    }

    fn moved(&self, shift: &Vec3) -> Path {
        Path { start: self.start + shift, end: self.end + shift, ..*self }
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

/// The way of a grain from where it was, through periodic faces, in a periodic box.
#[derive(Debug, Clone, Copy)]
pub struct Passage {
    /// The way, which starts in the box.
    pub path: Path,
    /// From the start to the end [m].
    pub way: Vec3,
    /// Periods in it [m]: zero where no face was passed.
    pub shift: Vec3,
    /// Whether the number of periods is sure.
    pub sure: bool,
    periodic: PeriodicBox,
}

impl Passage {
    /// Between two states (position [m], velocity [m/s]) at two times [s].
    pub fn new(periodic: &PeriodicBox, times: [f64; 2], start: (Vec3, Vec3), end: (Vec3, Vec3)) -> Passage {
        let expected = (start.1 + end.1) * (0.5 * (times[1] - times[0]));
        let (shift, sure) = periodic.passed(&start.0, &end.0, &expected);
        let path = Path::new(times, start, (end.0 + shift, end.1));
        Passage { path, way: end.0 - start.0 + shift, shift, sure, periodic: *periodic }
    }

    /// Times [s] and positions [m] at which it passes a plane in the box, and whether along its normal: once for a way inside the box, and
    /// for each image of a way through faces.
    pub fn through(&self, plane: &Plane) -> Vec<(f64, Vec3, bool)> {
        let beyond = |p: &Vec3| plane.signed_distance(p) >= 0.0;
        let change = |path: &Path| {
            let (start, end) = (beyond(&path.at(0.0)), beyond(&path.at(1.0)));
            (start != end).then(|| path.change(beyond)).map(|(time, position)| (time, position, end))
        };
        if self.shift == Vec3::zeros() {
            return change(&self.path).into_iter().collect();
        }
        let shifts = self.periodic.shifts(self.path.bounds(), self.periodic.corners());
        let images = shifts.iter().filter_map(|shift| change(&self.path.moved(shift)));
        let mut all: Vec<_> = images.filter(|(_, position, _)| self.periodic.contains(position)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // On a face, two images are in the box.
        all.dedup_by(|a, b| a.2 == b.2 && (a.0 - b.0).abs() <= 1e-9 * self.path.times[1].abs());
        all
    }
}

/// What measures say of ways that are not sure; `None` where all are.
pub fn unsure_note(count: u64) -> Option<String> {
    let ways = counted(count, "way");
    (count > 0).then(|| {
        format!(
            "{ways} between two frames may be wrong by a period of the domain: grains move further than their velocities tell; \
             set [output] every to less"
        )
    })
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

    /// The way of grain `row` of the next frame since the frame before, when it was there.
    pub fn passage(&self, frame: &Frame, row: usize) -> Option<Passage> {
        let times = [self.time?, frame.time];
        let old = *self.states.get(frame.id.get(row)?)?;
        let new = (*frame.position.get(row)?, *frame.velocity.get(row)?);
        Some(Passage::new(&frame.periodic, times, old, new))
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

/// Five grains of 1 m/s in a cell of 0.1 m, seen each 0.06 s for 0.48 s.
#[cfg(test)]
pub(crate) fn run_of_five(mut take: impl FnMut(&crate::Run, Frame)) {
    let periodic = PeriodicBox { range: [Some((0.0, 0.1)), None, None] };
    let run = crate::Run { periodic, ..Default::default() };
    for k in 0..9 {
        let time = 0.06 * f64::from(k);
        let at = |x: f64| Vec3::new((x + time) % 0.1, 0.0, 0.0);
        let frame = Frame {
            time,
            id: (0..5).collect(),
            position: [0.01, 0.03, 0.055, 0.07, 0.09].map(at).to_vec(),
            velocity: vec![Vec3::x(); 5],
            radius: vec![0.004; 5],
            mass: vec![2.0; 5],
            periodic,
            ..Frame::default()
        };
        take(&run, frame);
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

    /// A grain of 1 m/s in a cell of 0.1 m, seen after 0.26 s, passes a plane three times, and one on the face of the cell once a period.
    #[test]
    fn a_way_through_several_periods_passes_a_plane_each_time() {
        let cell = PeriodicBox { range: [Some((0.0, 0.1)), Some((0.0, 0.1)), None] };
        let v = Vec3::x();
        let state = |x: f64| (Vec3::new(x, 0.0, 0.0), v);
        let passage = Passage::new(&cell, [1.0, 1.26], state(0.03), state(0.09));
        assert!((passage.way.x - 0.26).abs() < 1e-12 && passage.sure);
        let times = |x: f64, n: f64| {
            let plane = Plane::new(Vec3::new(x, 0.0, 0.0), Vec3::new(n, 0.0, 0.0)).unwrap();
            passage.through(&plane).into_iter().map(|(t, _, along)| (t, along)).collect::<Vec<_>>()
        };
        for (x, n, right) in [
            (0.05, 1.0, [1.02, 1.12, 1.22]),
            (0.04, -1.0, [1.01, 1.11, 1.21]),
            (0.085, 1.0, [1.055, 1.155, 1.255]),
        ] {
            let found = times(x, n);
            assert_eq!(found.len(), 3, "{x}: {found:?}");
            let fits = |(a, b): (&(f64, bool), f64)| (a.0 - b).abs() < 1e-9 && a.1 == (n > 0.0);
            assert!(found.iter().zip(right).all(fits), "{x}: {found:?}");
        }
        assert_eq!([times(0.0, 1.0).len(), times(0.1, 1.0).len()], [2, 2]);
    }
}
