//! The list of effects, and the compositions of them that are compiled.
//!
//! Each composition is compiled for every width of lanes, with and without the ledger. So that they stay few, the laws and resistances
//! that most scenes use are compiled in every precision; all others in double precision only, where cohesion and the weakening of
//! friction, which keep nothing, are not compositions of their own but a question that is asked once for each group of contacts.

use super::cohesion::Cohesion;
use super::describe::{Description, Key, Slot};
use super::pair::Pair;
use super::rolling_resistance::RollingResistance;
use super::sliding_friction::SlidingFriction;
use super::weakening::Friction;
use super::{ContactEffect, Effect};
use crate::kernel::{Kernel, Narrow};
use crate::setup::{ContactLaw, Precision};

/// Lists the effects, a line for each slot, in the order in which they act.
macro_rules! effects {
    (every precision: $($common:ty),*; double precision: $($rare:ty),*; sliding: $($sliding:ty),*; rolling: $($rolling:ty),*;
     twisting: $($twisting:ty),*;) => {
        const LISTS: &[&[&Description]] = &[
            $(<$common>::DESCRIPTIONS,)* $(<$rare>::DESCRIPTIONS,)* Cohesion::DESCRIPTIONS, $(<$sliding>::DESCRIPTIONS,)*
            $(<$rolling>::DESCRIPTIONS,)* $(<$twisting>::DESCRIPTIONS,)*
        ];

        /// The effects of a pair, composed.
        pub fn compose(pair: &Pair, precision: Precision) -> Box<dyn Kernel> {
            let common = active(pair.law).all(|d| d.every_precision);
            $(if let Some(law) = <$common>::of(pair) {
                return if common { in_every_precision(pair, precision, law) } else { adhering(pair, law) };
            })*
            $(if let Some(law) = <$rare>::of(pair) { return adhering(pair, law); })*
            Box::new(())
        }

        fn sliding<E: Effect>(pair: &Pair, so_far: E) -> Box<dyn Kernel> {
            $(if let Some(effect) = <$sliding>::of(pair) { return rolling(pair, (so_far, effect)); })*
            Box::new(so_far)
        }

        fn rolling<E: Effect>(pair: &Pair, so_far: E) -> Box<dyn Kernel> {
            $(if let Some(effect) = <$rolling>::of(pair) { return twisting(pair, (so_far, effect)); })*
            twisting(pair, so_far)
        }

        fn twisting<E: Effect>(pair: &Pair, so_far: E) -> Box<dyn Kernel> {
            $(if let Some(effect) = <$twisting>::of(pair) { return Box::new((so_far, effect)); })*
            Box::new(so_far)
        }
    };
}

effects! {
    every precision: super::hooke::Hooke, super::hertz::Hertz;
    double precision: super::jkr::Jkr, super::walton_braun::WaltonBraun;
    sliding: SlidingFriction<Friction>;
    rolling: RollingResistance, super::constant_rolling::ConstantRolling;
    twisting: super::twisting_resistance::TwistingResistance;
}

/// Every effect there is, in the order in which they act.
pub const DESCRIPTIONS: [&Description; count()] = {
    let mut all = [LISTS[0][0]; count()];
    let (mut list, mut n) = (0, 0);
    while list < LISTS.len() {
        let mut k = 0;
        while k < LISTS[list].len() {
            all[n] = LISTS[list][k];
            (k, n) = (k + 1, n + 1);
        }
        list += 1;
    }
    all
};

const fn count() -> usize {
    let (mut list, mut sum) = (0, 0);
    while list < LISTS.len() {
        sum += LISTS[list].len();
        list += 1;
    }
    sum
}

fn in_every_precision<N: Effect>(pair: &Pair, precision: Precision, law: N) -> Box<dyn Kernel> {
    let (sliding, rolling) = (SlidingFriction::<f64>::of(pair), RollingResistance::of(pair));
    match (sliding, rolling) {
        (None, _) => precise(precision, law),
        (Some(sliding), None) => precise(precision, (law, sliding)),
        (Some(sliding), Some(rolling)) => precise(precision, (law, (sliding, rolling))),
    }
}

fn precise<E: Effect>(precision: Precision, effects: E) -> Box<dyn Kernel> {
    match precision {
        Precision::Double => Box::new(effects),
        Precision::Mixed => Box::new(Narrow::<E, f64>::new(effects)),
        Precision::Single => Box::new(Narrow::<E, f32>::new(effects)),
    }
}

fn adhering<N: Effect>(pair: &Pair, law: N) -> Box<dyn Kernel> {
    sliding(pair, (law, Cohesion::of(pair)))
}

/// The effects that a law asks for, in the order in which they act: one of a slot at most.
pub fn active(law: &ContactLaw) -> impl Iterator<Item = &'static Description> + '_ {
    DESCRIPTIONS.iter().filter(|d| d.asked_for(law)).copied()
}

/// Every number that contact laws take, each once.
pub fn keys() -> impl Iterator<Item = &'static Key> {
    let all = DESCRIPTIONS.iter().flat_map(|d| d.keys);
    all.enumerate()
        .filter(|(n, key)| !DESCRIPTIONS.iter().flat_map(|d| d.keys).take(*n).any(|k| k.name == key.name))
        .map(|(_, key)| key)
}

/// Every key that names a model, with its values.
pub fn models() -> Vec<(&'static str, Vec<&'static str>)> {
    let mut found: Vec<(&str, Vec<&str>)> = Vec::new();
    for model in DESCRIPTIONS.iter().filter_map(|d| d.model) {
        match found.iter_mut().find(|(key, _)| *key == model.key) {
            Some((_, values)) => values.push(model.value),
            None => found.push((model.key, vec![model.value])),
        }
    }
    found
}

/// A law without one of its effects, and without those that need it; `None` for the normal law.
pub fn without(law: &ContactLaw, effect: &Description) -> Option<ContactLaw> {
    if effect.slot == Slot::Normal {
        return None;
    }
    let mut less = law.clone();
    let dependent = active(law).filter(|d| d.slot == effect.slot || d.needs == Some(effect.slot));
    dependent.for_each(|d| remove(&mut less, d));
    Some(less)
}

/// Takes an effect out of a law: the keys that no other effect of the law has.
fn remove(law: &mut ContactLaw, effect: &Description) {
    effect.keys.iter().for_each(|key| law.remove(key.name));
    effect.model.into_iter().for_each(|model| law.remove(model.key));
}

/// What is dropped of a law because it does nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Dropped {
    /// Its numbers, under their keys.
    pub numbers: String,
    /// The model that is computed instead; `None`: nothing is.
    pub instead: Option<&'static str>,
}

/// A law without effects that do nothing, and what is dropped with them.
pub fn needed(law: &ContactLaw) -> (ContactLaw, Vec<Dropped>) {
    let (mut less, mut dropped) = (law.clone(), Vec::new());
    let idle: Vec<&Description> = active(law).filter(|d| (d.idle)(law)).collect();
    // Last first: an effect stays as long as another that stays needs it, though it does nothing by itself.
    for effect in idle.into_iter().rev() {
        if active(&less).any(|d| d.needs == Some(effect.slot)) {
            continue;
        }
        remove(&mut less, effect);
        if let (Some(model), Some(other)) = (effect.model, effect.instead) {
            less.choose(model.key, other);
            let kept =
                active(&less).flat_map(|d| d.keys).filter_map(|key| Some((key.name, law.number(key.name)?)));
            kept.collect::<Vec<_>>().into_iter().for_each(|(key, value)| less.set(key, value));
        }
        let gone = effect.keys.iter().filter(|key| less.number(key.name).is_none());
        let numbers = gone.filter_map(|key| key.shown(law)).collect::<Vec<_>>().join(", ");
        dropped.push(Dropped { numbers, instead: effect.instead });
    }
    dropped.reverse();
    (less, dropped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Elastic, Kind};
    use crate::setup::Material;
    use crate::setup::clumps::Ease;

    /// Every law that a scene can ask for: each normal law with each choice of effects for the other slots.
    fn laws() -> Vec<ContactLaw> {
        let with = |mut law: ContactLaw, effect: &Description| {
            effect.keys.iter().for_each(|key| law.set(key.name, 0.5));
            effect.model.into_iter().for_each(|model| law.choose(model.key, model.value));
            law
        };
        let of = |slot: Slot| DESCRIPTIONS.iter().filter(move |d| d.slot == slot);
        let mut all: Vec<ContactLaw> =
            of(Slot::Normal).map(|d| with(ContactLaw::new((0, 0), d.name), d)).collect();
        for slot in [Slot::Cohesion, Slot::Sliding, Slot::Rolling, Slot::Twisting] {
            let more = |law: &ContactLaw| {
                let fits = move |d: &&&Description| {
                    active(law).all(|a| a.excludes.is_none_or(|(slot, _)| slot != d.slot))
                        && d.needs.is_none_or(|needed| active(law).any(|a| a.slot == needed))
                };
                of(slot).filter(fits).map(|d| with(law.clone(), d)).collect::<Vec<_>>()
            };
            all.extend(all.iter().flat_map(more).collect::<Vec<_>>());
        }
        all
    }

    #[test]
    fn kernels_keep_what_their_effects_describe_and_no_more() {
        let material = Material { name: "a".to_owned(), density: 1e3, young: 1e6, poisson: 0.3 };
        let elastic = Elastic::of(&material, &material);
        assert!(laws().len() > 70, "{}", laws().len());
        for law in laws() {
            let pair = Pair { law: &law, elastic, ease: Ease { bodies: 1.0, springs: 1.0 } };
            let kernel = compose(&pair, Precision::Double);
            let flips = active(&law).flat_map(|d| d.history);
            let flips = flips.flat_map(|field| vec![field.kind == Kind::Vector; field.kind.columns()]);
            let found: Vec<bool> = (0..kernel.columns()).map(|column| kernel.flips(column)).collect();
            assert_eq!(found, flips.collect::<Vec<_>>(), "{law:?}");
            let has = |slot: Slot| active(&law).any(|d| d.slot == slot);
            assert_eq!(kernel.rotates(), has(Slot::Sliding), "{law:?}");
            assert_eq!(kernel.couples(), has(Slot::Rolling) || has(Slot::Twisting), "{law:?}");
        }
    }

    /// What does nothing is dropped with its keys, but not what something else needs.
    #[test]
    fn idle_effects_are_dropped() {
        let law = |friction: f64, twisting: f64| {
            let law = ContactLaw::new((0, 0), "jkr").with("restitution", 0.5).with("work_of_adhesion", 0.0);
            needed(&law.with("sliding_friction", friction).with("twisting_resistance", twisting))
        };
        let hertz = ContactLaw::new((0, 0), "hertz").with("restitution", 0.5);
        let (less, dropped) = law(0.0, 0.0);
        assert_eq!((less, dropped.len()), (hertz.clone(), 3), "{dropped:?}");
        let (less, dropped) = law(0.0, 0.1);
        assert_eq!(less, hertz.clone().with("sliding_friction", 0.0).with("twisting_resistance", 0.1));
        assert_eq!(dropped.len(), 1, "{dropped:?}");
        // Without sliding friction nothing turns, so that what resists turning goes with it.
        let rubs = hertz.clone().with("sliding_friction", 0.5).with("twisting_resistance", 0.1);
        let sliding = active(&rubs).find(|d| d.slot == Slot::Sliding).expect("it slides");
        assert_eq!(without(&rubs, sliding), Some(hertz));
    }
}
