//! Small setups for laws with closed answers.

use dem::setup::*;
use geom::{Moments, Plane, Vec3};

/// A normal law with its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Linear spring and dashpot: k_n [N/m], and k_t/k_n [–] where it is not Mindlin's.
    Hooke {
        /// k_n [N/m].
        stiffness: f64,
        /// k_t/k_n [–].
        tangential_ratio: Option<f64>,
    },
    /// Elastic spheres.
    Hertz,
    /// Elastic spheres that adhere.
    Jkr {
        /// w [J/m²].
        work_of_adhesion: f64,
    },
}

/// A contact law between two materials.
pub fn contact(between: (u16, u16), law: Law, restitution: f64) -> ContactLaw {
    let of = |name| ContactLaw::new(between, name).with("restitution", restitution);
    match law {
        Law::Hooke { stiffness, tangential_ratio } => {
            let mut law = of("hooke").with("stiffness", stiffness);
            law.set("tangential_ratio", tangential_ratio);
            law
        }
        Law::Hertz => of("hertz"),
        Law::Jkr { work_of_adhesion } => of("jkr").with("work_of_adhesion", work_of_adhesion),
    }
}

/// Gives a law sliding friction that weakens: static, dynamic [–], speed [m/s].
pub fn weaken(law: &mut ContactLaw, [at_rest, dynamic, speed]: [f64; 3]) {
    law.remove("sliding_friction");
    law.set("sliding_friction.static", at_rest);
    law.set("sliding_friction.dynamic", dynamic);
    law.set("sliding_friction.speed", speed);
}

/// Gives a law cohesion [J/m³].
pub fn sticky(law: &mut ContactLaw, energy_density: f64) {
    law.choose("cohesion", "sjkr");
    law.set("cohesion_energy_density", energy_density);
}

/// Gives a law a model of rolling resistance.
pub fn rolling(law: &mut ContactLaw, resistance: f64, model: &'static str) {
    law.set("rolling_resistance", resistance);
    law.choose("rolling_model", model);
}

/// Materials 0 (grain) and 1 (wall) with one law for all pairs, no particle, no wall, no gravity.
pub fn empty(law: Law, restitution: f64) -> Setup {
    let material =
        |name: &str| Material { name: name.to_owned(), density: 2500.0, young: 1e7, poisson: 0.25 };
    Setup {
        gravity: Vec3::zeros(),
        materials: vec![material("grain"), material("wall")],
        contacts: vec![contact((0, 0), law, restitution), contact((0, 1), law, restitution)],
        step: Step::Auto(0.05),
        ..Setup::default()
    }
}

/// A linear law.
pub const HOOKE: Law = Law::Hooke { stiffness: 1e4, tangential_ratio: None };

/// Both normal laws.
pub const LAWS: [Law; 2] = [HOOKE, Law::Hertz];

/// Elastic bonds between two materials, up to a gap of 2 mm, that never break.
pub fn bond(between: (u16, u16)) -> Bond {
    beam(between, [1e7, 4e6])
}

/// The same of other moduli E and G [Pa].
pub fn beam(between: (u16, u16), [young, shear_modulus]: [f64; 2]) -> Bond {
    Bond::new(between, 0.002, BondKind::Beam { young, shear_modulus })
}

/// A lattice of so many grains of radius 10 mm along each axis, 1 mm open between them, around a place.
pub fn lattice([x, y, z]: [u32; 3], centre: Vec3) -> Vec<Particle> {
    let half = Vec3::new(f64::from(x - 1), f64::from(y - 1), f64::from(z - 1)) * 0.5;
    let at = |k: u32| Vec3::new(f64::from(k % x), f64::from(k / x % y), f64::from(k / x / y));
    (0..x * y * z).map(|k| grain(k, centre + (at(k) - half) * 0.021)).collect()
}

/// A clump whose mass and moments of inertia are the sums over its spheres: centre [m], radius [m].
pub fn clump(spheres: &[(Vec3, f64)]) -> ClumpShape {
    ClumpShape::new("clump", 0, spheres, &Moments::of_sum(spheres))
}

/// Two spheres of radius 10 mm, 12 mm apart, along x.
pub fn dumbbell() -> ClumpShape {
    let at = |x: f64| (Vec3::new(x, 0.0, 0.0), 0.01);
    clump(&[at(-0.006), at(0.006)])
}

/// A grain of radius 10 mm at rest.
pub fn grain(id: u32, position: Vec3) -> Particle {
    Particle { id, material: 0, radius: 0.01, position, velocity: Vec3::zeros(), spin: Vec3::zeros() }
}

/// A still plane through the origin.
pub fn plane(normal: Vec3) -> Wall {
    let plane = Plane { point: Vec3::zeros(), normal: normal.normalize() };
    Wall::new("plane", 1, WallShape::Plane(plane))
}

/// Gives every pair sliding friction μ.
pub fn with_friction(mut setup: Setup, friction: f64) -> Setup {
    setup.contacts.iter_mut().for_each(|c| c.set("sliding_friction", friction));
    setup
}

/// Steps until `time` [s] has passed.
///
/// # Panics
/// When a guard stops the run: no law here reaches one.
pub fn run_until(sim: &mut dem::Simulation, time: f64) {
    while sim.time() < time {
        sim.step().expect("no guard trips in a test of a law");
    }
}

/// The particles, by id.
///
/// # Panics
/// When a guard has tripped.
pub fn particles(sim: &mut dem::Simulation) -> Vec<Particle> {
    sim.particles().expect("no guard trips in a test of a law")
}
