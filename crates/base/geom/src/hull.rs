//! The convex hull of points, exactly: point by point, faces that see the point are replaced by those from their rim to the point.
//!
//! Which faces see a point is decided by exact signs; a point in the plane of a face does not see it, so no face without area
//! is ever made.

use crate::{Vec3, mesh::TriMesh};
use robust::{Coord3D, orient3d};
use std::collections::HashSet;

/// The sign of the volume of abcd, exactly: positive where d is below abc, the side from which a, b, c run clockwise.
pub fn side(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> i8 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    let volume = orient3d(a, b, c, d);
    i8::from(volume > 0.0) - i8::from(volume < 0.0)
}

/// The hull of points [m] that are not all in one plane; `None` if they are.
pub fn hull(points: &[Vec3]) -> Option<TriMesh> {
    Some(packed(points, &hull_faces(points)?))
}

/// The faces of the hull, by the numbers of the points; `None` where all points [m] are in one plane.
pub fn hull_faces(points: &[Vec3]) -> Option<Vec<[u32; 3]>> {
    let first = tetrahedron(points)?;
    let [a, b, c, d] = first;
    let mut faces: Vec<[u32; 3]> = vec![[a, b, c], [a, d, b], [b, d, c], [c, d, a]];
    for (k, p) in (0u32..).zip(points) {
        let sees = |f: &[u32; 3]| {
            let [a, b, c] = f.map(|v| &points[v as usize]);
            side(a, b, c, p) < 0
        };
        let seen: Vec<bool> = faces.iter().map(sees).collect();
        if !seen.contains(&true) {
            continue;
        }
        let edges = |f: &[u32; 3]| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])];
        let removed = faces.iter().zip(&seen).filter(|(_, seen)| **seen);
        let all: Vec<(u32, u32)> = removed.flat_map(|(f, _)| edges(f)).collect();
        let set: HashSet<(u32, u32)> = all.iter().copied().collect();
        let rim = all.into_iter().filter(|(u, v)| !set.contains(&(*v, *u)));
        let new: Vec<[u32; 3]> = rim.map(|(u, v)| [u, v, k]).collect();
        let mut seen = seen.into_iter();
        faces.retain(|_| !seen.next().unwrap_or(false));
        faces.extend(new);
    }
    Some(faces)
}

/// Only the vertices that faces use.
fn packed(points: &[Vec3], faces: &[[u32; 3]]) -> TriMesh {
    let mut used: Vec<u32> = faces.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let place = |v: u32| used.binary_search(&v).unwrap_or(0) as u32;
    TriMesh {
        vertices: used.iter().map(|&v| points[v as usize]).collect(),
        faces: faces.iter().map(|f| f.map(place)).collect(),
    }
}

/// Four points that span a volume, the last one below the plane of the others.
fn tetrahedron(points: &[Vec3]) -> Option<[u32; 4]> {
    let farthest = |of: &dyn Fn(&Vec3) -> f64| {
        let all = points.iter().enumerate().map(|(k, p)| (of(p), k));
        all.fold((0.0, None), |best, (x, k)| if x > best.0 { (x, Some(k)) } else { best }).1
    };
    let a = *points.first()?;
    let b = points[farthest(&|p| (p - a).norm_squared())?];
    let c = points[farthest(&|p| (b - a).cross(&(p - a)).norm_squared())?];
    let n = (b - a).cross(&(c - a));
    let d = points[farthest(&|p| n.dot(&(p - a)).abs())?];
    let at = |q: Vec3| points.iter().position(|p| *p == q).map(|k| k as u32);
    let [i, j, k, l] = [at(a)?, at(b)?, at(c)?, at(d)?];
    match side(&a, &b, &c, &d) {
        1 => Some([i, j, k, l]),
        -1 => Some([i, k, j, l]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hulls_of_known_bodies() {
        // A lattice of points in a box: most lie in the planes of its sides and on its edges.
        let points: Vec<Vec3> = (0..125)
            .map(|k| Vec3::new(f64::from(k % 5), f64::from(k / 5 % 5) * 0.1, f64::from(k / 25) * 3.0))
            .collect();
        let found = hull(&points).unwrap();
        assert_eq!(found.open_edges(), 0);
        assert!((found.volume() - 4.0 * 0.4 * 12.0).abs() < 1e-12, "{}", found.volume());
        // All points of a ball are on its hull.
        let on_ball = |k: usize| {
            let (z, turn) = ((k as f64 + 0.5) / 250.0 - 1.0, 2.4 * k as f64);
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * libm::cos(turn), r * libm::sin(turn), z)
        };
        let found = hull(&(0..500).map(on_ball).collect::<Vec<Vec3>>()).unwrap();
        assert_eq!((found.vertices.len(), found.faces.len(), found.open_edges()), (500, 996, 0));
        assert!((found.volume() / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.02);
        assert!(hull(&points[..25]).is_none(), "points in one plane");
    }

    #[test]
    fn no_point_is_outside_its_hull() {
        let mut state = 9u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let points: Vec<Vec3> = (0..400).map(|_| Vec3::new(next(), next(), next())).collect();
        let found = hull(&points).unwrap();
        for [a, b, c] in found.triangles() {
            assert!(points.iter().all(|p| side(&a, &b, &c, p) >= 0));
        }
    }
}
