//! A face of any number of corners, cut into triangles that cover it and nothing else.
//!
//! A convex face becomes a fan around its first corner. Any other one is cut by ears, on the plane of two axes on which it is largest (its normal is Newell's): a
//! corner is an ear if it turns left and neither a corner nor an edge of the rest lies in its triangle. Each corner stays a corner of a triangle, also on a
//! straight edge, because a neighbour may have it; published crates leave such corners out, so none is used. The cut begins at the lowest corner, whichever comes first
//! in the list.
//!
//! Meisters (1975), Polygons have ears, doi:10.2307/2319703. Orientations are exact: Shewchuk (1997), doi:10.1007/PL00009321.

use geom::Vec3;
use robust::{Coord, orient2d};

/// Most corners of a face that is not convex: time grows with their square.
const MOST_CORNERS: usize = 4096;
/// A turn this far to the right, as the sine of its angle, is straight [–]: coordinates of 4 bytes are not exact.
const STRAIGHT: f64 = 1e-6;

/// Adds the triangles of a face with these corners, at least three.
///
/// # Errors
/// Why it cannot be cut.
pub(crate) fn cut(face: &[u32], vertices: &[Vec3], into: &mut Vec<[u32; 3]>) -> Result<(), String> {
    if let &[a, b, c] = face {
        into.push([a, b, c]);
        return Ok(());
    }
    let at = |v: &u32| vertices.get(*v as usize).copied().unwrap_or_default();
    let corners: Vec<Vec3> = face.iter().map(at).collect();
    // What is not finite is refused with its vertex, once all faces are there.
    let finite = corners.iter().all(|c| c.iter().all(|x| x.is_finite()));
    if !finite || is_convex(&corners) {
        into.extend((2..face.len()).map(|i| [face[0], face[i - 1], face[i]]));
        return Ok(());
    }
    let cure = "triangulate it in the program that wrote it";
    if face.len() > MOST_CORNERS {
        return Err(format!(
            "{} corners; one that is not convex has at most {MOST_CORNERS}: {cure}",
            face.len()
        ));
    }
    let Some(mut flat) = flattened(&corners) else {
        return Err(format!("its {} corners cross over, and both sides are of one size: {cure}", face.len()));
    };
    let lowest = (0..flat.len()).min_by(|&i, &j| {
        let (a, b) = (flat[i], flat[j]);
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    let first = lowest.unwrap_or(0);
    flat.rotate_left(first);
    if let Some([i, j]) = crossing(&flat) {
        let corner = |k: usize| (k + first) % face.len() + 1;
        return Err(format!("its edges behind corners {} and {} cross: {cure}", corner(i), corner(j)));
    }
    let ears =
        ears(&flat).ok_or_else(|| format!("its {} corners enclose no single area: {cure}", face.len()))?;
    into.extend(ears.into_iter().map(|three| three.map(|k| face[(k + first) % face.len()])));
    Ok(())
}

/// Newell's normal, whose length is twice the area of the face.
fn normal(corners: &[Vec3]) -> Vec3 {
    let next = corners.iter().skip(1).chain(corners.first());
    let origin = corners.first().copied().unwrap_or_default();
    corners.iter().zip(next).map(|(a, b)| (a - origin).cross(&(b - origin))).sum()
}

/// Whether every corner turns left, and so does the fan around the first corner. A face without area counts as convex.
fn is_convex(corners: &[Vec3]) -> bool {
    let normal = normal(corners);
    let up = normal.try_normalize(0.0).unwrap_or_default();
    let n = corners.len();
    let turn = |a: Vec3, b: Vec3| (a.cross(&b), a.norm() * b.norm());
    let left = |(cross, size): (Vec3, f64)| cross.dot(&up) >= -STRAIGHT * size;
    let edge = |i: usize| corners[(i + 1) % n] - corners[i % n];
    let ray = |i: usize| corners[i] - corners[0];
    let flat = |(cross, size): (Vec3, f64)| cross.norm() <= STRAIGHT * size;
    let (turns, fan) = ((0..n).map(|i| turn(edge(i), edge(i + 1))), (2..n).map(|i| turn(ray(i - 1), ray(i))));
    if turns.clone().all(flat) && fan.clone().all(flat) {
        return true;
    }
    up != Vec3::zeros() && turns.chain(fan).all(left)
}

/// The corners on the plane of two axes on which the face is largest, anticlockwise; none where it has no area.
fn flattened(corners: &[Vec3]) -> Option<Vec<Coord<f64>>> {
    let normal = normal(corners);
    let axis = normal.iamax();
    let (lo, hi) = geom::grid::bounds(corners);
    if !(normal[axis].abs() > STRAIGHT * STRAIGHT * (hi - lo).norm_squared()) {
        return None;
    }
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if normal[axis] > 0.0 { (u, v) } else { (v, u) };
    Some(corners.iter().map(|c| Coord { x: c[u], y: c[v] }).collect())
}

/// Two edges that cross, each named by its first corner. Edges may touch, as those of a bridge to a hole.
fn crossing(flat: &[Coord<f64>]) -> Option<[usize; 2]> {
    let n = flat.len();
    let ends = |i: usize| (flat[i], flat[(i + 1) % n]);
    let mut order: Vec<usize> = (0..n).collect();
    let left = |i: usize| ends(i).0.x.min(ends(i).1.x);
    order.sort_by(|&i, &j| left(i).total_cmp(&left(j)));
    for (k, &i) in order.iter().enumerate() {
        let right = ends(i).0.x.max(ends(i).1.x);
        let near = order[k + 1..].iter().take_while(|&&j| left(j) <= right);
        if let Some(&j) = near.into_iter().find(|&&j| cross(ends(i), ends(j))) {
            return Some([i.min(j), i.max(j)]);
        }
    }
    None
}

type Segment = (Coord<f64>, Coord<f64>);

/// Whether two segments cross within both.
fn cross((a, b): Segment, (c, d): Segment) -> bool {
    let apart = |p: f64, q: f64| p > 0.0 && q < 0.0 || p < 0.0 && q > 0.0;
    apart(orient2d(a, b, c), orient2d(a, b, d)) && apart(orient2d(c, d, a), orient2d(c, d, b))
}

/// Cuts ears off until a triangle is left; none where there is no ear.
fn ears(flat: &[Coord<f64>]) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let (mut cut, mut at) = (Vec::with_capacity(flat.len()), 0);
    while left.len() > 3 {
        let n = left.len();
        let turns = (0..n).map(|k| (at + k) % n);
        // First one that touches nothing, then one that touches, at last one without an area.
        let found = turns
            .clone()
            .find(|&k| is_ear(flat, &left, k, true))
            .or_else(|| turns.clone().find(|&k| is_ear(flat, &left, k, false)))
            .or_else(|| turns.clone().find(|&k| turn(flat, &left, k) == 0.0))?;
        cut.push(three(&left, found));
        left.remove(found);
        // The next ear is not beside this one, so that triangles do not all meet in one corner.
        at = (found + 1) % left.len();
    }
    let last = three(&left, 1);
    cut.push(last);
    (orient2d(flat[last[0]], flat[last[1]], flat[last[2]]) >= 0.0).then_some(cut)
}

/// A corner with the corner before it and the one after it.
fn three(left: &[usize], k: usize) -> [usize; 3] {
    let n = left.len();
    [left[(k + n - 1) % n], left[k], left[(k + 1) % n]]
}

fn turn(flat: &[Coord<f64>], left: &[usize], k: usize) -> f64 {
    let [a, b, c] = three(left, k).map(|i| flat[i]);
    orient2d(a, b, c)
}

/// Whether the triangle of a corner lies within the rest of the face; if `strict`, no other corner lies on its sides either.
fn is_ear(flat: &[Coord<f64>], left: &[usize], k: usize, strict: bool) -> bool {
    if !(turn(flat, left, k) > 0.0) {
        return false;
    }
    let [a, b, c] = three(left, k).map(|i| flat[i]);
    let same = |p: Coord<f64>, q: Coord<f64>| p.x == q.x && p.y == q.y;
    let n = left.len();
    (2..n - 1).all(|step| {
        let (p, q) = (flat[left[(k + step) % n]], flat[left[(k + step + 1) % n]]);
        let sides = [orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p)];
        let is_corner = [a, b, c].into_iter().any(|corner| same(corner, p));
        let blocks = match strict {
            true => sides.iter().all(|side| *side >= 0.0),
            false => sides.iter().all(|side| *side > 0.0),
        };
        !(blocks && !is_corner) && !cross((c, a), (p, q))
    })
}
