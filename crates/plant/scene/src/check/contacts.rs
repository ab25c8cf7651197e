//! Checks of `[[contact]]`: numbers out of range, keys that no effect takes, effects that lack or contradict each other.

use super::Check;
use crate::error::Result;
use crate::keys::{Contact, SceneKeys};
use dem::effects::{DESCRIPTIONS, Description, Key, MODULI, Slot, TANGENTIAL, active};

impl Check<'_> {
    pub(super) fn contacts(&self, m: &SceneKeys) -> Result<()> {
        for (i, c) in m.contact.iter().enumerate() {
            let entry = Entry { check: self, at: format!("contact.{i}"), contact: c };
            entry.stiffness()?;
            entry.foreign()?;
            entry.tangential()?;
            active(&c.law).try_for_each(|effect| entry.effect(effect))?;
        }
        Ok(())
    }
}

/// One `[[contact]]`.
struct Entry<'a> {
    check: &'a Check<'a>,
    at: String,
    contact: &'a Contact,
}

impl Entry<'_> {
    fn wrong(&self, key: &str, value: &str, why: &str, cure: &str) -> Result<()> {
        Err(self.check.wrong(&format!("{}.{key}", self.at), value, why, cure))
    }

    /// Linear laws take a stiffness, or the speed that it follows from.
    fn stiffness(&self) -> Result<()> {
        let (law, speed) = (&self.contact.law, self.contact.characteristic_velocity);
        self.check.positive(&format!("{}.characteristic_velocity", self.at), speed, "m/s")?;
        let linear = |d: &Description| d.keys.iter().any(|key| key.name == "stiffness");
        if active(law).any(linear) {
            let given = |key| (key, law.number(key).is_some());
            let stiffness = [given("stiffness"), ("characteristic_velocity", speed.is_some())];
            let moduli = MODULI.map(given);
            // Of the laws, one alone takes a modulus.
            let all = if law.model("law") == Some("hooke") {
                [stiffness, moduli].concat()
            } else {
                stiffness.to_vec()
            };
            return self.check.one_of(&self.at, &all);
        }
        if speed.is_none() {
            return Ok(());
        }
        let laws = each_once(DESCRIPTIONS.iter().filter(|d| linear(d)).map(|d| asks(d)));
        let cure = format!("take it out, or use {}", laws.join(" or "));
        let why = "this law takes its stiffness from young and poisson";
        self.wrong("characteristic_velocity", "(given)", why, &cure)
    }

    /// Keys that none of the effects takes that the others ask for.
    fn foreign(&self) -> Result<()> {
        let law = &self.contact.law;
        let numbers = law.numbers().map(|(key, _)| key).filter(|key| !takes(active(law), key));
        let model = |d: &Description| d.model.map(|m| m.key);
        let models =
            law.models().map(|(key, _)| key).filter(|key| !active(law).any(|d| model(d) == Some(key)));
        let Some(key) = numbers.chain(models).next() else { return Ok(()) };
        // Of the effects that take it, those that the same value of the key asks for, and that the numbers of this entry pick.
        let owners = DESCRIPTIONS.iter().filter(|d| {
            let asked = d.model.is_some_and(|m| law.model(key) == Some(m.value));
            (asked || takes(std::iter::once(**d), key)) && (d.picked)(law)
        });
        let lacks = |d: &&Description| {
            let model = d.model.filter(|m| !m.default && law.model(m.key) != Some(m.value));
            let mut missing: Vec<String> =
                model.iter().map(|m| format!("{} = \"{}\"", m.key, m.value)).collect();
            let numbers = d.keys.iter().filter(|k| k.required && law.number(k.name).is_none());
            missing.extend(numbers.map(written));
            missing.join(" and ")
        };
        let cures = each_once(owners.map(lacks).filter(|cure| !cure.is_empty()));
        let cure = match cures[..] {
            [] => format!("take {key} out"),
            _ => format!("add {}, or take {key} out", cures.join(", or ")),
        };
        let asked = active(law).map(|d| d.name).collect::<Vec<_>>().join(", ");
        self.wrong(key, "(given)", &format!("nothing in this [[contact]] uses it ({asked})"), &cure)
    }

    /// Keys of the spring across the normal, which sliding friction alone has; friction of 0 keeps it, so that a sweep may begin there.
    fn tangential(&self) -> Result<()> {
        let law = &self.contact.law;
        let Some(key) = TANGENTIAL.into_iter().find(|key| law.number(key).is_some()) else { return Ok(()) };
        if active(law).any(|d| d.slot == Slot::Sliding) {
            return Ok(());
        }
        let friction = Slot::Sliding.key();
        let why = format!("is the spring of {friction}, and this [[contact]] has none");
        self.wrong(key, "(given)", &why, &format!("add {friction} = 0.5, or take {key} out"))
    }

    fn effect(&self, effect: &Description) -> Result<()> {
        let law = &self.contact.law;
        for key in effect.keys {
            let Some(value) = law.number(key.name) else {
                if key.required && key.name != "stiffness" {
                    let why = format!("{} needs it ({})", asks(effect), key.doc);
                    return self.wrong(key.name, "(absent)", &why, &format!("add {}", written(key)));
                }
                continue;
            };
            if !key.range.holds(value) {
                let (value, cure) = (format!("{value} {}", key.unit), format!("give {}", key.range));
                return self.wrong(key.name, value.trim_end(), "is outside the range", &cure);
            }
        }
        if let Some(wrong) = (effect.contradiction)(law) {
            let value = law.number(wrong.key).unwrap_or(f64::NAN).to_string();
            return self.wrong(wrong.key, &value, &wrong.why, wrong.cure);
        }
        if let Some((slot, why)) = effect.excludes.filter(|(slot, _)| active(law).any(|d| d.slot == *slot)) {
            let value = law.model(slot.key()).map_or(String::new(), |model| format!("\"{model}\""));
            let cure = format!("take {} out, or use another law", slot.key());
            return self.wrong(slot.key(), &value, why, &cure);
        }
        self.needs(effect)
    }

    /// An effect without the one that it needs, or with one that does nothing.
    fn needs(&self, effect: &Description) -> Result<()> {
        let law = &self.contact.law;
        let works = |slot: Slot| {
            active(law).any(|d| d.slot == slot && law.number(slot.key()) != Some(0.0) && !(d.idle)(law))
        };
        let Some(slot) = effect.needs.filter(|slot| !works(*slot) && !(effect.idle)(law)) else {
            return Ok(());
        };
        let key = effect.slot.key();
        let value = law.number(key).unwrap_or(f64::NAN).to_string();
        let why = format!("acts on grains that turn, and nothing turns them without {}", slot.key());
        self.wrong(key, &value, &why, &format!("add {}, such as 0.5, or take {key} out", slot.key()))
    }
}

/// A key with a number as a scene has it; the unit stands behind it, where TOML has no place for it.
fn written(key: &Key) -> String {
    let unit = if key.unit.is_empty() { String::new() } else { format!(" (in {})", key.unit) };
    format!("{} = {}{unit}", key.name, key.example)
}

/// Words without those that came before.
fn each_once(words: impl Iterator<Item = String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for word in words {
        if !all.contains(&word) {
            all.push(word);
        }
    }
    all
}

fn takes(mut effects: impl Iterator<Item = &'static Description>, key: &str) -> bool {
    effects.any(|d| d.keys.iter().any(|k| k.name == key))
}

/// What asks for an effect.
fn asks(effect: &Description) -> String {
    effect.model.map_or(effect.name.to_owned(), |m| format!("{} = \"{}\"", m.key, m.value))
}
