//! Walls: a shape × a motion, yielding contact points that are rows like a particle's.
//!
//! A wall sphere is its centre and radius; a plane or a triangle is the point of it that is nearest to the particle, with radius
//! 0. A wall has no mass of its own in a contact (1/m = 0, so m* = m_i).

use crate::lane::{Row, Row4};
use crate::motion::Pose;
use crate::particles::FAR;
use crate::setup::{Motion, Wall, WallShape};
use geom::triangle::{Feature, closest_feature};
use geom::{Grid, Plane, Vec3};

/// Two points of a mesh closer than this share of the radius are one contact [–].
const SAME_POINT: f64 = 1e-6;

/// A wall, ready to be met.
#[derive(Debug, Clone)]
pub struct WallBody {
    /// Motion.
    pub motion: Motion,
    surface: Surface,
    span: f64,
}

#[derive(Debug, Clone)]
enum Surface {
    /// In the grid's sorted order.
    Spheres {
        centres: Vec<Vec3>,
        radii: Vec<f64>,
        grid: Grid,
        largest: f64,
        original: Vec<u32>,
    },
    Plane(Plane),
    Triangles(Vec<[Vec3; 3]>),
}

impl WallBody {
    /// Sorts wall spheres into their own grid, once.
    pub fn new(wall: &Wall) -> WallBody {
        let reach = |points: &mut dyn Iterator<Item = Vec3>| {
            points.map(|p| (p - wall.motion.through).norm()).fold(0.0, f64::max)
        };
        let (surface, span) = match &wall.shape {
            WallShape::Spheres(spheres) => {
                let largest = spheres.iter().map(|s| s.1).fold(0.0, f64::max);
                let span = reach(&mut spheres.iter().map(|s| s.0)) + largest;
                (sorted_spheres(spheres, largest), span)
            }
            WallShape::Plane(plane) => (Surface::Plane(*plane), 0.0),
            WallShape::Mesh(mesh) => {
                let span = reach(&mut mesh.vertices.iter().copied());
                (Surface::Triangles(mesh.triangles().collect()), span)
            }
        };
        WallBody { motion: wall.motion, surface, span }
    }

    /// Whether contact points must be found anew in each step.
    pub fn renewed(&self) -> bool {
        self.flat() || self.motion.moves()
    }

    /// Whether its contact points belong to a flat surface.
    pub fn flat(&self) -> bool {
        !matches!(self.surface, Surface::Spheres { .. })
    }

    /// Upper bound of the speed of its surface [m/s].
    pub fn fastest(&self) -> f64 {
        self.motion.fastest(self.span)
    }

    /// Wall spheres now: centre and radius [m], in the order they were given.
    pub fn spheres(&self, time: f64) -> Vec<(Vec3, f64)> {
        let Surface::Spheres { centres, radii, original, .. } = &self.surface else { return Vec::new() };
        let pose = self.motion.pose(time);
        let mut out = vec![(Vec3::zeros(), 0.0); centres.len()];
        for (k, &o) in original.iter().enumerate() {
            out[o as usize] = (pose.place(&centres[k]), radii[k]);
        }
        out
    }

    /// Parts of the wall, as at t = 0, within `reach` [m] of `p`, in order.
    pub fn parts_near(&self, p: Vec3, reach: f64, mut found: impl FnMut(u32)) {
        match &self.surface {
            Surface::Spheres { centres, radii, grid, largest, .. } => {
                for k in grid.runs_near(p, reach + largest).flatten() {
                    let close = reach + radii[k];
                    if (centres[k] - p).norm_squared() < close * close {
                        found(k as u32);
                    }
                }
            }
            Surface::Plane(plane) => {
                if plane.signed_distance(&p) < reach {
                    found(0);
                }
            }
            Surface::Triangles(triangles) => {
                for (k, t) in triangles.iter().enumerate() {
                    let (lo, hi) = (t[0].inf(&t[1]).inf(&t[2]), t[0].sup(&t[1]).sup(&t[2]));
                    let outside = (0..3).any(|a| p[a] < lo[a] - reach || p[a] > hi[a] + reach);
                    if !outside && (closest_feature(*t, p).0 - p).norm_squared() < reach * reach {
                        found(k as u32);
                    }
                }
            }
        }
    }

    /// Contact points of one particle at `centre` [m]: `parts` are all the parts it may touch.
    pub fn meet(&self, pose: &Pose, centre: Vec3, parts: &[u32], rows: &mut [Row], spins: &mut [Row4]) {
        let local = pose.home(&centre);
        let mut put = |k: usize, place: Vec3, radius: f64| {
            let v = pose.velocity(&place);
            rows[k] = Row([place.x, place.y, place.z, radius, v.x, v.y, v.z, 0.0]);
            if let Some(spin) = spins.get_mut(k) {
                *spin = Row4([pose.turn.x, pose.turn.y, pose.turn.z, 0.0]);
            }
        };
        match &self.surface {
            Surface::Spheres { centres, radii, .. } => {
                for (k, &part) in parts.iter().enumerate() {
                    put(k, pose.place(&centres[part as usize]), radii[part as usize]);
                }
            }
            Surface::Plane(plane) => {
                for k in 0..parts.len() {
                    put(k, pose.place(&plane.project(&local)), 0.0);
                }
            }
            Surface::Triangles(triangles) => {
                let points = one_contact_each(triangles, local, parts);
                for (k, point) in points.into_iter().enumerate() {
                    // What is no contact of its own is put out of reach.
                    put(k, point.map_or(Vec3::repeat(FAR[1][0]), |p| pose.place(&p)), 0.0);
                }
            }
        }
    }
}

fn sorted_spheres(spheres: &[(Vec3, f64)], largest: f64) -> Surface {
    let centres: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
    let cell = if largest > 0.0 { 2.0 * largest } else { 1.0 };
    let order = Grid::new(&centres, cell).order().to_vec();
    let centres: Vec<Vec3> = order.iter().map(|&k| centres[k as usize]).collect();
    let grid = Grid::new(&centres, cell);
    let radii = order.iter().map(|&k| spheres[k as usize].1).collect();
    Surface::Spheres { centres, radii, grid, largest, original: order }
}

/// The nearest points of some triangles, without those that are the same contact again: a particle on the seam
/// of two triangles touches once, in a corner between two faces twice.
///
/// Points inside a face come first; a point on an edge or at a corner counts only where it does not lie on a
/// triangle that is in contact already. After Kremmer & Favier (2001), Int. J. Numer. Methods Eng. 51.
fn one_contact_each(triangles: &[[Vec3; 3]], p: Vec3, parts: &[u32]) -> Vec<Option<Vec3>> {
    let near: Vec<(Vec3, Feature)> =
        parts.iter().map(|&t| closest_feature(triangles[t as usize], p)).collect();
    let mut points: Vec<Option<Vec3>> =
        near.iter().map(|&(point, feature)| (feature == Feature::Face).then_some(point)).collect();
    let mut rest: Vec<usize> = (0..parts.len()).filter(|&k| points[k].is_none()).collect();
    rest.sort_by(|&a, &b| {
        (near[a].0 - p).norm_squared().total_cmp(&(near[b].0 - p).norm_squared()).then(a.cmp(&b))
    });
    for k in rest {
        let point = near[k].0;
        let tolerance = SAME_POINT * (point - p).norm();
        let lies_on =
            |m: usize| (closest_feature(triangles[parts[m] as usize], point).0 - point).norm() <= tolerance;
        let covered = (0..parts.len()).any(|m| points[m].is_some() && lies_on(m));
        if !covered {
            points[k] = Some(point);
        }
    }
    points
}
