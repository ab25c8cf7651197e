//! The integration error of an oblique impact with damping falls as that of its forces does: what springs lose as they stiffen is booked as they held it.

use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{Law, empty, grain, particles, plane, with_friction};

/// Energy that the step makes of that of the throw [–].
fn made(restitution: f64, degrees: f64, spin: f64, safety: f64) -> f64 {
    let mut setup = with_friction(empty(Law::Hertz, restitution), 0.4);
    setup.step = Step::Auto(safety);
    setup.ledger = true;
    setup.walls = vec![plane(Vec3::z())];
    let (sin, cos) = degrees.to_radians().sin_cos();
    let above = grain(1, Vec3::new(0.0, 0.0, 0.01003));
    let (velocity, spin) = (Vec3::new(sin, 0.0, -cos), Vec3::new(0.0, spin / 0.01, 0.0));
    setup.particles = vec![Particle { velocity, spin, ..above }];
    let mut sim = Simulation::new(setup).expect("sound");
    let before = sim.energy().expect("within the guards");
    while particles(&mut sim)[0].position.z < 0.0101 || particles(&mut sim)[0].velocity.z < 0.0 {
        sim.step().expect("within the guards");
    }
    sim.energy().expect("within the guards").integration / (before.translation + before.rotation)
}

#[test]
fn oblique_impacts_of_hertz_leave_an_error_of_second_order() {
    for restitution in [0.3, 0.5, 0.7, 0.9] {
        for (degrees, spin) in [(20.0, 0.0), (45.0, 0.3), (70.0, 0.0), (30.0, -0.5), (60.0, 0.8)] {
            let [coarse, fine] = [0.2, 0.05].map(|safety| made(restitution, degrees, spin, safety).abs());
            assert!(
                coarse < 6e-5 && fine < 5e-6,
                "e = {restitution}, {degrees}°, spin {spin}: {coarse:e} and {fine:e} of the energy"
            );
        }
    }
}
