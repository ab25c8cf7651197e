//! A heap of 500 grains poured onto a plate, from Rust: `cargo run --release -p grainpipe-dem --example heap`.

use dem::setup::{ContactLaw, Material, Particle, Wall, WallShape};
use dem::{Setup, Simulation};
use geom::{Plane, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stone = Material { name: "stone".into(), density: 2500.0, young: 1e7, poisson: 0.25 };
    let law = ContactLaw::new((0, 0), "hertz").with("restitution", 0.3).with("sliding_friction", 0.5);
    let shape = WallShape::Plane(Plane { point: Vec3::zeros(), normal: Vec3::z() });
    let grain = |id: u32| Particle {
        id,
        material: 0,
        radius: 0.005,
        position: Vec3::new(f64::from(id % 5), f64::from(id / 5 % 5), f64::from(id / 25)) * 0.0105
            + Vec3::new(0.0003 * f64::from(id % 7), 0.0, 0.006),
        velocity: Vec3::zeros(),
        spin: Vec3::zeros(),
    };
    let mut sim = Simulation::new(Setup {
        materials: vec![stone],
        contacts: vec![law.with("rolling_resistance", 0.1)],
        particles: (0..500).map(grain).collect(),
        walls: vec![Wall::new("plate", 0, shape)],
        ..Setup::default()
    })?;
    while sim.time() < 1.0 {
        sim.step()?;
    }
    let top = sim.particles()?.iter().map(|p| p.position.z + p.radius).fold(0.0, f64::max);
    println!("{} steps of {:.2e} s: the heap is {:.0} mm high", sim.steps(), sim.dt(), 1e3 * top);
    Ok(())
}
