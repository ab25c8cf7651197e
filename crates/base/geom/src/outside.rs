//! How far a position is outside a solid.

use crate::Vec3;
use crate::shape::Solid;

impl Solid {
    /// Distance from `p` [m] to the solid [m]; 0 inside of it and on its surface, infinite for a place that is not finite.
    pub fn distance(&self, p: &Vec3) -> f64 {
        if !p.iter().all(|c| c.is_finite()) {
            return f64::INFINITY;
        }
        if self.contains(p) {
            return 0.0;
        }
        match self {
            Solid::Box(lo, hi) => (p - p.sup(lo).inf(hi)).norm(),
            Solid::Sphere(centre, radius) => (p - centre).norm() - radius,
            Solid::Cylinder(start, end, radius) => round(p, start, end, [*radius; 2]),
            Solid::Cone(start, end, radii) => round(p, start, end, *radii),
            Solid::Halfspace(plane) => -plane.signed_distance(p),
            Solid::Prism(prism) => prism.distance(p),
            Solid::Mesh(inside) => inside.distance(p),
        }
    }
}

/// Distance to a truncated cone from outside: that to its outline in the plane of the axis and the place.
fn round(p: &Vec3, start: &Vec3, end: &Vec3, radii: [f64; 2]) -> f64 {
    let axis = end - start;
    let length = axis.norm();
    let along = (p - start).dot(&axis) / length;
    let off = (p - start - axis * (along / length)).norm();
    let corners = [[0.0, 0.0], [0.0, radii[0]], [length, radii[1]], [length, 0.0]];
    let edges = corners.windows(2).map(|edge| {
        let [a, b] = [edge[0], edge[1]];
        let d = [b[0] - a[0], b[1] - a[1]];
        let square = d[0] * d[0] + d[1] * d[1];
        let share = ((along - a[0]) * d[0] + (off - a[1]) * d[1]) / square.max(f64::MIN_POSITIVE);
        let share = share.clamp(0.0, 1.0);
        (along - a[0] - share * d[0]).hypot(off - a[1] - share * d[1])
    });
    edges.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cuboid;
    use crate::prism::Prism;
    use crate::{Shape, mesh::TriMesh};

    /// Least distance to places of a fine lattice that are in the solid.
    fn searched(solid: &Solid, p: &Vec3, lo: Vec3, hi: Vec3) -> f64 {
        let steps = 60;
        let at = |k: i32, a: usize| lo[a] + (hi[a] - lo[a]) * f64::from(k) / f64::from(steps);
        let all =
            (0..=steps).flat_map(|i| (0..=steps).flat_map(move |j| (0..=steps).map(move |k| [i, j, k])));
        let places = all.map(|[i, j, k]| Vec3::new(at(i, 0), at(j, 1), at(k, 2)));
        places.filter(|q| solid.contains(q)).map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn distances_are_those_of_a_search_through_the_solid() {
        let solids: Vec<Solid> = [
            "box:0.2,0.1,0.3,0.8,0.9,0.7",
            "sphere:0.5,0.5,0.5,0.4",
            "cylinder:0.2,0.3,0.4,0.8,0.6,0.6,0.25",
            "cone:0.2,0.3,0.4,0.8,0.6,0.6,0.3,0.05",
            "cone:0.5,0.5,0.1,0.5,0.5,0.9,0.4,0",
        ]
        .iter()
        .map(|text| text.parse::<Shape>().unwrap().solid)
        .collect();
        let notched = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.5, 0.4], [0.1, 0.9]];
        let polygon: Vec<Vec3> = notched.iter().map(|c| Vec3::new(c[0], c[1], 0.2)).collect();
        let prism = Solid::Prism(Prism::new(&polygon, Vec3::new(0.1, 0.0, 0.6)).unwrap());
        let mesh: TriMesh = cuboid(Vec3::new(0.2, 0.1, 0.3), Vec3::new(0.8, 0.9, 0.7));
        let mesh = Solid::Mesh(crate::mesh::Inside::new(&mesh).unwrap());
        for solid in solids.into_iter().chain([prism, mesh]) {
            for k in 0..40 {
                let turn = |s: u32| f64::from((k * 7919 + s * 104_729) % 1000) / 1000.0;
                let p = Vec3::new(2.0 * turn(1) - 0.5, 2.0 * turn(2) - 0.5, 2.0 * turn(3) - 0.5);
                let (found, best) =
                    (solid.distance(&p), searched(&solid, &p, Vec3::zeros(), Vec3::repeat(1.0)));
                assert!(found <= best + 1e-9 && best - found < 0.03, "{solid:?}: {p}: {found} {best}");
            }
        }
    }
}
