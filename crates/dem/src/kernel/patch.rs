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

#[cfg(target_arch = "nvptx64")]
use crate::float::Float as _;
use crate::simd::Row;
use geom::Vec3;

/// Numbers of a contact: share of its stiffness, the share a step ago over that, and by what m* and 1/m* are multiplied [–].
pub const PATCH: usize = 4;
/// Those of a contact by itself.
pub const ALONE: [f64; PATCH] = [1.0; PATCH];

/// Cosine of the angle from the deepest sphere within which all belong together: half of what g = 1 allows for each two, with a margin.
const TOGETHER: f64 = 0.957;
/// Below this share a contact counts as none where one is divided by another.
const LEAST: f64 = 1e-30;
/// Largest factor of a contact: those that hardly touch, of which nothing depends on it, stay within single precision.
const MOST: f64 = 1e6;

/// How the elastic energy of a normal law grows, and whether the contacts of a grain with a wall share it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchLaw {
    /// Whether they do, as those with spheres; else each acts by itself, for the mass that it moves.
    pub shared: bool,
    /// u ∝ √R* δ^(5/2), else u ∝ δ².
    pub hertz: bool,
    /// Gap at which a contact that was made breaks, for R* = 1 m, from where overlaps count [m]; 0 without adhesion.
    pub gap: f64,
}

impl PatchLaw {
    /// Energy and force of a sphere alone, up to a factor that all spheres share.
    #[inline(always)]
    pub fn alone(self, overlap: f64, radius: f64) -> [f64; 2] {
        if self.hertz {
            let root = (radius * overlap).sqrt();
            [root * overlap * overlap, root * overlap]
        } else {
            [overlap * overlap, overlap]
        }
    }
}

/// A grain beside one sphere of a wall.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// δ, its mean in the part of a kick in which both touch; 0 where they do not [m].
    pub overlap: f64,
    /// The same a step ago [m].
    pub before: f64,
    /// R* [m].
    pub radius: f64,
    /// n, from the wall to the grain [–].
    pub normal: Vec3,
    /// Centre of the sphere [m].
    pub centre: Vec3,
    /// r + R [m].
    pub reach: f64,
}

impl Touch {
    /// Of a grain in `row` and a sphere in `other`, whose contact lasts up to a gap of `held` [m]; in steps of `dt`, of which the part `ahead` is looked
    /// ahead where contacts are averaged over a kick [s].
    #[inline(always)]
    pub fn of([dt, ahead]: [f64; 2], row: &Row, other: &Row, held: f64) -> Touch {
        let apart = row.position() - other.position();
        let (distance, reach) = (apart.norm_squared().sqrt(), row[3] + other[3]);
        let normal = apart / distance;
        let now = reach - distance + held;
        let approach = -(row.velocity() - other.velocity()).dot(&normal);
        let way = if approach < 0.0 { -approach } else { approach } * ahead;
        let mean = |overlap: f64| if way > overlap { 0.5 * (overlap + way) } else { overlap };
        let positive = |overlap: f64| if overlap > 0.0 { overlap } else { 0.0 };
        let radius = if other[3] > 0.0 { row[3] * other[3] / reach } else { row[3] };
        let (overlap, before) = (positive(mean(now)), positive(mean(now - approach * dt)));
        Touch { overlap, before, radius, normal, centre: other.position(), reach }
    }

    /// g of two spheres.
    #[inline(always)]
    fn coupling(&self, other: &Touch) -> f64 {
        (4.0 * self.cosine(other) - 2.3).clamp(0.0, 1.0)
    }

    /// Cosine of the angle at which a grain touches both at once.
    #[inline(always)]
    fn cosine(&self, other: &Touch) -> f64 {
        let (a, b) = (self.reach, other.reach);
        (a * a + b * b - (self.centre - other.centre).norm_squared()) / (2.0 * (a * b))
    }
}

/// x^(−3/4).
#[inline(always)]
fn power(x: f64) -> f64 {
    let root = x.sqrt();
    1.0 / (root * root.sqrt())
}

/// The larger of two numbers.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Which instant a share is of: this one, or the one a step ago.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instant {
    Now,
    Before,
}

impl Instant {
    /// Both, in order.
    pub const BOTH: [Instant; 2] = [Instant::Now, Instant::Before];
}

/// All spheres of a wall near a grain.
pub struct Patch<'a, F> {
    law: PatchLaw,
    count: usize,
    touch: F,
    /// Number of the one that is pressed deepest.
    deepest: usize,
    /// Largest energy of one alone, now and a step ago.
    largest: [f64; 2],
    /// Σ y now and a step ago, over the largest.
    sums: [f64; 2],
    /// Whether g = 1 for all.
    pub together: bool,
    /// What [`Patch::terms`] gives of each, now and a step ago; empty where it is not known.
    pub known: &'a [[[f64; 2]; 2]],
}

impl<F: Fn(usize) -> Touch> Patch<'_, F> {
    /// `None` where at most one of `count` is touched.
    #[inline(always)]
    pub fn of(law: PatchLaw, count: usize, touch: F) -> Option<Self> {
        let (mut touched, mut deepest, mut largest) = (0, 0, [0.0; 2]);
        for k in 0..count {
            let of = touch(k);
            if of.overlap > 0.0 {
                touched += 1;
            }
            let [now, before] = [of.overlap, of.before].map(|overlap| law.alone(overlap, of.radius)[0]);
            if now > largest[0] {
                (largest[0], deepest) = (now, k);
            }
            largest[1] = larger(before, largest[1]);
        }
        if touched < 2 {
            return None;
        }
        let mut new =
            Patch { law, count, touch, deepest, largest, sums: [0.0; 2], together: true, known: &[] };
        let middle = (new.touch)(deepest);
        for k in 0..count {
            let of = (new.touch)(k);
            if of.overlap > 0.0 || of.before > 0.0 {
                new.together &= of.cosine(&middle) >= TOGETHER;
                new.sums[0] += new.weight(&of, Instant::Now);
                new.sums[1] += new.weight(&of, Instant::Before);
            }
        }
        Some(new)
    }

    /// Where sphere `k` is.
    #[inline(always)]
    pub fn touch(&self, k: usize) -> Touch {
        (self.touch)(k)
    }

    /// u of a sphere over the largest.
    #[inline(always)]
    fn energy(&self, of: &Touch, instant: Instant) -> f64 {
        let overlap = if instant == Instant::Now { of.overlap } else { of.before };
        let [energy, _] = self.law.alone(overlap, of.radius);
        if energy > 0.0 { energy / self.largest[instant as usize] } else { 0.0 }
    }

    /// y of a sphere over the largest.
    #[inline(always)]
    fn weight(&self, of: &Touch, instant: Instant) -> f64 {
        let energy = self.energy(of, instant);
        let square = energy * energy;
        square * square
    }

    /// D^(−3/4) and y D^(−7/4) of sphere `k`.
    #[inline(always)]
    pub fn terms(&self, k: usize, instant: Instant) -> [f64; 2] {
        if let Some(known) = self.known.get(k) {
            return known[instant as usize];
        }
        let (of, mut sum) = (self.touch(k), 0.0);
        let weight = self.weight(&of, instant);
        if weight == 0.0 {
            return [0.0; 2];
        }
        for other in 0..self.count {
            let other = self.touch(other);
            sum += of.coupling(&other) * self.weight(&other, instant);
        }
        let power = power(sum);
        [power, weight / sum * power]
    }

    /// h of sphere `k`.
    #[inline(always)]
    pub fn share(&self, k: usize, instant: Instant) -> f64 {
        let of = self.touch(k);
        let energy = self.energy(&of, instant);
        if energy == 0.0 {
            return 0.0;
        }
        let cube = energy * energy * energy;
        if self.together {
            return cube * power(self.sums[instant as usize]);
        }
        let mut less = 0.0;
        for k in 0..self.count {
            less += of.coupling(&self.touch(k)) * self.terms(k, instant)[1];
        }
        // Between two that do not belong together, one that belongs to both would pull: it carries nothing.
        larger(4.0 * cube * (self.terms(k, instant)[0] - 0.75 * less), 0.0)
    }

    /// N of sphere `k` with a share of its stiffness, up to a factor that all have.
    #[inline(always)]
    fn force(&self, k: usize, share: f64) -> f64 {
        let of = self.touch(k);
        share * self.law.alone(of.overlap, of.radius)[1]
    }

    /// Σ N n, with the share of each.
    #[inline(always)]
    pub fn push(&self, share: impl Fn(usize) -> f64) -> Vec3 {
        let mut push = Vec3::zeros();
        for k in 0..self.count {
            push += self.touch(k).normal * self.force(k, share(k));
        }
        push
    }

    /// What moves sphere `k` of this share, where all together `push`.
    #[inline(always)]
    fn moved(&self, k: usize, share: f64, push: &Vec3, bodies: &Bodies) -> DampedMass {
        let of = self.touch(k);
        let (n, d) = (&of.normal, &bodies.direction);
        let along = n.dot(d);
        let own = bodies.inverse_mass + along * along * bodies.wall;
        let by_all = n.dot(push) * bodies.inverse_mass + along * push.dot(d) * bodies.wall;
        DampedMass::new(of.overlap, self.force(k, share), own, by_all)
    }

    /// Numbers of sphere `k`, where all together `push`, with the share of each.
    #[inline(always)]
    pub fn numbers(
        &self,
        k: usize,
        push: &Vec3,
        bodies: &Bodies,
        share: impl Fn(usize) -> [f64; 2],
    ) -> [f64; PATCH] {
        if self.touch(k).overlap <= 0.0 {
            return ALONE;
        }
        let [now, before] = share(k);
        let deepest = self.moved(self.deepest, share(self.deepest)[0], push, bodies);
        let change = (before / larger(now, LEAST)).min(MOST);
        self.moved(k, now, push, bodies).numbers([now, change], &deepest, bodies.inverse_mass)
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

/// What moves one contact of two bodies.
#[derive(Debug, Clone, Copy)]
pub struct DampedMass {
    /// δ [m].
    overlap: f64,
    /// N, up to a factor.
    force: f64,
    /// 1/m_i [1/kg].
    inverse: f64,
}

impl DampedMass {
    /// Of a contact with a force N, which yields `own` [1/kg] to it, and is accelerated by `by_all` (as N/kg) by all forces of the pair of bodies.
    #[inline(always)]
    pub fn new(overlap: f64, force: f64, own: f64, by_all: f64) -> DampedMass {
        let inverse = if force > 0.0 { larger(by_all / force, own) } else { own };
        DampedMass { overlap, force, inverse }
    }

    /// The numbers of a contact whose `shares` are known, in a contact loop that knows `inverse_mass`. What a finite step does to its dashpot depends on how
    /// fast the pair moves, S/m* of the `deepest`: 1/m* is such that this is its own, too.
    #[inline(always)]
    pub fn numbers(&self, shares: [f64; 2], deepest: &DampedMass, inverse_mass: f64) -> [f64; PATCH] {
        let pace = deepest.force * deepest.inverse / deepest.overlap;
        let stiffness = self.force / self.overlap;
        let inverse = if stiffness > 0.0 { pace / stiffness } else { self.inverse };
        [shares[0], shares[1], inverse_mass / self.inverse, (inverse / inverse_mass).min(MOST)]
    }
}
