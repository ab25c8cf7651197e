//! Laws of contact, as a setup asks for them.

use alloc::collections::BTreeMap;

/// What holds between two materials: models and numbers under their keys in scenes. Which there are, with units and ranges,
/// [`crate::effects::DESCRIPTIONS`] says. An effect that no key asks for takes no memory and no time.
///
/// ```
/// use laws::effects::ContactLaw;
/// let law = ContactLaw::new((0, 0), "hertz").with("restitution", 0.5).with("sliding_friction", 0.4);
/// assert_eq!(law.number("sliding_friction"), Some(0.4));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ContactLaw {
    /// The two materials, by index, in any order.
    pub between: (u16, u16),
    models: BTreeMap<&'static str, &'static str>,
    numbers: BTreeMap<&'static str, f64>,
}

impl ContactLaw {
    /// A normal law without any number.
    pub fn new(between: (u16, u16), law: &'static str) -> ContactLaw {
        ContactLaw { between, models: BTreeMap::from([("law", law)]), numbers: BTreeMap::new() }
    }

    /// The same with a number.
    pub fn with(mut self, key: &'static str, value: f64) -> ContactLaw {
        self.set(key, value);
        self
    }

    /// Sets a number, or takes it out.
    pub fn set(&mut self, key: &'static str, value: impl Into<Option<f64>>) {
        match value.into() {
            Some(value) => drop(self.numbers.insert(key, value)),
            None => drop(self.numbers.remove(key)),
        }
    }

    /// Names a model, as `choose("rolling_model", "constant")`.
    pub fn choose(&mut self, key: &'static str, model: &'static str) {
        self.models.insert(key, model);
    }

    /// Takes out a number or a model.
    pub fn remove(&mut self, key: &str) {
        self.numbers.remove(key);
        self.models.remove(key);
    }

    /// A number, where it is given.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.numbers.get(key).copied()
    }

    /// A model, where it is named.
    pub fn model(&self, key: &str) -> Option<&'static str> {
        self.models.get(key).copied()
    }

    /// All numbers, by key.
    pub fn numbers(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.numbers.iter().map(|(key, value)| (*key, *value))
    }

    /// All models, by key.
    pub fn models(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        self.models.iter().map(|(key, value)| (*key, *value))
    }
}
