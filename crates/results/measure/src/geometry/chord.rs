//! The parts of a straight way that lie in a solid.
//!
//! Boxes, spheres, cylinders, cones and half spaces: the way is cut where it meets a surface, in closed form, and a piece lies inside if
//! its middle does. Prisms and meshes: 4 to 64 pieces are looked at, of 1/64 of the solid where these are enough, and the ends of what is inside are found by
//! halving; what is thinner than a piece may be missed.

use geom::{Vec3, shape::Solid};

/// Fewest and most pieces of a way that are looked at where a solid has no closed form; a piece is so many times shorter than the solid.
const PIECES: [f64; 2] = [4.0, 64.0];
/// Halvings of a piece: to 1e-11 of the way.
const HALVINGS: u32 = 30;

/// Shares of the way from a point [m] along a vector [m] that lie in a solid: start and end of each, in order.
pub fn inside(solid: &Solid, from: &Vec3, way: &Vec3) -> Vec<[f64; 2]> {
    let (low, high) = solid.bounds();
    let to = from + way;
    if (0..3).any(|k| from[k].max(to[k]) < low[k] || from[k].min(to[k]) > high[k]) {
        return Vec::new();
    }
    let mut cuts = vec![0.0, 1.0];
    match solid {
        Solid::Box(low, high) => (0..3).for_each(|k| {
            cuts.extend([low[k], high[k]].map(|at| (at - from[k]) / way[k]));
        }),
        Solid::Sphere(centre, radius) => {
            let start = from - centre;
            cuts.extend(roots(way.norm_squared(), way.dot(&start), start.norm_squared() - radius * radius));
        }
        Solid::Cylinder(a, b, radius) => cuts.extend(round(from, way, [a, b], [*radius; 2])),
        Solid::Cone(a, b, radii) => cuts.extend(round(from, way, [a, b], *radii)),
        Solid::Halfspace(plane) => cuts.push(-plane.signed_distance(from) / way.dot(&plane.normal)),
        Solid::Prism(_) | Solid::Mesh(_) => cuts.extend(searched(solid, from, way)),
    }
    cuts.retain(|t| (0.0..=1.0).contains(t));
    cuts.sort_by(f64::total_cmp);
    let pieces = cuts.windows(2).map(|w| [w[0], w[1]]).filter(|[a, b]| a < b);
    merged(pieces.filter(|[a, b]| solid.contains(&(from + way * (0.5 * (a + b))))).collect())
}

/// Where a way meets the ends and the mantle of a cylinder or a cone.
fn round(from: &Vec3, way: &Vec3, [a, b]: [&Vec3; 2], [ra, rb]: [f64; 2]) -> Vec<f64> {
    let axis = b - a;
    let (start, square) = (from - a, axis.norm_squared());
    // Shares of the axis and distances from it, at the start and for the whole way.
    let (s, along) = (start.dot(&axis) / square, way.dot(&axis) / square);
    let (p, q) = (start - axis * s, way - axis * along);
    let (r, grows) = (ra + (rb - ra) * s, (rb - ra) * along);
    let mantle = roots(q.norm_squared() - grows * grows, p.dot(&q) - r * grows, p.norm_squared() - r * r);
    [-s / along, (1.0 - s) / along].into_iter().chain(mantle).collect()
}

/// Roots of a t² + 2 b t + c; NaN where there is none.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = (b * b - a * c).sqrt();
    let sum = -(b + root.copysign(b));
    [sum / a, c / sum]
}

fn searched(solid: &Solid, from: &Vec3, way: &Vec3) -> Vec<f64> {
    let holds = |t: f64| solid.contains(&(from + way * t));
    let (low, high) = solid.bounds();
    let [fewest, most] = PIECES;
    let wanted = most * way.norm() / (high - low).min();
    let count = wanted.ceil().max(fewest).min(most) as u32;
    let at = |k: u32| f64::from(k) / f64::from(count);
    let changes = (0..count).filter(|k| holds(at(*k)) != holds(at(k + 1)));
    let change = |k: u32| {
        let (mut low, mut high) = (at(k), at(k + 1));
        let before = holds(low);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if holds(middle) == before { &mut low } else { &mut high }) = middle;
        }
        0.5 * (low + high)
    };
    changes.map(change).collect()
}

/// The share of a way that lies between two corners of a box; its end is before its start where none does.
pub fn between((low, high): (Vec3, Vec3), from: &Vec3, way: &Vec3) -> [f64; 2] {
    let mut share = [0.0f64, 1.0f64];
    for k in 0..3 {
        if way[k] == 0.0 {
            if from[k] < low[k] || from[k] > high[k] {
                return [1.0, 0.0];
            }
            continue;
        }
        let [a, b] = [low[k], high[k]].map(|at| (at - from[k]) / way[k]);
        share = [share[0].max(a.min(b)), share[1].min(a.max(b))];
    }
    share
}

/// Pieces in order, those that touch as one.
pub fn merged(mut pieces: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    // Ends that differ by rounding touch.
    const TOUCH: f64 = 1e-12;
    pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for piece in pieces {
        match all.last_mut() {
            Some(last) if piece[0] <= last[1] + TOUCH => last[1] = last[1].max(piece[1]),
            _ => all.push(piece),
        }
    }
    all
}

/// What is left of the way.
pub fn rest(pieces: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let starts = std::iter::once(0.0).chain(pieces.iter().map(|p| p[1]));
    let ends = pieces.iter().map(|p| p[0]).chain(std::iter::once(1.0));
    starts.zip(ends).map(|(a, b)| [a, b]).filter(|[a, b]| a < b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Shape;
    use geom::mesh::cuboid;

    /// The share of a way in a solid, by a million points.
    fn counted(solid: &Solid, from: &Vec3, way: &Vec3) -> f64 {
        let n = 1_000_000;
        let at = |k: usize| from + way * ((k as f64 + 0.5) / n as f64);
        (0..n).filter(|k| solid.contains(&at(*k))).count() as f64 / n as f64
    }

    #[test]
    fn the_share_in_a_solid_is_that_of_a_million_points() {
        let from = Vec3::new(-1.2, 0.1, 0.25);
        let load = |_: &str| Ok(cuboid(Vec3::new(-0.2, -0.3, 0.0), Vec3::new(0.4, 0.5, 0.6)));
        for text in [
            "box:-0.2,-0.3,0,0.4,0.5,0.6",
            "sphere:0,0,0,0.9",
            "cylinder:-0.5,0,0,0.5,0.1,1,0.3",
            "cone:-0.5,0,0,0.5,0.1,1,0.3,0",
            "cone:0,0,-1,0,0,1,0,1",
            "halfspace:0.1,0,0,1,1,0",
            "mesh:x",
        ] {
            let solid = Shape::parse(text, &load).unwrap().solid;
            for way in [Vec3::new(2.0, -0.1, 0.1), Vec3::new(2.5, 0.3, -0.4), Vec3::new(3.0, 0.0, 0.0)] {
                let pieces = inside(&solid, &from, &way);
                let share: f64 = pieces.iter().map(|[a, b]| b - a).sum();
                let right = counted(&solid, &from, &way);
                assert!((share - right).abs() < 3e-6, "{text} {way}: {pieces:?} is not {right}");
            }
        }
    }

    /// One hundredth of a branch, of which 64 points see none or one.
    #[test]
    fn a_thin_share_is_exact() {
        let solid = "box:0.501,-1,-1,0.511,1,1".parse::<Shape>().unwrap().solid;
        let pieces = inside(&solid, &Vec3::zeros(), &Vec3::x());
        assert_eq!(pieces.len(), 1);
        assert!((pieces[0][1] - pieces[0][0] - 0.01).abs() < 1e-15, "{pieces:?}");
        // A way of no length, and one along a face.
        assert!(inside(&solid, &Vec3::zeros(), &Vec3::zeros()).is_empty());
        assert_eq!(inside(&solid, &Vec3::new(0.501, 0.0, 0.0), &Vec3::y()), [[0.0, 1.0]]);
    }

    #[test]
    fn two_cones_of_one_quadric_are_one_cone() {
        let solid = "cone:0,0,0,0,0,1,0,1".parse::<Shape>().unwrap().solid;
        let pieces = inside(&solid, &Vec3::new(0.0, 0.0, -1.0), &Vec3::new(0.0, 0.0, 2.0));
        assert_eq!(pieces, [[0.5, 1.0]]);
    }
}
