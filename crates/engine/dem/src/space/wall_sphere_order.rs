//! The order in which the spheres of a wall lie.

use geom::{Grid, Vec3};

/// Which of the spheres that were given is the first, the second, … of their grid.
pub fn order_of_spheres(spheres: &[(Vec3, f64)]) -> Vec<u32> {
    let centres: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
    Grid::new(&centres, cell_of_spheres(spheres)).order().to_vec()
}

/// Length of the cells that wall spheres are sorted by [m].
pub fn cell_of_spheres(spheres: &[(Vec3, f64)]) -> f64 {
    let largest = largest_of(spheres);
    if largest > 0.0 { 2.0 * largest } else { 1.0 }
}

/// Largest radius [m].
pub fn largest_of(spheres: &[(Vec3, f64)]) -> f64 {
    spheres.iter().map(|s| s.1).fold(0.0, f64::max)
}
