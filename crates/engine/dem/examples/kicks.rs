//! A second evaluation of forces in kicks in which a contact begins or ends: what it gains and what it costs, in one impact and in a row of
//! grains that the first one hits. Printed for docs/theory/time-step.md: `cargo run --release -p grainpipe-dem --example kicks`.
//!
//! Grains have the mass 1 and the stiffness 1, so that ω² = 2 of a pair.

use std::f64::consts::PI;

/// Distance of centres at touch, and phases of the step in which the first contact begins.
const TOUCH: f64 = 200.0;
const PHASES: usize = 16;
/// m*.
const MASS: f64 = 0.5;

#[derive(Clone, Copy, PartialEq)]
enum Law {
    Hooke,
    Hertz,
}

/// A row of grains.
struct Row {
    law: Law,
    /// γ.
    damping: f64,
    x: Vec<f64>,
    /// Half a step before the instant.
    speed: Vec<f64>,
    acceleration: Vec<f64>,
}

/// Forces of a kick, and which of them act for a part of it.
struct Kick {
    forces: Vec<f64>,
    partial: Vec<bool>,
}

impl Row {
    fn new(law: Law, restitution: f64, count: usize, phase: f64) -> Row {
        let l = -restitution.ln();
        // Gaps without order: no two contacts begin at one phase.
        let gap =
            |k: usize| if k == 0 { 2.0 + 0.3 * phase } else { 0.37 + 0.61 * ((7919 * k % 13) as f64) / 13.0 };
        let place = |k: usize| (0..k).map(|c| TOUCH + gap(c)).sum();
        let x = (0..count).map(place).collect();
        let mut speed = vec![0.0; count];
        speed[0] = 1.0;
        Row { law, damping: 2.0 * l / (PI * PI + l * l).sqrt(), x, speed, acceleration: vec![0.0; count] }
    }

    /// Force of a contact in a kick, averaged over the part in which it acts.
    fn force(&self, overlap: f64, approach: f64, dt: f64) -> (f64, bool) {
        let way = approach.abs() * dt / 2.0;
        if overlap + way <= 0.0 {
            return (0.0, false);
        }
        let partial = overlap < way;
        let (share, overlap) = match partial {
            true => ((overlap + way) / (2.0 * way), (overlap + way) / 2.0),
            false => (1.0, overlap),
        };
        let force = match self.law {
            Law::Hooke => overlap + self.damping * MASS.sqrt() * approach,
            Law::Hertz => {
                let stiffness = 1.5 * overlap.sqrt();
                overlap * overlap.sqrt() + self.damping * (5.0 / 6.0 * stiffness * MASS).sqrt() * approach
            }
        };
        (share * force, partial)
    }

    /// Velocities at the instant, if these accelerations act in the kick.
    fn now(&self, acceleration: &[f64], dt: f64) -> Vec<f64> {
        self.speed.iter().zip(acceleration).map(|(v, a)| v + 0.5 * dt * a).collect()
    }

    fn kick(&self, v: &[f64], dt: f64) -> Kick {
        let contact = |c: usize| self.force(TOUCH - (self.x[c + 1] - self.x[c]), v[c] - v[c + 1], dt);
        let (forces, partial) = (0..self.x.len() - 1).map(contact).unzip();
        Kick { forces, partial }
    }

    fn accelerations(&self, forces: &[f64]) -> Vec<f64> {
        let mut a = vec![0.0; self.x.len()];
        for (c, f) in forces.iter().enumerate() {
            a[c] -= f;
            a[c + 1] += f;
        }
        a
    }

    /// One step; evaluations of contacts that act, and those of a second time.
    fn step(&mut self, dt: f64, twice: bool) -> (usize, usize) {
        let mut kick = self.kick(&self.now(&self.acceleration, dt), dt);
        let acting = kick.forces.iter().filter(|f| **f != 0.0).count();
        let mut again = 0;
        if twice && kick.partial.contains(&true) {
            let second = self.kick(&self.now(&self.accelerations(&kick.forces), dt), dt);
            for (c, _) in kick.partial.iter().enumerate().filter(|p| *p.1) {
                kick.forces[c] = second.forces[c];
                again += 1;
            }
        }
        self.acceleration = self.accelerations(&kick.forces);
        for k in 0..self.x.len() {
            self.speed[k] += self.acceleration[k] * dt;
            self.x[k] += self.speed[k] * dt;
        }
        (acting, again)
    }

    /// Speeds when all is over, and how much more was evaluated.
    fn run(mut self, dt: f64, twice: bool) -> (Vec<f64>, f64) {
        let (mut acting, mut again) = (0, 0);
        for _ in 0..(12.0 * self.x.len() as f64 / dt) as usize {
            let (a, b) = self.step(dt, twice);
            (acting, again) = (acting + a, again + b);
        }
        (self.speed, again as f64 / acting as f64)
    }
}

/// Largest root mean square error of the speeds over the phases, and the second evaluations over the first.
fn error(law: Law, restitution: f64, count: usize, dt: f64, twice: bool) -> (f64, f64) {
    let (mut worst, mut more) = (0.0f64, 0.0);
    for k in 0..PHASES {
        let row = || Row::new(law, restitution, count, k as f64 / PHASES as f64);
        let ((exact, _), (found, again)) = (row().run(0.003, false), row().run(dt, twice));
        let square: f64 = exact.iter().zip(&found).map(|(a, b)| (a - b).powi(2)).sum();
        worst = worst.max((square / count as f64).sqrt());
        more = again;
    }
    (worst, more)
}

fn main() {
    println!("grains, law, e, ω Δt: error with one evaluation, with a second, evaluations more");
    for count in [2, 20] {
        for (law, name) in [(Law::Hooke, "linear"), (Law::Hertz, "Hertz")] {
            for restitution in [0.9, 0.5] {
                for dt in [0.3, 0.15, 0.075] {
                    let (once, _) = error(law, restitution, count, dt, false);
                    let (twice, more) = error(law, restitution, count, dt, true);
                    let pace = 2f64.sqrt() * dt;
                    println!(
                        "{count}, {name}, {restitution}, {pace:.2}: {once:.2e}, {twice:.2e}, +{:.0} %",
                        100.0 * more
                    );
                }
            }
        }
    }
}
