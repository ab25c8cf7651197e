//! The periodic box of a run at one time: shortest ways, and the images of points, balls, ways and shapes.
//!
//! Two questions are asked of a shape. How much of a ball or a branch lies in it: then every image counts, so that a shape may reach through
//! a face, or be larger than the box. Whether a point lies in it: then the point or one of its images may. A shape that is
//! longer than the period along an axis is cut off at the faces of this axis, so that a point lies in it once.

use crate::geometry::chord;
use geom::{Shape, Vec3};

/// Most images of one ball, branch or way that are looked at, and most periods that a grain moves between two frames.
pub const MOST_IMAGES: usize = 1000;

/// Shares of a period that are rounding [–].
const TOUCH: f64 = 1e-9;

/// Lowest and highest coordinate [m] of each axis that is periodic.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PeriodicBox {
    /// By axis; `None` where it is not periodic.
    pub range: [Option<(f64, f64)>; 3],
}

impl PeriodicBox {
    /// Whether no axis is periodic.
    pub fn is_open(&self) -> bool {
        self.range.iter().all(Option::is_none)
    }

    /// Length of each axis [m]; 0 where it is not periodic.
    pub fn lengths(&self) -> Vec3 {
        Vec3::from(self.range.map(|axis| axis.map_or(0.0, |(low, high)| high - low)))
    }

    /// Whether a position [m] lies in the box; on its faces, too.
    pub fn contains(&self, position: &Vec3) -> bool {
        self.range.iter().zip(position.iter()).all(|(period, x)| {
            period.is_none_or(|(low, high)| {
                let slack = TOUCH * (high - low);
                (low - slack..=high + slack).contains(x)
            })
        })
    }

    /// Whether a position [m] lies in the box; of two opposite faces on the lower one only, so that of the images of a place one does.
    pub fn has(&self, position: &Vec3) -> bool {
        let inside = |(period, x): (&Option<(f64, f64)>, &f64)| {
            period.is_none_or(|(low, high)| (low..high).contains(x))
        };
        self.range.iter().zip(position.iter()).all(inside)
    }

    /// Lowest and highest corner [m], without end along axes that are not periodic.
    pub fn corners(&self) -> (Vec3, Vec3) {
        let end = |k: usize, of: fn((f64, f64)) -> f64, open: f64| self.range[k].map_or(open, of);
        let corner = |of: fn((f64, f64)) -> f64, open: f64| Vec3::from([0, 1, 2].map(|k| end(k, of, open)));
        (corner(|range| range.0, f64::NEG_INFINITY), corner(|range| range.1, f64::INFINITY))
    }

    /// The shortest way from `a` to `b` [m], through faces where that is shorter.
    pub fn way(&self, a: &Vec3, b: &Vec3) -> Vec3 {
        let mut way = b - a;
        for (axis, period) in self.range.iter().enumerate() {
            if let Some((low, high)) = period {
                way[axis] -= (high - low) * libm::round(way[axis] / (high - low));
            }
        }
        way
    }

    /// Periods [m] to add to `b − a` for the way that comes nearest to the expected one, and whether no other way is nearly as near:
    /// the way may differ from the expected one by up to a quarter of a period.
    pub fn passed(&self, a: &Vec3, b: &Vec3, expected: &Vec3) -> (Vec3, bool) {
        let (mut shift, mut sure) = (Vec3::zeros(), true);
        for (axis, period) in self.range.iter().enumerate() {
            if let Some((low, high)) = period {
                let (length, missing) = (high - low, expected[axis] - (b - a)[axis]);
                let periods = libm::round(missing / length);
                shift[axis] = length * periods;
                sure &= (missing / length - periods).abs() <= 0.25 && periods.abs() < MOST_IMAGES as f64;
            }
        }
        (shift, sure)
    }

    /// Periods [m] that move a box from corner to corner to where it reaches the box `around`, at most [`MOST_IMAGES`] of them. Along axes
    /// that are not periodic it is not looked at.
    pub fn shifts(&self, (low, high): (Vec3, Vec3), around: (Vec3, Vec3)) -> Vec<Vec3> {
        let mut shifts = vec![Vec3::zeros()];
        for (axis, period) in self.range.iter().enumerate() {
            let Some(length) = period.map(|(low, high)| high - low) else { continue };
            // What lies on a face of `around` counts at the lower one only, or it would count twice where `around` is a period long.
            let least = |x: f64| (x - TOUCH).ceil();
            let first = least((around.0[axis] - high[axis]) / length);
            let last = least((around.1[axis] - low[axis]) / length) - 1.0;
            let count = (last - first + 1.0).clamp(0.0, MOST_IMAGES as f64) as usize;
            let along = |shift: &Vec3| {
                let shift = *shift;
                let at = move |k: usize| shift + Vec3::ith(axis, (first + k as f64) * length);
                (0..count).map(at).collect::<Vec<Vec3>>()
            };
            shifts = shifts.iter().flat_map(along).take(MOST_IMAGES).collect();
        }
        shifts
    }

    /// Whether a point or one of its images [m] lies in a shape.
    pub fn holds(&self, shape: &Shape, point: &Vec3) -> bool {
        if self.is_open() {
            return shape.contains(point);
        }
        let part = self.part_once(shape);
        let inside = |shift: &Vec3| {
            let p = point + shift;
            (0..3).all(|k| part.0[k] <= p[k] && p[k] <= part.1[k]) && shape.solid.contains(&p)
        };
        point.iter().all(|x| x.is_finite())
            && self.shifts((*point, *point), part).iter().any(inside) != shape.outside
    }

    /// Shares of the way from a point [m] along a vector [m] on which it or one of its images lies in a shape: start and end of each, in order.
    pub fn inside(&self, shape: &Shape, from: &Vec3, way: &Vec3) -> Vec<[f64; 2]> {
        let to = from + way;
        let part = if self.is_open() { shape.solid.bounds() } else { self.part_once(shape) };
        let mut pieces: Vec<[f64; 2]> = Vec::new();
        for shift in self.shifts((from.inf(&to), from.sup(&to)), part) {
            let start = from + shift;
            let room = if self.is_open() { [0.0, 1.0] } else { chord::between(part, &start, way) };
            let cut = |[a, b]: [f64; 2]| [a.max(room[0]), b.min(room[1])];
            pieces.extend(
                chord::inside(&shape.solid, &start, way).into_iter().map(cut).filter(|p| p[0] < p[1]),
            );
        }
        let pieces = chord::merged(pieces);
        if shape.outside { chord::rest(&pieces) } else { pieces }
    }

    /// The box around the part of the solid of a shape in which each point lies once.
    fn part_once(&self, shape: &Shape) -> (Vec3, Vec3) {
        let (mut low, mut high) = shape.solid.bounds();
        for (axis, period) in self.range.iter().enumerate() {
            if let Some(period) = period.filter(|(a, b)| high[axis] - low[axis] > b - a) {
                (low[axis], high[axis]) = period;
            }
        }
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: PeriodicBox = PeriodicBox { range: [Some((0.0, 1.0)), None, Some((-1.0, 1.0))] };

    fn shape(text: &str) -> Shape {
        text.parse().unwrap()
    }

    #[test]
    fn a_point_lies_in_a_shape_that_reaches_through_a_face() {
        let holds = |text: &str, x: f64, z: f64| CELL.holds(&shape(text), &Vec3::new(x, 0.0, z));
        assert!(holds("sphere:0,0,0,0.2", 0.9, 0.1) && holds("sphere:1,0,1,0.2", 0.1, -0.9));
        assert!(!holds("sphere:0,0,0,0.2", 0.5, 0.0) && holds("!sphere:0,0,0,0.2", 0.5, 0.0));
        assert!(!holds("!sphere:0,0,0,0.2", 0.9, 0.1));
        // Longer than the period: cut off at the faces.
        assert!(holds("box:0.5,-9,-9,9,9,9", 0.7, 0.0) && !holds("box:0.5,-9,-9,9,9,9", 0.2, 0.0));
        assert!(holds("halfspace:0.5,0,0,1,0,0", 0.7, 0.0) && !holds("halfspace:0.5,0,0,1,0,0", 0.2, 0.0));
    }

    #[test]
    fn a_way_of_several_periods_is_in_a_shape_several_times() {
        let box_ = shape("box:0.9,-1,-1,1.1,1,1");
        let found = CELL.inside(&box_, &Vec3::new(0.5, 0.0, 0.0), &Vec3::new(2.0, 0.0, 0.0));
        let right = [[0.2, 0.3], [0.7, 0.8]];
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().flatten().zip(right.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-12));
        let outside = Shape { outside: true, ..box_ };
        assert_eq!(CELL.inside(&outside, &Vec3::new(0.5, 0.0, 0.0), &Vec3::new(2.0, 0.0, 0.0)).len(), 3);
    }

    #[test]
    fn the_way_of_a_grain_follows_its_velocity() {
        let (a, b) = (Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.9, 0.0, 0.0));
        let passed = |x: f64| CELL.passed(&a, &b, &Vec3::new(x, 0.0, 0.0));
        assert_eq!([passed(0.7).0.x, passed(-0.3).0.x, passed(2.6).0.x], [0.0, -1.0, 2.0]);
        assert!(passed(2.6).1 && !passed(0.3).1 && !passed(1e9).1);
    }

    #[test]
    fn images_reach_a_box() {
        let at = |p: Vec3| (p.add_scalar(-0.1), p.add_scalar(0.1));
        let count = |p: Vec3| CELL.shifts(at(p), CELL.corners()).len();
        assert_eq!([count(Vec3::new(0.5, 7.0, 0.0)), count(Vec3::new(0.05, 0.0, 0.0))], [1, 2]);
        assert_eq!([count(Vec3::new(0.05, 0.0, 0.95)), count(Vec3::new(4.5, 0.0, 0.0))], [4, 1]);
    }
}
