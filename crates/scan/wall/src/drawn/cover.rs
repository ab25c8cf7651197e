//! Which candidates become spheres, and how well they cover the surface.

use super::candidate::Candidate;
use crate::radii::pairs::{REACH, pairs};
use geom::{Grid, Vec3};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;
use sampling::cells::Cells;
use std::collections::HashMap;

/// Darts lie at least this share of P apart at first.
const FIRST_SHARE: f64 = 0.8;
/// Times that share is corrected.
const CORRECTIONS: usize = 3;

/// Spheres whose normals are more than about 100° apart are on two sides of a plate and do not see each other.
const OTHER_SIDE: f64 = -0.2;
/// Spheres nearer than this share of the distance are one, whatever they look at.
const ONE: f64 = 0.25;
/// Spheres of stretches may be this share of the spacing apart: two stretches may come near each other.
const CROWD: f64 = 0.5;
/// Seed of the order of the darts.
const SEED: u64 = 0x5ca1_ab1e;

/// Centres [m]: those on stretches, then as many of those on faces as have room, at distances whose mean is the spacing [m].
pub(crate) fn cover(on_stretches: &[Candidate], on_faces: &[Candidate], spacing: f64) -> Vec<Vec3> {
    let mut order: Vec<u32> = (0..on_faces.len() as u32).collect();
    order.shuffle(&mut Pcg64Mcg::seed_from_u64(SEED));
    let mut share = FIRST_SHARE;
    let mut best: Option<(f64, Vec<Vec3>)> = None;
    for _ in 0..=CORRECTIONS {
        let mut taken = PlacedSpheres::new(share.max(CROWD) * spacing);
        on_stretches.iter().for_each(|c| taken.offer(c, CROWD * spacing));
        order.iter().for_each(|&i| taken.offer(&on_faces[i as usize], share * spacing));
        let Some(mean) = mean_distance(&taken.centres, share * spacing) else { return taken.centres };
        let off = (mean / spacing - 1.0).abs();
        if best.as_ref().is_none_or(|(least, _)| off < *least) {
            best = Some((off, taken.centres));
        }
        share *= spacing / mean;
    }
    best.map(|(_, centres)| centres).unwrap_or_default()
}

/// Mean distance of neighbours [m]; none without neighbours.
fn mean_distance(centres: &[Vec3], nearest: f64) -> Option<f64> {
    let lengths = pairs(&Cells::new(centres, REACH * nearest), nearest).lengths;
    (!lengths.is_empty()).then(|| lengths.iter().sum::<f64>() / lengths.len() as f64)
}

/// Spheres so far, in cells as wide as the longest distance that is asked for.
struct PlacedSpheres {
    cell: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
    centres: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl PlacedSpheres {
    fn new(cell: f64) -> PlacedSpheres {
        PlacedSpheres { cell, cells: HashMap::new(), centres: Vec::new(), normals: Vec::new() }
    }

    /// Takes a candidate that is at least `apart` [m] from all of its side.
    fn offer(&mut self, candidate: &Candidate, apart: f64) {
        let [x, y, z] = [0, 1, 2].map(|a| (candidate.centre[a] / self.cell).floor() as i64);
        let around = (-1..=1).flat_map(|k| (-1..=1).flat_map(move |j| (-1..=1).map(move |i| (i, j, k))));
        for (i, j, k) in around {
            for &other in self.cells.get(&[x + i, y + j, z + k]).map_or(&[][..], Vec::as_slice) {
                let distance = (self.centres[other as usize] - candidate.centre).norm();
                let sees = self.normals[other as usize].dot(&candidate.normal) > OTHER_SIDE;
                if distance < apart * if sees { 1.0 } else { ONE } {
                    return;
                }
            }
        }
        self.cells.entry([x, y, z]).or_default().push(self.centres.len() as u32);
        self.centres.push(candidate.centre);
        self.normals.push(candidate.normal);
    }
}

/// The greatest distance from a position of the surface to the nearest sphere [m], and where it is. Where centres stand on the surface,
/// it is counted from the level of the spheres' tops.
pub(crate) fn deepest(positions: &[Candidate], centres: &[Vec3], radius: f64, centred: bool) -> (f64, Vec3) {
    if centres.is_empty() {
        return (0.0, Vec3::zeros());
    }
    let grid = Grid::new(centres, radius.max(1e-9));
    let depth = |c: &Candidate| {
        let top = if centred { c.at + c.normal * radius } else { c.at };
        let nearest = grid.nearest(centres, top, 1.5 * radius);
        let least = nearest.map_or(f64::INFINITY, |i| (centres[i as usize] - top).norm());
        ((least - radius).max(0.0), c.at)
    };
    let all: Vec<(f64, Vec3)> = positions.par_iter().map(depth).collect();
    all.into_iter().fold((0.0, Vec3::zeros()), |best, d| if d.0 > best.0 { d } else { best })
}
