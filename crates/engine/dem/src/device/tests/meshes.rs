//! Walls of triangles on a device: seams, several walls that are one surface, motions, belts, periodic images.

use super::*;
use geom::mesh::TriMesh;

/// Numbers between 0 and 1.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize % n
    }
}

/// A rough floor under the trough, of triangles about as wide as the grains or much smaller, torn into so many walls at random; some are there twice.
fn rough_floor(random: &mut Random, walls: usize) -> Vec<TriMesh> {
    let cells = [6, 14, 30][random.below(3)];
    let depth = [0.0, 0.004, 0.015][random.below(3)];
    let side = |k: usize| -0.01 + 0.22 * k as f64 / cells as f64;
    let mut heights = Vec::new();
    (0..(cells + 1) * (cells + 1)).for_each(|_| heights.push(depth * (random.next() - 0.7)));
    let point = |i: usize, j: usize| Vec3::new(side(i), side(j), heights[i * (cells + 1) + j]);
    let mut triangles = vec![Vec::new(); walls];
    for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
        let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
        for triangle in [[a, b, c], [a, c, d]] {
            let [p, q, r] = triangle;
            let own = &mut triangles[random.below(walls)];
            own.push(triangle);
            if random.below(10) == 0 {
                own.push([r, q, p]);
            }
        }
    }
    let mesh = |all: Vec<[Vec3; 3]>| {
        let faces = (0..all.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        TriMesh::new(all.concat(), faces).expect("sound")
    };
    triangles.into_iter().filter(|all| !all.is_empty()).map(mesh).collect()
}

/// A trough whose floor is of triangles; everything else is drawn.
pub fn drawn(seed: u64) -> Setup {
    let mut random = Random(seed.wrapping_mul(977).wrapping_add(5));
    let effects = every_composition()[random.below(6)];
    let mut setup = trough(effects);
    setup.particles.truncate(160);
    if random.below(3) == 0 {
        for law in &mut setup.contacts {
            *law = ContactLaw::new(law.between, "jkr")
                .with("restitution", 0.4)
                .with("work_of_adhesion", 0.5)
                .with("sliding_friction", 0.3);
        }
    }
    let walls = 1 + random.below(3);
    let meshes = rough_floor(&mut random, walls);
    let planes = setup.walls.split_off(1);
    setup.walls = (0..).zip(meshes).map(|(k, m)| Wall::new(format!("m{k}"), 0, WallShape::Mesh(m))).collect();
    let (moves, each) = (random.below(4), random.below(2) == 0);
    for (k, wall) in setup.walls.iter_mut().enumerate() {
        // All in one motion, or each in its own.
        let share = if each { k as f64 } else { 1.0 };
        match moves {
            1 => {
                wall.motion.amplitude = Vec3::new(0.0, 0.001, 0.001) * share;
                wall.motion.frequency = 40.0;
            }
            2 => {
                wall.motion.turn = Vec3::new(0.3, 0.0, 0.5) * share;
                wall.motion.through = Vec3::new(0.1, 0.1, 0.0);
            }
            3 => wall.surface.velocity = Vec3::new(0.3, 0.1, 0.0) * share,
            _ => {}
        }
    }
    setup.walls.extend(planes);
    if random.below(2) == 0 {
        setup.periodic = [None; 3];
    }
    if random.below(2) == 0 {
        setup.sampling = Sampling::Sampled;
    }
    setup
}

#[test]
fn the_same_bits_on_triangles_of_any_kind() {
    let (mut met, mut surfaces, mut handed) = (0, 0, 0);
    for seed in 0..40 {
        let mut device = there(drawn(seed), Local::default());
        let mut host = Simulation::new(drawn(seed)).expect("sound");
        for last in [400, 1200] {
            advance(&mut device, last).expect("within the guards");
            while host.steps() < last {
                host.step().expect("within the guards");
            }
            let forces = host.wall_forces().expect("recorded");
            let meshes = host.model.walls.iter().zip(&forces).filter(|(w, _)| w.triangles().is_some());
            met += meshes.filter(|(_, f)| f.force.norm() > 0.0).count();
            assert!(bits(&mut device) == bits(&mut host), "drawing {seed}, step {last}");
            let [a, b] = [&device, &host].map(|sim| &sim.state.contacts.history);
            assert!(a[..] == b[..], "drawing {seed}, step {last}: histories");
            handed += b.iter().filter(|x| **x != 0.0).count();
        }
        surfaces += host
            .model
            .walls
            .iter()
            .filter(|w| w.triangles().is_some_and(|_| !w.surface_of(0).is_empty()))
            .count();
        assert!(device.rebuilds() == host.rebuilds() && host.rebuilds() > 1, "{}", host.rebuilds());
    }
    assert!(met > 60 && surfaces > 10 && handed > 500, "{met} {surfaces} {handed}");
}
