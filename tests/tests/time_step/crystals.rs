//! Face-centred cubic crystals in a periodic box: twelve contacts a grain, and every wave that the box holds, so that the worst
//! motions are among them: layers against layers, and all grains turning the same way.

use crate::trial::{ALL, Trial};
use dem::setup::*;
use dem::{Setup, mass};
use geom::{Moments, Vec3};
use grainpipe_tests::setups::{HOOKE, Law, beam, contact, empty, grain, with_friction};
use nalgebra::UnitQuaternion;
use std::f64::consts::SQRT_2;

const R: f64 = 0.01;
/// Places of a crystal of some cubes along each edge, whose neighbours overlap by a share of the radius, and the period.
fn places(cubes: u32, overlap: f64) -> (Vec<Vec3>, f64) {
    let cube = SQRT_2 * R * (2.0 - overlap);
    let corners = [(0.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.5, 0.0, 0.5), (0.0, 0.5, 0.5)];
    let mut list = Vec::new();
    for k in 0..cubes.pow(3) {
        let at = |k: u32| f64::from(k % cubes);
        for (x, y, z) in corners {
            let place = Vec3::new(at(k) + x, at(k / cubes) + y, at(k / cubes / cubes) + z);
            list.push((place + Vec3::new(0.25, 0.25, 0.25)) * cube);
        }
    }
    (list, cube * f64::from(cubes))
}

/// A crystal under its own pressure.
fn crystal(law: Law, e: f64, overlap: f64) -> Setup {
    cubes(2, law, e, overlap)
}

fn cubes(count: u32, law: Law, e: f64, overlap: f64) -> Setup {
    let (places, period) = places(count, overlap);
    let mut setup = empty(law, e);
    setup.periodic = [Some((0.0, period)); 3];
    // The bound is for the deepest overlap that the guard allows.
    setup.guards.overlap = overlap * 1.01;
    setup.particles = (0..).zip(places).map(|(id, place)| grain(id, place)).collect();
    setup
}

fn each(mut setup: Setup, change: impl Fn(&mut ContactLaw)) -> Setup {
    setup.contacts.iter_mut().for_each(change);
    setup
}

const SOFT: Law = Law::Hooke { stiffness: 1e4, tangential_ratio: Some(0.04) };

#[test]
fn pushing() {
    let jkr = Law::Jkr { work_of_adhesion: 1.0 };
    for (name, law, e) in [
        ("crystal, hooke, e = 1", HOOKE, 1.0),
        ("crystal, hooke, e = 0.5", HOOKE, 0.5),
        ("crystal, hooke, e = 0.1", HOOKE, 0.1),
        ("crystal, hertz at its overlap limit, e = 1", Law::Hertz, 1.0),
        ("crystal, hertz at its overlap limit, e = 0.1", Law::Hertz, 0.1),
        ("crystal, jkr at its overlap limit, e = 1", jkr, 1.0),
    ] {
        Trial { name, setup: crystal(law, e, 1e-2), ways: ALL }.meant();
    }
    let mut mixed = crystal(HOOKE, 0.1, 1e-2);
    mixed.contacts.iter_mut().for_each(|c| grainpipe_tests::setups::sticky(c, 1e4));
    Trial { name: "crystal, hooke with cohesion, e = 0.1", setup: mixed, ways: ALL }.meant();
}

#[test]
fn rubbing() {
    for (name, law, e) in [
        ("crystal, friction, hooke, e = 1", HOOKE, 1.0),
        ("crystal, friction, hooke, e = 0.5", HOOKE, 0.5),
        ("crystal, friction, hooke, e = 0.1", HOOKE, 0.1),
        ("crystal, friction, hertz, e = 0.3", Law::Hertz, 0.3),
        ("crystal, friction, hooke, k_t = 0.04 k, e = 1", SOFT, 1.0),
        ("crystal, friction, hooke, k_t = 0.04 k, e = 0.01", SOFT, 0.01),
    ] {
        Trial { name, setup: with_friction(crystal(law, e, 1e-2), 1.0), ways: ALL }.meant();
    }
}

#[test]
fn rolling_and_twisting() {
    for (name, e, rolling, twisting) in [
        ("crystal, rolling resistance 0.3, e = 0.3", 0.3, 0.3, None),
        ("crystal, rolling resistance 1.5, e = 1", 1.0, 1.5, None),
        ("crystal, twisting, e = 1", 1.0, 0.0, Some(1.0)),
        ("crystal, rolling 1 and twisting, e = 0.9", 0.9, 1.0, Some(1.0)),
    ] {
        let setup = each(with_friction(crystal(HOOKE, e, 1e-2), 1.0), |c| {
            c.set("rolling_resistance", Some(rolling).filter(|&r| r > 0.0));
            c.set("twisting_resistance", twisting);
        });
        Trial { name, setup, ways: ALL }.meant();
    }
}

/// A fluid whose relaxation time is as short as the step.
#[test]
fn in_a_fluid() {
    for (name, share) in [("crystal in a thick fluid", 1.0), ("crystal in a very thick fluid", 6.0)] {
        let mut setup = crystal(HOOKE, 1.0, 1e-2);
        let rate = share * (4.0 * 1e4 / (0.5 * mass(R, 2500.0))).sqrt();
        let viscosity = rate * mass(R, 2500.0) / (6.0 * std::f64::consts::PI * R);
        setup.drag = Some(Drag {
            law: DragLaw::Stokes,
            viscosity,
            density: 0.0,
            velocity: Vec3::zeros(),
            buoyancy: false,
        });
        Trial { name, setup, ways: ALL }.meant();
    }
}

/// Bonds between grains that do not touch, and the bound is that of bonds; bonds beside contacts as stiff as they are.
#[test]
fn bonded() {
    let loose = |e| {
        let mut setup = crystal(SOFT, e, 1e-2);
        let (places, period) = places(2, -0.05);
        setup.periodic = [Some((0.0, period)); 3];
        setup.particles.iter_mut().zip(places).for_each(|(p, place)| p.position = place);
        setup
    };
    let stiff = Bond { gap: 1e-3, ..beam((0, 0), [1e9, 4e8]) };
    for (name, bond) in [
        ("bonded crystal", stiff.clone()),
        ("bonded crystal, damping 0.5", Bond { damping: 0.5, ..stiff.clone() }),
        ("bonded crystal, damping 2", Bond { damping: 2.0, ..stiff.clone() }),
        ("bonded crystal, thick bonds", Bond { radius_ratio: 2.5, ..stiff.clone() }),
        ("bonded crystal, thin bonds", Bond { radius_ratio: 0.2, ..stiff.clone() }),
        ("bonded crystal, soft in shear", Bond { gap: 1e-3, ..beam((0, 0), [1e9, 1e7]) }),
    ] {
        let setup = Setup { bonds: vec![bond], ..loose(1.0) };
        Trial { name, setup, ways: ALL }.meant();
    }
    let mut both = with_friction(crystal(HOOKE, 1.0, 1e-2), 1.0);
    both.bonds = vec![beam((0, 0), [6e5, 2.4e5])];
    Trial { name: "bonded crystal, contacts as stiff as bonds", setup: both, ways: ALL }.meant();
}

/// One light grain in a crystal of heavy ones, and one that is stiff among soft ones.
#[test]
fn one_grain_is_different() {
    let mut setup = crystal(HOOKE, 1.0, 1e-2);
    setup.contacts.push(contact((1, 1), HOOKE, 1.0));
    (setup.materials[0].density, setup.materials[1].density) = (2.5, 2500.0);
    setup.particles[1..].iter_mut().for_each(|p| p.material = 1);
    Trial { name: "light grain among heavy ones, 1 : 1000", setup: setup.clone(), ways: ALL }.meant();
    let friction = with_friction(setup, 1.0);
    Trial { name: "light grain among heavy ones, friction", setup: friction, ways: ALL }.safe();
}

/// Grains joined two by two: a crystal of rigid dumbbells.
#[test]
fn clumps() {
    for (name, e, friction) in [
        ("crystal of dumbbells, hooke, e = 1", 1.0, None),
        ("crystal of dumbbells, hooke, e = 0.1", 0.1, None),
        ("crystal of dumbbells, friction, e = 1", 1.0, Some(1.0)),
        ("crystal of dumbbells, friction, e = 0.9", 0.9, Some(1.0)),
        ("crystal of dumbbells, friction, e = 0.1", 0.1, Some(1.0)),
    ] {
        // A box is to be five times as long as the largest radius about a centre of mass.
        let mut setup = cubes(4, HOOKE, e, 1e-2);
        let along = setup.particles[1].position - setup.particles[0].position;
        let half = 0.5 * along.norm();
        let spheres = [(Vec3::new(-half, 0.0, 0.0), R), (Vec3::new(half, 0.0, 0.0), R)];
        let shape = ClumpShape::new("dumbbell", 0, &spheres, &Moments::of_sum(&spheres));
        let turn = UnitQuaternion::rotation_between(&Vec3::x(), &along).expect("not opposite");
        let firsts = setup.particles.chunks(2).map(|pair| (pair[0].id, pair[0].position));
        let body = |(id, place): (u32, Vec3)| Body {
            id,
            shape: 0,
            scale: 1.0,
            position: place + 0.5 * along,
            orientation: turn,
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
        };
        setup.clumps = Clumps { shapes: vec![shape], placed: firsts.map(body).collect(), entries: vec![] };
        setup.particles = vec![];
        setup.contacts.iter_mut().for_each(|c| c.set("sliding_friction", friction));
        Trial { name, setup, ways: ALL }.meant();
    }
}
