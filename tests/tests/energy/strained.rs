//! Scenes whose periodic cell is strained.

use crate::scenes::Scene;
use dem::Setup;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, Law, bond, empty, grain, with_friction};

/// Side of the cell [m].
const SIDE: f64 = 0.1;

/// 64 grains in a cell that is pressed along x, follows a path along y and is compressed along z; they move at random.
fn cell(law: Law) -> Setup {
    let mut setup = with_friction(empty(law, 0.6), 0.4);
    setup.step = Step::Auto(0.2);
    setup.ledger = true;
    setup.periodic = [Some((-0.02, SIDE - 0.02)), Some((0.0, SIDE)), Some((0.3, 0.3 + SIDE))];
    let path = Target::new(vec![[0.0, 0.0], [0.05, 0.04], [0.4, 0.01]]).expect("rows");
    let stress = Strain::Stress { target: Target::constant(2e3), rate_limit: 1.5 };
    setup.strain = [Some(stress), Some(Strain::Path(path)), Some(Strain::Rate(0.3))];
    setup.particles = (0..64u32)
        .map(|k| {
            let at = |n: u32| 0.0125 + 0.025 * f64::from(n);
            let off = |n: u32| 1e-3 * (f64::from(k * n % 11) - 5.0);
            let place = Vec3::new(at(k % 4) - 0.02, at(k / 4 % 4), at(k / 16) + 0.3);
            let velocity = Vec3::new(off(3), off(5), off(7)) * 20.0;
            Particle { velocity, radius: [0.012, 0.011, 0.0105][k as usize % 3], ..grain(k, place) }
        })
        .collect();
    setup
}

fn scene(name: &str, setup: Setup) -> Scene {
    Scene { name: format!("strained cell, {name}"), setup, entries: vec![], until: 0.2 }
}

/// Grains, bonded grains, and clumps.
pub fn all() -> Vec<Scene> {
    let strength = BondStrength::of(3e4, 3e4);
    let mut bonded = cell(HOOKE);
    bonded.bonds = vec![Bond { damping: 0.05, strength, gap: 0.004, ..bond((0, 0)) }];
    let mut damped = cell(Law::Hertz);
    damped.local_damping = Some(0.7);
    let mut clumps = cell(Law::Hertz);
    clumps.particles.iter_mut().for_each(|p| p.velocity *= 3.0);
    let mut damped_clumps = clumps.clone();
    damped_clumps.local_damping = Some(0.7);
    vec![
        scene("clumps, local damping", crate::scenes::tumbling(damped_clumps, crate::scenes::boomerang())),
        scene("hooke", cell(HOOKE)),
        scene("hertz", cell(Law::Hertz)),
        scene("local damping", damped),
        scene("bonds", bonded),
        scene("clumps", crate::scenes::tumbling(clumps, grainpipe_tests::setups::dumbbell())),
    ]
}
