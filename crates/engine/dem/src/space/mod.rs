//! The search for neighbours, the order of wall spheres, turning by a vector.

pub mod rotation;
pub mod search;
pub mod wall_sphere_order;

const _: () = assert!(laws::space::sphere::TURNS == geom::sphere::INVERSE_INERTIA);

/// Mass of a sphere [kg] of `radius` [m] and `density` [kg/m³].
pub fn mass(radius: f64, density: f64) -> f64 {
    geom::sphere::volume(radius) * density
}
