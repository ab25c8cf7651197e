//! The shortest translation that takes a particle out of all faces that it overlaps: points of one wall whose normals differ little are one contact.
//!
//! ```text
//! u = argmin |u|  with  n_i·u ≥ δ_i for every point i of a group         q = |u|, the overlap; u/q, the normal
//! u = Σ λ_i n_i,  λ_i ≥ 0                                                at most three points bear
//! ```
//!
//! The force is F(q) along u, which is −dU/dx of one potential: q is the distance of the centre from where nothing is touched. So an elastic impact keeps its energy where faces meet at any
//! angle. Two faces of one plane push like one. Where a foot crosses a concave seam, its face does not bear yet as long as δ < r/(1 + cos θ), so that nothing jumps;
//! facets tend to the surface that they stand for. At a right angle of a linear law F(q) is the sum of both forces.

use super::seams::Member;
use primitives::Vec3;

/// Cosine of the angle between normals up to which points of a wall are one contact [–]: 45.6°, so that all corners of an octagon are.
const CREASE: f64 = 0.7;
/// Least square of the sine between two normals that bear together, and of the volume of three [–]: below, one of them is as good.
const LEAST_PAIR: f64 = 1e-9;
const LEAST_TRIPLE: f64 = 1e-14;

/// A point of a group.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Face {
    /// Its normal, towards the particle [–].
    pub normal: Vec3,
    /// Its overlap [m].
    pub overlap: f64,
}

/// Finds which of some points are one contact: each takes the number of the first of its group. `normal` tells that of the point at a place.
#[inline(always)]
pub fn groups(points: &mut [Member], normal: impl Fn(&Member) -> Vec3) {
    for (k, point) in (0..).zip(&mut *points) {
        point.group = k;
    }
    for a in 0..points.len() {
        for b in 0..a {
            if normal(&points[a]).dot(&normal(&points[b])) > CREASE {
                let (a, b) = (points[a].group, points[b].group);
                let (old, new) = (a.max(b), a.min(b));
                points.iter_mut().filter(|p| p.group == old).for_each(|p| p.group = new);
            }
        }
    }
}

/// u [m] of the points of a group, deepest first, and the one that bears most of it, as an index; `None` where the deepest bears alone.
#[inline(always)]
pub fn shortest(count: usize, face: impl Fn(usize) -> Face) -> Option<(Vec3, usize)> {
    if count < 2 {
        return None;
    }
    let deepest = face(0).overlap.max(0.0);
    let (mut longest, mut best) = (deepest * deepest, None);
    if deepest == 0.0 {
        return None;
    }
    let mut offer = |found: Option<(Vec3, usize)>| {
        if let Some((u, most)) = found.filter(|(u, _)| u.norm_squared() > longest) {
            (longest, best) = (u.norm_squared(), Some((u, most)));
        }
    };
    for a in 0..count {
        for b in a + 1..count {
            offer(pair([face(a), face(b)], [a, b]));
            for c in b + 1..count {
                offer(triple([face(a), face(b), face(c)], [a, b, c]));
            }
        }
    }
    best
}

/// u of two that bear, where both do.
#[inline(always)]
fn pair([a, b]: [Face; 2], at: [usize; 2]) -> Option<(Vec3, usize)> {
    let cosine = a.normal.dot(&b.normal);
    let square = a.normal.cross(&b.normal).norm_squared();
    let shares = [a.overlap - cosine * b.overlap, b.overlap - cosine * a.overlap];
    if square < LEAST_PAIR || shares.iter().any(|&share| share < 0.0) {
        return None;
    }
    let u = (a.normal * shares[0] + b.normal * shares[1]) / square;
    Some((u, at[usize::from(shares[1] > shares[0])]))
}

/// u of three that bear, where all do.
#[inline(always)]
fn triple(of: [Face; 3], at: [usize; 3]) -> Option<(Vec3, usize)> {
    let across = [1, 2, 0].map(|k: usize| of[k].normal.cross(&of[(k + 1) % 3].normal));
    let volume = of[0].normal.dot(&across[0]);
    if volume * volume < LEAST_TRIPLE {
        return None;
    }
    let u = (0..3).map(|k| across[k] * of[k].overlap).sum::<Vec3>() / volume;
    let shares = across.map(|n| n.dot(&u) / volume);
    let most = (1..3).fold(0, |m, k| if shares[k] > shares[m] { k } else { m });
    shares.iter().all(|&share| share >= 0.0).then(|| (u, at[most]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn shortest_of(faces: &[Face]) -> Option<(Vec3, usize)> {
        shortest(faces.len(), |k| faces[k])
    }

    fn groups_of(faces: &[Face]) -> Vec<u32> {
        let mut points: Vec<Member> = (0..faces.len() as u32).map(|at| Member { at, group: 0 }).collect();
        groups(&mut points, |m| faces[m.at as usize].normal);
        points.iter().map(|m| m.group).collect()
    }

    fn faces(of: &[(Vec3, f64)]) -> Vec<Face> {
        of.iter().map(|&(n, overlap)| Face { normal: n.normalize(), overlap }).collect()
    }

    /// The solution leaves no overlap, and is no longer than one that does; by projections in turn (Dykstra), which do not ask which faces bear.
    #[test]
    fn it_is_the_shortest_way_out() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut together = 0;
        for n in (2..=5).cycle().take(200) {
            let mut found: Vec<Face> = (0..n)
                .map(|_| Face {
                    normal: Vec3::new(0.7 * next() - 0.35, 0.7 * next() - 0.35, 1.0).normalize(),
                    overlap: 1.0 + 0.1 * next(),
                })
                .collect();
            found.sort_by(|a, b| b.overlap.total_cmp(&a.overlap));
            let several = shortest_of(&found);
            let u = several.map_or(found[0].normal * found[0].overlap, |(u, _)| u);
            let (mut x, mut corrections) = (Vec3::zeros(), vec![Vec3::zeros(); n]);
            for _ in 0..20_000 {
                for (face, correction) in found.iter().zip(&mut corrections) {
                    let from = x + *correction;
                    x = from + face.normal * (face.overlap - face.normal.dot(&from)).max(0.0);
                    *correction = from - x;
                }
            }
            assert!((u - x).norm() < 1e-6, "{found:?}: {u} instead of {x}");
            together += usize::from(several.is_some());
        }
        assert!(together > 50, "several bear together {together} times");
    }

    #[test]
    fn one_plane_pushes_once_and_a_right_angle_as_both() {
        assert_eq!(shortest_of(&faces(&[(Vec3::z(), 0.1), (Vec3::z(), 0.1)])), None);
        let (u, _) = shortest_of(&faces(&[(Vec3::x(), 0.3), (Vec3::z(), 0.2)])).expect("two");
        assert!((u - Vec3::new(0.3, 0.0, 0.2)).norm() < 1e-15, "{u}");
    }

    #[test]
    fn groups_are_joined_through_faces_between() {
        let at = |degrees: f64| (Vec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()), 0.1);
        assert_eq!(groups_of(&faces(&[at(0.0), at(80.0), at(40.0), at(170.0)])), [0, 0, 0, 3]);
        assert_eq!(groups_of(&faces(&[at(0.0), at(80.0)])), [0, 1]);
    }
}
