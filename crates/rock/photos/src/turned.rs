//! A stone that was turned over between two turns of the table: how its second place follows from the first.
//!
//! The two hulls are laid over each other in many orientations; where they overlap best, the move is refined until the silhouettes of both
//! agree ([`crate::coherence`]).

use crate::coherence::{Ball, refine, residuals};
use crate::hull::{HullError, View, carve, region};
use geom::Vec3;
use geom::random::orientation;
use nalgebra::{Matrix3, UnitQuaternion};
use rayon::prelude::*;
use remesh::Samples;

/// Cells of the two hulls.
const CELLS: usize = 64;
/// Orientations that are tried, and those of them that are refined.
const TRIED: usize = 1200;
const REFINED: usize = 8;
const COMPARED: usize = 3;
/// Points of a hull that are laid over the other.
const POINTS: usize = 3000;
/// Views of each place and rays of a view by which orientations are compared, and by which the best is refined.
const FEW: [usize; 2] = [9, 9];
const MANY: [usize; 2] = [24, 20];

/// A rigid move x ↦ Q x + q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// Q.
    pub turn: UnitQuaternion<f64>,
    /// q [m].
    pub shift: Vec3,
}

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alignment {
    /// From the second place to the first.
    pub place: Move,
    /// Volume of both hulls over that of either, laid over each other [–].
    pub overlap: f64,
    /// Root of the mean square distance by which edges of silhouettes miss the others [m].
    pub residual: f64,
    /// The same of the best other orientation [m].
    pub other: f64,
}

impl Move {
    /// Views of the second place as views of the first.
    pub fn views(&self, views: &[View]) -> Vec<View> {
        let back: Matrix3<f64> = self.turn.inverse().to_rotation_matrix().into_inner();
        let shift = -(back * self.shift);
        let moved = |v: &View| View { camera: v.camera.after(&back, &shift), field: v.field.clone() };
        views.iter().map(moved).collect()
    }
}

/// A hull as points inside it.
struct Body {
    samples: Samples,
    points: Vec<Vec3>,
    centre: Vec3,
    volume: f64,
    radius: f64,
}

fn body(views: &[View]) -> Result<Body, HullError> {
    let samples = carve(views, &region(views)?, CELLS);
    let inside: Vec<Vec3> = (0..samples.values.len())
        .filter(|n| samples.values[*n] > 0.0)
        .map(|n| samples.place(samples.node(n)))
        .collect();
    let centre = inside.iter().sum::<Vec3>() / inside.len() as f64;
    let count = POINTS.min(inside.len());
    let points = (0..count).map(|k| inside[k * inside.len() / count]).collect();
    let radius = inside.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
    let volume = inside.len() as f64 * samples.step.powi(3);
    Ok(Body { samples, points, centre, volume, radius })
}

/// Share of the overlap of the first body with the second one moved.
fn overlap(first: &Body, second: &Body, place: &Move) -> f64 {
    let within = second
        .points
        .iter()
        .filter(|p| first.samples.at(&(place.turn * *p + place.shift)).is_some_and(|d| d > 0.0));
    let both = within.count() as f64 / second.points.len() as f64 * second.volume;
    both / (first.volume + second.volume - both)
}

/// The move from the second place of a stone to the first.
///
/// # Errors
/// Views of one place that have no hull.
pub fn align(first: &[View], second: &[View]) -> Result<Alignment, HullError> {
    let (a, b) = (body(first)?, body(second)?);
    // The R3 sequence fills the orientations evenly.
    let even = |k: usize| {
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3]
            .map(|g| (0.5 + g * (k as f64 + 1.0)).fract())
    };
    let start = |k: usize| {
        let turn = orientation(even(k));
        let place = Move { turn, shift: a.centre - turn * b.centre };
        (overlap(&a, &b, &place), place)
    };
    let mut found: Vec<(f64, Move)> = (0..TRIED).into_par_iter().map(start).collect();
    found.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut near: Vec<(f64, Move)> =
        apart(&found, REFINED).into_par_iter().map(|m| climb(&a, &b, m)).collect();
    near.sort_by(|x, y| y.0.total_cmp(&x.0));
    let ball = Ball { centre: a.centre, radius: 1.05 * a.radius };
    let compared = |(overlap, place): (f64, Move)| {
        let (residual, place) = agree(first, second, FEW, &ball, &place);
        (residual, overlap, place)
    };
    let mut agreed: Vec<(f64, f64, Move)> = apart(&near, COMPARED).into_iter().map(compared).collect();
    agreed.sort_by(|x, y| x.0.total_cmp(&y.0));
    let (_, overlap, place) = agreed[0];
    let (residual, place) = agree(first, second, MANY, &ball, &place);
    Ok(Alignment { place, overlap, residual, other: agreed.get(1).map_or(f64::INFINITY, |o| o.0) })
}

/// The first of a sorted list that differ by more than 20°.
fn apart(found: &[(f64, Move)], most: usize) -> Vec<(f64, Move)> {
    let mut kept: Vec<(f64, Move)> = Vec::new();
    for one in found {
        if kept.len() < most && kept.iter().all(|k| k.1.turn.angle_to(&one.1.turn) > 0.35) {
            kept.push(*one);
        }
    }
    kept
}

/// Turns and shifts by less and less as long as the overlap grows.
fn climb(a: &Body, b: &Body, (mut best, mut place): (f64, Move)) -> (f64, Move) {
    let mut step = 0.2;
    while step > 0.01 {
        let mut improved = false;
        for k in 0..12 {
            let mut by = Vec3::zeros();
            by[k / 2 % 3] = if k % 2 == 0 { step } else { -step };
            let next = if k < 6 {
                about(&place, &a.centre, by)
            } else {
                Move { shift: place.shift + by * a.radius, ..place }
            };
            let found = overlap(a, b, &next);
            if found > best {
                (best, place, improved) = (found, next, true);
            }
        }
        if !improved {
            step /= 2.0;
        }
    }
    (best, place)
}

/// A move followed by a turn about a centre.
fn about(place: &Move, centre: &Vec3, by: Vec3) -> Move {
    let turn = UnitQuaternion::from_scaled_axis(by);
    Move { turn: turn * place.turn, shift: turn * (place.shift - centre) + centre }
}

/// Refines a move until the silhouettes agree: the residual and the move.
fn agree(
    first: &[View],
    second: &[View],
    [views, rays]: [usize; 2],
    ball: &Ball,
    place: &Move,
) -> (f64, Move) {
    let some = |all: &[View]| -> Vec<View> {
        let count = views.min(all.len());
        (0..count).map(|k| all[k * all.len() / count].clone()).collect()
    };
    let (first, second) = (some(first), some(second));
    let moved = |p: &[f64]| {
        let next = about(place, &ball.centre, Vec3::new(p[0], p[1], p[2]));
        Move { shift: next.shift + Vec3::new(p[3], p[4], p[5]) * ball.radius, ..next }
    };
    let of = |p: &[f64]| residuals(&[&first[..], &moved(p).views(&second)].concat(), ball, rays);
    let (found, residual) = refine(&[0.0; 6], &[2e-3; 6], of);
    (residual, moved(&found))
}
