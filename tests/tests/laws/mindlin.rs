//! Tangential loading and unloading at one contact, driven by hand.
//!
//! ```text
//! law here, F_n const:    F_t = −k_t ξ,  k_t = 8 G* a, up to μ F_n; a cycle of amplitude D takes 4 μ F_n (D − μ F_n/k_t)
//! law here, F_n grows:    F_t stays (a spring that stiffens keeps its force);  F_n falls: F_t = −k_t ξ
//! partial slip:           F_t = μ F_n (1 − (1 − 2 k_t ξ/3 μ F_n)^(3/2))      Mindlin & Deresiewicz (1953), J. Appl. Mech. 20
//! ```
//!
//! The law here has no partial slip: it is stiffer on the way to sliding, by at most 0.193 μ F_n, at k_t ξ = μ F_n.

use dem::effects::{Contact, Damping, Effect, Hertz, History, Response, SlidingFriction};
use dem::simd::{BLOCK, V};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::still;

const STICKS: Case =
    case("Friction and rolling", "tangential loading and unloading below μ F_n: F_t = −8 G* a ξ, over μ F_n");
const LOOP: Case =
    case("Friction and rolling", "tangential cycle of amplitude D dissipates 4 μ F_n (D − μ F_n/k_t)");
const STIFFENS: Case =
    case("Friction and rolling", "F_n grows at constant ξ: F_t stays; F_n falls: F_t = −8 G* a ξ");
const PARTIAL: Case = case(
    "Friction and rolling",
    "loading compared with partial slip (Mindlin & Deresiewicz), which this law leaves out: difference over μ F_n",
);
const LOADING: Case = case(
    "One contact",
    "Hertz with its dashpot compared with another engine's loading and unloading (sample-data/reference)",
);

const MU: f64 = 0.4;
const RATIO: f64 = 0.857;
const MODULUS: f64 = 1e7;
const OVERLAP: f64 = 1e-4;

type Rubbing = (Hertz, SlidingFriction);

/// A contact of flat wall and grain of 10 mm that is dragged along; the spring is its history.
struct Dragged {
    law: Rubbing,
    history: <Rubbing as Effect>::History<f64>,
}

impl Dragged {
    fn new() -> Dragged {
        let hertz = Hertz { modulus: MODULUS, damping: Damping::NONE };
        let friction =
            SlidingFriction { friction: MU, stiffness_ratio: RATIO, damping_ratio: 0.0, compliance: 1.0 };
        let nothing = vec![0.0; Rubbing::HISTORY * BLOCK];
        Dragged { law: (hertz, friction), history: History::load(&nothing, 0) }
    }

    /// One step of slip [m] at an overlap that has grown [m] in it; step so short that nothing is late.
    fn step(&mut self, slip: f64, overlap: f64, growth: f64) -> Response<f64> {
        let dt = 1e-9;
        let contact = Contact {
            slip: V::new(slip / dt, 0.0, 0.0),
            approach: growth / dt,
            before: overlap - growth,
            ..still(overlap, 0.01, 0.0)
        };
        let mut response = Response::zero();
        self.law.apply(&contact, dt, &mut self.history, &mut response);
        response
    }
}

fn spring(overlap: f64) -> (f64, f64) {
    let a = (0.01 * overlap).sqrt();
    (RATIO * 2.0 * MODULUS * a, MU * 4.0 / 3.0 * MODULUS * a * overlap)
}

/// Ways to and fro, in shares of μ F_n/k_t.
#[test]
fn loading_and_unloading_below_the_cap() {
    let ((k, cap), mut dragged) = (spring(OVERLAP), Dragged::new());
    let (n, mut xi, mut worst) = (1000, 0.0f64, 0.0f64);
    for to in [0.9, -0.9, 0.5, 0.0] {
        let step = (to * cap / k - xi) / f64::from(n);
        for _ in 0..n {
            // The force is that of the middle of the step.
            let force = dragged.step(step, OVERLAP, 0.0).tangential.x;
            worst = worst.max((force + k * (xi + 0.5 * step)).abs() / cap);
            xi += step;
        }
    }
    STICKS.within("hertz, 0 → 0.9 → −0.9 → 0.5 → 0", worst, "–", 1e-9);
}

#[test]
fn a_cycle_takes_what_slides() {
    let (k, cap) = spring(OVERLAP);
    for times in [1.5, 3.0, 10.0] {
        let (mut dragged, d) = (Dragged::new(), times * cap / k);
        let n = 20_000;
        let mut sweep = |from: f64, to: f64| {
            let step = (to - from) / f64::from(n);
            (0..n).map(|_| dragged.step(step, OVERLAP, 0.0)).fold((0.0, 0.0), |(work, lost), response| {
                (work - response.tangential.x * step, lost + response.dissipated[1])
            })
        };
        sweep(0.0, d);
        let (there, back) = (sweep(d, -d), sweep(-d, d));
        let expected = 4.0 * cap * (d - cap / k);
        LOOP.equals(&format!("area, D = {times} μ F_n/k_t"), there.0 + back.0, "J", expected, 2e-3);
        LOOP.equals(&format!("ledger, D = {times} μ F_n/k_t"), there.1 + back.1, "J", expected, 2e-3);
    }
}

#[test]
fn the_normal_force_grows_and_falls() {
    let ((k, cap), mut dragged) = (spring(OVERLAP), Dragged::new());
    let xi = 0.5 * cap / k;
    (0..1000).for_each(|_| {
        dragged.step(xi / 1000.0, OVERLAP, 0.0);
    });
    let (n, growth) = (1000, OVERLAP / 1000.0);
    let (mut kept, mut off) = (0.0f64, 0.0f64);
    let mut overlap = OVERLAP;
    for _ in 0..n {
        overlap += growth;
        kept = kept.max((dragged.step(0.0, overlap, growth).tangential.x / (k * xi) + 1.0).abs());
    }
    let now = k * xi / spring(overlap).0;
    for _ in 0..n {
        overlap -= growth;
        let expected = spring(overlap).0 * now;
        off = off.max((dragged.step(0.0, overlap, -growth).tangential.x / expected + 1.0).abs());
    }
    STIFFENS.within("δ → 2 δ", kept, "–", 1e-9);
    STIFFENS.within("2 δ → δ", off, "–", 1e-9);
}

/// How far the law is from Mindlin's of partial slip, over the whole way to sliding.
#[test]
fn beside_partial_slip() {
    let ((k, cap), mut dragged) = (spring(OVERLAP), Dragged::new());
    let (n, mut x, mut far) = (3000, 0.0, 0.0f64);
    let (mut here, mut theory) = (Vec::new(), Vec::new());
    let step = 1.6 / f64::from(n);
    for at in 0..n {
        let force = -dragged.step(step * cap / k, OVERLAP, 0.0).tangential.x / cap;
        let middle = x + 0.5 * step;
        let partial = 1.0 - (1.0 - 2.0 / 3.0 * middle).max(0.0).powf(1.5);
        far = far.max((force - partial).abs());
        if at % 30 == 0 {
            here.push((middle, force));
            theory.push((middle, partial));
        }
        x += step;
    }
    PARTIAL.within("hertz", far, "–", 0.193);
    PARTIAL.curve("the law here", "k_t ξ / μ F_n [–]", "F_t / μ F_n [–]", &here);
    PARTIAL.curve("partial slip", "k_t ξ / μ F_n [–]", "F_t / μ F_n [–]", &theory);
}

/// E* = 100 kPa, R = 0.25 m, m = 0.125 kg; c = 2 √(2/3 S m). The other engine's test drives its sphere against its velocity: the
/// dashpot pulls on the way in.
#[test]
fn another_engines_loading() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../sample-data/reference/hertz_loading.csv");
    let text = std::fs::read_to_string(file).expect("the sample is there");
    let damping = Damping { ratio: 2.0 * 0.8f64.sqrt() * (5.0f64 / 6.0).sqrt(), ..Damping::exact(0.5) };
    let law = Hertz { modulus: 1e5, damping };
    let (mut worst, mut rows) = (0.0f64, 0);
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
        let (time, overlap, force) = (row[0], row[1], row[2]);
        if overlap < 1e-9 {
            continue;
        }
        let approach = if time < 1.503 { -0.01 } else { 0.01 };
        let contact = Contact { mass: 0.125, inverse_mass: 8.0, approach, ..still(overlap, 0.25, 0.0) };
        let mut response = Response::zero();
        law.apply(&contact, 1e-9, &mut (), &mut response);
        worst = worst.max((response.normal / force - 1.0).abs());
        rows += 1;
    }
    assert_eq!(rows, 499);
    // Ten digits are printed; at first touch spring and dashpot nearly cancel.
    LOADING.within("499 rows, relative", worst, "–", 2e-9);
}
