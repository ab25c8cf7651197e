//! Bonds as beams: a bar, a cantilever and a crank of bonded spheres in a steady wind, whose drag on each sphere is known, held by a sphere
//! so heavy that it stays; where they break; and that no order of particles matters.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, beam, contact, empty, grain, particles, run_until};
use std::f64::consts::PI;

const BAR: Case = case("Bonds", "bar of n spheres, force F on each: its end moves by Σ F x/E A");
const BENDS: Case =
    case("Bonds", "cantilever of n spheres: its end moves by Σ F x² (3 L − x)/6 E I (one: F L³/3 E I)");
const ROOT: Case = case("Bonds", "cantilever of n spheres: tension at the rim of the fixed end, Σ F x r/I");
const CRANK: Case = case("Bonds", "crank of bonded spheres: bending of both arms and torsion F b² a/G J");
const BREAKS: Case = case(
    "Bonds",
    "a bond breaks at σ = F_n/A + |M| r/I or τ = |F_t|/A + |M_t| r/J, 1 % on each side: wrong results of two",
);
const ORDER: Case = case("Bonds", "particles listed in another order: numbers that differ");
const NAMES: Case = case("Bonds", "particles with other ids: difference of positions, over the deflection");

const E: f64 = 1e7;
const G: f64 = 4e6;
/// Between centres: a tenth of a radius is left open, so that nothing touches.
const PITCH: f64 = 0.021;
const R: f64 = 0.01;
const AREA: f64 = PI * R * R;
const INERTIA: f64 = 0.25 * PI * R * R * R * R;

/// Spheres at these places of a lattice, the first one heavy, in a wind that pushes each with so much force [N]; its rate of drag [1/s].
fn held(places: &[[i32; 2]], force: Vec3, rate: f64) -> Setup {
    held_by(|between| Bond { damping: 0.5, ..beam(between, [E, G]) }, places, force, rate)
}

/// The same with these bonds.
pub fn held_by(made: impl Fn((u16, u16)) -> Bond, places: &[[i32; 2]], force: Vec3, rate: f64) -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    setup.contacts.push(contact((1, 1), HOOKE, 0.5));
    setup.materials[1].density = 1e20;
    let mass = dem::mass(R, setup.materials[0].density);
    let velocity = force / (rate * mass);
    let viscosity = rate * mass / (6.0 * PI * R);
    setup.drag = Some(Drag { law: DragLaw::Stokes, viscosity, density: 0.0, velocity, buoyancy: false });
    setup.bonds = vec![made((0, 0)), made((0, 1))];
    let at = |[x, y]: [i32; 2]| Vec3::new(f64::from(x), f64::from(y), 0.0) * PITCH;
    setup.particles = (0..).zip(places).map(|(id, &p)| grain(id, at(p))).collect();
    setup.particles[0].material = 1;
    if places.len() == 2 {
        setup.bonds.remove(0);
    }
    setup.step = Step::Auto(0.5);
    setup
}

pub fn row(n: usize) -> Vec<[i32; 2]> {
    (0..=n as i32).map(|x| [x, 0]).collect()
}

/// How far the last sphere has moved when all is at rest, looked at every so often [s].
pub fn deflection(setup: Setup, time: f64) -> (Vec3, Simulation) {
    let start = setup.particles[setup.particles.len() - 1].position;
    let mut sim = simulation(setup);
    for look in 1..100 {
        run_until(&mut sim, f64::from(look) * time);
        let all = particles(&mut sim);
        let moved = all[all.len() - 1].position - start;
        if all.iter().all(|p| p.velocity.norm() * time < 1e-7 * moved.norm()) {
            return (moved, sim);
        }
    }
    panic!("it does not come to rest");
}

const LENGTHS: [usize; 4] = [1, 2, 5, 10];

/// Rate of drag near twice the lowest frequency of n spheres [1/s].
pub fn rate(n: usize) -> f64 {
    let mass = dem::mass(R, 2500.0);
    2.0 * 3.52 * (E * INERTIA / (mass / PITCH)).sqrt() / (n as f64 * PITCH).powi(2)
}

#[test]
fn a_bar_of_bonded_spheres_yields_by_its_section() {
    for n in LENGTHS {
        let (moved, _) = deflection(held(&row(n), Vec3::x(), rate(n)), 20.0 / rate(n));
        let sum: f64 = (1..=n).map(|k| k as f64 * PITCH).sum();
        BAR.equals(&format!("n = {n}"), moved.x, "m", sum / (E * AREA), 1e-8);
    }
}

#[test]
fn a_cantilever_of_bonded_spheres_bends_as_a_beam() {
    for n in LENGTHS {
        // Small against the length: a beam is linear there.
        let force = 0.02 / (n as f64).powi(3);
        let length = n as f64 * PITCH;
        let (moved, mut sim) = deflection(held(&row(n), Vec3::y() * force, rate(n)), 20.0 / rate(n));
        let at = || (1..=n).map(|k| k as f64 * PITCH);
        let expected: f64 = at().map(|x| force * x * x * (3.0 * length - x) / (6.0 * E * INERTIA)).sum();
        BENDS.equals(&format!("n = {n}"), moved.y, "m", expected, 1e-6);
        let moment: f64 = at().map(|x| force * x).sum();
        let root = sim.bonds().expect("no guard trips")[0];
        ROOT.equals(&format!("n = {n}"), root.stress[0], "Pa", moment * R / INERTIA, 1e-5);
    }
}

#[test]
fn a_crank_of_bonded_spheres_bends_and_twists() {
    for n in [1, 3] {
        let mut places = row(n);
        places.extend((1..=n as i32).map(|y| [n as i32, y]));
        let force = 0.05 / (n as f64).powi(3);
        let (moved, _) = deflection(held(&places, Vec3::z() * force, 0.5 * rate(n)), 40.0 / rate(n));
        let a = n as f64 * PITCH;
        let at = || (1..=n).map(|k| k as f64 * PITCH);
        let bent = |x: f64| x * x * (3.0 * a - x) / (6.0 * E * INERTIA);
        // On the first arm; on the second, which also pulls at the first and turns it.
        let first: f64 = at().map(bent).sum();
        let second: f64 = at().map(|y| bent(y) + bent(a) + y * a * a / (G * 2.0 * INERTIA)).sum();
        CRANK.equals(&format!("n = {n} and {n}"), moved.z, "m", force * (first + second), 1e-6);
    }
}

/// Whether any of its bonds has broken after a while.
fn breaks(places: &[[i32; 2]], force: Vec3, strength: [f64; 2]) -> bool {
    // So slow that nothing swings.
    let mut setup = held(places, force, 4e3);
    for bond in &mut setup.bonds {
        bond.strength = BondStrength::of(strength[0], strength[1]);
        bond.damping = 1.0;
    }
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.1);
    sim.bond_count()[1] > 0
}

#[test]
fn bonds_break_at_their_strength() {
    let (one, crank): (&[[i32; 2]], &[[i32; 2]]) = (&[[0, 0], [1, 0]], &[[0, 0], [1, 0], [1, 1]]);
    let f = 1e-2;
    let polar = 2.0 * INERTIA;
    let tension = [
        ("pulled", Vec3::x(), f / AREA),
        ("bent", Vec3::z(), f * PITCH * R / INERTIA),
        ("pulled and bent", Vec3::new(1.0, 1.0, 0.0), f / AREA + f * PITCH * R / INERTIA),
        ("pressed and bent", Vec3::new(-1.0, 1.0, 0.0), -f / AREA + f * PITCH * R / INERTIA),
    ];
    let shear = [
        ("sheared", one, Vec3::y(), f / AREA),
        ("sheared and twisted", crank, Vec3::z(), 2.0 * f / AREA + f * PITCH * R / polar),
    ];
    let all = tension.map(|(name, way, most)| (name, one, way, most, 0));
    let all = all.into_iter().chain(shear.map(|(name, places, way, most)| (name, places, way, most, 1)));
    for (name, places, way, most, which) in all {
        let strength = |share: f64| {
            let mut s = [f64::INFINITY; 2];
            s[which] = share * most;
            s
        };
        let wrong = u8::from(!breaks(places, way * f, strength(0.99)))
            + u8::from(breaks(places, way * f, strength(1.01)));
        BREAKS.within(name, wrong.into(), "wrong", 0.0);
    }
}

#[test]
fn the_order_of_particles_changes_nothing() {
    let mut places = row(3);
    places.extend([[3, 1], [3, 2], [2, 2]]);
    let setup = held(&places, Vec3::new(1e-3, 2e-3, 3e-3), 30.0);
    let places = |setup: Setup| {
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.05);
        particles(&mut sim)
    };
    let (first, mut other) = (places(setup.clone()), setup.clone());
    other.particles.reverse();
    let differ = first.iter().zip(&places(other)).filter(|(a, b)| a != b).count();
    ORDER.within("seven in a hook, backwards", differ as f64, "particles", 0.0);
    let mut named = setup.clone();
    let last = named.particles.len() as u32 - 1;
    named.particles.iter_mut().for_each(|p| p.id = last - p.id);
    let there = places(named);
    let moved = (first[last as usize].position - setup.particles[last as usize].position).norm();
    let off = first.iter().zip(there.iter().rev()).map(|(a, b)| (a.position - b.position).norm());
    NAMES.within("seven in a hook, numbered backwards", off.fold(0.0, f64::max) / moved, "–", 1e-9);
}
