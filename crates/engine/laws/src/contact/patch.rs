//! One patch: all spheres of a wall that a grain touches at once act as one contact.
//!
//! ```text
//! u_i = elastic energy of sphere i alone at its overlap δ_i;   y_i = u_i⁴
//! U = Σ y_i D_i^(−3/4),  D_i = Σ_j g_ij y_j                    a 4-norm where all belong together (g = 1); a plain sum where none do (g_ij = 0)
//! N_i = −∂U/∂x along n_i = h_i f_i(δ_i),   h_i = 4 u_i³ (D_i^(−3/4) − ¾ Σ_k g_ki y_k D_k^(−7/4))
//! g_ij = clamp(4 x − 2.3, 0, 1),  x = (D_i² + D_j² − |c_i − c_j|²)/2 D_i D_j,  D_i = r + R_i
//! m_i = min(N_i/a_i, 1/A_i),  a_i = n_i·(V/m + d (V·d)/M),  V = Σ N_j n_j,  A_i = 1/m + (n_i·d)²/M
//! ```
//!
//! N spheres that push the same way would be N times as stiff as one, and damp N times as much as one dashpot √N times as stiff should. The energy U is
//! a function of the position alone, since x is the cosine of the angle at which the grain touches both spheres at once, which their centres fix. So
//! nothing is made on any way around. Spheres at less than 34° are one patch, those at more than 55°, as in a corner, a slot or a pocket of spheres of the grain's size, are contacts of their own.
//! Each dashpot is made for the mass m_i that all springs of this pair of bodies move at its place; d and M are of a wall on a spring.
//!
//! Where one sphere is touched nothing of this is computed. Scalar, in double precision: the same for all widths of lanes, and on a GPU.

use crate::contact::damped_mass::{DampedMass, MOST};
use crate::contact::touch::{PatchLaw, Touch};
use crate::float::Float;
use primitives::Vec3;

/// Numbers of a contact: share of its stiffness, the share a step ago over that, and by what m* and 1/m* are multiplied [–].
pub const PATCH: usize = 4;
/// Those of a contact by itself.
pub const ALONE: [f64; PATCH] = [1.0; PATCH];

/// Cosine of the angle from the deepest sphere within which all belong together: half of what g = 1 allows for each two, with a margin.
const TOGETHER: f64 = 0.957;
/// Below this share a contact counts as none where one is divided by another.
const LEAST: f64 = 1e-30;
/// Below this energy alone, which no overlap above 1e-60 m has, none counts as larger than another.
const FAINTEST: f64 = 1e-250;

/// x^(−3/4); 0 of 0.
#[inline(always)]
fn power(x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let root = x.root();
    1.0 / (root * root.root())
}

/// The larger of two numbers.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// x⁴.
#[inline(always)]
fn fourth(x: f64) -> f64 {
    let square = x * x;
    square * square
}

/// Of this instant, and of the one a step ago.
pub type Instants = [f64; 2];

/// How the spheres of a patch belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Belonging {
    /// g = 0 for each two.
    Apart,
    /// g = 1 for each two.
    Together,
    /// Each two as they stand.
    EachTwo,
}

/// All spheres of a wall near a grain.
pub struct Patch<'a, F> {
    law: PatchLaw,
    count: usize,
    touch: F,
    /// Number of the one that is pressed deepest.
    deepest: usize,
    /// 1 over the largest energy of one alone.
    scales: Instants,
    /// (Σ y)^(−3/4) over the largest, where all belong together.
    powers: Instants,
    /// Which spheres belong to one contact.
    pub belonging: Belonging,
    /// What [`Patch::terms`] gives of each; empty where it is not known.
    pub known: &'a [[Instants; 2]],
}

impl<F: Fn(usize) -> Touch> Patch<'_, F> {
    /// `None` where at most one of `count` is touched.
    #[inline(always)]
    pub fn of(law: PatchLaw, count: usize, touch: F) -> Option<Self> {
        let (mut touched, mut deepest, mut largest) = (0, 0, 0.0);
        for k in 0..count {
            let of = touch(k);
            if of.overlap > 0.0 {
                touched += 1;
            }
            if of.energy() > largest {
                (largest, deepest) = (of.energy(), k);
            }
        }
        if touched < 2 {
            return None;
        }
        let mut new = Patch {
            law,
            count,
            touch,
            deepest,
            scales: [0.0; 2],
            powers: [0.0; 2],
            belonging: Belonging::Apart,
            known: &[],
        };
        let together = new.together();
        if !together && new.apart() {
            return Some(new);
        }
        let mut most_before = 0.0;
        for k in 0..count {
            most_before = larger((new.touch)(k).energy_before(law), most_before);
        }
        new.scales = [largest, most_before].map(|most| if most > FAINTEST { 1.0 / most } else { 0.0 });
        new.belonging = Belonging::EachTwo;
        if together {
            let mut sums = [0.0; 2];
            for k in 0..count {
                let [now, before] = new.weights(&(new.touch)(k));
                sums = [sums[0] + now, sums[1] + before];
            }
            (new.belonging, new.powers) = (Belonging::Together, sums.map(power));
        }
        Some(new)
    }

    /// Whether g = 1 for each two, as far as the angles from the deepest tell.
    #[inline(always)]
    fn together(&self) -> bool {
        let (middle, mut together) = ((self.touch)(self.deepest), true);
        for k in 0..self.count {
            let of = (self.touch)(k);
            together &= !of.counts() || of.cosine(&middle).exceeds(TOGETHER);
        }
        together
    }

    /// Whether g = 0 for each two.
    #[inline(always)]
    fn apart(&self) -> bool {
        let mut apart = true;
        for a in 0..self.count {
            let one = (self.touch)(a);
            if !one.counts() {
                continue;
            }
            for b in a + 1..self.count {
                let other = (self.touch)(b);
                apart &= !(other.counts() && one.cosine(&other).coupling() > 0.0);
            }
        }
        apart
    }

    /// u of a sphere over the largest.
    #[inline(always)]
    fn energies(&self, of: &Touch) -> Instants {
        [of.energy() * self.scales[0], of.energy_before(self.law) * self.scales[1]]
    }

    /// y of a sphere over the largest.
    #[inline(always)]
    fn weights(&self, of: &Touch) -> Instants {
        self.energies(of).map(fourth)
    }

    /// D^(−3/4) and y D^(−7/4) of sphere `k`.
    #[inline(always)]
    pub fn terms(&self, k: usize) -> [Instants; 2] {
        if let Some(known) = self.known.get(k) {
            return *known;
        }
        let (of, mut sums) = ((self.touch)(k), [0.0; 2]);
        for other in 0..self.count {
            let other = (self.touch)(other);
            let (coupling, [now, before]) = (of.cosine(&other).coupling(), self.weights(&other));
            sums = [sums[0] + coupling * now, sums[1] + coupling * before];
        }
        let (weights, powers) = (self.weights(&of), sums.map(power));
        let term = |t: usize| if weights[t] > 0.0 { weights[t] / sums[t] * powers[t] } else { 0.0 };
        [powers, [term(0), term(1)]]
    }

    /// h of sphere `k`.
    #[inline(always)]
    pub fn shares(&self, k: usize) -> Instants {
        let of = (self.touch)(k);
        if self.belonging == Belonging::Apart {
            return [of.overlap, of.before].map(|overlap| if overlap > 0.0 { 1.0 } else { 0.0 });
        }
        let cubes = self.energies(&of).map(|energy| energy * energy * energy);
        if self.belonging == Belonging::Together {
            return [cubes[0] * self.powers[0], cubes[1] * self.powers[1]];
        }
        let mut less = [0.0; 2];
        for other in 0..self.count {
            let coupling = of.cosine(&(self.touch)(other)).coupling();
            let [_, [now, before]] = self.terms(other);
            less = [less[0] + coupling * now, less[1] + coupling * before];
        }
        let [powers, _] = self.terms(k);
        // Between two that do not belong together, one that belongs to both would pull: it carries nothing.
        let share = |t: usize| larger(4.0 * cubes[t] * (powers[t] - 0.75 * less[t]), 0.0);
        [share(0), share(1)]
    }

    /// What all forces do together, with the share of each now.
    #[inline(always)]
    pub fn push(&self, bodies: &Bodies, share: impl Fn(usize) -> f64) -> Push {
        let mut all = Vec3::zeros();
        for k in 0..self.count {
            let of = (self.touch)(k);
            all += of.normal * (share(k) * of.force);
        }
        let along = all.dot(&bodies.direction) * bodies.wall;
        let mut push = Push { all, along, pace: 0.0 };
        let of = (self.touch)(self.deepest);
        push.pace = push.moves(&of, share(self.deepest), bodies).pace();
        push
    }

    /// Numbers of sphere `k`, with its shares.
    #[inline(always)]
    pub fn numbers(&self, k: usize, push: &Push, bodies: &Bodies, shares: Instants) -> [f64; PATCH] {
        let of = (self.touch)(k);
        if of.overlap <= 0.0 {
            return ALONE;
        }
        let [now, before] = shares;
        let change = if before == now { 1.0 } else { (before / larger(now, LEAST)).min(MOST) };
        let [mass, inverse] = push.moves(&of, now, bodies).numbers(push.pace, bodies.inverse_mass);
        [now, change, mass, inverse]
    }
}

/// What all forces of a patch do together.
pub struct Push {
    /// Σ N n, up to a factor that all have.
    all: Vec3,
    /// Of it what accelerates the wall, over its mass.
    along: f64,
    /// [`DampedMass::pace`] of the sphere that is pressed deepest.
    pace: f64,
}

impl Push {
    /// What moves a sphere of this share.
    #[inline(always)]
    fn moves(&self, of: &Touch, share: f64, bodies: &Bodies) -> DampedMass {
        let along = of.normal.dot(&bodies.direction);
        let own = bodies.inverse_mass + along * along * bodies.wall;
        let by_all = of.normal.dot(&self.all) * bodies.inverse_mass + along * self.along;
        DampedMass::new(of.overlap, share * of.force, own, by_all)
    }
}

/// A grain, and a wall that forces may move in one direction.
#[derive(Debug, Clone, Copy)]
pub struct Bodies {
    /// 1/m of the grain [1/kg].
    pub inverse_mass: f64,
    /// In which the wall moves [–].
    pub direction: Vec3,
    /// 1/M of the wall; 0 where forces do not move it [1/kg].
    pub wall: f64,
}

impl Bodies {
    /// Numbers of a contact with the normal n that is alone.
    #[inline(always)]
    pub fn alone(&self, normal: &Vec3) -> [f64; PATCH] {
        let along = normal.dot(&self.direction);
        let own = self.inverse_mass + along * along * self.wall;
        [1.0, 1.0, self.inverse_mass / own, own / self.inverse_mass]
    }
}
