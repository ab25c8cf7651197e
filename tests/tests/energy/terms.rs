//! Each term of the ledger by itself: scenes in which all that was there at the start goes to one term, whose answer is closed.
//!
//! [`super::closing`] cannot see that a term is a little wrong: what the finite step made is the rest of the sum, and takes it
//! up. Here the step is so short that this rest is nothing, at every instant: one per mille of any term or of what a spring holds would be
//! seen in it. The terms themselves are held against what must have become of the motion of the start:
//!
//! ```text
//! rebound                    normal = ½ m v² (1 − e²)                    with JKR, e = 1: W, what a cycle takes
//! thrown ball, until it rolls    sliding = ½ m v² · ⅖ r²/(a² + ⅖ r²)         whatever μ is or depends on; a: radius less the overlap
//! rolling ball, until it rests   rolling = ½ m v² + ½ I ω²,   top: twisting = ½ I ω²,   grain in a fluid: drag = ½ m v²
//! floor that turns a grain       walls = ½ I Ω² + twisting,   twisting = ½ I Ω²    slips as much as the grain turns
//! bonded pair, damped    bonds = ½ m/2 v²,   pair that is torn apart    bonds = A L σ_c²/2 E
//! piston, e = 1              walls = 2 m V²                              a grain at rest leaves at 2 V
//! ```

use dem::setup::*;
use dem::{Energy, Setup, Simulation, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::{MODULUS, NORMALS, Normal, Surface, WORK, name_of, precisions};
use grainpipe_tests::setups::{Law, bond, grain, lattice, plane};
use std::f64::consts::PI;

const ALONE: Case =
    case("Energy", "scenes with one energy term: it takes the energy that the closed solution predicts");
const NOTHING: Case = case(
    "Energy",
    "scenes with one energy term, short steps: energy created by the finite step at every instant, over the energy exchanged",
);

const R: f64 = 0.01;
/// Of what is asked: 10⁻³ of a term is seen.
const LIMIT: f64 = 3e-4;

fn mass_of_grain() -> f64 {
    mass(R, 2500.0)
}

/// ½ I of a grain [kg m²].
fn half_inertia() -> f64 {
    0.2 * mass_of_grain() * R * R
}

/// A scene in which one thing happens.
struct Alone {
    name: String,
    setup: Setup,
    until: f64,
    /// Of the critical step [–].
    step: f64,
}

impl Alone {
    /// What the step makes, of so much energy [J], is nothing at every instant; the ledger at the end.
    fn makes_nothing(self, scale: f64) -> Energy {
        let Alone { name, mut setup, until, step } = self;
        (setup.ledger, setup.step) = (true, Step::Auto(step));
        let mut sim = Simulation::new(setup).expect("the setup is sound");
        let start = sim.energy().expect("sound").integration;
        let mut most = 0.0f64;
        let every = (until / sim.dt() / 400.0).ceil() as u64;
        while sim.time() < until {
            (0..every).for_each(|_| sim.step().expect("no guard trips"));
            most = most.max((sim.energy().expect("sound").integration - start).abs());
        }
        NOTHING.within(&name, most / scale, "–", LIMIT);
        sim.energy().expect("sound")
    }

    /// The same, and a term is what it is to be [J].
    fn holds(self, term: impl Fn(&Energy) -> f64, answer: f64) {
        let name = self.name.clone();
        let end = self.makes_nothing(answer);
        ALONE.equals(&name, term(&end), "J", answer, LIMIT);
    }
}

fn name(what: &str, normal: &Normal, precision: Precision) -> String {
    format!("{what}, {}", name_of(normal, precision))
}

/// A grain at rest on a floor, which stays as deep in it: nothing is lost by the normal law, whatever the restitution is. Below 1 the
/// dashpot of friction takes what its spring holds when sliding ends.
fn resting(normal: &Normal, precision: Precision, friction: f64, restitution: f64) -> Setup {
    let (mut setup, _) = normal.resting(restitution, Surface::Plane);
    setup.precision = precision;
    setup.contacts.iter_mut().for_each(|c| c.set("sliding_friction", friction));
    setup
}

/// Its radius less the overlap [m].
fn arm(normal: &Normal) -> f64 {
    R - normal.at_rest(mass_of_grain() * 9.81).0
}

/// A grain that is thrown at a floor and comes back.
#[test]
fn rebound() {
    let (speed, m) = (0.1, mass_of_grain());
    for (normal, precision) in precisions() {
        for e in [1.0f64, 0.5] {
            let adheres = matches!(normal.law, Law::Jkr { .. });
            let mut setup = Setup { precision, ..normal.setup(e) };
            setup.walls = vec![plane(Vec3::z())];
            let velocity = Vec3::new(0.0, 0.0, -speed);
            setup.particles = vec![Particle { velocity, ..grain(1, Vec3::new(0.0, 0.0, 1.003 * R)) }];
            let last = (PI * WORK * R * R / (8.0 * MODULUS)).cbrt();
            let cycle = 4.0 * PI * WORK * last * last * (0.1 + 0.15 * 4f64.powf(4.0 / 3.0));
            let kinetic = 0.5 * m * speed * speed;
            let name = name(&format!("rebound, e = {e}"), &normal, precision);
            let alone = Alone { name, setup, until: 0.02, step: 5e-4 };
            if e < 1.0 && (adheres || normal.cohesion.is_some()) {
                // What the dashpot of a contact that adheres takes has no closed answer.
                alone.makes_nothing(kinetic);
                continue;
            }
            match (adheres, e < 1.0) {
                (true, _) => alone.holds(|e| e.normal, cycle),
                (_, true) => alone.holds(|e| e.normal, kinetic * (1.0 - e * e)),
                // Without loss it is what the spring holds that is looked at.
                _ => alone.holds(|e| e.translation, kinetic),
            }
        }
    }
}

/// A thrown ball slides until it rolls.
#[test]
fn sliding() {
    let (speed, m) = (0.3, mass_of_grain());
    for (normal, precision) in precisions() {
        for weakens in [false, true] {
            if weakens && precision != Precision::Double {
                continue;
            }
            let mut setup = resting(&normal, precision, 0.5, 0.3);
            if weakens {
                setup.contacts.iter_mut().for_each(|c| grainpipe_tests::setups::weaken(c, [0.3, 0.2, 0.05]));
            }
            setup.particles[0].velocity.x = speed;
            let (a, turns) = (arm(&normal), 0.4 * R * R);
            let answer = 0.5 * m * speed * speed * turns / (a * a + turns);
            let what = if weakens { "thrown ball, friction that weakens" } else { "thrown ball" };
            let name = name(what, &normal, precision);
            Alone { name, setup, until: 0.06, step: 0.01 }.holds(|e| e.sliding, answer);
        }
    }
}

/// A ball that rolls comes to rest; friction that holds takes nothing.
#[test]
fn rolling() {
    let (speed, m) = (0.3, mass_of_grain());
    for model in ["spring", "constant"] {
        for (normal, precision) in precisions() {
            if model == "constant" && precision != Precision::Double {
                continue;
            }
            // A constant torque begins and ends at once: the dashpot of sliding takes what goes to and fro on its spring.
            let restitution = if model == "constant" { 0.5 } else { 1.0 };
            let mut setup = resting(&normal, precision, 0.9, restitution);
            for c in &mut setup.contacts {
                grainpipe_tests::setups::rolling(c, 0.5, model);
            }
            let spin = speed / arm(&normal);
            (setup.particles[0].velocity.x, setup.particles[0].spin.y) = (speed, spin);
            let answer = 0.5 * m * speed * speed + half_inertia() * spin * spin;
            let name = name(&format!("rolling ball, {model:?}"), &normal, precision);
            let taken = |e: &Energy| {
                assert!(e.sliding < 3e-3 * answer, "{e:?}");
                e.rolling + e.sliding
            };
            Alone { name, setup, until: 0.2, step: 0.01 }.holds(taken, answer);
        }
    }
}

/// A top comes to rest; a floor that turns takes a grain along.
#[test]
fn twisting() {
    let speed = 20.0;
    for normal in NORMALS {
        let mut setup = resting(&normal, Precision::Double, 0.5, 1.0);
        setup.contacts.iter_mut().for_each(|c| c.set("twisting_resistance", 0.1));
        let answer = half_inertia() * speed * speed;
        let mut floor = setup.clone();
        setup.particles[0].spin.z = speed;
        let name_of = |what: &str| name(what, &normal, Precision::Double);
        Alone { name: name_of("top"), setup, until: 0.15, step: 0.01 }.holds(|e| e.twisting, answer);
        floor.walls[0].motion.turn = Vec3::new(0.0, 0.0, speed);
        let turned = Alone { name: name_of("floor that turns"), setup: floor, until: 0.15, step: 0.01 };
        let end = turned.makes_nothing(answer);
        ALONE.equals(&name_of("floor that turns, twisting"), end.twisting, "J", answer, LIMIT);
        ALONE.equals(&name_of("floor that turns, walls"), end.walls, "J", 2.0 * answer, LIMIT);
    }
}

/// Two bonded grains whose swing dies away, and two that tear their bond.
#[test]
fn bonds() {
    let (speed, m) = (0.02, mass_of_grain());
    let pair = |bond: Bond| {
        let mut setup = NORMALS[0].setup(1.0);
        (setup.bonds, setup.particles) = (vec![bond], lattice([2, 1, 1], Vec3::zeros()));
        setup.particles.iter_mut().zip([-0.5, 0.5]).for_each(|(p, s)| p.velocity.x = s * speed);
        setup
    };
    let answer = 0.25 * m * speed * speed;
    let setup = pair(Bond { damping: 0.3, ..bond((0, 0)) });
    let damped = Alone { name: "bonded pair, damped".to_owned(), setup, until: 0.03, step: 5e-4 };
    damped.holds(|e| e.bonds, answer);
    let strength = 1e3;
    let setup = pair(Bond { strength: BondStrength::of(strength, f64::INFINITY), ..bond((0, 0)) });
    // A force that ends within a step is wrong by half of the step.
    let torn = Alone { name: "bonded pair, torn apart".to_owned(), setup, until: 0.005, step: 1e-4 };
    torn.holds(|e| e.bonds, PI * R * R * 0.021 * strength * strength / 2e7);
}

/// A belt takes a grain along; a piston throws one.
#[test]
fn walls() {
    let (speed, m) = (0.3, mass_of_grain());
    for (normal, precision) in precisions() {
        let mut setup = resting(&normal, precision, 0.5, 0.3);
        setup.walls[0].motion.velocity.x = speed;
        let (a, turns) = (arm(&normal), 0.4 * R * R);
        let answer = m * speed * speed * turns / (a * a + turns);
        let name_of = |what: &str| name(what, &normal, precision);
        Alone { name: name_of("belt"), setup, until: 0.06, step: 0.01 }.holds(|e| e.walls, answer);
        if matches!(normal.law, Law::Jkr { .. }) {
            continue;
        }
        let mut setup = Setup { precision, ..normal.setup(1.0) };
        setup.walls = vec![plane(Vec3::z())];
        setup.walls[0].motion.velocity.z = 0.1;
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 1.003 * R))];
        let answer = 2.0 * m * 0.01;
        Alone { name: name_of("piston"), setup, until: 0.02, step: 5e-4 }.holds(|e| e.walls, answer);
    }
}

/// A grain comes to rest in a fluid.
#[test]
fn drag() {
    for (law, name) in [(DragLaw::Stokes, "stokes"), (DragLaw::SchillerNaumann, "schiller-naumann")] {
        let mut setup = NORMALS[0].setup(1.0);
        setup.drag =
            Some(Drag { law, viscosity: 1.3, density: 1000.0, velocity: Vec3::zeros(), buoyancy: false });
        setup.particles = vec![Particle { velocity: Vec3::x(), ..grain(1, Vec3::zeros()) }];
        let answer = 0.5 * mass_of_grain();
        let name = format!("grain in a fluid, {name}");
        Alone { name, setup, until: 0.5, step: 0.002 }.holds(|e| e.drag, answer);
    }
}

/// What holds without sliding: a grain that is pushed aside swings on the springs of friction, of rolling and of twisting.
#[test]
fn springs() {
    let m = mass_of_grain();
    for (normal, precision) in precisions() {
        let mixed = precision != Precision::Double;
        for kind in ["sliding", "rolling", "twisting"] {
            if kind == "twisting" && mixed {
                continue;
            }
            let mut setup = resting(&normal, precision, 0.9, 1.0);
            let p = &mut setup.particles[0];
            let answer = match kind {
                "twisting" => {
                    p.spin.z = 0.2;
                    half_inertia() * 4e-2
                }
                _ => {
                    p.velocity.x = 2e-3;
                    0.5 * m * 4e-6
                }
            };
            for c in &mut setup.contacts {
                c.set("rolling_resistance", Some(0.9).filter(|_| kind == "rolling"));
                c.set("twisting_resistance", Some(0.9).filter(|_| kind == "twisting"));
            }
            let name = name(&format!("swings on the spring of {kind}"), &normal, precision);
            Alone { name, setup, until: 0.02, step: 0.005 }.makes_nothing(answer);
        }
    }
}
