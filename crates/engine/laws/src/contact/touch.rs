//! A grain beside one sphere of a wall: how deep, and what their contact would hold alone.

use crate::float::Float;
use crate::simd::{Row, cube_root};
use primitives::Vec3;

/// g = clamp(a x − b, 0, 1), a and b.
const COUPLING: [f64; 2] = [4.0, 2.3];

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
    /// Gap up to which the contact of a grain in `row` and a sphere in `other` lasts, if it was made or is being made [m].
    #[inline(always)]
    pub fn held(self, row: &Row, other: &Row, made: bool) -> f64 {
        if self.gap == 0.0 {
            return 0.0;
        }
        let reach = row.radius() + other.radius();
        let touches = (row.position() - other.position()).norm_squared() < reach * reach;
        if made || touches { self.gap * cube_root(row.radius() * other.radius() / reach) } else { 0.0 }
    }

    /// Force of a sphere alone, up to a factor that all spheres share; its energy is this × δ, up to another.
    #[inline(always)]
    fn alone(self, overlap: f64, radius: f64) -> f64 {
        if self.hertz { (radius * overlap).root() * overlap } else { overlap }
    }
}

/// A grain beside one sphere of a wall.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// δ, its mean in the part of a kick in which both touch; 0 where they do not [m].
    pub overlap: f64,
    /// The same a step ago [m].
    pub before: f64,
    /// Force alone at this overlap, up to a factor that all spheres share.
    pub force: f64,
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
    pub fn of(law: PatchLaw, [dt, ahead]: [f64; 2], row: &Row, other: &Row, held: f64) -> Touch {
        let apart = row.position() - other.position();
        let (distance, reach) = (apart.norm_squared().root(), row.radius() + other.radius());
        // One division for both.
        let inverse = 1.0 / (distance * reach);
        let normal = apart * (inverse * reach);
        let now = reach - distance + held;
        let approach = -(row.velocity() - other.velocity()).dot(&normal);
        let way = if approach < 0.0 { -approach } else { approach } * ahead;
        let mean = |overlap: f64| if way > overlap { 0.5 * (overlap + way) } else { overlap };
        let positive = |overlap: f64| if overlap > 0.0 { overlap } else { 0.0 };
        let radius = if other.radius() > 0.0 {
            row.radius() * other.radius() * (inverse * distance)
        } else {
            row.radius()
        };
        let (overlap, before) = (positive(mean(now)), positive(mean(now - approach * dt)));
        let force = law.alone(overlap, radius);
        Touch { overlap, before, force, radius, normal, centre: other.position(), reach }
    }

    /// Energy alone now, up to a factor that all spheres share; 0 where they do not touch.
    #[inline(always)]
    pub fn energy(&self) -> f64 {
        self.force * self.overlap
    }

    /// The same a step ago.
    #[inline(always)]
    pub fn energy_before(&self, law: PatchLaw) -> f64 {
        law.alone(self.before, self.radius) * self.before
    }

    /// Whether both touch, or did a step ago.
    #[inline(always)]
    pub fn counts(&self) -> bool {
        self.overlap > 0.0 || self.before > 0.0
    }

    /// x of two spheres, as a fraction.
    #[inline(always)]
    pub fn cosine(&self, other: &Touch) -> Fraction {
        let (a, b) = (self.reach, other.reach);
        let over = a * a + b * b - (self.centre - other.centre).norm_squared();
        Fraction { over, under: 2.0 * (a * b) }
    }
}

/// A number whose denominator is positive; most are compared only, which takes no division.
#[derive(Debug, Clone, Copy)]
pub struct Fraction {
    over: f64,
    under: f64,
}

impl Fraction {
    /// Whether it is above `x`.
    #[inline(always)]
    pub fn exceeds(self, x: f64) -> bool {
        self.over > x * self.under
    }

    /// g of two spheres of this cosine ([`crate::contact::patch`]).
    #[inline(always)]
    pub fn coupling(self) -> f64 {
        let [slope, less] = COUPLING;
        if self.exceeds(less / slope) {
            (slope * (self.over / self.under) - less).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}
