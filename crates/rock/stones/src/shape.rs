//! Measures of shape.
//!
//! ```text
//! sieve size    side of the smallest square hole that the stone passes without turning on its way:
//!               D = min over u ⟂ v of max(w(u), w(v)),  w(u) width of the stone along the unit vector u
//! L ≥ I ≥ S     sides of the smallest box around the stone, by volume
//! elongation    I/L,  flatness S/I                 Zingg (1935), Schweiz. Mineral. Petrogr. Mitt. 15
//! convexity     V/V_hull
//! sphericity    π^⅓ (6 V)^⅔ / A                    Wadell (1932), doi:10.1086/623964
//! roundness     see crate::roundness
//! ```
//!
//! Volume, area and hull are exact. D and the box are minima over all rotations: a search from even orientations and from the principal axes,
//! refined to 10⁻⁷ rad.

use crate::random::{even, orientation};
use crate::roundness::roundness;
use crate::stone::Stone;
use geom::{Vec3, hull::hull};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use serde::Serialize;
use std::f64::consts::PI;

/// Orientations that a search starts from, and those of them that are refined.
const STARTS: usize = 600;
const REFINED: usize = 10;
/// Least gain of a turn [–]: less is rounding, as of a ball, which is the same from all sides.
const GAIN: f64 = 1e-9;
/// Directions of the turns that refine, without sign.
const TURNS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Measures of one stone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShapeMeasures {
    /// V [m³].
    pub volume: f64,
    /// A [m²].
    pub area: f64,
    /// D, side of the smallest square hole [m].
    pub sieve_size: f64,
    /// L, I, S of the smallest box [m].
    pub sides: [f64; 3],
    /// I/L [–].
    pub elongation: f64,
    /// S/I [–].
    pub flatness: f64,
    /// V/V_hull [–].
    pub convexity: f64,
    /// Area of the sphere of the same volume, over A [–].
    pub sphericity: f64,
    /// Mean radius of the corners over that of the largest sphere inside [–].
    pub roundness: f64,
    /// Radius of that sphere [m].
    pub inscribed_radius: f64,
}

impl ShapeMeasures {
    pub fn of(stone: &Stone) -> ShapeMeasures {
        let (volume, area) = (stone.moments.volume, stone.mesh.area());
        // A closed mesh that encloses a volume is not flat.
        let hull = hull(&stone.mesh.vertices).unwrap_or_else(|| stone.mesh.clone());
        let axes = principal(&stone.moments.inertia);
        let widths = |turn: &Matrix3<f64>| widths(&hull.vertices, turn);
        let sieve_size = least(&axes, |turn| {
            let w = widths(turn);
            w[0].max(w[1])
        });
        let found = minimum(&axes, |turn| widths(turn).iter().product());
        let mut sides = widths(&found.1);
        sides.sort_by(|a, b| b.total_cmp(a));
        let [long, middle, short] = sides;
        let (roundness, inscribed_radius) = roundness(stone);
        ShapeMeasures {
            volume,
            area,
            sieve_size,
            sides,
            elongation: middle / long,
            flatness: short / middle,
            convexity: volume / hull.volume(),
            sphericity: PI.cbrt() * (6.0 * volume).powf(2.0 / 3.0) / area,
            roundness,
            inscribed_radius,
        }
    }
}

/// The side of the smallest square hole that a stone passes [m].
pub fn sieve_size(stone: &Stone) -> f64 {
    ShapeMeasures::of(stone).sieve_size
}

/// Widths of points along the three rows of a rotation.
fn widths(points: &[Vec3], turn: &Matrix3<f64>) -> [f64; 3] {
    let (mut lo, mut hi) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    for p in points {
        let q = turn * p;
        (lo, hi) = (lo.inf(&q), hi.sup(&q));
    }
    (hi - lo).into()
}

fn principal(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let axes = inertia.symmetric_eigen().eigenvectors;
    let signed = if axes.determinant() < 0.0 { -axes } else { axes };
    signed.transpose()
}

fn least(axes: &Matrix3<f64>, of: impl Fn(&Matrix3<f64>) -> f64) -> f64 {
    minimum(axes, of).0
}

/// The least value over all rotations, and its rotation.
fn minimum(axes: &Matrix3<f64>, of: impl Fn(&Matrix3<f64>) -> f64) -> (f64, Matrix3<f64>) {
    // The principal axes in each order: the value may depend on which is which.
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
    let ordered = orders.map(|o| Matrix3::from_rows(&o.map(|k| axes.row(k).into_owned())));
    let spread = (0..STARTS).map(|k| orientation(even(k)).to_rotation_matrix().into_inner());
    let mut starts: Vec<(f64, Matrix3<f64>)> =
        ordered.into_iter().chain(spread).map(|m| (of(&m), m)).collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let refined = starts.into_iter().take(REFINED).map(|start| refine(start, &of));
    refined.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((of(axes), *axes))
}

/// Turns a rotation by less and less as long as the value falls.
fn refine(
    (mut value, mut turn): (f64, Matrix3<f64>),
    of: &impl Fn(&Matrix3<f64>) -> f64,
) -> (f64, Matrix3<f64>) {
    let mut step = 0.2;
    while step > 1e-7 {
        let directions = TURNS.iter().flat_map(|t| [Vec3::from(*t), -Vec3::from(*t)]);
        let tried = directions.map(|d| {
            let turned = UnitQuaternion::from_scaled_axis(d.normalize() * step).to_rotation_matrix()
                * Rotation3::from_matrix_unchecked(turn);
            (of(turned.matrix()), turned.into_inner())
        });
        match tried.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some(best) if best.0 < value * (1.0 - GAIN) => (value, turn) = best,
            _ => step *= 0.5,
        }
    }
    (value, turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stone::tests::{ball, block};
    use geom::mesh::cuboid;

    fn close(found: f64, wanted: f64, tolerance: f64) {
        assert!((found / wanted - 1.0).abs() < tolerance, "{found}, not {wanted}");
    }

    /// A box passes flat on its two smaller sides, or through the diagonal of the hole if it is flat enough.
    #[test]
    fn boxes_have_their_closed_values_in_any_orientation() {
        for (x, y, z) in [(0.04, 0.03, 0.02), (0.05, 0.05, 0.05), (0.06, 0.05, 0.01)] {
            let mesh = cuboid(Vec3::zeros(), Vec3::new(x, y, z));
            let turn = orientation([0.3, 0.7, 0.2]);
            let vertices = mesh.vertices.iter().map(|v| turn * v).collect();
            let turned = geom::mesh::TriMesh { vertices, ..mesh };
            let found = ShapeMeasures::of(&Stone::new(&turned, false).unwrap());
            close(found.sieve_size, y.min((y + z) / 2f64.sqrt()), 1e-5);
            close(found.elongation, y / x, 1e-5);
            close(found.flatness, z / y, 1e-5);
            close(found.convexity, 1.0, 1e-12);
            let area = 2.0 * (x * y + y * z + z * x);
            close(found.sphericity, PI.cbrt() * (6.0 * x * y * z).powf(2.0 / 3.0) / area, 1e-12);
        }
    }

    #[test]
    fn an_ellipsoid_has_its_axes() {
        let mut mesh = ball(1.0, 4);
        mesh.vertices.iter_mut().for_each(|v| *v = Vec3::new(0.04 * v.x, 0.03 * v.y, 0.02 * v.z));
        let found = ShapeMeasures::of(&Stone::new(&mesh, false).unwrap());
        // Across the long axis the stone passes with its ellipse turned by 45° in the hole.
        close(found.sieve_size, (2.0f64 * (0.03 * 0.03 + 0.02 * 0.02)).sqrt(), 0.002);
        close(found.elongation, 0.75, 0.002);
        close(found.flatness, 2.0 / 3.0, 0.002);
        let stone = Stone::new(&ball(0.05, 4), false).unwrap();
        let sphere = ShapeMeasures::of(&stone);
        close(sphere.sphericity, 1.0, 0.003);
        // Between the spheres inside and around.
        let inner = stone.inside.distance(&Vec3::zeros());
        assert!(sphere.sieve_size >= 2.0 * inner && sphere.sieve_size <= 0.1, "{}", sphere.sieve_size);
    }

    /// An L of three cubes fills 3 of the 3.5 cubes of its hull.
    #[test]
    fn a_notch_lowers_convexity() {
        let corner = |x: f64, y: f64, z: f64| Vec3::new(x, y, z) * 0.01;
        let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
        let vertices = [0.0, 1.0].iter().flat_map(|z| outline.map(|(x, y)| corner(x, y, *z))).collect();
        let mut faces =
            vec![[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 5, 4], [6, 7, 8], [6, 8, 9], [6, 9, 10], [6, 10, 11]];
        for k in 0..6u32 {
            let j = (k + 1) % 6;
            faces.extend([[k, j, 6 + j], [k, 6 + j, 6 + k]]);
        }
        let stone = Stone::new(&geom::mesh::TriMesh { vertices, faces }, false).unwrap();
        close(ShapeMeasures::of(&stone).convexity, 3.0 / 3.5, 1e-12);
        close(ShapeMeasures::of(&block(0.02, 0.01, 0.01)).elongation, 0.5, 1e-5);
    }
}
