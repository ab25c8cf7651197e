//! Ball pivoting: a ball rolls over the points; three that it rests on make a triangle.
//!
//! ```text
//! A ball of radius ρ rests on a, b, o and holds no other point. It turns about the edge a b, away from o,
//! until it touches a point k: then (b, a, k) is the next triangle. Edges that it falls through stay open,
//! and are tried again with the next larger ball.
//! ```
//!
//! Bernardini, Mittleman, Rushmeier, Silva & Taubin (1999), IEEE Trans. Vis. Comput. Graph. 5(4),
//! doi:10.1109/2945.817351. Deviation: points are kept in memory, not in slices.

use geom::{Grid, Vec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Share of the ball's radius by which a point may be inside of a ball that rests on it.
const TOUCH: f64 = 1e-7;
/// Angles this close to a whole turn are the start of the turn [rad].
const START: f64 = 1e-7;

/// Triangles of the surface through `points` [m] (finite), seen from the side of their `normals`, by balls of the
/// given `radii` [m] in growing order.
pub fn pivot(points: &[Vec3], normals: &[Vec3], radii: &[f64]) -> Vec<[u32; 3]> {
    let mut front =
        Front { open: vec![0; points.len()], used: vec![false; points.len()], ..Front::default() };
    for &radius in radii.iter().filter(|r| **r > 0.0 && r.is_finite()) {
        let grid = Grid::new(points, radius);
        let ball = Ball { points, normals, grid: &grid, radius };
        front.wake(&ball);
        front.expand(&ball);
        for i in 0..points.len() as u32 {
            if !front.used[i as usize]
                && let Some((corners, centre)) = seed(&ball, &front, i)
            {
                front.add(corners, centre);
                front.expand(&ball);
            }
        }
    }
    front.faces
}

/// One ball over the points.
struct Ball<'a> {
    points: &'a [Vec3],
    normals: &'a [Vec3],
    grid: &'a Grid,
    radius: f64,
}

impl Ball<'_> {
    /// Centre of the ball that rests on three corners, on the side of their normals; none when it is too small
    /// for them, or when they are seen from behind.
    fn centre(&self, corners: [u32; 3]) -> Option<Vec3> {
        let [a, b, c] = corners.map(|i| self.points[i as usize]);
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(&ac);
        let area = normal.norm_squared();
        let facing: Vec3 = corners.iter().map(|&i| self.normals[i as usize]).sum();
        if area <= 1e-24 * ab.norm_squared() * ac.norm_squared() || normal.dot(&facing) <= 0.0 {
            return None;
        }
        let from_a =
            (ac.norm_squared() * normal.cross(&ab) - ab.norm_squared() * normal.cross(&ac)) / (2.0 * area);
        let height = self.radius * self.radius - from_a.norm_squared();
        (height >= 0.0).then(|| a + from_a + normal * (height / area).sqrt())
    }

    /// Whether no point but the corners is inside the ball.
    fn is_empty(&self, centre: Vec3, corners: [u32; 3]) -> bool {
        let mut inside = self.grid.within(self.points, centre, self.radius * (1.0 - TOUCH));
        inside.all(|i| {
            corners.contains(&i)
                || corners.iter().any(|&c| self.points[c as usize] == self.points[i as usize])
        })
    }

    /// The point that the ball touches first when it turns about the edge a b of (a, b, opposite).
    fn turn(&self, edge: &Edge) -> Option<(u32, Vec3)> {
        let (a, b) = (self.points[edge.a as usize], self.points[edge.b as usize]);
        let middle = (a + b) / 2.0;
        let axis = (b - a).normalize();
        let start = edge.centre - middle;
        let mut first: Option<(f64, u32, Vec3)> = None;
        for k in self.grid.within(self.points, middle, 2.0 * self.radius) {
            if k == edge.a || k == edge.b || k == edge.opposite {
                continue;
            }
            let Some(centre) = self.centre([edge.b, edge.a, k]) else { continue };
            let to = centre - middle;
            let angle = libm::atan2(axis.dot(&start.cross(&to)), start.dot(&to)).rem_euclid(TAU);
            let angle = if angle > TAU - START { 0.0 } else { angle };
            if first.is_none_or(|(least, ..)| angle < least) {
                first = Some((angle, k, centre));
            }
        }
        first.map(|(_, k, centre)| (k, centre))
    }
}

/// An edge that has a triangle on one side, and the ball that rests on that triangle.
#[derive(Clone, Copy)]
struct Edge {
    a: u32,
    b: u32,
    opposite: u32,
    centre: Vec3,
}

/// Triangles so far and where they end.
#[derive(Default)]
struct Front {
    faces: Vec<[u32; 3]>,
    /// Corner opposite of each directed edge of a triangle.
    sides: HashMap<(u32, u32), u32>,
    active: Vec<Edge>,
    /// Open edges at each point.
    open: Vec<u16>,
    used: Vec<bool>,
}

impl Front {
    /// Whether a triangle can be added: its edges are free, and its corners are new or on the front.
    fn fits(&self, [a, b, c]: [u32; 3]) -> bool {
        [(a, b), (b, c), (c, a)].iter().all(|side| !self.sides.contains_key(side))
            && [a, b, c].iter().all(|&v| !self.used[v as usize] || self.open[v as usize] > 0)
    }

    fn add(&mut self, corners: [u32; 3], centre: Vec3) {
        let [a, b, c] = corners;
        self.faces.push(corners);
        for (a, b, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
            self.used[a as usize] = true;
            self.sides.insert((a, b), opposite);
            let closes = self.sides.contains_key(&(b, a));
            for v in [a, b] {
                let open = &mut self.open[v as usize];
                *open = if closes { open.saturating_sub(1) } else { open.saturating_add(1) };
            }
            if !closes {
                self.active.push(Edge { a, b, opposite, centre });
            }
        }
    }

    /// Takes up the open edges whose triangle the new ball can rest on.
    fn wake(&mut self, ball: &Ball) {
        self.active.clear();
        for &[a, b, c] in &self.faces {
            let open = |a, b| !self.sides.contains_key(&(b, a));
            if !(open(a, b) || open(b, c) || open(c, a)) {
                continue;
            }
            let Some(centre) = ball.centre([a, b, c]).filter(|&centre| ball.is_empty(centre, [a, b, c]))
            else {
                continue;
            };
            for (a, b, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
                if open(a, b) {
                    self.active.push(Edge { a, b, opposite, centre });
                }
            }
        }
    }

    /// Rolls the ball over every active edge.
    fn expand(&mut self, ball: &Ball) {
        while let Some(edge) = self.active.pop() {
            if self.sides.contains_key(&(edge.b, edge.a)) {
                continue;
            }
            let Some((k, centre)) = ball.turn(&edge) else { continue };
            let corners = [edge.b, edge.a, k];
            if self.fits(corners) && ball.is_empty(centre, corners) {
                self.add(corners, centre);
            }
        }
    }
}

/// The first triangle at an unused point that an empty ball can rest on.
fn seed(ball: &Ball, front: &Front, i: u32) -> Option<([u32; 3], Vec3)> {
    let position = ball.points[i as usize];
    let free = |&j: &u32| j != i && !front.used[j as usize] && ball.points[j as usize] != position;
    let mut near: Vec<u32> =
        ball.grid.within(ball.points, position, 2.0 * ball.radius).filter(free).collect();
    let far = |j: &u32| (ball.points[*j as usize] - position).norm_squared();
    near.sort_by(|p, q| far(p).total_cmp(&far(q)).then(p.cmp(q)));
    // A ball rests on near points if on any: looking further costs much and finds little.
    near.truncate(24);
    for (n, &j) in near.iter().enumerate() {
        for &k in &near[..n] {
            for corners in [[i, j, k], [i, k, j]] {
                let centre =
                    ball.centre(corners).filter(|&c| front.fits(corners) && ball.is_empty(c, corners));
                if let Some(centre) = centre {
                    return Some((corners, centre));
                }
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::mesh::TriMesh;

    /// Points spread evenly over the unit sphere along a spiral.
    fn sphere(count: usize) -> Vec<Vec3> {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        (0..count)
            .map(|i| {
                let z = 1.0 - (2 * i + 1) as f64 / count as f64;
                let (r, phi) = ((1.0 - z * z).sqrt(), golden * i as f64);
                Vec3::new(r * phi.cos(), r * phi.sin(), z)
            })
            .collect()
    }

    #[test]
    fn a_sphere_is_closed_and_has_its_volume() {
        let points = sphere(2000);
        let faces = pivot(&points, &points, &[0.12]);
        let mesh = TriMesh::new(points, faces).unwrap();
        assert_eq!((mesh.faces.len(), mesh.open_edges()), (3996, 0));
        assert!((mesh.volume() - 4.0 / 3.0 * std::f64::consts::PI).abs() < 0.02, "{}", mesh.volume());
    }

    #[test]
    fn a_lattice_becomes_a_square_without_gaps_or_overlaps() {
        let points: Vec<Vec3> = (0..144).map(|i| Vec3::new((i % 12) as f64, (i / 12) as f64, 0.0)).collect();
        let faces = pivot(&points, &[Vec3::z(); 144], &[0.8]);
        let mesh = TriMesh::new(points, faces).unwrap();
        assert_eq!(mesh.faces.len(), 2 * 121);
        assert!((mesh.area() - 121.0).abs() < 1e-9);
        assert!(mesh.triangles().all(|[a, b, c]| (b - a).cross(&(c - a)).z > 0.0));
    }

    #[test]
    fn a_larger_ball_closes_what_the_smaller_one_falls_through() {
        let hole = |p: &Vec3| (p - Vec3::new(7.0, 7.0, 0.0)).norm() > 3.2;
        let points: Vec<Vec3> =
            (0..225).map(|i| Vec3::new((i % 15) as f64, (i / 15) as f64, 0.0)).filter(hole).collect();
        let normals = vec![Vec3::z(); points.len()];
        let area =
            |radii: &[f64]| TriMesh::new(points.clone(), pivot(&points, &normals, radii)).unwrap().area();
        assert!(area(&[0.8]) < 180.0);
        assert!((area(&[0.8, 2.0, 5.0]) - 196.0).abs() < 1e-9);
    }

    #[test]
    fn no_surface_no_triangle() {
        for points in [
            vec![],
            vec![Vec3::zeros()],
            vec![Vec3::x(); 40],
            (0..40).map(|i| Vec3::x() * f64::from(i)).collect(),
        ] {
            let normals = vec![Vec3::z(); points.len()];
            assert!(pivot(&points, &normals, &[0.5, 2.0]).is_empty());
        }
    }
}
