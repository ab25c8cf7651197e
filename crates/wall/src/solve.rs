//! Radii point by point from equation (1).
//!
//! One equation for each pair, more pairs than points: not all can hold. What is minimised is
//!
//! ```text
//! Σ_pairs |ζ_ij(r_i, r_j) − ζ_ij| + 0.05 Σ_points ζ_i |ln(r_i/r̄_i)|
//! ```
//!
//! ζ_ij(r_i, r_j) the dent that the radii make, ζ_ij the one asked for, r̄ the uniform radius. A sum of absolute values is least where
//! many terms are exactly zero: ζ is changed on few pairs, and by little; the second sum keeps radii equal where the first
//! leaves a choice. Points are visited from the first: each takes, of the radii that meet (1) with one of its neighbours, its
//! own and r̄, the one with the least sum. Visits go by colours (no two neighbours have one colour), so that
//! points of a colour can be visited at once and the result does not depend on threads.

use crate::equation::{dent, partners};
use geom::Vec3;
use rayon::prelude::*;
use serde::Serialize;

const MOST_SWEEPS: usize = 12;
/// A sweep that gains less than this share is the last.
const WORTH: f64 = 0.03;
const EQUAL: f64 = 0.05;
/// Radii stay within this factor of r̄: beyond it contact search and time step pay for roughness nobody sees.
const WIDEST: f64 = 2.0;
/// ζ_ij counts as changed beyond this share of it.
const CHANGED: f64 = 1e-6;

/// What was changed to make the equations agree.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Changes {
    /// Pairs of neighbours.
    pub pairs: usize,
    /// Pairs whose ζ differs from what was asked for.
    pub pairs_changed: usize,
    /// Mean change over all pairs [m].
    pub mean_change: f64,
    /// Largest change [m].
    pub largest_change: f64,
}

/// Neighbours of each point with their distance [m] and the ζ [m] asked for.
struct Links {
    starts: Vec<u32>,
    to: Vec<(u32, f64, f64)>,
}

impl Links {
    fn of(&self, i: u32) -> &[(u32, f64, f64)] {
        &self.to[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }
}

/// Radii [m] for pairs of points [m] with roughness `zeta` [m] each, from the uniform ones `even` [m].
pub fn solve(points: &[Vec3], pairs: &[(u32, u32)], zeta: &[f64], even: &[f64]) -> Vec<f64> {
    let links = links(points, pairs, zeta);
    let colours = colours(&links, points.len());
    let mut radii = even.to_vec();
    let mut cost = vec![0.0; points.len()];
    // When (in steps of colours) a point was changed and visited: one whose neighbours stayed would choose the same again.
    let (mut changed, mut visited) = (vec![1u32; points.len()], vec![0u32; points.len()]);
    let (mut step, mut before) = (1, f64::INFINITY);
    for _ in 0..MOST_SWEEPS {
        for colour in &colours {
            step += 1;
            let stale =
                |i: &u32| links.of(*i).iter().any(|&(j, _, _)| changed[j as usize] > visited[*i as usize]);
            let due: Vec<u32> = colour.iter().copied().filter(stale).collect();
            let new: Vec<(f64, f64)> = due
                .par_iter()
                .with_min_len(256)
                .map(|&i| visit(links.of(i), &radii, i, zeta[i as usize], even[i as usize]))
                .collect();
            for (&i, (radius, sum)) in due.iter().zip(new) {
                let i = i as usize;
                visited[i] = step;
                if radii[i] != radius {
                    (radii[i], changed[i]) = (radius, step);
                }
                cost[i] = sum;
            }
        }
        let total: f64 = cost.iter().sum();
        if before - total <= WORTH * total {
            break;
        }
        before = total;
    }
    radii
}

/// The best radius of one point [m], and its sum [m].
fn visit(links: &[(u32, f64, f64)], radii: &[f64], i: u32, zeta: f64, even: f64) -> (f64, f64) {
    let sum = |radius: f64| {
        let off = |&(j, p, want): &(u32, f64, f64)| {
            let other = radii[j as usize];
            // One sphere inside the other is no wall: never chosen, whatever it saves elsewhere.
            let nested = if (radius - other).abs() >= p { links.len() as f64 * p } else { 0.0 };
            (dent(radius, other, p) - want).abs() + nested
        };
        links.iter().map(off).sum::<f64>() + EQUAL * zeta * libm::log(radius / even).abs()
    };
    let now = radii[i as usize];
    let mut best = (now, sum(now));
    let mut offer = |radius: f64| {
        let cost = sum(radius);
        if cost < best.1 * (1.0 - 1e-12) {
            best = (radius, cost);
        }
    };
    offer(even);
    let within = (even / WIDEST, even * WIDEST);
    for &(j, p, want) in links {
        partners(radii[j as usize], want, p, within).into_iter().flatten().for_each(&mut offer);
    }
    best
}

/// How far the dents of given radii are from those asked for.
pub fn changes(points: &[Vec3], pairs: &[(u32, u32)], zeta: &[f64], radii: &[f64]) -> Changes {
    let mut changes = Changes { pairs: pairs.len(), ..Changes::default() };
    for &(i, j) in pairs {
        let (i, j) = (i as usize, j as usize);
        let want = 0.5 * (zeta[i] + zeta[j]);
        let off = (dent(radii[i], radii[j], (points[i] - points[j]).norm()) - want).abs();
        changes.pairs_changed += (off > CHANGED * want) as usize;
        changes.mean_change += off / pairs.len() as f64;
        changes.largest_change = changes.largest_change.max(off);
    }
    changes
}

fn links(points: &[Vec3], pairs: &[(u32, u32)], zeta: &[f64]) -> Links {
    let mut starts = vec![0u32; points.len() + 1];
    for &(i, j) in pairs {
        starts[i as usize + 1] += 1;
        starts[j as usize + 1] += 1;
    }
    for i in 0..points.len() {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut to = vec![(0, 0.0, 0.0); 2 * pairs.len()];
    for &(i, j) in pairs {
        let p = (points[i as usize] - points[j as usize]).norm();
        let want = 0.5 * (zeta[i as usize] + zeta[j as usize]);
        for (a, b) in [(i, j), (j, i)] {
            to[next[a as usize] as usize] = (b, p, want);
            next[a as usize] += 1;
        }
    }
    Links { starts, to }
}

/// Each point, from the first, gets the lowest colour that no neighbour has.
fn colours(links: &Links, count: usize) -> Vec<Vec<u32>> {
    let mut colour = vec![u32::MAX; count];
    let mut sets: Vec<Vec<u32>> = Vec::new();
    for i in 0..count as u32 {
        let taken = |c: u32| links.of(i).iter().any(|&(j, _, _)| colour[j as usize] == c);
        let mine = (0..).find(|&c| !taken(c)).unwrap_or(0);
        colour[i as usize] = mine;
        if mine as usize == sets.len() {
            sets.push(Vec::new());
        }
        sets[mine as usize].push(i);
    }
    sets
}
