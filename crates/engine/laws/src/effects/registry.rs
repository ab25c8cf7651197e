//! The list of effects.

use super::ContactEffect;
use super::describe::{Description, Key, Slot};
use super::law::ContactLaw;
use alloc::vec;
use alloc::vec::Vec;

/// The list of effects, a line for each slot, in the order in which they act: given to the macro that is named, after further arguments.
#[macro_export]
macro_rules! effects {
    ($then:ident) => { $crate::effects!(@ [$then]); };
    (@ [$($then:tt)*] $($argument:tt)*) => {
        $($then)*! {
            $($argument)*
            normal: hooke_direct::Linear, hertz::Hertz, jkr::Jkr, walton_braun::WaltonBraun;
            cohesion: cohesion::Cohesion;
            sliding: sliding_friction::SlidingFriction<friction::Friction>;
            rolling: rolling_resistance::RollingResistance, constant_rolling::ConstantRolling;
            twisting: twisting_resistance::TwistingResistance;
        }
    };
}

macro_rules! lists {
    ($($slot:ident : $($module:ident :: $effect:ident $(<$of:ident :: $model:ident>)?),*;)*) => {
        const LISTS: &[&[&Description]] =
            &[$($(<super::$module::$effect $(<super::$of::$model>)? as ContactEffect>::DESCRIPTIONS,)*)*];
    };
}
effects!(lists);

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
            Some((_, values)) if values.contains(&model.value) => {}
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
pub(super) fn remove(law: &mut ContactLaw, effect: &Description) {
    effect.keys.iter().for_each(|key| law.remove(key.name));
    effect.model.into_iter().for_each(|model| law.remove(model.key));
}
