//! What a scanner saw: the space in front of what it measured is free.
//!
//! ```text
//! directions   from the viewpoint, in the cells of a cube's faces: about as many cells that hold points as there are points
//! free         every measured point in the cell of a direction, and in the eight around it, is farther than the position, by a margin
//! shadow       not free, and some point in the cell is nearer than the position; where it holds none, all points in the cells around it
//! unseen       neither: no point was measured in the cell, or it lies beside one
//! ```
//!
//! A space that is free from any viewpoint is free. A cell holds its nearest point alone, so a cloud of several scans needs no column of
//! scans: nothing of the cloud lies in front of the nearest. It takes 24 n² bytes for each viewpoint, n ≤ 2048: at most
//! 100 MB. This is the line-of-sight test of space carving (Curless & Levoy 1996, doi:10.1145/237170.237269), by direction in place of voxels.

use super::mesh::cover::Cover;
use crate::holes::hole::Hole;
use geom::{Grid, Vec3};
use serde::Serialize;

/// Points for each cell that holds some.
const POINTS: f64 = 1.0;
/// Most cells along an edge of the cube.
const MOST: f64 = 2048.0;

/// How far behind a point of the fill the scan must be for the space there to be free, in spacings around the hole.
const MARGIN: f64 = 3.0;
/// A point that is not seen, so near to one that is free, is free as well, in the same: the cells around it reach so far over the rim.
const BESIDE: f64 = 4.5;

/// How a position looks from the viewpoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sight {
    /// A scanner looked through it.
    Free,
    /// Something is in front of it.
    Shadow,
    /// Nothing was measured in its direction, or it is beside what was measured.
    Unseen,
}

/// How many points of a fill were seen to be free, or could not be seen.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct SightReport {
    /// In space that a scanner looked through: not added.
    pub free: usize,
    /// Behind something.
    pub shadow: usize,
    /// Neither: nothing was measured there.
    pub unseen: usize,
}

/// The viewpoints of a cloud.
pub(crate) struct Seen(Vec<View>);

/// The nearest points around a viewpoint.
struct View {
    eye: Vec3,
    /// Cells along an edge of the cube.
    side: usize,
    /// Distance of the nearest point by cell [m]; infinite where there is none.
    nearest: Vec<f32>,
}

impl Seen {
    /// From `eyes` [m], of finite `points` [m].
    pub fn new(points: &[Vec3], eyes: &[Vec3]) -> Seen {
        Seen(eyes.iter().map(|&eye| View::new(points, eye)).collect())
    }

    /// Drops what lies in space that a scanner looked through: of the local positions of a fill, and of the faces of its cover. Says how the
    /// fill looked.
    pub fn drop_free(&self, hole: &Hole, cover: &mut Cover, local: &mut Vec<Vec3>) -> SightReport {
        let spacing = cover.density.sqrt().recip();
        let sight = |p: &Vec3| self.sight(&hole.frame.world(p), MARGIN * spacing);
        let sights: Vec<Sight> = local.iter().map(sight).collect();
        let is_free = |(_, sight): &(&Vec3, &Sight)| **sight == Sight::Free;
        let free: Vec<Vec3> = local.iter().zip(&sights).filter(is_free).map(|(p, _)| *p).collect();
        let reach = BESIDE * spacing;
        let grid = Grid::new(&free, reach);
        let drops = |p: &Vec3, sight: Sight| {
            let beside = || grid.within(&free, *p, reach).next().is_some();
            sight == Sight::Free || sight == Sight::Unseen && beside()
        };
        cover.faces.retain(|face| {
            let middle = face.iter().map(|&i| cover.positions[i as usize]).sum::<Vec3>() / 3.0;
            !drops(&middle, sight(&middle))
        });
        let mut report = SightReport::default();
        let mut sights = sights.into_iter();
        local.retain(|p| {
            // As many sights as positions.
            let sight = sights.next().unwrap_or(Sight::Unseen);
            let goes = drops(p, sight);
            let count = match sight {
                _ if goes => &mut report.free,
                Sight::Shadow => &mut report.shadow,
                _ => &mut report.unseen,
            };
            *count += 1;
            !goes
        });
        report
    }

    /// How a position [m] looks; a point at most `margin` [m] behind it is a surface that it lies on.
    fn sight(&self, p: &Vec3, margin: f64) -> Sight {
        let sights = || self.0.iter().map(|view| view.sight(p, margin));
        let any = |wanted: Sight| sights().any(|sight| sight == wanted);
        if any(Sight::Free) {
            Sight::Free
        } else if any(Sight::Shadow) {
            Sight::Shadow
        } else {
            Sight::Unseen
        }
    }
}

impl View {
    fn new(points: &[Vec3], eye: Vec3) -> View {
        let even = (points.len() as f64 / (6.0 * POINTS)).sqrt().clamp(1.0, MOST);
        let coarse = View::with_side(points, eye, even as usize);
        // A scan that looks to one side fills a part of the cells: finer ones have as many points each.
        let filled = coarse.nearest.iter().filter(|r| r.is_finite()).count().max(1) as f64;
        let finer = (even * (points.len() as f64 / filled / POINTS).sqrt()).clamp(1.0, MOST);
        View::with_side(points, eye, finer as usize)
    }

    fn with_side(points: &[Vec3], eye: Vec3, side: usize) -> View {
        let mut view = View { eye, side, nearest: vec![f32::INFINITY; 6 * side * side] };
        for p in points {
            let off = p - eye;
            if let Some(cell) = view.cell(&off) {
                let nearest = &mut view.nearest[cell];
                *nearest = nearest.min(off.norm() as f32);
            }
        }
        view
    }

    /// The cell of a direction; none of no direction.
    fn cell(&self, off: &Vec3) -> Option<usize> {
        let axis = off.iamax();
        let depth = off[axis].abs();
        let [u, v] = [1, 2].map(|k| {
            let share = 0.5 + 0.5 * off[(axis + k) % 3] / depth;
            ((share * self.side as f64) as usize).min(self.side - 1)
        });
        let face = 2 * axis + usize::from(off[axis] < 0.0);
        (depth > 0.0).then(|| (face * self.side + u) * self.side + v)
    }

    fn sight(&self, p: &Vec3, margin: f64) -> Sight {
        let off = p - self.eye;
        let range = off.norm();
        let Some(own) = self.cell(&off) else { return Sight::Free };
        // The directions around are those of steps of a cell along the face, over its border as well.
        let axis = off.iamax();
        let step = 2.0 * off[axis].abs() / self.side as f64;
        let around = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|k| {
            let mut to = off;
            to[(axis + 1) % 3] += f64::from(k / 3 - 1) * step;
            to[(axis + 2) % 3] += f64::from(k % 3 - 1) * step;
            self.cell(&to).map_or(f64::INFINITY, |cell| f64::from(self.nearest[cell]))
        });
        let own = f64::from(self.nearest[own]);
        let in_front = |nearest: f64| nearest < range - margin;
        let mut known = around.iter().filter(|n| n.is_finite()).peekable();
        let hidden = if own.is_finite() {
            in_front(own)
        } else {
            known.peek().is_some() && known.all(|n| in_front(*n))
        };
        if hidden {
            Sight::Shadow
        } else if own.is_finite() && around.iter().all(|n| *n > range + margin) {
            Sight::Free
        } else {
            Sight::Unseen
        }
    }
}
