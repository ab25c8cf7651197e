//! A mesh acts like the surface that it stands for: seams, corners, edges, many triangles, and periodic faces.

use dem::setup::*;
use dem::{Setup, Simulation};
use geom::{Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles, plane, run_until, with_friction};

/// A sheet of `n` × `n` squares of two triangles around the origin, its points moved along their plane at random, and lifted.
fn sheet(n: u32, cell: f64, lift: impl Fn(f64, f64) -> f64) -> Wall {
    let mut state = 5u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let at = |k: u32, s: f64| (f64::from(k) - 0.5 * f64::from(n) + 0.5 * s) * cell;
    let vertices = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| (i, j)))
        .map(|(i, j)| {
            let (x, y) = (at(i, next()), at(j, next()));
            Vec3::new(x, y, lift(x, y))
        })
        .collect();
    let v = |i: u32, j: u32| j * (n + 1) + i;
    let faces = (0..n)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .flat_map(|(i, j)| [[v(i, j), v(i + 1, j), v(i + 1, j + 1)], [v(i, j), v(i + 1, j + 1), v(i, j + 1)]])
        .collect();
    let mesh = TriMesh::new(vertices, faces).expect("sound");
    Wall { shape: WallShape::Mesh(mesh), ..plane(Vec3::z()) }
}

/// A ball on a slope of angle θ, tilted gravity instead of a tilted wall.
fn on_slope(law: Law, theta: f64, floor: Wall, start: Vec3) -> Setup {
    let mut setup = with_friction(empty(law, 0.3), 0.5);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.2));
    setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
    setup.walls = vec![floor];
    setup.step = Step::Auto(0.2);
    setup.particles = vec![grain(1, start + Vec3::new(0.0, 0.0, 0.01))];
    setup
}

/// Below arctan μ_r a ball rests on a finely triangulated slope as it does on the plane: over seams and corners, too.
#[test]
fn ball_rests_on_seams_as_on_the_plane() {
    for law in LAWS {
        for start in [Vec3::zeros(), Vec3::new(3e-4, 1e-4, 0.0)] {
            let rest = |floor: Wall| {
                let mut sim = Simulation::new(on_slope(law, 0.15f64.atan(), floor, start)).expect("sound");
                run_until(&mut sim, 0.3);
                let first = particles(&mut sim)[0].position;
                run_until(&mut sim, 0.4);
                (first, particles(&mut sim)[0].position)
            };
            let (flat, meshed) = (rest(plane(Vec3::z())), rest(sheet(8, 0.001, |_, _| 0.0)));
            let creep = (meshed.1 - meshed.0).norm();
            assert!(creep < 1e-9, "{law:?}: creeps {creep:e} m, on the plane {:e}", (flat.1 - flat.0).norm());
            assert!((meshed.1 - flat.1).norm() < 1e-9, "{law:?}: rests at {}, not {}", meshed.1, flat.1);
        }
    }
}

/// A ball rolls and slides over hundreds of seams as it does over the plane.
#[test]
fn ball_rolls_over_seams_as_over_the_plane() {
    for law in LAWS {
        let end = |floor: Wall| {
            let mut setup = on_slope(law, 0.0, floor, Vec3::zeros());
            setup.contacts.iter_mut().for_each(|c| c.remove("rolling_resistance"));
            setup.ledger = true;
            setup.particles[0].velocity = Vec3::new(0.3, 0.07, 0.0);
            let mut sim = Simulation::new(setup).expect("sound");
            run_until(&mut sim, 0.2);
            let e = sim.energy().expect("sound");
            (particles(&mut sim)[0], e.translation + e.rotation, e.sliding)
        };
        let (flat, meshed) = (end(plane(Vec3::z())), end(sheet(100, 0.002, |_, _| 0.0)));
        assert!(
            (meshed.0.position - flat.0.position).norm() < 1e-9,
            "{law:?}: {} {}",
            meshed.0.position,
            flat.0.position
        );
        assert!((meshed.1 / flat.1 - 1.0).abs() < 1e-9, "{law:?}: {} J instead of {}", meshed.1, flat.1);
        assert!((meshed.2 / flat.2 - 1.0).abs() < 1e-6, "{law:?}: {} J instead of {}", meshed.2, flat.2);
    }
}

/// Force of walls on a grain at rest there.
fn push(walls: Vec<Wall>, place: Vec3) -> Vec3 {
    let mut setup = empty(HOOKE, 0.5);
    setup.walls = walls;
    setup.particles = vec![grain(1, place)];
    let mut sim = Simulation::new(setup).expect("sound");
    -sim.wall_forces().expect("sound").iter().map(|w| w.force).sum::<Vec3>()
}

fn mesh(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Wall {
    let vertices = vertices.iter().map(|v| Vec3::from(*v)).collect();
    let mesh = TriMesh::new(vertices, faces.to_vec()).expect("sound");
    Wall { shape: WallShape::Mesh(mesh), ..plane(Vec3::z()) }
}

/// An edge or a corner between any number of faces pushes once; a corner between floor and wall twice.
#[test]
fn edges_and_corners_push_once() {
    // A pyramid of four faces, its tip at the origin.
    let s = 0.1;
    let pyramid = mesh(
        &[[0.0, 0.0, 0.0], [s, 0.0, -s], [0.0, s, -s], [-s, 0.0, -s], [0.0, -s, -s]],
        &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]],
    );
    let k = 1e4;
    let tip = push(vec![pyramid.clone()], Vec3::new(0.0, 0.0, 0.0099));
    assert!((tip - Vec3::new(0.0, 0.0, k * 1e-4)).norm() < 1e-9, "{tip}");
    let edge =
        push(vec![pyramid], Vec3::new(0.05, 0.0, -0.05) + Vec3::new(1.0, 0.0, 1.0).normalize() * 0.0099);
    assert!((edge.norm() / (k * 1e-4) - 1.0).abs() < 1e-9, "{edge}");
    // Floor and wall, each of two triangles.
    let corner = mesh(
        &[[0.0, -s, 0.0], [s, -s, 0.0], [s, s, 0.0], [0.0, s, 0.0], [0.0, -s, s], [0.0, s, s]],
        &[[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4]],
    );
    let both = push(vec![corner], Vec3::new(0.0099, 0.0, 0.0099));
    assert!((both - Vec3::new(k * 1e-4, 0.0, k * 1e-4)).norm() < 1e-9, "{both}");
}

/// Faces that lie on each other, or nearly in one plane, push like one.
#[test]
fn coplanar_faces_never_push_twice() {
    let s = 0.1;
    let square = [[-s, -s, 0.0], [s, -s, 0.0], [s, s, 0.0], [-s, s, 0.0]];
    let twice = mesh(&square, &[[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3], [0, 1, 2]]);
    for place in [Vec3::new(0.01, 0.03, 0.0099), Vec3::new(0.0, 0.0, 0.0099), Vec3::new(-0.02, -0.02, 0.0099)]
    {
        let force = push(vec![twice.clone()], place);
        assert!((force - Vec3::new(0.0, 0.0, 1.0)).norm() < 1e-9, "{place}: {force}");
    }
    // A bowl of 10 m: the force on a grain in it changes by less than a percent from place to place.
    let bowl = sheet(40, 0.003, |x, y| (x * x + y * y) / 20.0);
    for k in 0..40 {
        let x = 0.0007 * f64::from(k) - 0.014;
        let depth = |z: f64| push(vec![bowl.clone()], Vec3::new(x, 0.3 * x, z));
        let force = depth(0.0099 + 1.09 * x * x / 20.0);
        assert!((force.norm() - 1.0).abs() < 0.02, "{x}: {force:?}");
    }
}

/// 100 000 triangles, listed in milliseconds for each thousand grains, as brute force finds them.
#[test]
fn many_triangles_are_found_quickly() {
    let floor = sheet(224, 0.002, |_, _| 0.0);
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    setup.gravity.z = -9.81;
    setup.particles = (0..400u32)
        .map(|k| {
            grain(k, Vec3::new(0.021 * f64::from(k % 20) - 0.2, 0.021 * f64::from(k / 20) - 0.2, 0.0099))
        })
        .collect();
    setup.walls = vec![floor];
    let mut sim = Simulation::new(setup).expect("sound");
    let start = std::time::Instant::now();
    (0..2).for_each(|_| sim.step().expect("within the guards"));
    let took = start.elapsed().as_secs_f64();
    let (force, listed) = (sim.wall_forces().expect("sound")[0], sim.listed_contacts());
    assert!(force.contacts == 400, "{force:?}");
    println!("{took} s for a listing and two steps, {} contacts listed", listed);
    assert!(took < 2.0, "{took} s");
}

/// A setup in a box of 0.2 m along x, periodic, and the same moved by `shift`, wrapped.
fn across(wall: Wall, x: f64) -> Vec<Vec3> {
    let mut setup = with_friction(empty(Law::Hertz, 0.5), 0.5);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.1));
    setup.gravity = Vec3::new(1.0, 0.3, -9.81);
    setup.periodic = [Some((0.0, 0.2)), Some((0.0, 0.2)), None];
    setup.step = Step::Fixed(4e-5);
    let mut wall = wall;
    let moved = |p: &Vec3| *p + Vec3::new(x, 0.0, 0.0);
    match &mut wall.shape {
        WallShape::Spheres(s) => s.iter_mut().for_each(|s| s.0 = moved(&s.0)),
        WallShape::Mesh(m) => m.vertices.iter_mut().for_each(|v| *v = moved(v)),
        WallShape::Plane(p) => p.point = moved(&p.point),
    }
    setup.walls = vec![wall];
    setup.particles = (0..6)
        .map(|k| {
            let mut p = grain(k, Vec3::new(0.02 + 0.03 * f64::from(k), 0.03 * f64::from(k), 0.012));
            p.position.x = (p.position.x + x).rem_euclid(0.2);
            p.velocity = Vec3::new(0.4, 0.1, 0.0);
            p
        })
        .collect();
    let mut sim = Simulation::new(setup).expect("sound");
    let mut seen: Vec<Vec3> = Vec::new();
    for _ in 0..30 {
        let next = sim.time() + 0.02;
        run_until(&mut sim, next);
        seen.extend(
            particles(&mut sim)
                .iter()
                .map(|p| Vec3::new((p.position.x - x).rem_euclid(0.2), p.position.y, p.position.z)),
        );
    }
    seen
}

/// Walls act through periodic faces: a scene shifted by half a box behaves like itself, where the wall ends at the faces of one
/// and goes through the face of the other.
#[test]
fn walls_act_across_periodic_faces() {
    let spheres = |moves: bool| {
        let at =
            |k: u32| Vec3::new(0.005 + 0.01 * f64::from(k % 20), 0.005 + 0.01 * f64::from(k / 20), -0.006);
        let mut wall = plane(Vec3::z());
        wall.shape = WallShape::Spheres((0..400).map(|k| (at(k), 0.008)).collect());
        if moves {
            // A conveyor: more than one period within the run.
            wall.motion.velocity.x = 0.9;
        }
        wall
    };
    let s = 0.2;
    let floor = mesh(&[[0.0, 0.0, 0.0], [s, 0.0, 0.0], [s, s, 0.0], [0.0, s, 0.0]], &[[0, 1, 2], [0, 2, 3]]);
    let fence = mesh(
        &[[0.19, -0.1, -0.1], [0.19, 0.3, -0.1], [0.21, 0.3, 0.1], [0.21, -0.1, 0.1]],
        &[[0, 1, 2], [0, 2, 3]],
    );
    let both = {
        let (WallShape::Mesh(a), WallShape::Mesh(b)) = (&floor.shape, &fence.shape) else { unreachable!() };
        let vertices: Vec<Vec3> = a.vertices.iter().chain(&b.vertices).copied().collect();
        let faces = a.faces.iter().copied().chain(b.faces.iter().map(|f| f.map(|v| v + 4))).collect();
        Wall { shape: WallShape::Mesh(TriMesh::new(vertices, faces).expect("sound")), ..plane(Vec3::z()) }
    };
    for (name, wall) in
        [("spheres", spheres(false)), ("conveyor", spheres(true)), ("floor", floor), ("fence", both)]
    {
        let (here, there) = (across(wall.clone(), 0.0), across(wall, 0.113));
        for (n, (a, b)) in here.iter().zip(&there).enumerate() {
            let mut away = a - b;
            (0..2).for_each(|k| away[k] -= 0.2 * (away[k] / 0.2).round());
            assert!(away.norm() < 1e-7, "{name}: {n}: {a:?} and {b:?}");
        }
        assert!(here.iter().all(|p| p.z > 0.0), "{name}: nothing falls through");
    }
}

/// A grain in the corner of a periodic box presses on the image of a plane that crosses it.
#[test]
fn planes_have_images_where_they_cross_the_box() {
    let mut setup = empty(HOOKE, 0.5);
    setup.periodic = [Some((0.0, 0.2)), None, None];
    setup.walls = vec![Wall {
        shape: WallShape::Plane(Plane { point: Vec3::zeros(), normal: Vec3::x() }),
        ..plane(Vec3::z())
    }];
    setup.particles = vec![grain(1, Vec3::new(0.2 - 0.0099, 0.0, 0.0))];
    let mut sim = Simulation::new(setup).expect("sound");
    let force = sim.wall_forces().expect("sound")[0].force;
    assert!((force.x - 1.0).abs() < 1e-9, "{force}");
}

/// A soft grain that adheres is pulled off a mesh where it is pulled off the plane: its contact lasts beyond a tenth of its radius.
#[test]
fn what_adheres_holds_on_a_mesh_as_on_the_plane() {
    let path = |floor: Wall| {
        let mut setup = empty(Law::Jkr { work_of_adhesion: 1.0 }, 0.9);
        setup.materials.iter_mut().for_each(|m| m.young = 1e4);
        setup.guards.overlap = 0.9;
        setup.walls = vec![floor];
        setup.particles = vec![grain(1, Vec3::new(0.0003, 0.0001, 0.0099))];
        setup.particles[0].velocity.z = 0.3;
        let mut sim = Simulation::new(setup).expect("sound");
        let mut heights = Vec::new();
        for k in 1..40 {
            run_until(&mut sim, 1e-3 * f64::from(k));
            heights.push(particles(&mut sim)[0].position.z);
        }
        heights
    };
    let (flat, meshed) = (path(plane(Vec3::z())), path(sheet(8, 0.05, |_, _| 0.0)));
    let highest = flat.iter().fold(0.0f64, |a, b| a.max(*b));
    assert!(highest > 0.0105, "the contact reaches over a gap: {highest} m");
    for (a, b) in flat.iter().zip(&meshed) {
        assert!((a - b).abs() < 1e-9, "{a} m on the plane, {b} m on the mesh");
    }
}
