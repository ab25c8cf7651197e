//! How far meshes are from the stone that `render` made photographs of: a row of a table for each.
//!
//! ```sh
//! cargo run --release -p grainpipe-photos --example compare -- STONE.ply MESH.ply…
//! ```
//!
//! Prints the error of the volume, and the mean distance between both surfaces, seen from points of each, in percent of the longest side of the
//! stone's smallest box. `render` has moved the middle of the stone to the origin, so it is moved here, too.

use geom::Vec3;
use std::error::Error;
use stones::{ShapeMeasures, Stone};

/// Points on a surface, about.
const POINTS: f64 = 20_000.0;

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let Some((stone, meshes)) = files.split_first().filter(|(_, meshes)| !meshes.is_empty()) else {
        return Err("give STONE.ply MESH.ply…".into());
    };
    let mut stone = mesh::load(stone)?;
    let (lo, hi) = geom::grid::bounds(&stone.vertices);
    stone.vertices.iter_mut().for_each(|v| *v -= (lo + hi) / 2.0);
    let stone = Stone::new(&stone, true)?;
    let longest = ShapeMeasures::of(&stone).sides[0];
    for file in meshes {
        let mesh = Stone::new(&mesh::load(file)?, true)?;
        let volume = mesh.moments.volume / stone.moments.volume - 1.0;
        let distance = (mean_distance(&mesh, &stone) + mean_distance(&stone, &mesh)) / 2.0;
        println!("{file} {:.2} {:.2}", 100.0 * volume, 100.0 * distance / longest);
    }
    Ok(())
}

/// Mean distance of points on one surface to another [m].
fn mean_distance(from: &Stone, to: &Stone) -> f64 {
    let total: f64 = from.mesh.triangles().map(|t| area(&t)).sum();
    let (mut sum, mut weight) = (0.0, 0.0);
    for corners in from.mesh.triangles() {
        let side = (POINTS * area(&corners) / total).sqrt().ceil().max(1.0);
        let each = area(&corners) / (side * side);
        for p in middles(&corners, side as usize) {
            sum += each * to.inside.distance(&p);
            weight += each;
        }
    }
    sum / weight
}

fn area([a, b, c]: &[Vec3; 3]) -> f64 {
    (b - a).cross(&(c - a)).norm() / 2.0
}

/// Middles of the n² equal parts of a face.
fn middles([a, b, c]: &[Vec3; 3], n: usize) -> Vec<Vec3> {
    let at = |u: f64, v: f64| a + (b - a) * (u / n as f64) + (c - a) * (v / n as f64);
    let (third, mut all) = (1.0 / 3.0, Vec::with_capacity(n * n));
    for i in 0..n {
        for j in 0..n - i {
            all.push(at(i as f64 + third, j as f64 + third));
            if i + j + 1 < n {
                all.push(at(i as f64 + 2.0 * third, j as f64 + 2.0 * third));
            }
        }
    }
    all
}
