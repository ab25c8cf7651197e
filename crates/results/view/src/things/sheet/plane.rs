//! A plane as a sheet: a rectangle around everything, cut off where other planes stand, with a grid of round spacing.

use super::Sheet;
use crate::WallSurface;
use crate::appearance::scale::{Range, round_below};
use geom::{Plane, Vec3};

/// How far a plane is shown beyond all else, as a share of the size of all else [–].
const MARGIN: f64 = 0.06;

/// Squares of the grid along its longer side, about.
const SQUARES: f64 = 12.0;

/// The sheet of a plane, around the box `extent` [m].
pub fn sheet<'a>(surface: &'a WallSurface, plane: &Plane, extent: [Range; 3], beside: &[Plane]) -> Sheet<'a> {
    let [u, v] = directions(plane.normal);
    let corners: Vec<Vec3> = (0..8).map(|n| corner(extent, n)).collect();
    let reach = |d: Vec3| {
        let along = |p: &Vec3| p.dot(&d);
        let all = Range::of(corners.iter().map(along));
        if all.lo <= all.hi {
            all
        } else {
            Range { lo: along(&plane.point) - 1.0, hi: along(&plane.point) + 1.0 }
        }
    };
    let all = [reach(u), reach(v)];
    let size = all.iter().map(|r| r.hi - r.lo).fold(1e-9, f64::max);
    let step = round_below(1.01 * size / SQUARES * 2.0);
    let [across, along] = all.map(|r| whole_squares(r, MARGIN * size, step));
    let place = |a: f64, b: f64| plane.project(&(u * a + v * b));
    let rectangle = vec![
        place(across.lo, along.lo),
        place(across.hi, along.lo),
        place(across.hi, along.hi),
        place(across.lo, along.hi),
    ];
    let cut = beside.iter().fold(rectangle.clone(), |left, other| clipped(&left, other));
    let (polygon, beside) = if cut.len() < 3 { (rectangle, &[][..]) } else { (cut, beside) };
    let mut lines: Vec<[Vec3; 2]> = multiples(across, step)
        .map(|a| [place(a, along.lo), place(a, along.hi)])
        .chain(multiples(along, step).map(|b| [place(across.lo, b), place(across.hi, b)]))
        .filter_map(|line| beside.iter().try_fold(line, shortened))
        .collect();
    lines.extend((0..polygon.len()).map(|n| [polygon[n], polygon[(n + 1) % polygon.len()]]));
    let faces = (2..polygon.len() as u32).map(|n| [0, n - 1, n]).collect();
    let centre = Vec3::from_fn(|k, _| 0.5 * (extent[k].lo + extent[k].hi));
    let whole = corners.is_empty() || plane.signed_distance(&centre).abs() < 2.0 * size;
    Sheet { surface, vertices: polygon, faces, parts: Vec::new(), lines, ink: 0.3, closed: false, whole }
}

fn corner(of: [Range; 3], n: usize) -> Vec3 {
    Vec3::from_fn(|k, _| if n >> k & 1 == 0 { of[k].lo } else { of[k].hi })
}

/// Two directions in a plane, along the axes of the world where that can be.
fn directions(normal: Vec3) -> [Vec3; 2] {
    let least =
        if normal.x.abs() <= normal.y.abs().min(normal.z.abs()) + 1e-9 { Vec3::x() } else { Vec3::y() };
    let u = (least - normal * normal.dot(&least)).normalize();
    [u, normal.cross(&u)]
}

/// The range and a margin, as whole squares.
fn whole_squares(range: Range, margin: f64, step: f64) -> Range {
    Range { lo: ((range.lo - margin) / step).floor() * step, hi: ((range.hi + margin) / step).ceil() * step }
}

/// Multiples of `step` inside a range, without its ends.
fn multiples(range: Range, step: f64) -> impl Iterator<Item = f64> {
    let count = ((range.hi - range.lo) / step).round().min(1e3) as usize;
    (1..count).map(move |n| range.lo + n as f64 * step)
}

/// The part of a convex polygon on the positive side of a plane.
fn clipped(polygon: &[Vec3], by: &Plane) -> Vec<Vec3> {
    let mut kept = Vec::new();
    for (n, a) in polygon.iter().enumerate() {
        let b = &polygon[(n + 1) % polygon.len()];
        let [at_a, at_b] = [by.signed_distance(a), by.signed_distance(b)];
        if at_a >= 0.0 {
            kept.push(*a);
        }
        if at_a * at_b < 0.0 {
            kept.push(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    kept
}

/// The part of a line on the positive side of a plane.
fn shortened([a, b]: [Vec3; 2], by: &Plane) -> Option<[Vec3; 2]> {
    let [at_a, at_b] = [by.signed_distance(&a), by.signed_distance(&b)];
    let between = || a + (b - a) * (at_a / (at_a - at_b));
    match (at_a >= 0.0, at_b >= 0.0) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, between()]),
        (false, true) => Some([between(), b]),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::things::sheet::sheets;
    use crate::{Motion, SurfaceShape};

    fn surface(point: [f64; 3], normal: [f64; 3]) -> WallSurface {
        let plane = Plane::new(point.into(), normal.into()).expect("a direction");
        WallSurface { name: "p".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() }
    }

    #[test]
    fn a_floor_is_shown_as_whole_squares_around_the_grains() {
        let floor = [surface([0.0, 0.0, -1.0], [0.0, 0.0, 1.0])];
        let sheet = &sheets(&floor, [Range { lo: 0.0, hi: 1.0 }; 3])[0];
        let far = sheet.vertices.iter().map(|p| p.x.max(p.y)).fold(0.0, f64::max);
        assert!((far - 1.1).abs() < 1e-9 && sheet.vertices.iter().all(|p| p.z == -1.0), "{far}");
        assert_eq!((sheet.vertices.len(), sheet.faces.len()), (4, 2));
    }

    #[test]
    fn planes_of_a_box_end_where_they_meet() {
        let sides = [
            surface([0.0; 3], [1.0, 0.0, 0.0]),
            surface([0.0; 3], [0.0, 1.0, 0.0]),
            surface([0.0; 3], [0.0, 0.0, 1.0]),
        ];
        for sheet in sheets(&sides, [Range { lo: 0.0, hi: 1.0 }; 3]) {
            let ends = sheet.lines.iter().flatten().chain(&sheet.vertices);
            assert!(ends.flat_map(|p| p.iter().copied().collect::<Vec<_>>()).all(|c| c >= -1e-12));
        }
    }
}
