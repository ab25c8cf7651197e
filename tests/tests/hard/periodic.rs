//! Contacts across the faces of a periodic box.

use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{empty, grain, particles, with_friction};

const ACROSS: Case =
    case("Rest and extremes", "a contact is the same in the middle of a periodic box and across its face");

const ACROSS_SPIN: Case =
    case("Rest and extremes", "spins are the same in the middle of a periodic box and across its face");

/// Two rubbing, rolling grains, in the middle of a periodic box or across its face.
fn rubbing(x: f64, period: f64, skin: Option<f64>) -> Vec<Particle> {
    let law = Law::Hooke { stiffness: 100.0, tangential_ratio: None };
    let mut setup = with_friction(empty(law, 0.9), 0.3);
    setup.contacts.iter_mut().for_each(|c| c.rolling_resistance = Some(0.2));
    setup.periodic = [Some((0.0, period)), None, None];
    (setup.skin, setup.guards.overlap) = (skin, 0.5);
    let spin = Vec3::new(0.0, 0.0, 20.0);
    let drift = Vec3::new(3.0, 0.5, 0.0);
    setup.particles = vec![
        Particle { spin, velocity: drift, ..grain(0, Vec3::new(x, 0.0, 0.0)) },
        Particle { velocity: drift, ..grain(1, Vec3::new((x + 0.0195) % period, 0.0, 0.0)) },
    ];
    let mut sim = Simulation::new(setup).expect("sound");
    (0..400).for_each(|_| sim.step().expect("within the guards"));
    particles(&mut sim)
}

/// Spring and couple of a contact go with it through a periodic face, also where both images of a grain are listed with another.
#[test]
fn a_contact_is_the_same_across_a_periodic_face() {
    let middle = rubbing(0.4, 1.0, None);
    for (x, period, skin) in
        [(0.99, 1.0, None), (0.02, 0.05, None), (0.045, 0.05, None), (0.02, 0.05, Some(0.02))]
    {
        for (a, b) in middle.iter().zip(&rubbing(x, period, skin)) {
            let (v, w) = ((a.velocity - b.velocity).norm(), (a.spin - b.spin).norm());
            let on = format!("from {x} m of {period} m");
            ACROSS.within(&on, v, "m/s", 1e-9);
            ACROSS_SPIN.within(&on, w, "rad/s", 1e-6);
            assert!(a.spin.norm() > 0.5, "{on}: they rub");
        }
    }
}
