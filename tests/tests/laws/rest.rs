//! A column at rest.

use crate::simulation;
use dem::mass;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::{NORMALS, SURFACES, Surface, name_of, precisions};
use grainpipe_tests::setups::{grain, particles, run_until};

const COLUMN: Case = case("Many grains", "column of 10 at rest: force in the n-th contact = weight above it");

const ON_A_SPHERE: Case = case("One contact", "grain at rest on a wall sphere: contact force = weight");

/// A wall sphere is round: R* is r s/(r + s), and what adheres is the circle in which both meet.
#[test]
fn a_grain_on_top_of_a_wall_sphere() {
    let weight = mass(0.01, 2500.0) * 9.81;
    for (normal, precision) in precisions() {
        for s in [0.005, 0.02, 0.1] {
            let mut setup = normal.setup(0.1);
            (setup.precision, setup.gravity.z, setup.step) = (precision, -9.81, Step::Auto(0.8));
            let shape = WallShape::Spheres(vec![(Vec3::new(0.0, 0.0, -s), s)]);
            setup.walls = vec![Wall { shape, ..Surface::Plane.wall() }];
            setup.particles = vec![grain(0, Vec3::new(0.0, 0.0, 0.01))];
            let mut sim = simulation(setup);
            run_until(&mut sim, 2.0);
            let found = normal.force(0.01 - particles(&mut sim)[0].position.z, 0.01, Some(s));
            let limit = if precision != Precision::Double { 1e-5 } else { 1e-9 };
            ON_A_SPHERE.equals(&format!("{}, {s} m", name_of(&normal, precision)), found, "N", weight, limit);
        }
    }
}

/// The force that the overlap stands for, by the formulas of the sources, is the weight above, for every normal law, on a plane and on a wall sphere.
#[test]
fn static_column() {
    let weight = mass(0.01, 2500.0) * 9.81;
    for normal in NORMALS {
        for surface in SURFACES {
            let mut setup = normal.setup(0.1);
            setup.gravity.z = -9.81;
            setup.step = Step::Auto(0.8);
            setup.walls = vec![surface.wall()];
            let n = 10;
            setup.particles =
                (0..n).map(|k| grain(k, Vec3::new(0.0, 0.0, 0.01 + 0.02 * f64::from(k)))).collect();
            let mut sim = simulation(setup);
            run_until(&mut sim, 6.0);
            let p = particles(&mut sim);
            for k in 0..n as usize {
                let found = match k {
                    // Beside a wall sphere of 10 km no digit of the area is left: it is flat.
                    0 => normal.force(0.01 - p[0].position.z, 0.01, None),
                    _ => normal.force(0.02 - (p[k].position.z - p[k - 1].position.z), 0.01, Some(0.01)),
                };
                let above = weight * (f64::from(n) - k as f64);
                let on = format!("{} on {surface:?}, contact {k}", normal.name);
                // An overlap behind 10 km has 2e-12 m in its last bit.
                let limit = if surface == Surface::Sphere && k == 0 { 1e-6 } else { 1e-9 };
                COLUMN.equals(&on, found, "N", above, limit);
            }
        }
    }
}
