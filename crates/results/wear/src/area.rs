//! The area that a part of a wall stands for.
//!
//! A triangle stands for itself. Of the wall that spheres stand for, each has the places in its tangent plane that are nearer to it than to
//! any other sphere of its wall (its Voronoi cell), as far as 0.65 of the mean distance of its six nearest: beyond the rim of a wall
//! no other sphere ends it. The plane is that of least squares through its neighbours.

use geom::mesh::{TriMesh, area};
use geom::{Grid, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::prelude::*;

/// Neighbours that tell the plane and the distance.
const NEAREST: usize = 12;

/// How often the distance within which they are sought is doubled, from a radius on.
const DOUBLINGS: u32 = 6;

/// Of them, those whose distances are averaged.
const FIRST: usize = 6;

/// How far a cell reaches at most, over that mean [–]: a square lattice, whose corners are at 0.62, is left whole.
const REACH: f64 = 0.65;

/// Corners of the polygon that a cell is cut out of.
const CORNERS: usize = 16;

/// Area of each triangle [m²].
pub fn of_triangles(mesh: &TriMesh) -> Vec<f64> {
    mesh.triangles().map(area).collect()
}

/// Area that each sphere of one wall stands for [m²]: the surface of the ball where it is the whole wall; the area of a disk as large as the sphere
/// where it has fewer than three neighbours.
pub fn of_spheres(centres: &[Vec3], radii: &[f64]) -> Vec<f64> {
    let largest = radii.iter().copied().fold(0.0, f64::max);
    if centres.is_empty() || !(largest > 0.0) {
        return vec![0.0; centres.len()];
    }
    if let [radius] = radii {
        return vec![4.0 * std::f64::consts::PI * radius * radius];
    }
    let grid = Grid::new(centres, 2.0 * largest);
    let disk = |radius: f64| std::f64::consts::PI * radius * radius;
    let of_one = |k: usize| cell(&nearest(&grid, centres, k, radii[k])).unwrap_or_else(|| disk(radii[k]));
    (0..centres.len()).into_par_iter().map(of_one).collect()
}

/// Places of the nearest spheres, the nearest first, relative to one of them [m]; sought farther and farther.
fn nearest(grid: &Grid, centres: &[Vec3], own: usize, radius: f64) -> Vec<Vec3> {
    let around = |reach: f64| {
        let others = grid.within(centres, centres[own], reach).map(|k| centres[k as usize] - centres[own]);
        others.filter(|away| away.norm_squared() > 0.0).collect::<Vec<Vec3>>()
    };
    let mut found = Vec::new();
    for reach in (1..=DOUBLINGS).map(|n| radius * f64::from(1 << n)) {
        found = around(reach);
        found.sort_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
        // A neighbour ends a cell at half the way to it.
        if found.len() >= NEAREST && 2.0 * REACH * mean_of_first(&found) <= reach {
            break;
        }
    }
    found
}

/// Mean distance of the first few [m].
fn mean_of_first(found: &[Vec3]) -> f64 {
    let first = &found[..found.len().min(FIRST)];
    first.iter().map(|away| away.norm()).sum::<f64>() / first.len().max(1) as f64
}

/// The area of a cell [m²]; none where too few neighbours tell it.
fn cell(others: &[Vec3]) -> Option<f64> {
    if others.len() < 3 {
        return None;
    }
    let near = &others[..others.len().min(NEAREST)];
    let reach = REACH * mean_of_first(near);
    let [u, v] = tangents(near);
    let mut polygon: Vec<[f64; 2]> = (0..CORNERS)
        .map(|k| std::f64::consts::TAU * k as f64 / CORNERS as f64)
        .map(|angle| [reach * angle.cos(), reach * angle.sin()])
        .collect();
    for away in others.iter().take_while(|away| away.norm() < 2.0 * reach) {
        polygon = nearer(&polygon, [away.dot(&u), away.dot(&v)]);
    }
    let twice: f64 =
        (0..polygon.len()).map(|k| cross(polygon[k], polygon[(k + 1) % polygon.len().max(1)])).sum();
    Some(0.5 * twice.abs())
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Two directions in the plane of least squares through the origin and these places.
fn tangents(places: &[Vec3]) -> [Vec3; 2] {
    let mean = places.iter().sum::<Vec3>() / (places.len() + 1) as f64;
    let spread = |away: Vec3| away * away.transpose();
    let sum: Matrix3<f64> = places.iter().map(|p| spread(p - mean)).sum::<Matrix3<f64>>() + spread(mean);
    let eigen = SymmetricEigen::new(sum);
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    [order[0], order[1]].map(|k| eigen.eigenvectors.column(k).into_owned())
}

/// The part of a convex polygon that is nearer to the origin than to a place.
fn nearer(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> Vec<[f64; 2]> {
    let half = 0.5 * (x * x + y * y);
    let beyond = |p: [f64; 2]| p[0] * x + p[1] * y - half;
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let [at_a, at_b] = [beyond(*a), beyond(b)];
        if at_a <= 0.0 {
            kept.push(*a);
        }
        if at_a * at_b < 0.0 {
            let share = at_a / (at_a - at_b);
            kept.push([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_of_a_square_lattice_stands_for_a_square() {
        let at = |k: usize| Vec3::new(0.01 * (k % 20) as f64, 0.0, 0.01 * (k / 20) as f64);
        let centres: Vec<Vec3> = (0..400).map(at).collect();
        for radius in [0.004, 0.006, 0.02] {
            let found = of_spheres(&centres, &[radius; 400]);
            assert!((found[210] / 1e-4 - 1.0).abs() < 1e-9, "{radius}: {}", found[210]);
            let sum: f64 = found.iter().sum();
            // At the rim a cell reaches at most 0.87 of a distance outwards (three neighbours at 1, 1 and 1.41), not half of one.
            assert!(sum > 0.2f64.powi(2) && sum < 0.2074f64.powi(2), "{radius}: {sum}");
        }
    }

    #[test]
    fn spheres_on_a_ball_share_its_surface() {
        let count = 3000;
        let point = |k: usize| {
            let (a, z) = (2.399_963_229_728_653 * k as f64, (k as f64 + 0.5) / (0.5 * count as f64) - 1.0);
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * a.cos(), r * a.sin(), z)
        };
        let centres: Vec<Vec3> = (0..count).map(point).collect();
        let sum: f64 = of_spheres(&centres, &vec![0.04; count]).iter().sum();
        assert!((sum / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.01, "{sum}");
    }

    #[test]
    fn spheres_without_neighbours_stand_for_their_disks_and_one_for_its_ball() {
        let found = of_spheres(&[Vec3::zeros(), Vec3::x()], &[0.1, 0.2]);
        let disk = |r: f64| std::f64::consts::PI * r * r;
        assert!((found[0] - disk(0.1)).abs() < 1e-15 && (found[1] - disk(0.2)).abs() < 1e-15);
        // A wall of one sphere is a ball.
        assert_eq!(of_spheres(&[Vec3::x()], &[0.2]), [4.0 * disk(0.2)]);
        assert!(of_spheres(&[], &[]).is_empty());
    }
}
