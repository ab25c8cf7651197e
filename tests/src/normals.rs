//! Every normal law there is, with and without cohesion, and every surface a grain can meet: what laws are tried on.

use crate::setups::{HOOKE, Law, empty, grain, plane, sticky};
use dem::effects::{Cohesion, Contact, Damping, Effect, Hertz, Hooke, Jkr, Response};
use dem::setup::*;
use dem::simd::V;
use dem::{Setup, mass};
use geom::Vec3;
use std::f64::consts::PI;

/// A normal law, and what adheres.
#[derive(Debug, Clone, Copy)]
pub struct Normal {
    /// Name.
    pub name: &'static str,
    /// Law.
    pub law: Law,
    /// C [J/m³].
    pub cohesion: Option<f64>,
}

/// w of the JKR law here [J/m²].
pub const WORK: f64 = 1.0;

/// All of them.
pub const NORMALS: [Normal; 5] = [
    Normal { name: "hooke", law: HOOKE, cohesion: None },
    Normal { name: "hertz", law: Law::Hertz, cohesion: None },
    Normal { name: "jkr", law: Law::Jkr { work_of_adhesion: WORK }, cohesion: None },
    Normal { name: "hooke with cohesion", law: HOOKE, cohesion: Some(5e4) },
    Normal { name: "hertz with cohesion", law: Law::Hertz, cohesion: Some(5e4) },
];

/// Every normal law, and again in mixed and in single precision where it is offered in these.
pub fn precisions() -> impl Iterator<Item = (Normal, Precision)> {
    let double = NORMALS.into_iter().map(|n| (n, Precision::Double));
    let narrow = [Precision::Mixed, Precision::Single];
    double.chain(NORMALS.into_iter().filter(|n| !n.adheres()).flat_map(move |n| narrow.map(|p| (n, p))))
}

/// What a law in a precision is called.
pub fn name_of(normal: &Normal, precision: Precision) -> String {
    let precision = match precision {
        Precision::Double => "",
        Precision::Mixed => ", mixed precision",
        Precision::Single => ", single precision",
    };
    format!("{}{precision}", normal.name)
}

/// E* of the materials of [`empty`] [Pa].
pub const MODULUS: f64 = 1e7 / (1.0 - 0.25 * 0.25) / 2.0;

/// A contact of no speed.
pub fn still(overlap: f64, radius: f64, curvature: f64) -> Contact<f64> {
    Contact {
        touching: true,
        normal: V::new(0.0, 0.0, 1.0),
        overlap,
        present: overlap,
        partial: 0.0,
        before: overlap,
        radius,
        smaller: if curvature > 0.0 { 0.5 / curvature } else { radius },
        share: 1.0,
        share_before: 1.0,
        curvature,
        mass: 0.01,
        inverse_mass: 100.0,
        approach: 0.0,
        slip: V::zero(),
        spin: V::zero(),
        lever: 0.0,
        stiffness_last: 0.0,
        inertia: 4e-7,
        turn: 0.0,
    }
}

/// What an effect makes of a contact that has just been made.
pub fn response<E: Effect>(effect: E, contact: &Contact<f64>) -> Response<f64> {
    let nothing = vec![0.0; E::HISTORY * dem::simd::BLOCK];
    let mut history = <E::History<f64> as dem::effects::History<f64>>::load(&nothing, 0);
    let mut response = Response::zero();
    effect.apply(contact, 1e-6, &mut history, &mut response);
    response
}

impl Normal {
    /// Whether grains adhere; that is offered in double precision only.
    pub fn adheres(&self) -> bool {
        self.cohesion.is_some() || matches!(self.law, Law::Jkr { .. })
    }

    /// Two materials with this law and restitution for every pair.
    pub fn setup(&self, restitution: f64) -> Setup {
        let mut setup = empty(self.law, restitution);
        if let Some(density) = self.cohesion {
            setup.contacts.iter_mut().for_each(|c| sticky(c, density));
        }
        setup
    }

    /// Force and energy without damping.
    pub fn response(&self, contact: &Contact<f64>) -> Response<f64> {
        let cohesion = self.cohesion.map(|energy_density| Cohesion { energy_density });
        let (modulus, damping) = (MODULUS, Damping::NONE);
        match self.law {
            Law::Hooke { stiffness, .. } => response((Hooke { stiffness, damping }, cohesion), contact),
            Law::Hertz => response((Hertz { modulus, damping }, cohesion), contact),
            Law::Jkr { work_of_adhesion } => {
                response(Jkr::with_modulus(modulus, work_of_adhesion, damping), contact)
            }
        }
    }

    /// Force at rest [N] of a sphere of radius r [m] on another, or on a flat wall, by the formulas of the sources and not by the
    /// engine's: k δ; 4/3 E* √R* δ^(3/2); of JKR through its own radius of contact, δ = a²/R* − √(2π w a/E*); less C times the area of the
    /// circle in which the surfaces meet.
    pub fn force(&self, overlap: f64, r: f64, other: Option<f64>) -> f64 {
        let radius = other.map_or(r, |s| r * s / (r + s));
        let elastic = match self.law {
            Law::Hooke { stiffness, .. } => stiffness * overlap,
            Law::Hertz => 4.0 / 3.0 * MODULUS * radius.sqrt() * overlap.powf(1.5),
            Law::Jkr { work_of_adhesion: w } => {
                let at = |a: f64| a * a / radius - (2.0 * PI * w * a / MODULUS).sqrt() - overlap;
                // δ grows with a from the radius at which the pull is strongest under a given force on.
                let (mut low, mut high) = ((9.0 * PI * w * radius * radius / (8.0 * MODULUS)).cbrt(), r);
                for _ in 0..200 {
                    let a = 0.5 * (low + high);
                    if at(a) < 0.0 { low = a } else { high = a }
                }
                4.0 * MODULUS * high.powi(3) / (3.0 * radius) - (8.0 * PI * w * MODULUS * high.powi(3)).sqrt()
            }
        };
        // Where two spheres meet: the plane at x from the one's centre. On a wall: a cap as high as the overlap.
        let square = match other {
            None => overlap * (2.0 * r - overlap),
            Some(s) => {
                let d = r + s - overlap;
                let x = (d * d + r * r - s * s) / (2.0 * d);
                r * r - x * x
            }
        };
        elastic - self.cohesion.unwrap_or(0.0) * PI * square
    }

    /// Overlap [m] at which a grain of 10 mm on a flat wall bears a force [N], and what friction is capped by there [N].
    pub fn at_rest(&self, force: f64) -> (f64, f64) {
        let of = |overlap| self.response(&still(overlap, 0.01, 0.0));
        // Above the overlap without response the force grows with the overlap.
        let (mut low, mut high) = (0.0, 2e-3);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if of(middle).normal < force { low = middle } else { high = middle }
        }
        (high, of(high).pressing)
    }

    /// A grain of 10 mm at rest under gravity on a surface, and what friction is capped by over its mass [m/s²].
    pub fn resting(&self, restitution: f64, surface: Surface) -> (Setup, f64) {
        let mut setup = self.setup(restitution);
        let m = mass(0.01, 2500.0);
        let (overlap, pressing) = self.at_rest(m * 9.81);
        setup.gravity.z = -9.81;
        setup.walls = vec![surface.wall()];
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.01 - overlap))];
        (setup, pressing / m)
    }
}

/// What a grain rests on: its top is at z = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// A plane.
    Plane,
    /// A wall sphere so large that it is flat for a grain.
    Sphere,
}

/// All of them.
pub const SURFACES: [Surface; 2] = [Surface::Plane, Surface::Sphere];

impl Surface {
    /// The wall.
    pub fn wall(self) -> Wall {
        let mut wall = plane(Vec3::z());
        if self == Surface::Sphere {
            wall.shape = WallShape::Spheres(vec![(Vec3::new(0.0, 0.0, -1e4), 1e4)]);
        }
        wall
    }
}
