//! Roundness: how blunt the corners of a stone are.
//!
//! ```text
//! roundness = mean over the corners of r/R        Wadell (1932), doi:10.1086/623964, for outlines
//! ```
//! R is the radius of the largest sphere inside the stone, r = 1/k₁ that of the surface where it bends most, and a corner is where r < R. Wadell measured
//! outlines; here the mean is by area over the surface, in the manner of Zhao & Wang (2016), doi:10.1016/j.powtec.2015.12.029. A ball and a capsule have 1.
//!
//! Curvature is a matter of scale: the least-squares paraboloid of the surface within δ = 0.15 R of a point gives k₁, so that roughness and facets much
//! smaller than that do not count, and an edge without any radius counts as one of about δ.

use crate::random::even;
use crate::samples::{SurfacePoint, surface};
use crate::stone::Stone;
use geom::{Grid, Vec3};
use nalgebra::{Matrix2, SMatrix, SVector};
use std::f64::consts::PI;

/// Distance within which the surface is fitted, over R [–].
const SCALE: f64 = 0.15;
/// Points of the surface within it, on average, and at most on the whole surface: of stones with more area than 700 R² the scale is wider.
const NEAR: f64 = 40.0;
const MOST: usize = 400_000;
/// Points at which the curvature is fitted, about.
const FITTED: usize = 5000;
/// Fewest points of a fit with six unknowns.
const FEWEST: usize = 12;
/// Points at which the search for R begins, and those of them that it follows.
const STARTS: usize = 300;
const FOLLOWED: usize = 4;
/// Step of the search at its end, over R [–].
const FINE: f64 = 1e-4;

/// Roundness [–], and R [m].
pub fn roundness(stone: &Stone) -> (f64, f64) {
    let inscribed = inscribed(stone);
    let area = stone.mesh.area();
    let wanted = NEAR * area / (PI * (SCALE * inscribed).powi(2));
    let count = wanted.clamp(1.0, MOST as f64) as usize;
    let reach = (NEAR * area / (PI * count as f64)).sqrt();
    let points = surface(stone, count);
    let places: Vec<Vec3> = points.iter().map(|p| p.place).collect();
    let grid = Grid::new(&places, reach);
    let corner = |p: &SurfacePoint| {
        let near: Vec<&SurfacePoint> =
            grid.within(&places, p.place, reach).map(|k| &points[k as usize]).collect();
        let radius = 1.0 / bend(p, &near, reach)?;
        (radius > 0.0 && radius < inscribed).then_some(radius / inscribed)
    };
    let every = points.len().div_ceil(FITTED).max(1);
    let corners: Vec<f64> = points.iter().step_by(every).filter_map(corner).collect();
    // Without corners: a ball.
    let mean = corners.iter().sum::<f64>() / corners.len() as f64;
    (if corners.is_empty() { 1.0 } else { mean }, inscribed)
}

/// k₁, the largest curvature of the surface at a point [1/m], positive where it bulges; `None` where too few points are near.
fn bend(at: &SurfacePoint, near: &[&SurfacePoint], reach: f64) -> Option<f64> {
    // The other side of a thin plate is another surface.
    let near = || near.iter().filter(|p| p.inwards.dot(&at.inwards) > -0.5);
    let normal = near().map(|p| p.inwards).sum::<Vec3>().try_normalize(1e-9)?;
    let u = normal.cross(&if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).normalize();
    let v = normal.cross(&u);
    let (mut matrix, mut right) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
    let mut count = 0;
    for p in near() {
        let d = (p.place - at.place) / reach;
        let (x, y, z) = (d.dot(&u), d.dot(&v), d.dot(&normal));
        let row = SVector::<f64, 6>::from([1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y]);
        matrix += row * row.transpose();
        right += row * z;
        count += 1;
    }
    let fit = (count >= FEWEST).then(|| matrix.cholesky()).flatten()?.solve(&right);
    // Second over first fundamental form of z(x, y); z points inwards, so it grows where the surface bulges.
    let [_, zx, zy, zxx, zxy, zyy]: [f64; 6] = fit.into();
    let first = Matrix2::new(1.0 + zx * zx, zx * zy, zx * zy, 1.0 + zy * zy);
    let second = Matrix2::new(zxx, zxy, zxy, zyy) / (1.0 + zx * zx + zy * zy).sqrt();
    let shape = first.try_inverse()? * second;
    let (mean, gauss) = (0.5 * shape.trace(), shape.determinant());
    let largest = mean + (mean * mean - gauss).max(0.0).sqrt();
    (largest > 0.0).then_some(largest / reach)
}

/// Radius of the largest sphere inside [m].
fn inscribed(stone: &Stone) -> f64 {
    let (lo, hi) = stone.inside.bounds();
    let depth = |p: &Vec3| if stone.inside.contains(p) { stone.inside.distance(p) } else { 0.0 };
    let mut starts: Vec<(f64, Vec3)> = (0..STARTS)
        .map(|k| lo + (hi - lo).component_mul(&Vec3::from(even(k))))
        .chain([stone.moments.centre])
        // A thin shell may hold none of these.
        .chain(surface(stone, STARTS).iter().map(|p| p.place + p.inwards * 1e-3 * (hi - lo).min()))
        .map(|p| (depth(&p), p))
        .collect();
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let directions: Vec<Vec3> = (0..27)
        .map(|k| Vec3::new((k % 3) as f64, (k / 3 % 3) as f64, (k / 9) as f64) - Vec3::repeat(1.0))
        .filter_map(|d| d.try_normalize(0.5))
        .collect();
    let climb = |&(mut best, mut at): &(f64, Vec3)| {
        let (size, mut step) = ((hi - lo).min(), 0.1 * (hi - lo).min());
        while step > FINE * size {
            let tried = directions.iter().map(|d| at + d * step).map(|p| (depth(&p), p));
            match tried.max_by(|a, b| a.0.total_cmp(&b.0)) {
                Some(found) if found.0 > best * (1.0 + FINE) => (best, at) = found,
                _ => step *= 0.5,
            }
        }
        best
    };
    starts.iter().take(FOLLOWED).map(climb).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stone::tests::{ball, block};
    use geom::mesh::TriMesh;

    fn of(mesh: &TriMesh) -> (f64, f64) {
        roundness(&Stone::new(mesh, false).unwrap())
    }

    /// A ball pulled apart at its middle planes: its octants become corners with a radius, its great circles edges.
    fn rounded_block(half: [f64; 3], radius: f64) -> TriMesh {
        let mut mesh = ball(1.0, 5);
        for v in &mut mesh.vertices {
            let pulled =
                |k: usize| radius * v[k] + v[k].signum() * f64::from(v[k].abs() > 1e-9) * (half[k] - radius);
            *v = Vec3::from([0, 1, 2].map(pulled));
        }
        mesh
    }

    #[test]
    fn a_ball_and_a_capsule_are_round() {
        let (round, inscribed) = of(&ball(0.02, 5));
        assert!((round - 1.0).abs() < 0.02 && (inscribed / 0.02 - 1.0).abs() < 0.005, "{round} {inscribed}");
        let (round, inscribed) = of(&rounded_block([0.05, 0.02, 0.02], 0.02));
        assert!((round - 1.0).abs() < 0.03 && (inscribed / 0.02 - 1.0).abs() < 0.005, "{round} {inscribed}");
    }

    /// Edges and corners of one radius: r/R, but for the strips beside them of which the fit sees both.
    #[test]
    fn a_block_has_the_roundness_of_its_edges() {
        let sharp = of(&block(0.04, 0.04, 0.04).mesh);
        assert!((sharp.1 / 0.02 - 1.0).abs() < 1e-3 && sharp.0 < 0.18, "{sharp:?}");
        let plate = of(&block(0.08, 0.04, 0.02).mesh);
        assert!((plate.0 - sharp.0).abs() < 0.02, "as sharp: {plate:?} {sharp:?}");
        for share in [0.3, 0.5, 0.8] {
            let (round, _) = of(&rounded_block([0.03, 0.025, 0.02], share * 0.02));
            assert!((round - share).abs() < 0.08, "{share}: {round}");
        }
    }

    /// An ellipsoid of revolution a × a × c, c > a: R = a, and k₁ = 1/r with r = b²/√(…) of its circles where they are tighter than R: at its tips a²/c.
    #[test]
    fn an_ellipsoid_has_the_mean_over_its_ends() {
        let (a, c) = (0.02, 0.04);
        let mut mesh = ball(1.0, 5);
        mesh.vertices.iter_mut().for_each(|v| *v = Vec3::new(a * v.x, a * v.y, c * v.z));
        let (found, inscribed) = of(&mesh);
        // Over the parameter t of z = c sin t: meridian k = a c/g³, parallel k = c/(a g) with g² = a² sin² t + c² cos² t; area 2π a cos t g dt.
        let (mut sum, mut area) = (0.0, 0.0);
        for k in 0..20_000 {
            let t = PI / 2.0 * (f64::from(k) + 0.5) / 20_000.0;
            let g = ((a * t.sin()).powi(2) + (c * t.cos()).powi(2)).sqrt();
            let bend = (a * c / g.powi(3)).max(c / (a * g));
            let weight = t.cos() * g;
            if bend * a > 1.0 {
                sum += weight / (bend * a);
                area += weight;
            }
        }
        let exact = sum / area;
        assert!((inscribed / a - 1.0).abs() < 0.003 && (found / exact - 1.0).abs() < 0.02, "{found} {exact}");
    }

    /// Facets that are small against the scale do not count; coarse ones are edges.
    #[test]
    fn the_mesh_hardly_matters_when_it_is_fine_enough() {
        let [coarse, fine, finer] = [1, 5, 6].map(|levels| of(&ball(0.02, levels)).0);
        assert!((fine - finer).abs() < 0.01 && coarse < 0.5, "{coarse} {fine} {finer}");
    }
}
