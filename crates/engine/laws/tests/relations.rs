//! Relations that hold for one contact at any numbers: force and energy, stiffness, caps, directions.

use laws::effects::*;
use laws::simd::{Row, V};
use laws::slowing::fluid::{Drag, DragLaw};

/// Random numbers from 0 to 1, of a linear congruential generator.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn vector(&mut self) -> V<f64> {
        V::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A contact at rest, a share of the kick that acts in full; overlap and slip are set by the tests.
    fn contact(&mut self) -> Contact<f64> {
        let way = self.vector();
        let normal = way.scale(1.0 / way.dot(way).sqrt());
        let [radius, mass, overlap] =
            [self.between(1e-3, 1e-2), self.between(1e-6, 1e-3), self.between(1e-5, 1e-4)];
        Contact {
            touching: true,
            normal,
            overlap,
            present: overlap,
            partial: 0.0,
            before: overlap,
            radius,
            smaller: 2.0 * radius,
            share: self.between(0.2, 1.0),
            share_before: 1.0,
            curvature: 0.25 / radius,
            mass,
            inverse_mass: 1.0 / mass,
            approach: 0.0,
            slip: V::zero(),
            spin: V::zero(),
            lever: radius,
            inertia: 0.2 * mass * radius * radius,
            stiffness_last: 0.0,
            turn: 0.0,
        }
    }
}

const ELASTIC: Elastic = Elastic { modulus: 3e7, tangential_ratio: 0.8 };
const DT: f64 = 1e-6;

fn pair(law: &ContactLaw) -> Pair<'_> {
    let damping = Damping::exact(law.number("restitution").unwrap_or(1.0));
    Pair { law, elastic: ELASTIC, compliance: Compliance { clumps: 1.0, springs: 1.0 }, damping }
}

fn law(name: &'static str) -> ContactLaw {
    let law = ContactLaw::new((0, 0), name).with("restitution", 0.6).with("stiffness", 2e4);
    law.with("work_of_adhesion", 0.1).with("cohesion_energy_density", 1e5)
}

/// What a normal law answers, from a copy of its history.
fn response<E: Effect>(effect: &E, contact: &Contact<f64>, history: &E::History<f64>) -> Response<f64>
where
    E::History<f64>: Copy,
{
    let (mut history, mut response) = (*history, Response::zero());
    effect.apply(contact, DT, &mut history, &mut response);
    response
}

fn at(contact: &Contact<f64>, overlap: f64) -> Contact<f64> {
    Contact { overlap, present: overlap, ..*contact }
}

fn close(found: f64, wanted: f64, to: f64, what: &str) {
    assert!(
        (found - wanted).abs() <= to * wanted.abs().max(f64::MIN_POSITIVE),
        "{what}: {found:e}, not {wanted:e}"
    );
}

/// F = dE/dδ at rest; `stiff`: S = dF/dδ, and that of the step before by the overlap that it had.
fn derives<E: Effect>(name: &str, effect: &E, history: impl Fn(&Contact<f64>) -> E::History<f64>, stiff: bool)
where
    E::History<f64>: Copy,
{
    let mut random = Random(7);
    for _ in 0..200 {
        let contact = random.contact();
        let (held, h) = (history(&contact), 1e-4 * contact.overlap);
        let of = |overlap: f64| response(effect, &at(&contact, overlap), &held);
        let (low, here, high) = (of(contact.overlap - h), of(contact.overlap), of(contact.overlap + h));
        close(here.normal, (high.elastic - low.elastic) / (2.0 * h), 1e-5, &format!("{name}: F"));
        // A pull does not cap friction.
        assert!(here.pressing >= here.normal, "{name}: {} {}", here.pressing, here.normal);
        if !stiff {
            continue;
        }
        close(here.stiffness, (high.normal - low.normal) / (2.0 * h), 1e-5, &format!("{name}: S"));
        close(here.impedance, (here.stiffness * contact.mass).sqrt(), 1e-12, &format!("{name}: √(S m*)"));
        let before = random.between(0.2, 2.0) * contact.overlap;
        let later = response(effect, &Contact { before, share_before: 1.1, ..contact }, &held);
        let earlier = of(before).stiffness * 1.1;
        close(later.stiffness_last, earlier, 1e-9, &format!("{name}: S a step ago"));
        close(
            later.stiffness_before,
            earlier / here.stiffness,
            1e-9,
            &format!("{name}: S a step ago over S"),
        );
    }
}

#[test]
fn forces_are_derivatives_of_energies() {
    let [hooke, hertz, jkr] = ["hooke", "hertz", "jkr"].map(law);
    derives("hooke", &Hooke::new(&pair(&hooke)), |_| (), true);
    derives("hertz", &Hertz::new(&pair(&hertz)), |_| (), true);
    let adhesive = Jkr::new(&pair(&jkr));
    derives("jkr", &adhesive, |contact| adhesive.last_radius(contact.radius), false);
    derives("cohesion", &Cohesion::new(&pair(&hooke)), |_| (), false);
    // Deeper once than now: both branches of unloading, and none of loading.
    let yielding = law("walton_braun");
    derives("walton_braun", &WaltonBraun::new(&pair(&yielding)), |contact| 1.2 * contact.overlap, false);
}

/// At the overlap that a law is asked about, its largest stiffness is that of its force there.
#[test]
fn the_stiffest_is_the_stiffness_at_the_largest_overlap() {
    let mut random = Random(11);
    for _ in 0..100 {
        let contact = Contact { share: 1.0, ..random.contact() };
        let limit = OverlapLimit {
            radius: contact.radius,
            smaller: contact.smaller,
            share: contact.overlap / contact.smaller,
        };
        for name in ["hooke", "hertz", "jkr", "walton_braun"] {
            let law = law(name);
            let normal = active(&law).find_map(|d| d.normal).expect("a normal law");
            let (pair, held) = (pair(&law), 0.0);
            let found = match name {
                "hooke" => response(&Hooke::new(&pair), &contact, &()),
                "hertz" => response(&Hertz::new(&pair), &contact, &()),
                "jkr" => response(&Jkr::new(&pair), &contact, &held),
                _ => response(&WaltonBraun::new(&pair), &contact, &held),
            };
            close((normal.stiffest)(&law, ELASTIC, limit), found.stiffness, 1e-9, name);
        }
    }
}

/// A dashpot adds c v to the force and books c v² Δt, whichever way the grains move; c = γ √(S m*).
#[test]
fn dashpots_book_the_work_that_they_do() {
    let (mut random, law) = (Random(13), law("hertz"));
    for _ in 0..100 {
        let still = random.contact();
        let approach = random.between(-1.0, 1.0);
        let hertz = Hertz::new(&pair(&law));
        let towards = Contact { approach, ..still };
        let (rest, moving) = (response(&hertz, &still, &()), response(&hertz, &towards, &()));
        let force = moving.normal - rest.normal;
        close(force, hertz.damping.ratio * rest.impedance * approach, 1e-6, "c v");
        close(moving.dissipated.iter().sum(), force * approach * DT, 1e-6, "c v² Δt");
    }
}

/// Springs that turn with their contact keep their length and lie in its plane; what rubs stays under its cap and loses energy.
#[test]
fn friction_rolling_and_twisting_stay_under_their_caps() {
    let (mut random, mut at_cap) = (Random(17), [0; 3]);
    let law = law("hertz").with("sliding_friction", 0.4).with("rolling_resistance", 0.1);
    let law = law.with("twisting_resistance", 0.2);
    let pair = pair(&law);
    let sliding = <SlidingFriction<f64> as ContactEffect>::new(&pair);
    let (rolling, twisting) = (RollingResistance::new(&pair), TwistingResistance::new(&pair));
    for _ in 0..500 {
        let contact = random.contact();
        let n = contact.normal;
        let slip = random.vector();
        let contact =
            Contact { slip: slip - n.scale(slip.dot(n)), spin: random.vector().scale(100.0), ..contact };
        let start = response(&Hertz::new(&pair), &contact, &());
        let length = random.between(0.0, 2e-6);
        let spring = random.vector();
        let spring = (spring - n.scale(spring.dot(n))).scale(length);
        let size = |v: V<f64>| v.dot(v).sqrt();
        let mut caps = |kind: usize, made: Response<f64>, cap: f64| {
            let torque = if kind == 0 { made.tangential } else { made.torque };
            let along = torque.dot(n).abs() / size(torque);
            assert!(if kind == 2 { along > 1.0 - 1e-9 } else { along < 1e-9 }, "{kind}: {along} along n");
            assert!(size(torque) <= cap * (1.0 + 1e-9), "{kind}: {} above {cap}", size(torque));
            at_cap[kind] += usize::from(size(torque) > cap * (1.0 - 1e-9));
            made
        };
        let mut made = start;
        sliding.apply(&contact, DT, &mut spring.clone(), &mut made);
        caps(0, made, 0.4 * start.pressing);
        let mut made = start;
        rolling.apply(&contact, DT, &mut spring.clone(), &mut made);
        caps(1, made, 0.1 * contact.radius * start.pressing);
        let mut made = start;
        twisting.apply(&contact, DT, &mut (1e3 * length), &mut made);
        caps(2, made, 0.2 * contact.radius * start.pressing);
    }
    assert!(at_cap.iter().all(|n| (20..500).contains(n)), "some slide and some stick: {at_cap:?}");
}

/// E* and k_t/k_n do not depend on which material is the first; two of one kind have E/2(1 − ν²) and 2 (1 − ν)/(2 − ν).
#[test]
fn elastic_constants_of_a_pair() {
    let mut random = Random(19);
    for _ in 0..100 {
        let [a, b] = [0, 1].map(|_| Material {
            name: String::new(),
            density: 2500.0,
            young: random.between(1e6, 1e9),
            poisson: random.between(0.0, 0.49),
        });
        let (of, back, same) = (Elastic::of(&a, &b), Elastic::of(&b, &a), Elastic::of(&a, &a));
        close(of.modulus, back.modulus, 1e-14, "E*");
        close(of.tangential_ratio, back.tangential_ratio, 1e-14, "k_t/k_n");
        close(same.modulus, a.young / (2.0 * (1.0 - a.poisson * a.poisson)), 1e-14, "E* of one");
        close(same.tangential_ratio, 2.0 * (1.0 - a.poisson) / (2.0 - a.poisson), 1e-14, "k_t/k_n of one");
    }
}

/// The slope of drag over speed is that of its force, on both sides of the turbulent regime.
#[test]
fn the_slope_of_drag_is_its_derivative() {
    let mut random = Random(23);
    let [viscosity, density] = [1e-3, 1000.0];
    let stokes = Drag { law: DragLaw::Stokes, viscosity, density, ..Drag::default() };
    for drag in [stokes, Drag { law: DragLaw::SchillerNaumann, ..stokes }] {
        for _ in 0..200 {
            let (radius, reynolds) = (random.between(1e-4, 1e-2), 10f64.powf(random.between(-2.0, 4.0)));
            let speed = reynolds * viscosity / (2.0 * radius * density);
            if (reynolds / 1000.0 - 1.0).abs() < 1e-2 {
                continue;
            }
            let force = |speed: f64| {
                let row = Row([0.0, 0.0, 0.0, radius, speed, 0.0, 0.0, 1.0]);
                -drag.slowing(&row).x / (6.0 * std::f64::consts::PI * viscosity * radius)
            };
            let h = 1e-5 * speed;
            close(
                drag.slope(radius, speed),
                (force(speed + h) - force(speed - h)) / (2.0 * h),
                1e-6,
                "slope",
            );
        }
    }
}
