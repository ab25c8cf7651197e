//! Elastic grains without friction keep their energy where faces of a mesh meet at a shallow concave angle.

use dem::setup::*;
use dem::{Setup, Simulation, mass};
use geom::{Vec3, mesh::TriMesh};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles, plane, run_until};

const RADIUS: f64 = 0.01;
/// Half the length of a trough [m].
const LONG: f64 = 0.2;

/// A trough along y through these points of the xz plane.
fn trough(points: &[[f64; 2]]) -> Wall {
    let vertices =
        points.iter().flat_map(|&[x, z]| [Vec3::new(x, -LONG, z), Vec3::new(x, LONG, z)]).collect();
    let squares = (0..points.len() as u32 - 1).map(|k| 2 * k);
    let faces = squares.flat_map(|k| [[k, k + 2, k + 3], [k, k + 3, k + 1]]).collect();
    let mesh = TriMesh::new(vertices, faces).expect("sound");
    Wall { shape: WallShape::Mesh(mesh), ..plane(Vec3::z()) }
}

/// A polygon of `n` sides around the y axis, at this distance from it [m].
fn tube(n: u32, apothem: f64) -> Wall {
    let corner = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        let radius = apothem / (std::f64::consts::PI / f64::from(n)).cos();
        [radius * angle.cos(), radius * angle.sin()]
    };
    trough(&(0..=n).map(|k| corner(k % n)).collect::<Vec<_>>())
}

fn elastic(law: Law, wall: Wall) -> Setup {
    let mut setup = empty(law, 1.0);
    setup.step = Step::Auto(0.02);
    setup.walls = vec![wall];
    setup.ledger = true;
    setup
}

/// E/E₀ − 1 of each grain, once none touches anything.
fn gain(setup: Setup, until: f64) -> f64 {
    let before: Vec<f64> = setup.particles.iter().map(|p| p.velocity.norm_squared()).collect();
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, until);
    while sim.energy().expect("within the guards").elastic > 0.0 {
        sim.step().expect("within the guards");
    }
    let after = particles(&mut sim);
    let gain = after.iter().zip(before).map(|(p, e)| (p.velocity.norm_squared() / e - 1.0).abs());
    gain.fold(0.0, f64::max)
}

/// Grains thrown at a valley at 1 m/s, all about its seam: at overlaps of a few hundredths of the radius.
#[test]
fn a_valley_of_two_plates_makes_no_energy() {
    for law in LAWS {
        for degrees in [2.0, 5.0, 9.0, 15.0, 22.0, 30.0, 44.0f64] {
            for angle in [0.0, 0.5f64] {
                let (sin, cos) = (0.5 * degrees.to_radians()).sin_cos();
                let side = 0.1;
                let valley = trough(&[[-side * cos, side * sin], [0.0, 0.0], [side * cos, side * sin]]);
                let mut setup = elastic(law, valley);
                let velocity = Vec3::new(angle.sin(), 0.0, -angle.cos());
                let place = |k: u32| {
                    let share = f64::from(k) / 14.0 - 0.5;
                    let touching = Vec3::new(share * RADIUS, 0.0, RADIUS / cos + share.abs() * RADIUS * sin);
                    touching + Vec3::y() * (0.025 * f64::from(k) - 0.175) - velocity * 2e-3
                };
                setup.particles = (0..15).map(|k| Particle { velocity, ..grain(k, place(k)) }).collect();
                let gain = gain(setup, 0.02);
                assert!(gain < 5e-5, "{law:?}, {degrees}°, thrown at {angle} rad: E/E₀ − 1 = {gain:e}");
            }
        }
    }
}

/// A grain bounces to and fro in a tube of any number of facets.
#[test]
fn a_tube_of_facets_makes_no_energy() {
    for law in LAWS {
        for n in [8, 12, 16, 24, 40, 56, 64] {
            for (k, share) in [(0, 1.3), (1, 2.0), (2, 5.0)] {
                let mut setup = elastic(law, tube(n, share * RADIUS));
                let velocity = Vec3::new(0.8, 0.0, 0.37 + 0.1 * f64::from(k));
                setup.particles = vec![Particle { velocity, ..grain(0, Vec3::new(1e-3, 0.0, 2e-3)) }];
                let mut sim = Simulation::new(setup).expect("sound");
                let m = mass(RADIUS, 2500.0);
                let kinetic = 0.5 * m * velocity.norm_squared();
                let (mut worst, mut flights) = (0.0f64, 0);
                for step in 1..200 {
                    run_until(&mut sim, 1e-3 * f64::from(step));
                    let e = sim.energy().expect("within the guards");
                    // In contact, a step later or earlier than velocities, their sum swings.
                    if e.elastic == 0.0 {
                        worst = worst.max((e.translation / kinetic - 1.0).abs());
                        flights += 1;
                    }
                }
                assert!(flights > 20, "{flights}");
                assert!(worst < 2e-4, "{law:?}, {n} facets, {share} radii: E/E₀ − 1 = {worst:e}");
            }
        }
    }
}

/// Force of a wall on a grain.
fn push(wall: Wall, position: Vec3) -> Vec3 {
    let mut setup = elastic(HOOKE, wall);
    setup.particles = vec![grain(0, position)];
    setup.record_wrenches = true;
    let mut sim = Simulation::new(setup).expect("sound");
    -sim.wall_forces().expect("within the guards").iter().map(|w| w.force).sum::<Vec3>()
}

/// Facets push as the cylinder does that they stand for, the more the finer they are; the mean over places is k δ.
#[test]
fn facets_tend_to_the_cylinder() {
    let apothem = 0.05;
    let off = |n: u32| {
        let each = (0..97).map(|k| {
            let angle = 0.0127 + std::f64::consts::TAU * f64::from(k) / 97.0;
            let out = Vec3::new(angle.cos(), 0.0, angle.sin());
            let overlap = 5e-4;
            let force = push(tube(n, apothem), out * (apothem - RADIUS + overlap) + Vec3::y() * 1e-3);
            (force / (-1e4 * overlap) - out).norm()
        });
        each.fold(0.0, f64::max)
    };
    let found = [32, 64, 128].map(off);
    assert!(found[1] < 0.4 * found[0] && found[2] < 0.4 * found[1], "{found:?}");
}

/// Two walls that meet are one surface: grains that come down about the seam of two plates go where one mesh of both sends them, whichever wall is named
/// first; so they do on plates that lie within each other.
#[test]
fn walls_that_meet_are_one_surface() {
    for (law, restitution) in [(HOOKE, 1.0), (Law::Hertz, 0.5)] {
        for degrees in [0.0, 7.0, 30.0f64] {
            let (sin, cos) = (0.5 * degrees.to_radians()).sin_cos();
            let points = [[-0.1 * cos, 0.1 * sin], [0.0, 0.0], [0.1 * cos, 0.1 * sin]];
            let one = vec![trough(&points)];
            let [left, right] = [trough(&points[..2]), trough(&points[1..])];
            let others =
                [vec![left.clone(), right.clone()], vec![right, left.clone()], vec![one[0].clone(), left]];
            let after = |walls: Vec<Wall>| {
                let mut setup = empty(law, restitution);
                setup.walls = walls;
                let velocity = Vec3::new(0.3, 0.1, -1.0);
                let place = |k: u32| {
                    let across = (f64::from(k) / 14.0 - 0.5) * RADIUS;
                    Vec3::new(across, 0.025 * f64::from(k) - 0.175, RADIUS / cos + across.abs() * sin)
                        - velocity * 2e-3
                };
                setup.particles = (0..15).map(|k| Particle { velocity, ..grain(k, place(k)) }).collect();
                let mut sim = Simulation::new(setup).expect("sound");
                run_until(&mut sim, 0.02);
                particles(&mut sim)
            };
            let wanted = after(one);
            for (n, walls) in others.into_iter().enumerate() {
                for (found, wanted) in after(walls).iter().zip(&wanted) {
                    let off = (found.velocity - wanted.velocity).norm();
                    assert!(
                        off < 1e-9,
                        "{law:?}, {degrees}°, order {n}: grain {} is {off} m/s off",
                        found.id
                    );
                }
            }
        }
    }
}
