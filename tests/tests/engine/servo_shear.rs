//! Servos that hold their force while a specimen is sheared.

use super::servo::{SIDE, filled_box};
use dem::setup::*;
use dem::{ServoReport, Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, Law, empty, grain, plane, run_until};

/// When the lid begins to move [s].
const SHEAR: f64 = 0.4;

/// 64 grains of three sizes in a box: two sides press with `force` [N], and the lid compresses at `rate` [1/s].
fn triaxial(law: Law, force: f64, rate: f64) -> Setup {
    let mut setup = filled_box(law);
    for axis in 0..2 {
        setup.walls[2 * axis + 1].servo = Some(Servo::force(-Vec3::ith(axis, 1.0), force, 1.0));
    }
    setup.walls[5].motion =
        Motion { velocity: Vec3::z() * (-rate * SIDE), from: SHEAR, until: 10.0, ..Motion::still() };
    setup
}

fn report(sim: &mut Simulation, wall: usize) -> ServoReport {
    sim.wall_forces().expect("sound")[wall].servo.expect("it has a servo")
}

/// How far the force on the sides is from its target, over this, in a hundred frames while the lid compresses by 15 %.
fn sheared(law: Law, force: f64, rate: f64) -> Vec<f64> {
    let mut sim = Simulation::new(triaxial(law, force, rate)).expect("sound");
    // The first hundredth of strain is the start of the motion.
    run_until(&mut sim, SHEAR + 0.01 / rate);
    let mut off = Vec::new();
    for frame in 1..=100 {
        run_until(&mut sim, SHEAR + (0.01 + 0.0014 * f64::from(frame)) / rate);
        off.extend([1, 3].map(|wall| report(&mut sim, wall).push / force - 1.0));
    }
    off
}

/// A servo bears its force whatever the rate of strain: without its integral, 12.8 N become 14.4, 16.1 and 19.3 N. Where grains
/// rearrange at once the force jumps for less than a frame.
#[test]
fn force_is_held_at_three_rates_of_strain() {
    for law in [HOOKE, Law::Hertz] {
        for rate in [0.25, 0.5, 1.0] {
            let off = sheared(law, 12.8, rate);
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            let mut sizes: Vec<f64> = off.iter().map(|x| x.abs()).collect();
            sizes.sort_by(f64::total_cmp);
            let [most, worst] = [sizes[sizes.len() - 4], sizes[sizes.len() - 1]];
            println!("{law:?}, {rate} /s: mean {mean:e}, 98 % within {most:e}, worst {worst:e}");
            assert!(mean.abs() < 5e-4, "{law:?}, {rate} /s: mean off by {mean}");
            assert!(most < 0.01 && worst < 0.1, "{law:?}, {rate} /s: frames off by {most} and {worst}");
        }
    }
}

/// The most that the sides press with while they meet the specimen, over their force.
fn peak(law: Law, force: f64, speed_limit: f64) -> f64 {
    let mut setup = triaxial(law, force, 0.0);
    setup.walls[5].motion = Motion::still();
    for wall in [1, 3] {
        let servo = setup.walls[wall].servo.as_mut().expect("a servo");
        servo.speed_limit = speed_limit;
    }
    let mut sim = Simulation::new(setup).expect("sound");
    let mut most = 0.0f64;
    while sim.time() < 0.2 {
        sim.step().expect("within the guards");
        most = most.max(report(&mut sim, 1).push).max(report(&mut sim, 3).push);
    }
    most / force
}

/// A servo that meets a specimen at its speed limit overshoots no more than the grains' own inertia makes it.
#[test]
fn first_contact_crushes_nothing() {
    for law in [HOOKE, Law::Hertz] {
        // A single grain met at 0.05 m/s bears 0.5 N by its inertia.
        for (force, speed, most) in
            [(12.8, 0.05, 1.01), (12.8, 0.5, 1.1), (0.5, 0.05, 3.0), (200.0, 0.2, 1.01)]
        {
            let peak = peak(law, force, speed);
            println!("{law:?}, {force} N at {speed} m/s: peak {peak}");
            assert!(peak < most, "{law:?}, {force} N at {speed} m/s: peak {peak}");
        }
    }
}

/// All three axes follow a stress on an area that the other walls bound, while all of them move.
#[test]
fn stress_is_held_on_a_changing_area() {
    for law in [HOOKE, Law::Hertz] {
        let mut setup = triaxial(law, 0.0, 0.0);
        let between = |axis: usize| Length::Between(2 * axis, 2 * axis + 1);
        for axis in 0..3 {
            let area = Some([between((axis + 1) % 3), between((axis + 2) % 3)]);
            // From loose to five times the stress.
            let target = Target::new(vec![[0.2, 1e3], [0.4, 5e3 + 500.0 * axis as f64]]).expect("rows");
            let direction = -Vec3::ith(axis, 1.0);
            setup.walls[2 * axis + 1].servo = Some(Servo { direction, target, area, speed_limit: 0.2 });
            setup.walls[2 * axis + 1].motion = Motion::still();
        }
        let mut sim = Simulation::new(setup).expect("sound");
        let mut worst = 0.0f64;
        for frame in 0..60 {
            run_until(&mut sim, 0.15 + 0.01 * f64::from(frame));
            let walls = sim.wall_forces().expect("sound");
            let side = |axis: usize| SIDE + walls[2 * axis + 1].shift[axis];
            for axis in 0..3 {
                let area = side((axis + 1) % 3) * side((axis + 2) % 3);
                let ramp = ((sim.time() - 0.2) / 0.2).clamp(0.0, 1.0);
                let stress = 1e3 + (4e3 + 500.0 * axis as f64) * ramp;
                let servo = walls[2 * axis + 1].servo.expect("a servo");
                assert!((servo.area.expect("an area") / area - 1.0).abs() < 1e-12);
                assert!((servo.target / (stress * area) - 1.0).abs() < 1e-12, "{servo:?}");
                worst = worst.max((servo.push / servo.target - 1.0).abs());
            }
            if frame == 59 {
                println!(
                    "{law:?}: sides {} {} {}, {:?}",
                    side(0),
                    side(1),
                    side(2),
                    walls[1].servo.expect("s").held
                );
                assert!(side(0) < 0.98 * SIDE, "the area has changed: {}", side(0));
            }
        }
        println!("{law:?}: worst {worst:e}");
        assert!(worst < 0.01, "{law:?}: off by {worst}");
    }
}

/// Two servos that press from both sides hold the same force; soft and stiff grains lie between them.
#[test]
fn opposite_servos_hold_soft_and_stiff_grains() {
    let mut setup = triaxial(Law::Hertz, 3.0, 0.5);
    let soft = Material { name: "soft".to_owned(), density: 2500.0, young: 5e5, poisson: 0.25 };
    setup.materials.push(soft);
    let law = |a, b| grainpipe_tests::setups::contact((a, b), Law::Hertz, 0.3).with("sliding_friction", 0.3);
    setup.contacts.extend([law(0, 2), law(1, 2), law(2, 2)]);
    setup.particles.iter_mut().filter(|p| p.id % 3 == 0).for_each(|p| p.material = 2);
    setup.walls[0].servo = Some(Servo::force(Vec3::x(), 3.0, 1.0));
    (0..2).for_each(|axis| {
        setup.walls[2 * axis + 1].servo = Some(Servo::force(-Vec3::ith(axis, 1.0), 3.0, 1.0))
    });
    let mut sim = Simulation::new(setup).expect("sound");
    let mut worst = 0.0f64;
    for frame in 1..=100 {
        run_until(&mut sim, SHEAR + 0.02 + 0.002 * f64::from(frame));
        for wall in [0, 1, 3] {
            worst = worst.max((report(&mut sim, wall).push / 3.0 - 1.0).abs());
        }
    }
    println!("worst {worst:e}, {:?}", report(&mut sim, 0).held);
    assert!(worst < 0.01, "off by {worst}");
}

/// A lid that is to press with no force gives way to grains that push it, and then stays.
#[test]
fn lid_without_force_gives_way() {
    let mut setup = triaxial(HOOKE, 12.8, 0.5);
    setup.walls[3].servo = Some(Servo::force(-Vec3::y(), 0.0, 1.0));
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, SHEAR + 0.3);
    let side = sim.wall_forces().expect("sound")[3];
    println!("{side:?}");
    assert!(side.shift.y > 1e-3 && side.force.norm() < 0.2, "{side:?}");
}

/// A plate that moves away from the grains stops the run with its name; a plane that would do so is refused.
#[test]
fn servo_that_moves_away_is_noticed() {
    let mut setup = empty(HOOKE, 0.3);
    let half = Vec3::new(0.05, 0.05, 0.005);
    let plate = WallShape::Mesh(geom::mesh::cuboid(Vec3::z() * 0.1 - half, Vec3::z() * 0.1 + half));
    setup.walls = vec![Wall { name: "plate".to_owned(), shape: plate, ..plane(Vec3::z()) }];
    setup.walls[0].servo = Some(Servo::force(Vec3::z(), 5.0, 0.1));
    setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.01))];
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    let halt = (0..10_000).find_map(|_| sim.step().err()).expect("it stops");
    assert!(matches!(&halt, dem::Halt::WallPastAll { wall, .. } if wall == "plate"), "{halt}");
    // The other way it arrives.
    setup.walls[0].servo = Some(Servo::force(-Vec3::z(), 5.0, 0.1));
    setup.walls.push(plane(Vec3::z()));
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    run_until(&mut sim, 1.0);
    assert!((report(&mut sim, 0).push / 5.0 - 1.0).abs() < 1e-6);
    setup.walls[1].servo = Some(Servo::force(-Vec3::z(), 5.0, 0.1));
    let error = Simulation::new(setup).err().expect("refused").to_string();
    assert!(error.contains("servo.direction"), "{error}");
}
