//! Recorded contacts: force, place and sliding work against what a slide down a plane must give.

use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, LAWS, empty, grain, particles, plane, run_until, with_friction};

/// A grain thrown along a floor, looked at while it still slides.
#[test]
fn a_thrown_grain_leaves_its_sliding_work_on_the_floor() {
    let (friction, speed) = (0.3, 2.0);
    for law in LAWS {
        let mut setup = with_friction(empty(law, 0.2), friction);
        setup.gravity.z = -9.81;
        setup.ledger = true;
        setup.walls = vec![plane(Vec3::z())];
        setup.particles =
            vec![Particle { velocity: Vec3::new(speed, 0.0, 0.0), ..grain(7, Vec3::new(0.0, 0.0, 0.01)) }];
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 0.08);
        let slip = |sim: &mut Simulation| {
            let p = particles(sim)[0];
            // The arm ends on the floor.
            p.velocity.x - p.position.z * p.spin.y
        };
        let (first, start) = (slip(&mut sim), sim.time());
        let settled = sim.record_contacts().expect("within the guards");
        let before = sim.energy().expect("within the guards").sliding;
        assert_eq!((settled[0].i, settled[0].j, settled[0].wall), (7, 0, true));
        run_until(&mut sim, 0.15);
        let now = sim.record_contacts().expect("within the guards");
        let one = now[0];
        let weight = dem::mass(0.01, 2500.0) * 9.81;
        assert_eq!(now.len(), 1);
        assert!((one.normal - Vec3::z()).norm() < 1e-12 && one.point.z.abs() < 1e-6);
        assert!((one.force.z / weight - 1.0).abs() < 1e-3, "{law:?}: {} N", one.force.z);
        assert!((one.force.x / weight + friction).abs() < 1e-3, "{law:?}: {} N of friction", one.force.x);
        // The speed of the contact point falls evenly.
        let expected = friction * weight * 0.5 * (first + slip(&mut sim)) * (sim.time() - start);
        assert!((one.work / expected - 1.0).abs() < 1e-3, "{law:?}: {} J, {expected} J", one.work);
        let ledger = sim.energy().expect("within the guards").sliding - before;
        assert!((one.work - ledger).abs() < 1e-12 * ledger, "{law:?}: the ledger says {ledger} J");
        assert_eq!(sim.record_contacts().expect("within the guards")[0].work, 0.0, "told once");
    }
}

/// The work outlives new lists, with the partners in either order.
#[test]
fn work_is_carried_over_to_new_lists() {
    let mut setup = with_friction(empty(HOOKE, 0.9), 0.4);
    setup.ledger = true;
    setup.skin = Some(1e-4);
    // One grain turns on another while both drift.
    let drift = Vec3::new(0.5, 0.3, 0.1);
    setup.particles = (0..2)
        .map(|k| Particle {
            velocity: drift,
            spin: Vec3::new(0.0, 0.0, 40.0),
            ..grain(k, Vec3::new(0.0199 * f64::from(k), 0.0, 0.0))
        })
        .collect();
    let mut sim = Simulation::new(setup).expect("sound");
    sim.record_contacts().expect("within the guards");
    let listings = sim.rebuilds();
    run_until(&mut sim, 0.001);
    assert!(sim.rebuilds() > listings + 2, "{} listings", sim.rebuilds());
    let done: f64 = sim.record_contacts().expect("within the guards").iter().map(|c| c.work).sum();
    let ledger = sim.energy().expect("within the guards").sliding;
    assert!(
        ledger > 0.0 && (done - ledger).abs() < 1e-12 * ledger,
        "{done} J recorded, {ledger} J in the ledger"
    );
    assert_eq!(particles(&mut sim).len(), 2);
}

/// A grain that grazes a mesh and is gone by the next record leaves its work at its centre: a finite place, no normal, no touch.
#[test]
fn what_has_left_a_mesh_is_told_at_the_grain() {
    let corner = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let square = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let mesh = geom::mesh::TriMesh::new(square, vec![[0, 1, 2], [0, 2, 3]]).expect("sound");
    for law in LAWS {
        let mut setup = with_friction(empty(law, 0.5), 0.4);
        setup.ledger = true;
        setup.walls = vec![Wall { shape: WallShape::Mesh(mesh.clone()), ..plane(Vec3::z()) }];
        let velocity = Vec3::new(1.0, 0.0, -0.5);
        setup.particles = vec![Particle { velocity, ..grain(7, Vec3::new(0.0, 0.0, 0.0105)) }];
        let mut sim = Simulation::new(setup).expect("sound");
        sim.record_contacts().expect("within the guards");
        let mut told = Vec::new();
        for k in 1..60 {
            run_until(&mut sim, 1e-3 * f64::from(k));
            told.extend(sim.record_contacts().expect("within the guards"));
        }
        let ledger = sim.energy().expect("within the guards").sliding;
        let work: f64 = told.iter().map(|c| c.work).sum();
        assert!(ledger > 0.0 && (work - ledger).abs() < 1e-12 * ledger, "{law:?}: {work} J of {ledger} J");
        assert!(told.iter().all(|c| c.point.amax() < 1.0 && c.overlap.abs() <= 0.01), "{law:?}: {told:?}");
    }
}
