//! Contact effects: each is one file, written once for any lane, and composed by type.
//!
//! A file holds the formula ([`Effect`]), how a contact law asks for it ([`ContactEffect`]) and what the rest of the program needs to
//! know of it ([`Description`]). `registry.rs` lists the files, a line each. `(A, B)` applies A, then B; its history is A's and
//! B's. `()` is no effect, no code, no history. A scene's composition is chosen once, outside the time loop (`dem/src/model/compose.rs`).

mod capped_spring;
mod cohesion;
mod compositions;
mod constant_rolling;
mod contact_history;
mod damping;
mod describe;
mod friction;
mod hertz;
mod history;
mod hooke;
mod hooke_direct;
mod jkr;
mod law;
mod material;
mod messages;
mod numbers;
mod pair;
mod registry;
mod rolling_resistance;
mod sliding_friction;
mod table;
mod twisting_resistance;
mod walton_braun;
mod weakening;

pub use cohesion::Cohesion;
pub use constant_rolling::ConstantRolling;
pub use contact_history::{ContactHistory, RECORDED};
pub use damping::{Damping, NORMAL_DAMPING, RESTITUTION, damping_ratio, damping_ratios};
pub use describe::*;
pub use friction::Friction;
pub use hertz::Hertz;
pub use history::History;
pub use hooke::{Hooke, TANGENTIAL};
pub use hooke_direct::{Linear, MODULI, by_modulus};
pub use jkr::Jkr;
pub use law::ContactLaw;
pub use material::{Compliance, Elastic, Material, OverlapLimit};
pub use messages::{Dropped, needed};
pub use numbers::Numbers;
pub use pair::{Pair, tangential_ratio};
pub use registry::{DESCRIPTIONS, active, keys, models, without};
pub use rolling_resistance::RollingResistance;
pub use sliding_friction::{Coefficient, SlidingFriction};
pub use table::table;
pub use twisting_resistance::TwistingResistance;
pub use walton_braun::WaltonBraun;
pub use weakening::Weakening;

use crate::simd::{Lane, V};

/// What effects know of a contact; i is pushed along the normal.
#[derive(Clone, Copy)]
pub struct Contact<R: Lane> {
    /// Where the two act on each other: they touch, or a contact that was made lasts ([`Effect::reach`]).
    pub touching: R::Mask,
    /// n, from j to i [–].
    pub normal: V<R>,
    /// δ, positive in contact; the mean of the part of the kick in which both act on each other [m].
    pub overlap: R,
    /// δ at the instant itself, which is what springs hold [m].
    pub present: R,
    /// 1 where the two act on each other for a part of the kick only, else 0 [–].
    pub partial: R,
    /// δ a step ago [m].
    pub before: R,
    /// R* [m].
    pub radius: R,
    /// The smaller radius [m].
    pub smaller: R,
    /// Share of the stiffness of a contact alone, where a grain touches several spheres of a wall ([`crate::contact::patch`]); else 1 [–].
    pub share: R,
    /// The same a step ago, over the one now [–].
    pub share_before: R,
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
    /// Arm at which n × F_t turns the two against each other, (a_i/I_i − a_j/I_j)/(1/I_i + 1/I_j) with a the arm of each [m]; of contacts with torques.
    pub lever: R,
    /// Inertia against turning against each other, 1/(1/I_i + 1/I_j) [kg·m²]; of contacts with torques.
    pub inertia: R,
    /// ∂F_n/∂δ that the step before had, 0 where it is not known [N/m]; the ledger alone asks for it.
    pub stiffness_last: R,
    /// How far the two turn together about n in a step, ½ (ω_i + ω_j)·n Δt [rad].
    pub turn: R,
}

/// What effects make of it.
#[derive(Clone, Copy)]
pub struct Response<R: Lane> {
    /// F_n [N], repulsion positive.
    pub normal: R,
    /// What caps friction, rolling and twisting resistance [N]: F_n without the pull of cohesion.
    pub pressing: R,
    /// ∂F_n/∂δ, without damping [N/m].
    pub stiffness: R,
    /// The same a step ago, over the one now [–].
    pub stiffness_before: R,
    /// ∂F_n/∂δ a step ago, also of a contact that has just ended [N/m]; the ledger alone asks for it.
    pub stiffness_last: R,
    /// √(∂F_n/∂δ m*): what all dashpots are a share of, and the root of a contact that is taken once [N·s/m].
    pub impedance: R,
    /// F_t on i [N].
    pub tangential: V<R>,
    /// Couple on i [N·m]; j gets its opposite.
    pub torque: V<R>,
    /// Elastic energy in the contact [J].
    pub elastic: R,
    /// Energy dissipated in this step: by the normal law, sliding, rolling, twisting [J].
    pub dissipated: [R; DISSIPATORS],
    /// Energy that the normal law loses at once, at this instant [J].
    pub lost: R,
}

impl<R: Lane> Response<R> {
    /// ∂F_n/∂δ a step ago: over the one now as springs take it, and as they held energy [–], and of a contact that has just ended [N/m].
    #[inline(always)]
    pub fn earlier(&self, contact: &Contact<R>) -> [R; 3] {
        let last = contact.stiffness_last;
        let known = last.gt(R::splat(0.0));
        let booked = last / self.stiffness.max(R::splat(R::TINY));
        let ended = R::select(known, last, self.stiffness_last);
        [self.stiffness_before, R::select(known, booked, self.stiffness_before), ended]
    }

    /// No force.
    #[inline(always)]
    pub fn zero() -> Response<R> {
        let zero = R::splat(0.0);
        Response {
            normal: zero,
            pressing: zero,
            stiffness: zero,
            stiffness_before: zero,
            stiffness_last: zero,
            impedance: zero,
            tangential: V::zero(),
            torque: V::zero(),
            elastic: zero,
            dissipated: [zero; DISSIPATORS],
            lost: zero,
        }
    }

    /// What acts for this share of a step only.
    #[inline(always)]
    pub fn shorten(&mut self, share: R) {
        self.normal = self.normal * share;
        self.tangential = self.tangential.scale(share);
        self.torque = self.torque.scale(share);
    }

    /// Adds what an effect of this slot dissipates in the step [J].
    #[inline(always)]
    pub fn dissipate(&mut self, slot: Slot, energy: R) {
        let sum = &mut self.dissipated[slot.ledger()];
        *sum = *sum + energy;
    }
}

/// How contact laws ask for an effect.
pub trait ContactEffect: Effect {
    /// What the program knows of it: one description, or one for each way of asking.
    const DESCRIPTIONS: &'static [&'static Description];
    /// The effect of a pair whose law asks for it.
    fn new(pair: &Pair) -> Self;
    /// The effect of a pair; `None` where its law does not ask for it.
    fn of(pair: &Pair) -> Option<Self> {
        Self::DESCRIPTIONS.iter().any(|d| d.asked_for(pair.law)).then(|| Self::new(pair))
    }
}

/// An effect of contact.
pub trait Effect: Numbers + Send + Sync + 'static {
    /// Memory of one contact between steps.
    type History<R: Lane>: History<R>;
    /// Numbers of history for each contact.
    const HISTORY: usize = <Self::History<f64> as History<f64>>::COLUMNS;
    /// Whether it turns particles: without any such effect there is no rotation at all.
    const ROTATES: bool = false;
    /// Whether it makes a torque besides the moment of the tangential force.
    const TORQUES: bool = false;
    /// Whether a contact that was made lasts beyond touching.
    const REACHES: bool = false;

    /// Adds to the response; `dt` is the time of the step in which both act on each other [s].
    fn apply<R: Lane>(
        &self,
        contact: &Contact<R>,
        dt: R,
        history: &mut Self::History<R>,
        response: &mut Response<R>,
    );

    /// Gap up to which the contact still acts [m]: 0 where none was made; `radius` is R* [m].
    #[inline(always)]
    fn reach<R: Lane>(&self, _radius: R, _memory: &Self::History<R>) -> R {
        R::splat(0.0)
    }
}

impl Effect for () {
    type History<R: Lane> = ();
    #[inline(always)]
    fn apply<R: Lane>(&self, _: &Contact<R>, _: R, _: &mut (), _: &mut Response<R>) {}
}

/// An effect that may be absent at run time: for what is rare and keeps no history, so that there need not be a composition with it
/// and one without. Absent, it costs a question for each group of contacts.
impl<E: Effect> Effect for Option<E> {
    type History<R: Lane> = E::History<R>;
    const ROTATES: bool = E::ROTATES;
    const TORQUES: bool = E::TORQUES;
    const REACHES: bool = E::REACHES;
    #[inline(always)]
    fn apply<R: Lane>(
        &self,
        c: &Contact<R>,
        dt: R,
        history: &mut Self::History<R>,
        response: &mut Response<R>,
    ) {
        if let Some(effect) = self {
            effect.apply(c, dt, history, response);
        }
    }
    #[inline(always)]
    fn reach<R: Lane>(&self, radius: R, history: &Self::History<R>) -> R {
        self.map_or(R::splat(0.0), |effect| effect.reach(radius, history))
    }
}

impl<A: Effect, B: Effect> Effect for (A, B) {
    type History<R: Lane> = (A::History<R>, B::History<R>);
    const ROTATES: bool = A::ROTATES || B::ROTATES;
    const TORQUES: bool = A::TORQUES || B::TORQUES;
    const REACHES: bool = A::REACHES || B::REACHES;
    #[inline(always)]
    fn apply<R: Lane>(
        &self,
        c: &Contact<R>,
        dt: R,
        history: &mut Self::History<R>,
        response: &mut Response<R>,
    ) {
        self.0.apply(c, dt, &mut history.0, response);
        self.1.apply(c, dt, &mut history.1, response);
    }
    #[inline(always)]
    fn reach<R: Lane>(&self, radius: R, history: &Self::History<R>) -> R {
        match (A::REACHES, B::REACHES) {
            (true, true) => self.0.reach(radius, &history.0).max(self.1.reach(radius, &history.1)),
            (true, false) => self.0.reach(radius, &history.0),
            (false, _) => self.1.reach(radius, &history.1),
        }
    }
}
