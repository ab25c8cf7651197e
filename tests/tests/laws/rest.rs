//! A column at rest.

use crate::simulation;
use dem::mass;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::{NORMALS, SURFACES, Surface};
use grainpipe_tests::setups::{grain, particles, run_until};

const COLUMN: Case = case("Many grains", "column of 10 at rest: force in the n-th contact = weight above it");

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
