//! The convex hull of places on the picture, and whether it meets a rectangle.

/// Whether the hull of points and a rectangle (left, top, right, bottom) have a place in common.
pub(super) fn meets(points: Vec<[f64; 2]>, [left, top, right, bottom]: [f64; 4]) -> bool {
    let hull = hull(points);
    let mut part = vec![[left, top], [right, top], [right, bottom], [left, bottom]];
    for (n, a) in hull.iter().enumerate() {
        let b = hull[(n + 1) % hull.len()];
        part = kept(&part, *a, b);
    }
    hull.len() > 2 && !part.is_empty()
}

/// Twice the area of a triangle; above 0 where c lies to the left of a → b.
fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The part of a polygon on the left of a line.
fn kept(polygon: &[[f64; 2]], a: [f64; 2], b: [f64; 2]) -> Vec<[f64; 2]> {
    let mut out = Vec::new();
    for (n, p) in polygon.iter().enumerate() {
        let q = polygon[(n + 1) % polygon.len()];
        let [at_p, at_q] = [side(a, b, *p), side(a, b, q)];
        if at_p >= 0.0 {
            out.push(*p);
        }
        if at_p * at_q < 0.0 {
            let share = at_p / (at_p - at_q);
            out.push([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]);
        }
    }
    out
}

/// The corners of the hull, counted so that the inside is on the left (A. M. Andrew 1979, Information Processing
/// Letters 9(5): the lower and the upper chain of the sorted points).
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.retain(|p| p.iter().all(|v| v.is_finite()));
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1 && side(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let lower = chain(&mut points.iter().copied());
    let upper = chain(&mut points.iter().rev().copied());
    [lower, upper].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_meets_the_rectangles_that_it_covers_in_part() {
        let triangle = vec![[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 1.0]];
        let with = |part| meets(triangle.clone(), part);
        assert!(with([1.0, 1.0, 1.5, 1.5]) && with([3.0, -1.0, 9.0, 9.0]) && with([-9.0, -9.0, 9.0, 9.0]));
        assert!(!with([3.0, 3.0, 9.0, 9.0]) && !with([-2.0, 0.0, -1.0, 4.0]));
        assert!(!meets(vec![[1.0, 1.0]], [0.0, 0.0, 2.0, 2.0]));
    }
}
