//! Effects in reports and messages: keys with their values, and what of a law is dropped because it does nothing.

use super::describe::{Description, Key, MOST, Range};
use super::law::ContactLaw;
use super::registry::{active, remove};
use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{Display, Formatter};
use primitives::Shown;

impl Display for Range {
    fn fmt(&self, f: &mut Formatter) -> core::fmt::Result {
        match self {
            Range::Positive => write!(f, "above 0, up to {MOST:e}"),
            Range::UpTo(most) => write!(f, "0 to {}", Shown(*most)),
            Range::AboveZeroUpTo(most) => write!(f, "above 0, up to {most}"),
        }
    }
}

impl Key {
    /// The key with its value and unit in a law that has it.
    pub fn shown(&self, law: &ContactLaw) -> Option<String> {
        let value = Shown(law.number(self.name)?);
        Some(format!("{} = {value} {}", self.name, self.unit).trim_end().to_owned())
    }
}

impl Description {
    /// The keys by which a law asks for it, with their values.
    pub fn because(&self, law: &ContactLaw) -> String {
        let model = self.model.map(|m| format!("{} = \"{}\"", m.key, m.value));
        let numbers = self.keys.iter().filter_map(|key| key.shown(law));
        let (first, last) = if self.is_law() { (model, None) } else { (None, model) };
        first.into_iter().chain(numbers).chain(last).collect::<Vec<_>>().join(", ")
    }
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
