//! Parallel and contact bonds: chains of spheres in a steady wind, whose drag on each is known, against the springs of their sections one after the other;
//! buckling, swinging, and where they break.

use crate::bonds::{deflection, held_by, rate, row};
use crate::simulation;
use dem::Setup;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, beam, empty, grain, particles, run_until};
use nalgebra::{Matrix2, SymmetricEigen};
use std::f64::consts::PI;

const BAR: Case = case("Bonds", "bar of n parallel bonds: its end moves by Σ N/k_n A");
const BENDS: Case = case(
    "Bonds",
    "cantilever of n parallel bonds: its end moves by Σ V/k_s A + M x/k_n I, M at the sections",
);
const TWISTS: Case =
    case("Bonds", "crank of parallel bonds: bending, shear and twist M_t/k_s J of both arms");
const GLUE: Case =
    case("Bonds", "grain between two contact bonds: it moves by F/2 k_n along them, F/2 k_s across");
const UNEQUAL: Case = case(
    "Bonds",
    "parallel bond between unequal spheres: V/k_s A + V l²/k_n I, l from where the surfaces meet",
);
const BUCKLES: Case =
    case("Bonds", "column of one bond buckles at its load, 1 % on each side: wrong results of two");
const SWINGS: Case =
    case("Bonds", "first bending of one bond: phase after three periods, by its 2 × 2 stiffness");
const BREAKS: Case = case(
    "Bonds",
    "a parallel or contact bond breaks at its strength, 1 % on each side: wrong results of two",
);
const TORN: Case = case("Bonds", "energy of a crack: ½ F²/k_n of the force that breaks it");

const R: f64 = 0.01;
const PITCH: f64 = 0.021;
const AREA: f64 = PI * R * R;
const INERTIA: f64 = 0.25 * PI * R * R * R * R;
/// Springs per area [Pa/m].
const NORMAL: f64 = 5e8;
const SHEAR: f64 = 2e8;

fn parallel() -> BondKind {
    BondKind::Parallel { springs: BondSprings::Given([NORMAL, SHEAR]), moments: 1.0 }
}

/// Bonds of a kind from the grains to the heavy one as well, with dashpots.
fn made(kind: BondKind) -> impl Fn((u16, u16)) -> Bond {
    move |between| Bond { damping: 0.5, ..Bond::new(between, 0.002, kind) }
}

#[test]
fn a_bar_of_parallel_bonds_yields_by_their_springs() {
    for n in [1, 2, 5, 10] {
        let setup = held_by(made(parallel()), &row(n), Vec3::x(), rate(n));
        let (moved, _) = deflection(setup, 20.0 / rate(n));
        let sum: f64 = (1..=n).map(|k| k as f64).sum();
        BAR.equals(&format!("n = {n}"), moved.x, "m", sum / (NORMAL * AREA), 1e-8);
    }
}

/// How far the end of a row of n spheres moves under a unit force on each, across; the sections are half-way.
fn across(n: usize) -> f64 {
    let one = |bond: usize| {
        let section = (bond as f64 - 0.5) * PITCH;
        let beyond = || (bond..=n).map(|k| k as f64 * PITCH);
        let moment: f64 = beyond().map(|x| x - section).sum();
        (n + 1 - bond) as f64 / (SHEAR * AREA) + moment * (n as f64 * PITCH - section) / (NORMAL * INERTIA)
    };
    (1..=n).map(one).sum()
}

#[test]
fn a_cantilever_of_parallel_bonds_bends_by_their_springs() {
    for n in [1, 2, 5, 10] {
        let force = 0.02 / (n as f64).powi(3);
        let setup = held_by(made(parallel()), &row(n), Vec3::y() * force, rate(n));
        let (moved, mut sim) = deflection(setup, 20.0 / rate(n));
        BENDS.equals(&format!("n = {n}"), moved.y, "m", force * across(n), 1e-6);
        let moment: f64 = (1..=n).map(|k| (k as f64 - 0.5) * PITCH * force).sum();
        let root = sim.bonds().expect("no guard trips")[0];
        BENDS.equals(
            &format!("n = {n}, tension at the root"),
            root.stress[0],
            "Pa",
            moment * R / INERTIA,
            1e-5,
        );
    }
}

#[test]
fn a_crank_of_parallel_bonds_twists() {
    let mut places = row(2);
    places.extend([[2, 1], [2, 2]]);
    let force = 5e-3;
    let setup = held_by(made(parallel()), &places, Vec3::z() * force, 0.5 * rate(2));
    let (moved, _) = deflection(setup, 40.0 / rate(2));
    // Each bond by its place and direction; forces on the spheres beyond it.
    let at = |p: &[i32; 2]| Vec3::new(f64::from(p[0]), f64::from(p[1]), 0.0) * PITCH;
    let end = at(&places[4]);
    let one = |k: usize| {
        let (from, to) = (at(&places[k - 1]), at(&places[k]));
        let (n, section) = ((to - from) / PITCH, (from + to) * 0.5);
        let moment: Vec3 = places[k..].iter().map(|p| (at(p) - section).cross(&Vec3::z())).sum();
        let (twist, bent) = (moment.dot(&n), moment - n * moment.dot(&n));
        let turn = bent / (NORMAL * INERTIA) + n * (twist / (SHEAR * 2.0 * INERTIA));
        (places.len() - k) as f64 / (SHEAR * AREA) + turn.cross(&(end - section)).z
    };
    let expected: f64 = (1..places.len()).map(one).sum();
    TWISTS.equals("two arms of two", moved.z, "m", force * expected, 1e-6);
}

/// A grain between two heavy ones, glued to both.
fn between(force: Vec3) -> Setup {
    let glue = BondKind::Contact(BondSprings::Given([3e4, 1e4]));
    let mut setup = held_by(made(glue), &[[0, 0], [1, 0]], force, 200.0);
    setup.particles.push(Particle { material: 1, ..grain(2, Vec3::x() * 2.0 * PITCH) });
    setup
}

#[test]
fn glue_has_its_two_stiffnesses() {
    for (name, way, stiffness) in [("along", Vec3::x(), 3e4), ("across", Vec3::y(), 1e4)] {
        let mut sim = simulation(between(way * 1e-2));
        run_until(&mut sim, 0.3);
        let moved = (particles(&mut sim)[1].position - Vec3::x() * PITCH).dot(&way);
        GLUE.equals(name, moved, "m", 1e-2 / (2.0 * stiffness), 1e-6);
    }
}

#[test]
fn the_section_is_where_the_surfaces_meet() {
    let (small, force) = (0.004, 4e-3);
    let mut setup = held_by(made(parallel()), &[[0, 0], [1, 0]], Vec3::y() * force, 50.0);
    // The force of the wind is that on a sphere of radius R.
    setup.particles[1].radius = small;
    setup.particles[1].position.x = 0.0142;
    let (moved, _) = deflection(setup, 0.4);
    let force = force * small / R;
    let arm = 0.0142 * small / (R + small);
    let (area, inertia) = (PI * small.powi(2), 0.25 * PI * small.powi(4));
    let expected = force * (1.0 / (SHEAR * area) + arm * arm / (NORMAL * inertia));
    UNEQUAL.equals("radii 10 and 4 mm", moved.y, "m", expected, 1e-6);
}

/// P_i, P_j and Q of one bond (docs/theory/time-step.md), and its normal stiffness.
fn tilt(kind: BondKind, ratio: f64) -> ([f64; 3], f64) {
    let (area, inertia) = (AREA * ratio * ratio, INERTIA * ratio.powi(4));
    match kind {
        BondKind::Beam { young, .. } => {
            let k = young * inertia / PITCH;
            ([4.0 * k, 4.0 * k, 2.0 * k], young * area / PITCH)
        }
        _ => {
            let (bend, slide) = (NORMAL * inertia, 0.25 * SHEAR * area * PITCH * PITCH);
            ([bend + slide, bend + slide, slide - bend], NORMAL * area)
        }
    }
}

/// Bonds so thin that a column of one is hardly shorter when it buckles.
const THIN: f64 = 0.1;

fn thin(kind: BondKind) -> impl Fn((u16, u16)) -> Bond {
    move |between| Bond { radius_ratio: THIN, damping: 1.0, ..Bond::new(between, 0.002, kind) }
}

fn kinds() -> [(&'static str, BondKind); 2] {
    [("beam", beam((0, 0), [1e7, 4e6]).kind), ("parallel", parallel())]
}

#[test]
fn a_column_buckles_at_its_load() {
    for (name, kind) in kinds() {
        let ([p, _, q], along) = tilt(kind, THIN);
        // Of a given lean the free end turns until it bears no moment: U = ½ k ψ², and the load gives ½ P l ψ² at the length l = L − P/k_n.
        let k = p - q * q / p;
        let load = {
            let mut load = k / PITCH;
            (0..50).for_each(|_| load = k / (PITCH - load / along));
            load
        };
        let leans = |share: f64| {
            let rate = 30.0;
            let mut setup = held_by(thin(kind), &row(1), -Vec3::x() * (share * load), rate);
            setup.particles[1].velocity.y = 1e-5;
            let mut sim = simulation(setup);
            run_until(&mut sim, 40.0);
            particles(&mut sim)[1].position.y.abs()
        };
        // The wind stops it after 1e-5/30 m.
        let wrong = u8::from(leans(0.99) > 1e-7) + u8::from(leans(1.01) < 1e-6);
        BUCKLES.within(name, wrong.into(), "wrong", 0.0);
    }
}

#[test]
fn one_bond_swings_with_its_frequency() {
    for (name, kind) in kinds() {
        let ([p_i, p_j, q], _) = tilt(kind, 1.0);
        let (mass, mut setup) = (dem::mass(R, 2500.0), held_by(made(kind), &row(1), Vec3::zeros(), 1.0));
        setup.drag = None;
        setup.bonds.iter_mut().for_each(|bond| bond.damping = 0.0);
        let turns = 0.4 * mass * R * R;
        // In ψ = y/L and θ, by roots of the masses.
        let (a, b) = ((mass * PITCH * PITCH).sqrt(), turns.sqrt());
        let stiffness = Matrix2::new(
            (p_i + p_j + 2.0 * q) / (a * a),
            -(p_j + q) / (a * b),
            -(p_j + q) / (a * b),
            p_j / (b * b),
        );
        let modes = SymmetricEigen::new(stiffness);
        let first = modes.eigenvalues.imin();
        let (omega, mode) = (modes.eigenvalues[first].sqrt(), modes.eigenvectors.column(first).into_owned());
        let (lean, turn) = (mode[0] / a, mode[1] / b);
        let speed = 1e-5 * omega / lean.abs();
        setup.particles[1].velocity.y = speed * lean * PITCH;
        setup.particles[1].spin.z = speed * turn;
        let time = 3.125 * 2.0 * PI / omega;
        let errors = [0.4, 0.2, 0.1].map(|safety| {
            setup.step = Step::Auto(safety);
            let mut sim = simulation(setup.clone());
            // Whole steps: the phase of the time that was reached.
            run_until(&mut sim, time);
            let y = particles(&mut sim)[1].position.y;
            let expected = speed * lean * PITCH / omega * (omega * sim.time()).sin();
            (sim.dt(), ((y - expected) / (speed * lean * PITCH / omega)).abs())
        });
        SWINGS.order(name, &errors, 2.0, 0.2);
    }
}

/// Whether a bond of a kind breaks under a force on one sphere.
fn breaks(kind: BondKind, force: Vec3, strength: BondStrength) -> bool {
    let law = |between| Bond { strength, damping: 1.0, ..Bond::new(between, 0.002, kind) };
    let mut setup = held_by(law, &row(1), force, 4e3);
    // A grain on the other side keeps glue from turning.
    setup.particles.push(Particle { material: 1, ..grain(2, Vec3::x() * 2.0 * PITCH) });
    if !matches!(kind, BondKind::Contact(_)) {
        setup.particles.pop();
    }
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.1);
    sim.bond_count()[1] > 0
}

#[test]
fn bonds_of_each_kind_break_at_their_strength() {
    let f = 1e-2;
    let bent = f * 0.5 * PITCH * R / INERTIA;
    let unbent = BondKind::Parallel { springs: BondSprings::Given([NORMAL, SHEAR]), moments: 0.0 };
    let half = BondKind::Parallel { springs: BondSprings::Given([NORMAL, SHEAR]), moments: 0.5 };
    let glue = BondKind::Contact(BondSprings::Given([3e4, 1e4]));
    let never = f64::INFINITY;
    let pulled = |most: f64| BondStrength::of(most, never);
    let sheared = |most: f64| BondStrength::of(never, most);
    let slope = 0.7;
    let rubs = |most: f64| BondStrength { friction: slope, ..BondStrength::of(never, most) };
    let newtons =
        |tension: f64, shear: f64| BondStrength { forces: true, ..BondStrength::of(tension, shear) };
    let both = Vec3::new(-1.0, 1.0, 0.0);
    type Made<'a> = &'a dyn Fn(f64) -> BondStrength;
    let cases: [(&str, BondKind, Vec3, f64, Made); 9] = [
        ("parallel, pulled", parallel(), Vec3::x(), f / AREA, &pulled),
        ("parallel, bent", parallel(), Vec3::y(), bent, &pulled),
        ("parallel, bent, half of the moment", half, Vec3::y(), 0.5 * bent, &pulled),
        ("parallel, sheared", unbent, Vec3::y(), f / AREA, &sheared),
        ("parallel, sheared under pressure", unbent, both, f / AREA * (1.0 - slope), &rubs),
        ("parallel, sheared and pulled", unbent, Vec3::new(1.0, 1.0, 0.0), f / AREA * (1.0 + slope), &rubs),
        ("contact, pulled", glue, Vec3::x(), 0.5 * f, &|most| newtons(most, never)),
        ("contact, sheared", glue, Vec3::y(), 0.5 * f, &|most| newtons(never, most)),
        ("contact, sheared, as a stress", glue, Vec3::y(), 0.5 * f / AREA, &sheared),
    ];
    for (name, kind, way, most, strength) in cases {
        let wrong = u8::from(!breaks(kind, way * f, strength(0.99 * most)))
            + u8::from(breaks(kind, way * f, strength(1.01 * most)));
        BREAKS.within(name, wrong.into(), "wrong", 0.0);
    }
}

#[test]
fn a_crack_takes_the_energy_of_its_bond() {
    let glue = BondKind::Contact(BondSprings::Given([3e4, 1e4]));
    for (name, kind, along) in [("parallel", parallel(), NORMAL * AREA), ("contact", glue, 3e4)] {
        let mut setup = empty(HOOKE, 1.0);
        setup.particles = vec![grain(0, Vec3::zeros()), grain(1, Vec3::x() * PITCH)];
        let most = 1e3;
        setup.bonds =
            vec![Bond { strength: BondStrength::of(most, f64::INFINITY), ..Bond::new((0, 0), 0.002, kind) }];
        setup.particles[1].velocity.x = 0.05;
        (setup.ledger, setup.step) = (true, Step::Auto(1e-3));
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.02);
        let energy = sim.energy().expect("sound");
        let cracks = sim.take_cracks();
        assert_eq!((cracks.len(), cracks[0].mode), (1, dem::BreakMode::Tension));
        let expected = 0.5 * (most * AREA).powi(2) / along;
        TORN.equals(name, energy.bonds, "J", expected, 1e-2);
        assert!((cracks[0].energy / energy.bonds - 1.0).abs() < 1e-12);
    }
}
