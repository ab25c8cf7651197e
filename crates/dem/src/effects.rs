//! Contact effects: each is one file, written once for any lane, and composed by type.
//!
//! `(A, B)` applies A, then B; its memory is A's and B's. `()` is no effect, no code, no memory. The scene
//! picks the composition once, outside the time loop (`law::compose`).

mod capped_spring;
mod cohesion;
mod constant_rolling;
mod hertz;
mod hooke;
mod jkr;
mod rolling_resistance;
mod sliding_friction;
mod twisting_resistance;
mod weakening;

pub use cohesion::Cohesion;
pub use constant_rolling::ConstantRolling;
pub use hertz::Hertz;
pub use hooke::Hooke;
pub use jkr::Jkr;
pub use rolling_resistance::RollingResistance;
pub use sliding_friction::{Coefficient, SlidingFriction};
pub use twisting_resistance::TwistingResistance;
pub use weakening::{Friction, Weakening};

use crate::lane::{BLOCK, Lane, V};
use crate::number::Number;

/// What effects know of a contact; i is pushed along the normal.
#[derive(Clone, Copy)]
pub struct Contact<R: Lane> {
    /// Where the two act on each other: they touch, or a contact that was made lasts ([`Effect::reach`]).
    pub touching: R::Mask,
    /// n, from j to i [–].
    pub normal: V<R>,
    /// δ, positive in contact [m].
    pub overlap: R,
    /// R* [m].
    pub radius: R,
    /// 1/(r_i + r_j), 0 at a flat wall [1/m].
    pub curvature: R,
    /// m* [kg].
    pub mass: R,
    /// 1/m* [1/kg].
    pub inverse_mass: R,
    /// Rate at which the overlap grows, −v·n [m/s].
    pub approach: R,
    /// v_t: velocity of i's surface relative to j's at the contact, in the tangent plane [m/s].
    pub slip: V<R>,
    /// ω_i − ω_j [rad/s].
    pub spin: V<R>,
    /// How far the two turn together about n in a step, ½ (ω_i + ω_j)·n Δt [rad].
    pub turn: R,
}

/// Kinds of dissipation that are told apart.
pub const DISSIPATORS: usize = 4;

/// What effects make of it.
#[derive(Clone, Copy)]
pub struct Load<R: Lane> {
    /// F_n [N], repulsion positive.
    pub normal: R,
    /// What caps friction, rolling and twisting resistance [N]: F_n without the pull of cohesion.
    pub pressing: R,
    /// ∂F_n/∂δ, without damping [N/m].
    pub stiffness: R,
    /// The same a step ago, over the one now [–].
    pub stiffness_before: R,
    /// √(∂F_n/∂δ m*): what all dashpots are a share of, and the root of a contact that is taken once [N·s/m].
    pub impedance: R,
    /// F_t on i [N].
    pub tangential: V<R>,
    /// Couple on i [N·m]; j gets its opposite.
    pub couple: V<R>,
    /// Elastic energy in the contact [J].
    pub elastic: R,
    /// Energy dissipated in this step: by the normal law, sliding, rolling, twisting [J].
    pub dissipated: [R; DISSIPATORS],
    /// Energy that the normal law loses at once, at this instant [J].
    pub lost: R,
}

impl<R: Lane> Load<R> {
    /// No load.
    #[inline(always)]
    pub fn zero() -> Load<R> {
        let zero = R::splat(0.0);
        Load {
            normal: zero,
            pressing: zero,
            stiffness: zero,
            stiffness_before: zero,
            impedance: zero,
            tangential: V::zero(),
            couple: V::zero(),
            elastic: zero,
            dissipated: [zero; DISSIPATORS],
            lost: zero,
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
    const ROTATES: bool = false;
    /// Whether it makes a couple besides the moment of the tangential force.
    const COUPLES: bool = false;
    /// Whether a contact that was made lasts beyond touching.
    const REACHES: bool = false;

    /// Adds to the load; `dt` [s].
    fn apply<R: Lane>(&self, contact: &Contact<R>, dt: R, memory: &mut Self::Memory<R>, load: &mut Load<R>);

    /// Gap up to which the contact still acts [m]: 0 where none was made; `radius` is R* [m].
    #[inline(always)]
    fn reach<R: Lane>(&self, _radius: R, _memory: &Self::Memory<R>) -> R {
        R::splat(0.0)
    }
}

/// Memory that is stored as columns of numbers.
pub trait Memory<R: Lane>: Copy {
    /// Numbers for each contact.
    const COLUMNS: usize;
    /// Reads the lanes from `lane` on in a block of columns, [`BLOCK`] apart.
    fn load<T: Number>(block: &[T], lane: usize) -> Self;
    /// Writes them.
    fn store<T: Number>(self, block: &mut [T], lane: usize);
    /// Forgets where the mask does not hold.
    fn keep(self, mask: R::Mask) -> Self;
    /// Whether a column changes its sign when i and j change places, as vectors do.
    fn flips(column: usize) -> bool;
}

impl<R: Lane> Memory<R> for () {
    const COLUMNS: usize = 0;
    #[inline(always)]
    fn load<T: Number>(_: &[T], _: usize) {}
    #[inline(always)]
    fn store<T: Number>(self, _: &mut [T], _: usize) {}
    #[inline(always)]
    fn keep(self, _: R::Mask) {}
    fn flips(_: usize) -> bool {
        false
    }
}

/// A number is the same seen from i and from j.
impl<R: Lane> Memory<R> for R {
    const COLUMNS: usize = 1;
    #[inline(always)]
    fn load<T: Number>(block: &[T], lane: usize) -> R {
        T::load(&block[lane..])
    }
    #[inline(always)]
    fn store<T: Number>(self, block: &mut [T], lane: usize) {
        T::store(self, &mut block[lane..]);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> R {
        R::select(mask, self, R::splat(0.0))
    }
    fn flips(_: usize) -> bool {
        false
    }
}

impl<R: Lane> Memory<R> for V<R> {
    const COLUMNS: usize = 3;
    #[inline(always)]
    fn load<T: Number>(block: &[T], lane: usize) -> V<R> {
        let (x, y, z) = (&block[lane..], &block[BLOCK + lane..], &block[2 * BLOCK + lane..]);
        V::new(T::load(x), T::load(y), T::load(z))
    }
    #[inline(always)]
    fn store<T: Number>(self, block: &mut [T], lane: usize) {
        T::store(self.x, &mut block[lane..]);
        T::store(self.y, &mut block[BLOCK + lane..]);
        T::store(self.z, &mut block[2 * BLOCK + lane..]);
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
    fn load<T: Number>(block: &[T], lane: usize) -> (A, B) {
        (A::load(block, lane), B::load(&block[A::COLUMNS * BLOCK..], lane))
    }
    #[inline(always)]
    fn store<T: Number>(self, block: &mut [T], lane: usize) {
        self.0.store(block, lane);
        self.1.store(&mut block[A::COLUMNS * BLOCK..], lane);
    }
    #[inline(always)]
    fn keep(self, mask: R::Mask) -> (A, B) {
        (self.0.keep(mask), self.1.keep(mask))
    }
    fn flips(column: usize) -> bool {
        if column < A::COLUMNS { A::flips(column) } else { B::flips(column - A::COLUMNS) }
    }
}

impl Effect for () {
    type Memory<R: Lane> = ();
    #[inline(always)]
    fn apply<R: Lane>(&self, _: &Contact<R>, _: R, _: &mut (), _: &mut Load<R>) {}
}

/// An effect that may be absent at run time: for what is rare and has no memory, so that there need not be a composition with it
/// and one without. Absent, it costs a question for each group of contacts.
impl<E: Effect> Effect for Option<E> {
    type Memory<R: Lane> = E::Memory<R>;
    const ROTATES: bool = E::ROTATES;
    const COUPLES: bool = E::COUPLES;
    const REACHES: bool = E::REACHES;
    #[inline(always)]
    fn apply<R: Lane>(&self, c: &Contact<R>, dt: R, memory: &mut Self::Memory<R>, load: &mut Load<R>) {
        if let Some(effect) = self {
            effect.apply(c, dt, memory, load);
        }
    }
    #[inline(always)]
    fn reach<R: Lane>(&self, radius: R, memory: &Self::Memory<R>) -> R {
        self.map_or(R::splat(0.0), |effect| effect.reach(radius, memory))
    }
}

impl<A: Effect, B: Effect> Effect for (A, B) {
    type Memory<R: Lane> = (A::Memory<R>, B::Memory<R>);
    const ROTATES: bool = A::ROTATES || B::ROTATES;
    const COUPLES: bool = A::COUPLES || B::COUPLES;
    const REACHES: bool = A::REACHES || B::REACHES;
    #[inline(always)]
    fn apply<R: Lane>(&self, c: &Contact<R>, dt: R, memory: &mut Self::Memory<R>, load: &mut Load<R>) {
        self.0.apply(c, dt, &mut memory.0, load);
        self.1.apply(c, dt, &mut memory.1, load);
    }
    #[inline(always)]
    fn reach<R: Lane>(&self, radius: R, memory: &Self::Memory<R>) -> R {
        match (A::REACHES, B::REACHES) {
            (true, true) => self.0.reach(radius, &memory.0).max(self.1.reach(radius, &memory.1)),
            (true, false) => self.0.reach(radius, &memory.0),
            (false, _) => self.1.reach(radius, &memory.1),
        }
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
