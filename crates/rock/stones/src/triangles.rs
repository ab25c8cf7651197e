//! Whether two triangles meet, exactly: rounding never turns a touch into a gap or a gap into a touch.
//!
//! Two triangles that are not in one plane meet if and only if an edge of one meets the other. A segment pq meets a triangle abc if p and
//! q are not strictly on the same side of its plane and the line pq passes on the same side of ab, bc and ca (or through one of them). All
//! of this is signs of determinants, which the crate `robust` computes exactly: Shewchuk (1997), Discrete Comput. Geom. 18(3),
//! doi:10.1007/PL00009321. In one plane the same is decided in two dimensions, along the axis that the normal is longest in.
//! A common point is a meeting.

use geom::Vec3;
use geom::hull::side;
use robust::{Coord, orient2d};

/// Three corners [m].
pub(crate) type Triangle = [Vec3; 3];

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

/// Whether two triangles have a common point.
pub(crate) fn meet(a: &Triangle, b: &Triangle) -> bool {
    let sides = |t: &Triangle, u: &Triangle| u.each_ref().map(|p| side(&t[0], &t[1], &t[2], p));
    let apart = |s: [i8; 3]| s == [1; 3] || s == [-1; 3];
    let (of_b, of_a) = (sides(a, b), sides(b, a));
    if apart(of_b) || apart(of_a) {
        return false;
    }
    let edges = |t: &Triangle, s: [i8; 3], u: &Triangle| {
        (0..3).any(|k| crosses((&t[k], &t[(k + 1) % 3]), [s[k], s[(k + 1) % 3]], u))
    };
    edges(b, of_b, a) || edges(a, of_a, b)
}

/// Whether a segment meets a triangle.
pub(crate) fn segment_meets(p: &Vec3, q: &Vec3, t: &Triangle) -> bool {
    let sides = [p, q].map(|v| side(&t[0], &t[1], &t[2], v));
    crosses((p, q), sides, t)
}

/// The same, where the sides of the ends are known.
fn crosses((p, q): (&Vec3, &Vec3), sides: [i8; 2], t: &Triangle) -> bool {
    match sides {
        [1, 1] | [-1, -1] => false,
        [0, 0] => flat_meets(p, q, t),
        _ => {
            let around = [0, 1, 2].map(|k| side(p, q, &t[k], &t[(k + 1) % 3]));
            around.iter().all(|s| *s >= 0) || around.iter().all(|s| *s <= 0)
        }
    }
}

/// The axis along which a triangle is seen largest.
fn longest_normal(t: &Triangle) -> usize {
    (t[1] - t[0]).cross(&(t[2] - t[0])).iamax()
}

fn turn(axis: usize, a: &Vec3, b: &Vec3, c: &Vec3) -> i8 {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p[u], y: p[v] });
    sign(orient2d(a, b, c))
}

/// A segment in the plane of a triangle.
fn flat_meets(p: &Vec3, q: &Vec3, t: &Triangle) -> bool {
    let axis = longest_normal(t);
    let around = [0, 1, 2].map(|k| turn(axis, &t[k], &t[(k + 1) % 3], p));
    let inside = around.iter().all(|s| *s >= 0) || around.iter().all(|s| *s <= 0);
    // A triangle without area has no inside: its edges decide.
    let area = turn(axis, &t[0], &t[1], &t[2]) != 0;
    (inside && area) || (0..3).any(|k| segments_meet(axis, p, q, &t[k], &t[(k + 1) % 3]))
}

fn segments_meet(axis: usize, p: &Vec3, q: &Vec3, a: &Vec3, b: &Vec3) -> bool {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let [s, t] = [turn(axis, p, q, a), turn(axis, p, q, b)];
    let [k, l] = [turn(axis, a, b, p), turn(axis, a, b, q)];
    if [s, t, k, l] == [0; 4] {
        // On one line: as intervals along both axes.
        let overlap = |c: usize| p[c].min(q[c]) <= a[c].max(b[c]) && a[c].min(b[c]) <= p[c].max(q[c]);
        return overlap(u) && overlap(v);
    }
    s * t <= 0 && k * l <= 0
}

/// Whether two triangles with the common edge ab lie on each other: same plane, same side of the edge.
pub(crate) fn folded(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> bool {
    let axis = longest_normal(&[*a, *b, *c]);
    side(a, b, c, d) == 0 && turn(axis, a, b, c) * turn(axis, a, b, d) > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    /// One unit in the last place decides, also far from the origin, where products are rounded.
    #[test]
    fn a_touch_and_a_gap_differ_by_the_last_bit() {
        for shift in [0.0, 1e3, 0.1] {
            let flat = [v(shift, shift, 0.5), v(shift + 1.0, shift, 0.5), v(shift, shift + 1.0, 0.5)];
            let tip =
                |z: f64| [v(shift + 0.25, shift + 0.25, z), v(shift, shift, 9.0), v(shift + 1.0, shift, 9.0)];
            assert!(meet(&flat, &tip(0.5)) && meet(&tip(0.5), &flat));
            assert!(!meet(&flat, &tip(0.5f64.next_up())) && !meet(&tip(0.5f64.next_up()), &flat));
        }
        // Numbers of 40 bits: their sum is exact, so the four points are in one plane.
        let cut = |p: Vec3| p.map(|x| ((x * 2f64.powi(40)) as i64) as f64 / 2f64.powi(40));
        let [a, b] = [v(0.1, 0.2, 0.3), v(0.3, 0.1, 0.7)].map(cut);
        assert_eq!(side(&Vec3::zeros(), &a, &b, &(a + b)), 0);
        let above = (a + b).map(f64::next_up);
        assert_ne!(side(&Vec3::zeros(), &a, &b, &above), 0);
    }

    /// Against the least distance of points of a fine lattice on both triangles.
    #[test]
    fn random_triangles_meet_when_points_of_them_are_close() {
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let (mut met, mut apart) = (0, 0);
        for _ in 0..300 {
            let mut triangle =
                || [v(next(), next(), next()), v(next(), next(), next()), v(next(), next(), next())];
            let (a, b) = (triangle(), triangle());
            let n = 60;
            let least = (0..=n)
                .flat_map(|i| (0..=n - i).map(move |j| (i, j)))
                .map(|(i, j)| {
                    let (s, t) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                    let p = a[0] * (1.0 - s - t) + a[1] * s + a[2] * t;
                    (geom::mesh::closest_point(b, p) - p).norm()
                })
                .fold(f64::INFINITY, f64::min);
            if meet(&a, &b) {
                met += 1;
                assert!(least < 0.03, "{a:?} {b:?}: {least}");
            } else {
                apart += 1;
                assert!(least > 1e-9, "{a:?} {b:?}: {least}");
            }
        }
        assert!(met > 30 && apart > 30, "{met} {apart}");
    }

    #[test]
    fn triangles_in_one_plane() {
        let a = [v(0.0, 0.0, 1.0), v(1.0, 0.0, 1.0), v(0.0, 1.0, 1.0)];
        let moved = |x: f64, y: f64, s: f64| a.map(|p| v(x + s * p.x, y + s * p.y, 1.0));
        assert!(meet(&a, &moved(0.1, 0.1, 0.2)) && meet(&moved(0.1, 0.1, 0.2), &a), "one inside the other");
        assert!(meet(&a, &moved(1.0, 0.0, 1.0)), "a common corner");
        assert!(!meet(&a, &moved(1.0f64.next_up(), 0.0, 1.0)));
        assert!(folded(&a[0], &a[1], &a[2], &v(0.5, 0.2, 1.0)));
        assert!(
            !folded(&a[0], &a[1], &a[2], &v(0.5, -0.2, 1.0))
                && !folded(&a[0], &a[1], &a[2], &v(0.5, 0.2, 1.1))
        );
    }
}
