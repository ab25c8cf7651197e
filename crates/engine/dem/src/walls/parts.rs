//! Spheres and triangles of a wall by their numbers, and its reference point.

use super::{Surface, WallBody};
use geom::Vec3;
use geom::motion::Pose;

impl WallBody {
    /// Number of its spheres or triangles.
    pub fn parts(&self) -> u32 {
        match &self.surface {
            Surface::Spheres { centres, .. } => centres.len() as u32,
            Surface::Plane(_) => 1,
            Surface::Triangles(triangles) => triangles.corners.len() as u32,
        }
    }

    /// Number of a part in the order in which the wall was given.
    pub fn given(&self, part: u32) -> u32 {
        match &self.surface {
            Surface::Spheres { original, .. } => original[part as usize],
            Surface::Plane(_) | Surface::Triangles(_) => part,
        }
    }

    /// Where the point is, in a pose, about which torques are taken [m]: on the axis of the first motion that turns, else at the origin at t = 0.
    pub fn reference(&self, pose: &Pose) -> Vec3 {
        pose.position(&self.motion.reference())
    }

    /// Centres of spheres and centroids of triangles [m], by their numbers in the order in which the wall was given.
    pub fn part_positions(&self, pose: &Pose, parts: impl Iterator<Item = u32>) -> Vec<Vec3> {
        match &self.surface {
            Surface::Spheres { .. } => {
                let all = self.spheres(pose);
                parts.map(|part| all[part as usize].0).collect()
            }
            Surface::Plane(plane) => parts.map(|_| pose.position(&plane.point)).collect(),
            Surface::Triangles(triangles) => {
                let centroid = |[a, b, c]: [Vec3; 3]| (a + b + c) / 3.0;
                parts.map(|part| pose.position(&centroid(triangles.corners[part as usize]))).collect()
            }
        }
    }
}
