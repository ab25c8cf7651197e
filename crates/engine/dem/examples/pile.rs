//! Time of the bench pile: `cargo run --release -p grainpipe-dem --example pile -- PILE.csv STEPS [THREADS [SKIN]]`.
//!
//! Spheres settled on a floor, periodic in x and y; Hooke, dashpot, sliding friction with memory; Δt = 10⁻⁵ s; one skin [m] for all, or
//! the engine's own choice.
//! Columns of the file: id, x, y, z, radius, vx, vy, vz, wx, wy, wz.

use dem::setup::*;
use dem::{Setup, Simulation};
use geom::{Plane, Vec3};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let steps: u64 = args[2].parse()?;
    if let Some(threads) = args.get(3) {
        rayon::ThreadPoolBuilder::new().num_threads(threads.parse()?).use_current_thread().build_global()?;
    }
    let mut particles = Vec::new();
    for line in std::fs::read_to_string(&args[1])?.lines().skip(1) {
        let c: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let v = |at: usize| Vec3::new(c[at], c[at + 1], c[at + 2]);
        let (position, velocity, spin) = (v(1), v(5), v(8));
        particles.push(Particle { id: c[0] as u32, material: 0, radius: c[4], position, velocity, spin });
    }
    let material = |name: &str| Material { name: name.to_owned(), density: 3300.0, young: 5e6, poisson: 0.3 };
    let contact = |between| {
        let law = ContactLaw::new(between, "hooke").with("restitution", 0.9977).with("sliding_friction", 0.5);
        law.with("stiffness", 1e4).with("tangential_ratio", 2.0 / 7.0)
    };
    let floor = Wall::new("floor", 1, WallShape::Plane(Plane { point: Vec3::zeros(), normal: Vec3::z() }));
    let count = particles.len();
    let setup = Setup {
        materials: vec![material("grain"), material("floor")],
        contacts: vec![contact((0, 0)), contact((0, 1))],
        particles,
        walls: vec![floor],
        step: Step::Fixed(1e-5),
        periodic: [Some((0.0, 0.1196)), Some((0.0, 0.1196)), None],
        skin: args.get(4).map(|s| s.parse()).transpose()?,
        ..Setup::default()
    };
    let mut sim = Simulation::new(setup)?;
    for _ in 0..50 {
        sim.step()?;
    }
    let start = Instant::now();
    for _ in 0..steps {
        sim.step()?;
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{count} particles, {steps} steps, {} listed contacts, {} listings: {:.2} M particle-steps/s",
        sim.listed_contacts(),
        sim.rebuilds(),
        count as f64 * steps as f64 / seconds / 1e6
    );
    let e = sim.energy()?;
    println!("kinetic energy {:.6e} J", e.translation + e.rotation);
    Ok(())
}
