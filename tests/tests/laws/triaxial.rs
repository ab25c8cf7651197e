//! A face-centred cubic array of rigid spheres, compressed along an axis of its cube.
//!
//! ```text
//! σ_1/σ_3 = 2 (1 + μ)/(1 − μ)     while the contacts between layers slide and those within a layer are open
//! ```
//!
//! Thornton (1979), Géotechnique 29(4), doi:10.1680/geot.1979.29.4.441. Periodic across, so that no grain has a side where nothing
//! holds it, and pressed between two smooth planes: k_t > μ k_n makes every contact slide from the start. Stresses are those of the
//! contacts, Σ f_i l_j / V.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{LAWS, Law, empty, grain, run_until, with_friction};

const RATIO: Case = case("Many grains", "FCC array of stiff spheres, triaxial: σ₁/σ₃ = 2 (1 + μ)/(1 − μ)");
const R: f64 = 0.01;
const ACROSS: u32 = 4;
const LAYERS: u32 = 6;

/// Layers across z, each a square of spheres that nearly touch; every other one is shifted by half a square.
fn array(law: Law, mu: f64) -> Setup {
    let law = match law {
        Law::Hooke { .. } => Law::Hooke { stiffness: 1e6, tangential_ratio: None },
        other => other,
    };
    let mut setup = with_friction(empty(law, 0.1), mu);
    setup.materials.iter_mut().for_each(|m| m.young = 1e10);
    setup.contacts[1].remove("sliding_friction");
    setup.step = Step::Auto(0.5);
    // A hair more than a diameter: compressed, the spheres of a layer do not touch.
    let side = 2.0 * R * (1.0 + 1e-6);
    let layer = (4.0 * R * R - 0.5 * side * side).sqrt();
    let period = side * f64::from(ACROSS);
    setup.periodic = [Some((0.0, period)), Some((0.0, period)), None];
    for z in 0..LAYERS {
        let shift = 0.25 + 0.5 * f64::from(z % 2);
        for k in 0..ACROSS * ACROSS {
            let at = |k: u32| (f64::from(k) + shift) * side;
            let place = Vec3::new(at(k % ACROSS), at(k / ACROSS), R + layer * f64::from(z));
            setup.particles.push(grain(setup.particles.len() as u32, place));
        }
    }
    let wall = |name: &str, z: f64, normal: Vec3, speed: f64| {
        let mut motion = Motion::still();
        motion.velocity = normal * speed;
        let plane = Plane { point: Vec3::new(0.0, 0.0, z), normal };
        Wall { motion, ..Wall::new(name, 1, WallShape::Plane(plane)) }
    };
    let top = 2.0 * R + layer * f64::from(LAYERS - 1);
    setup.walls = vec![wall("floor", 0.0, Vec3::z(), 0.0), wall("lid", top, -Vec3::z(), 1e-3)];
    setup
}

/// σ_1/σ_3 of the contacts between grains.
fn ratio(sim: &mut Simulation) -> f64 {
    let contacts = sim.record_contacts().expect("within the guards");
    let (mut axial, mut lateral) = (0.0, 0.0);
    for c in contacts.iter().filter(|c| !c.wall) {
        let branch = c.normal * (2.0 * R - c.overlap);
        axial += c.force.z * branch.z;
        lateral += 0.5 * (c.force.x * branch.x + c.force.y * branch.y);
    }
    axial / lateral
}

#[test]
fn triaxial_compression_of_a_cubic_array() {
    for (law, name) in LAWS.into_iter().zip(["hooke", "hertz"]) {
        for mu in [0.0, 0.1, 0.25, 0.5] {
            let mut sim = simulation(array(law, mu));
            // Overlaps of some 1e-5 radii. An array that slides everywhere is not stable: later it gives way to one side.
            run_until(&mut sim, 0.004);
            RATIO.equals(
                &format!("{name}, μ = {mu}"),
                ratio(&mut sim),
                "–",
                2.0 * (1.0 + mu) / (1.0 - mu),
                2e-3,
            );
        }
    }
}
