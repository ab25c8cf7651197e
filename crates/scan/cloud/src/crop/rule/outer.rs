//! Points beyond a given outer shape, as connected parts to remove.
//!
//! The outer shape of the equipment is a union of shapes, with a tolerance. Points farther outside are not equipment: a mounting,
//! a scaffold, a person. Points beyond are joined by steps of a few input spacings; small heaps are stray points, not parts.

use crate::neighbours::connected;
use crate::neighbours::density::{self, FEWEST};
use geom::{Shape, Vec3};
use rayon::prelude::*;
use serde::Serialize;

/// The outer shape of the equipment.
#[derive(Debug, Clone, Default)]
pub struct Outer {
    /// What it consists of; empty when none is described. None of them is an outside.
    pub shapes: Vec<Shape>,
    /// How far outside a point may be and still belong to the equipment [m].
    pub tolerance: f64,
}

/// Points that are joined lie at most so many input spacings apart (of the sparsest twentieth of the cloud).
const STEP: f64 = 4.0;
/// Share of the cloud that is sparser than the spacing that steps are taken from.
const SPARSE: f64 = 0.05;
/// Points judged by one task.
const CHUNK: usize = 1 << 12;

/// A connected heap of points beyond the outer shape.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OutsidePart {
    /// How many points it has.
    pub points: usize,
    /// Lowest coordinates [m].
    pub low: [f64; 3],
    /// Highest coordinates [m].
    pub high: [f64; 3],
    /// Mean place [m].
    pub middle: [f64; 3],
    /// Largest distance from the outer shape [m].
    pub beyond: f64,
}

/// What lies beyond the outer shape.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outside {
    /// Rows beyond, in order.
    #[serde(skip)]
    pub rows: Vec<u32>,
    /// Connected parts of at least thirty points, the largest first.
    pub parts: Vec<OutsidePart>,
    /// Points of smaller heaps.
    pub stray: usize,
    /// Largest step between two points of a part [m].
    pub step: f64,
}

/// What of the finite `points` [m] lies beyond.
pub fn beyond(points: &[Vec3], outer: &Outer) -> Outside {
    let off = |p: &Vec3| outer.shapes.iter().map(|s| s.solid.distance(p)).fold(f64::INFINITY, f64::min);
    let judged: Vec<Vec<(u32, f64)>> = points
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, some)| {
            let all = ((chunk * CHUNK) as u32..).zip(some).map(|(i, p)| (i, off(p)));
            all.filter(|(_, off)| *off > outer.tolerance).collect()
        })
        .collect();
    let out: Vec<(u32, f64)> = judged.into_iter().flatten().collect();
    let rows: Vec<u32> = out.iter().map(|(i, _)| *i).collect();
    let some: Vec<Vec3> = rows.iter().map(|&i| points[i as usize]).collect();
    let step = density::sparse(points, SPARSE).map_or(outer.tolerance, |d| STEP / d.sqrt());
    let part_of = connected::parts(&some, step);
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|&k| (part_of[k], k));
    let mut found = Outside { step, ..Outside::default() };
    for heap in order.chunk_by(|a, b| part_of[*a] == part_of[*b]) {
        if heap.len() < FEWEST {
            found.stray += heap.len();
        } else {
            found.parts.push(part(heap.iter().map(|&k| (some[k], out[k].1)), heap.len()));
        }
    }
    found.parts.sort_by_key(|part| std::cmp::Reverse(part.points));
    found.rows = rows;
    found
}

fn part(heap: impl Iterator<Item = (Vec3, f64)>, points: usize) -> OutsidePart {
    let (mut low, mut high) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let (mut sum, mut beyond) = (Vec3::zeros(), 0.0f64);
    for (p, off) in heap {
        (low, high, sum, beyond) = (low.inf(&p), high.sup(&p), sum + p, beyond.max(off));
    }
    OutsidePart { points, low: low.into(), high: high.into(), middle: (sum / points as f64).into(), beyond }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tube of radius 0.5 m along z, with an arm at its side and a lone point.
    fn tube() -> Vec<Vec3> {
        let wall = (0..20_000).map(|k| {
            let (turn, up) = (f64::from(k % 200) / 200.0, f64::from(k / 200) / 100.0);
            let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
            Vec3::new(0.5 * cos, 0.5 * sin, 2.0 * up)
        });
        let arm = (0..600).map(|k| Vec3::new(0.5 + 0.01 * f64::from(k / 20), 0.01 * f64::from(k % 20), 1.0));
        wall.chain(arm).chain([Vec3::new(0.0, 3.0, 0.0)]).collect()
    }

    fn outer(text: &str, tolerance: f64) -> Outer {
        Outer { shapes: vec![text.parse().unwrap()], tolerance }
    }

    #[test]
    fn an_arm_is_a_part_and_a_lone_point_is_stray() {
        let found = beyond(&tube(), &outer("cylinder:0,0,-0.01,0,0,2.01,0.5", 0.02));
        assert_eq!((found.parts.len(), found.stray), (1, 1), "{found:?}");
        let arm = found.parts[0];
        assert!((500..=580).contains(&arm.points) && (arm.beyond - 0.29).abs() < 0.04, "{arm:?}");
        assert!(arm.low[0] >= 0.5 && arm.high[0] < 0.8 && (arm.middle[2] - 1.0).abs() < 1e-9, "{arm:?}");
        assert_eq!(found.rows.len(), arm.points + 1);
    }

    #[test]
    fn nothing_is_beyond_a_wide_shape() {
        let found = beyond(&tube(), &outer("sphere:0,0,0,9", 0.0));
        assert!(found.parts.is_empty() && found.rows.is_empty() && found.stray == 0);
        let none = beyond(&[], &outer("sphere:0,0,0,9", 0.0));
        assert!(none.parts.is_empty() && none.rows.is_empty());
    }
}
