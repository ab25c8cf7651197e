//! Two stacked particles, squeezed between walls 3.6 r apart: the two coupled equations, integrated here by themselves.
//!
//! ```text
//! m_1 z̈_1 = F(r − z_1) − F(2r − z_2 + z_1) − m_1 g,    m_2 z̈_2 = F(2r − z_2 + z_1) − F(r − (3.6 r − z_2)) − m_2 g
//! ```
//!
//! A test of MFIX-DEM: Garg, Galvin, Li & Pannala (2012), Powder Technology 220, doi:10.1016/j.powtec.2011.09.019.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, mass};
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, Law, contact, empty, grain, particles, plane};
use std::f64::consts::PI;

const SQUEEZED: Case = case(
    "Many grains",
    "two grains squeezed between walls 3.6 r apart: z(t) by Runge–Kutta of the coupled equations, over r",
);
const R: f64 = 0.01;
const GAP: f64 = 0.036;
const WORK: f64 = 5.0;
const DENSITIES: [f64; 2] = [2500.0, 5000.0];
const START: [f64; 2] = [0.9 * R, 2.7 * R];

#[derive(Clone, Copy)]
struct Pile {
    law: Law,
    e: f64,
}

impl Pile {
    fn setup(&self, dt: f64) -> Setup {
        let mut setup = empty(self.law, self.e);
        setup.contacts.push(contact((1, 1), self.law, self.e));
        setup.materials.iter_mut().zip(DENSITIES).for_each(|(m, d)| m.density = d);
        setup.gravity.z = -9.81;
        setup.step = Step::Fixed(dt);
        let mut lid = plane(-Vec3::z());
        lid.shape = WallShape::Plane(Plane { point: Vec3::new(0.0, 0.0, GAP), normal: -Vec3::z() });
        setup.walls = vec![plane(Vec3::z()), lid];
        setup.particles = (0..2u16)
            .map(|k| Particle { material: k, ..grain(k.into(), Vec3::new(0.0, 0.0, START[usize::from(k)])) })
            .collect();
        setup
    }

    /// Force of a contact [N], written by itself.
    fn force(&self, overlap: f64, rate: f64, radius: f64, mass: f64) -> f64 {
        let ln = self.e.ln();
        let gamma = if self.e < 1.0 { -2.0 * ln / (PI * PI + ln * ln).sqrt() } else { 0.0 };
        let modulus = 1e7 / (1.0 - 0.0625) / 2.0;
        let (elastic, stiffness, share) = match self.law {
            Law::Hooke { stiffness, .. } => (stiffness * overlap, stiffness, 1.0),
            Law::Hertz => {
                let a = (radius * overlap).sqrt();
                (4.0 / 3.0 * modulus * a * overlap, 2.0 * modulus * a, (5.0f64 / 6.0).sqrt())
            }
            Law::Jkr { .. } => {
                let a = radius_of_contact(overlap, radius, modulus);
                let pull = (8.0 * PI * WORK * modulus * a.powi(3)).sqrt();
                (4.0 * modulus * a.powi(3) / (3.0 * radius) - pull, 2.0 * modulus * a, (5.0f64 / 6.0).sqrt())
            }
        };
        elastic + gamma * share * (stiffness * mass).sqrt() * rate
    }

    fn slopes(&self, [z1, v1, z2, v2]: [f64; 4]) -> [f64; 4] {
        let [m1, m2] = DENSITIES.map(|d| mass(R, d));
        let floor = self.force(R - z1, -v1, R, m1);
        let middle = self.force(2.0 * R - z2 + z1, v1 - v2, 0.5 * R, m1 * m2 / (m1 + m2));
        let lid = self.force(z2 + R - GAP, v2, R, m2);
        [v1, (floor - middle) / m1 - 9.81, v2, (middle - lid) / m2 - 9.81]
    }

    /// z_1, z_2 by the classical method of Runge and Kutta, of fourth order.
    fn exact(&self, time: f64) -> [f64; 2] {
        let (mut y, n) = ([START[0], 0.0, START[1], 0.0], 20_000);
        let h = time / f64::from(n);
        let moved = |y: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
        for _ in 0..n {
            let a = self.slopes(y);
            let b = self.slopes(moved(y, a, 0.5 * h));
            let c = self.slopes(moved(y, b, 0.5 * h));
            let d = self.slopes(moved(y, c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        [y[0], y[2]]
    }
}

/// a of δ = a²/R − √(2π w a/E*), by bisection.
fn radius_of_contact(overlap: f64, radius: f64, modulus: f64) -> f64 {
    let (mut low, mut high) = ((PI * WORK * radius * radius / (8.0 * modulus)).cbrt(), radius);
    for _ in 0..60 {
        let a = 0.5 * (low + high);
        if a * a / radius - (2.0 * PI * WORK * a / modulus).sqrt() < overlap { low = a } else { high = a }
    }
    high
}

/// Contacts never open: the error is of second order.
#[test]
fn two_stacked_grains() {
    for (law, name) in [(HOOKE, "hooke"), (Law::Hertz, "hertz"), (Law::Jkr { work_of_adhesion: WORK }, "jkr")]
    {
        for e in [1.0, 0.5] {
            let pile = Pile { law, e };
            let mut setup = pile.setup(1.0);
            setup.step = Step::Auto(0.4);
            let coarse = simulation(setup).dt();
            let time = 256.0 * coarse;
            let exact = pile.exact(time);
            let off = |halvings: u32| {
                let dt = coarse / f64::from(1u32 << halvings);
                let mut sim = simulation(pile.setup(dt));
                (0..256u32 << halvings).for_each(|_| sim.step().expect("within the guards"));
                let p = particles(&mut sim);
                ((p[0].position.z - exact[0]).abs() + (p[1].position.z - exact[1]).abs()) / R
            };
            let on = format!("{name}, e = {e}");
            let points: Vec<(f64, f64)> = (2..7).map(|k| (0.4 / f64::from(1u32 << k), off(k))).collect();
            SQUEEZED.order(&on, &points, 2.0, 0.1);
            SQUEEZED.within(&on, points[4].1, "–", 1e-4);
        }
    }
}
