//! Contact effects: each is one file, written once for any lane, and composed by type.
//!
//! `(A, B)` applies A, then B; its memory is A's and B's. `()` is no effect, no code, no memory. The scene
//! picks the composition once, outside the time loop ([`crate::interaction`]).

mod capped_spring;
mod hertz;
mod hooke;
mod rolling_resistance;
mod sliding_friction;

pub use hertz::Hertz;
pub use hooke::Hooke;
pub use rolling_resistance::RollingResistance;
pub use sliding_friction::SlidingFriction;

use crate::lane::{BLOCK, Lane, V};

/// What effects know of a contact; i is pushed along the normal.
#[derive(Clone, Copy)]
pub struct Contact<R: Lane> {
    /// Where the two touch.
    pub touching: R::Mask,
    /// n, from j to i [–].
    pub normal: V<R>,
    /// δ, positive in contact [m].
    pub overlap: R,
    /// R* [m].
    pub radius: R,
    /// m* [kg].
    pub mass: R,
    /// Rate at which the overlap grows, −v·n [m/s].
    pub approach: R,
    /// v_t: velocity of i's surface relative to j's at the contact, in the tangent plane [m/s].
    pub slip: V<R>,
    /// ω_i − ω_j [rad/s].
    pub spin: V<R>,
}

/// What effects make of it.
#[derive(Clone, Copy)]
pub struct Load<R: Lane> {
    /// F_n [N], repulsion positive.
    pub normal: R,
    /// ∂F_n/∂δ, without damping [N/m].
    pub stiffness: R,
    /// The same a step ago, over the one now [–].
    pub stiffness_before: R,
    /// F_t on i [N].
    pub tangential: V<R>,
    /// Couple on i [N·m]; j gets its opposite.
    pub couple: V<R>,
    /// Elastic energy in the contact [J].
    pub elastic: R,
    /// Energy dissipated in this step: by the normal law, sliding, rolling [J].
    pub dissipated: [R; 3],
}

impl<R: Lane> Load<R> {
    /// No load.
    #[inline(always)]
    pub fn zero() -> Load<R> {
        let zero = R::splat(0.0);
        Load {
            normal: zero,
            stiffness: zero,
            stiffness_before: zero,
            tangential: V::zero(),
            couple: V::zero(),
            elastic: zero,
            dissipated: [zero; 3],
        }
    }
}

/// An effect of contact.
pub trait Effect: Copy + Send + Sync + 'static {
    /// Memory of one contact between steps.
    type Memory<R: Lane>: Memory<R>;
    /// Numbers of memory for each contact.
    const MEMORY: usize = <Self::Memory<f64> as Memory<f64>>::COLUMNS;
    /// Whether it turns particles: without any such effect there is no rotation at all.
    const ROTATES: bool;
    /// Whether it makes a couple besides the moment of the tangential force.
    const COUPLES: bool;

    /// Adds to the load; `dt` [s].
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, memory: &mut Self::Memory<R>, load: &mut Load<R>);
}

/// Memory that is stored as columns of numbers.
pub trait Memory<R: Lane>: Copy {
    /// Numbers for each contact.
    const COLUMNS: usize;
    /// Reads the lanes from `lane` on in a block of columns, [`BLOCK`] apart.
    fn load(block: &[f64], lane: usize) -> Self;
    /// Writes them.
    fn store(self, block: &mut [f64], lane: usize);
    /// Forgets where the mask does not hold.
    fn keep(self, mask: R::Mask) -> Self;
    /// Whether column `c` changes its sign when i and j are the other way round.
    fn flips(c: usize) -> bool;
}

impl<R: Lane> Memory<R> for () {
    const COLUMNS: usize = 0;
    #[inline(always)]
    fn load(_: &[f64], _: usize) {}
    #[inline(always)]
    fn store(self, _: &mut [f64], _: usize) {}
    #[inline(always)]
    fn keep(self, _: R::Mask) {}
    fn flips(_: usize) -> bool {
        false
    }
}

impl<R: Lane> Memory<R> for V<R> {
    const COLUMNS: usize = 3;
    #[inline(always)]
    fn load(block: &[f64], lane: usize) -> V<R> {
        V::new(R::load(&block[lane..]), R::load(&block[BLOCK + lane..]), R::load(&block[2 * BLOCK + lane..]))
    }
    #[inline(always)]
    fn store(self, block: &mut [f64], lane: usize) {
        self.x.store(&mut block[lane..]);
        self.y.store(&mut block[BLOCK + lane..]);
        self.z.store(&mut block[2 * BLOCK + lane..]);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> V<R> {
        V::select(mask, self, V::zero())
    }
    fn flips(_: usize) -> bool {
        true
    }
}

impl<R: Lane, A: Memory<R>, B: Memory<R>> Memory<R> for (A, B) {
    const COLUMNS: usize = A::COLUMNS + B::COLUMNS;
    #[inline(always)]
    fn load(block: &[f64], lane: usize) -> (A, B) {
        (A::load(block, lane), B::load(&block[A::COLUMNS * BLOCK..], lane))
    }
    #[inline(always)]
    fn store(self, block: &mut [f64], lane: usize) {
        self.0.store(block, lane);
        self.1.store(&mut block[A::COLUMNS * BLOCK..], lane);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> (A, B) {
        (self.0.keep(mask), self.1.keep(mask))
    }
    fn flips(c: usize) -> bool {
        if c < A::COLUMNS { A::flips(c) } else { B::flips(c - A::COLUMNS) }
    }
}

impl Effect for () {
    type Memory<R: Lane> = ();
    const ROTATES: bool = false;
    const COUPLES: bool = false;
    #[inline(always)]
    fn apply<R: Lane>(&self, _: &Contact<R>, _: R, _: &mut (), _: &mut Load<R>) {}
}

impl<A: Effect, B: Effect> Effect for (A, B) {
    type Memory<R: Lane> = (A::Memory<R>, B::Memory<R>);
    const ROTATES: bool = A::ROTATES || B::ROTATES;
    const COUPLES: bool = A::COUPLES || B::COUPLES;
    #[inline(always)]
    fn apply<R: Lane>(&self, c: &Contact<R>, dt: R, memory: &mut Self::Memory<R>, load: &mut Load<R>) {
        self.0.apply(c, dt, &mut memory.0, load);
        self.1.apply(c, dt, &mut memory.1, load);
    }
}

/// Damping ratio of a linear oscillator that rebounds with restitution `e` when it is let go at δ = 0:
///
/// ```text
/// γ = −2 ln e / √(π² + ln² e),   c = γ √(k m*)         γ → 2 (critical) for e → 0
/// ```
///
/// Exact, by inversion of e = exp(−c t_c / 2m*), t_c = π / √(k/m* − (c/2m*)²).
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution <= 0.0 {
        return 2.0;
    }
    let ln = libm::log(restitution);
    -2.0 * ln / (std::f64::consts::PI * std::f64::consts::PI + ln * ln).sqrt()
}
