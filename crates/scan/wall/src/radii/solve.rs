//! Radii point by point from equation (1).
//!
//! There is one equation for each pair, and more pairs than points, so not all can hold. The solver minimises
//!
//! ```text
//! Σ_pairs |ζ_ij(r_i, r_j) − ζ_ij| + 0.05 Σ_points ζ_i |ln(r_i/r̄_i)|
//! ```
//!
//! Here ζ_ij(r_i, r_j) is the dent that the radii make, ζ_ij the requested dent, and r̄ the uniform radius. A sum of absolute values is
//! smallest if many terms are exactly zero: so ζ changes on few pairs, and by little. The second sum keeps radii equal where the first
//! leaves a choice. The points are visited in order. Each point compares the radii that fulfil (1) with one of its neighbours, its current
//! radius and r̄, and takes the one with the smallest sum. Visits go by colours (neighbours differ in colour). So
//! points of one colour can be visited at once, and the result does not depend on threads.

use super::equation::{Beside, LANES, ROUNDED, dent, partners};
use multiversion::multiversion;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

const MOST_SWEEPS: usize = 12;
/// A sweep that gains less than this share is the last.
const WORTH: f64 = 0.02;
const EQUAL: f64 = 0.05;
/// Radii stay within this factor of r̄: beyond it contact search and time step pay for roughness without effect.
const WIDEST: f64 = 2.0;
/// Points are visited in parts of this many.
const PART: usize = 512;
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
    /// Least, mean and largest ζ of the pairs whose spheres meet [m]; zeros when none do.
    pub dents: [f64; 3],
    /// Pairs whose spheres do not meet, or lie one in the other.
    pub pairs_apart: usize,
}

/// A pair whose ζ is not what was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Changed {
    /// Numbers of the two points, in the order that they came in.
    pub points: [u32; 2],
    /// Middle between the two [m].
    pub at: [f64; 3],
    /// Distance of the two [m].
    pub distance: f64,
    /// ζ that was asked for [m].
    pub asked: f64,
    /// ζ that the radii make [m]; more than half the distance of spheres that do not meet.
    pub made: f64,
}

/// Neighbours of each point, a column each; behind the last, as many empty rows as there are lanes.
struct Links {
    starts: Vec<u32>,
    /// The other's number.
    to: Vec<u32>,
    /// Distance [m].
    p: Vec<f64>,
    /// ζ [m] asked for.
    zeta: Vec<f64>,
}

impl Links {
    fn of(&self, i: u32) -> Range<usize> {
        self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize
    }

    /// The rows from `row` on, as many as there are lanes.
    #[inline(always)]
    fn lanes(column: &[f64], row: usize) -> &[f64; LANES] {
        column[row..].first_chunk().unwrap_or(&[1.0; LANES])
    }
}

/// What is known while radii are looked for.
struct Sweep<'a> {
    links: &'a Links,
    zeta: &'a [f64],
    even: &'a [f64],
    radii: &'a [f64],
    /// When (in steps of colours) a point was changed and visited: one whose neighbours stayed would choose the same again.
    changed: &'a [u32],
    visited: &'a [u32],
}

/// What a visit chose for a point.
struct Choice {
    point: usize,
    /// [m]
    radius: f64,
    /// Of what its pairs are off [m].
    sum: f64,
}

/// Radii [m] for pairs of points at distances `lengths` [m] with roughness `zeta` [m] each point, from the uniform ones `even` [m].
pub fn solve(pairs: &[(u32, u32)], lengths: &[f64], zeta: &[f64], even: &[f64]) -> Vec<f64> {
    let links = links(pairs, lengths, zeta);
    let colours = colours(&links, even.len());
    let mut radii = even.to_vec();
    let mut cost = vec![0.0; even.len()];
    let (mut changed, mut visited) = (vec![1u32; even.len()], vec![0u32; even.len()]);
    let (mut step, mut before) = (1, f64::INFINITY);
    for _ in 0..MOST_SWEEPS {
        for colour in &colours {
            step += 1;
            let now =
                Sweep { links: &links, zeta, even, radii: &radii, changed: &changed, visited: &visited };
            let chosen: Vec<Vec<Choice>> =
                colour.par_chunks(PART).map(|part| visit_all(&now, part)).collect();
            for Choice { point: i, radius, sum } in chosen.into_iter().flatten() {
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

/// The choices of those points that may choose again.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn visit_all(now: &Sweep, points: &[u32]) -> Vec<Choice> {
    let mut visit = Visit::default();
    let mut chosen = Vec::with_capacity(points.len());
    for &i in points {
        let links = now.links.of(i);
        let visited = now.visited[i as usize];
        if now.links.to[links.clone()].iter().any(|&to| now.changed[to as usize] > visited) {
            let (radius, sum) = visit.choose(now, i, links);
            chosen.push(Choice { point: i as usize, radius, sum });
        }
    }
    chosen
}

/// One point's choice; the memory is used again for the next.
#[derive(Default)]
struct Visit {
    /// Radii to choose from [m], filled up to whole lanes.
    radii: Vec<f64>,
    /// Their sums [m].
    sums: Vec<f64>,
    /// Radii of the neighbours [m], and of the filler.
    others: Vec<f64>,
}

impl Visit {
    /// The best radius of one point [m], and its sum [m].
    #[inline(always)]
    fn choose(&mut self, now: &Sweep, i: u32, links: Range<usize>) -> (f64, f64) {
        let (zeta, even) = (now.zeta[i as usize], now.even[i as usize]);
        let count = self.candidates(now, i, links.clone());
        let Visit { radii, sums, others } = self;
        let rows = || now.links.p[links.clone()].iter().zip(&now.links.zeta[links.clone()]).zip(&*others);
        for (radii, sums) in radii.chunks_exact(LANES).zip(sums.chunks_exact_mut(LANES)) {
            let mut here = [0.0; LANES];
            for ((&p, &zeta), &other) in rows() {
                // One sphere inside the other is no wall: never chosen, whatever it saves elsewhere.
                let nested = links.len() as f64 * p;
                for k in 0..LANES {
                    let off = (dent(radii[k], other, p) - zeta).abs();
                    here[k] += off + if (radii[k] - other).abs() >= p { nested } else { 0.0 };
                }
            }
            sums.copy_from_slice(&here);
        }
        // The logarithm is expensive and only adds: a choice that loses without it loses.
        let equal = |radius: f64| EQUAL * zeta * libm::log(radius / even).abs();
        let mut best = (radii[0], sums[0] + equal(radii[0]));
        for (&radius, &sum) in radii.iter().zip(&*sums).take(count).skip(1) {
            let bar = best.1 * (1.0 - 1e-12);
            if sum < bar && sum + equal(radius) < bar {
                best = (radius, sum + equal(radius));
            }
        }
        best
    }

    /// Its own radius, the uniform one, and those that meet (1) with a neighbour; how many.
    #[inline(always)]
    fn candidates(&mut self, now: &Sweep, i: u32, links: Range<usize>) -> usize {
        let even = now.even[i as usize];
        let Visit { radii, sums, others } = self;
        others.clear();
        others.extend(now.links.to[links.clone()].iter().map(|&to| now.radii[to as usize]));
        others.resize(links.len() + LANES, even);
        radii.clear();
        radii.extend([now.radii[i as usize], even]);
        for first in (0..links.len()).step_by(LANES) {
            let beside = Beside {
                radius: Links::lanes(others, first),
                zeta: Links::lanes(&now.links.zeta, links.start + first),
                p: Links::lanes(&now.links.p, links.start + first),
            };
            partners(beside, links.len() - first, (even / WIDEST, even * WIDEST), radii);
        }
        let count = radii.len();
        radii.resize(count.next_multiple_of(LANES), even);
        sums.resize(radii.len(), 0.0);
        count
    }
}

/// How far the dents of given radii are from those asked for; `lengths` [m] are the pairs' distances.
pub fn changes(pairs: &[(u32, u32)], lengths: &[f64], zeta: &[f64], radii: &[f64]) -> Changes {
    let none = Changes { dents: [f64::INFINITY, 0.0, f64::NEG_INFINITY], ..Changes::default() };
    let parts: Vec<Changes> = pairs
        .par_chunks(PART * 8)
        .zip(lengths.par_chunks(PART * 8))
        .map(|(pairs, lengths)| {
            let mut part = Changes { pairs: pairs.len(), ..none };
            pairs.iter().zip(lengths).for_each(|(pair, p)| part.add(pair, *p, zeta, radii));
            part
        })
        .collect();
    // In order, so that the sums have the same bits for any number of threads.
    let mut all = parts.iter().fold(none, Changes::with);
    let met = all.pairs - all.pairs_apart;
    all.mean_change /= all.pairs.max(1) as f64;
    all.dents = if met > 0 { [all.dents[0], all.dents[1] / met as f64, all.dents[2]] } else { [0.0; 3] };
    all
}

/// A pair that counts as changed.
pub(crate) struct ChangedPair {
    /// Its number in the list of pairs.
    pub(crate) pair: usize,
    /// ζ asked for [m].
    pub(crate) asked: f64,
    /// ζ that the radii make [m].
    pub(crate) made: f64,
}

/// The pairs that count as changed.
pub(crate) fn changed<'a>(
    pairs: &'a [(u32, u32)],
    lengths: &'a [f64],
    zeta: &'a [f64],
    radii: &'a [f64],
) -> impl Iterator<Item = ChangedPair> + 'a {
    let all = (0..pairs.len()).map(move |pair| {
        let [i, j] = [pairs[pair].0 as usize, pairs[pair].1 as usize];
        let (asked, made) = (0.5 * (zeta[i] + zeta[j]), dent(radii[i], radii[j], lengths[pair]));
        ChangedPair { pair, asked, made }
    });
    all.filter(|c| (c.made - c.asked).abs() > CHANGED * c.asked)
}

impl Changes {
    /// Adds a pair; means are sums until the end.
    fn add(&mut self, &(i, j): &(u32, u32), p: f64, zeta: &[f64], radii: &[f64]) {
        let (i, j) = (i as usize, j as usize);
        let (want, dent) = (0.5 * (zeta[i] + zeta[j]), dent(radii[i], radii[j], p));
        let off = (dent - want).abs();
        self.pairs_changed += (off > CHANGED * want) as usize;
        self.mean_change += off;
        self.largest_change = self.largest_change.max(off);
        if p <= (radii[i] + radii[j]) * ROUNDED && (radii[i] - radii[j]).abs() < p {
            self.dents = [self.dents[0].min(dent), self.dents[1] + dent, self.dents[2].max(dent)];
        } else {
            self.pairs_apart += 1;
        }
    }

    fn with(self, other: &Changes) -> Changes {
        let (a, b) = (self.dents, other.dents);
        Changes {
            pairs: self.pairs + other.pairs,
            pairs_changed: self.pairs_changed + other.pairs_changed,
            mean_change: self.mean_change + other.mean_change,
            largest_change: self.largest_change.max(other.largest_change),
            dents: [a[0].min(b[0]), a[1] + b[1], a[2].max(b[2])],
            pairs_apart: self.pairs_apart + other.pairs_apart,
        }
    }
}

fn links(pairs: &[(u32, u32)], lengths: &[f64], zeta: &[f64]) -> Links {
    let mut starts = vec![0u32; zeta.len() + 1];
    for &(i, j) in pairs {
        starts[i as usize + 1] += 1;
        starts[j as usize + 1] += 1;
    }
    for i in 0..zeta.len() {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let rows = 2 * pairs.len() + LANES;
    let mut links = Links { starts, to: vec![0; rows], p: vec![1.0; rows], zeta: vec![1.0; rows] };
    for (&(i, j), &p) in pairs.iter().zip(lengths) {
        let zeta = 0.5 * (zeta[i as usize] + zeta[j as usize]);
        for (a, b) in [(i, j), (j, i)] {
            let row = next[a as usize] as usize;
            (links.to[row], links.p[row], links.zeta[row]) = (b, p, zeta);
            next[a as usize] += 1;
        }
    }
    links
}

/// Each point, from the first, gets the lowest colour that no neighbour has.
fn colours(links: &Links, count: usize) -> Vec<Vec<u32>> {
    let mut colour = vec![u32::MAX; count];
    let mut sets: Vec<Vec<u32>> = Vec::new();
    for i in 0..count as u32 {
        let taken = |c: u32| links.to[links.of(i)].iter().any(|&to| colour[to as usize] == c);
        let mine = (0..).find(|&c| !taken(c)).unwrap_or(0);
        colour[i as usize] = mine;
        if mine as usize == sets.len() {
            sets.push(Vec::new());
        }
        sets[mine as usize].push(i);
    }
    sets
}
