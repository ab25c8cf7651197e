//! Materials and contact laws: the keys are those of the engine's list of effects, so a new effect is drawn as soon as it is in the list.

use super::Draw;
use dem::effects::{DESCRIPTIONS, Description, Key, Slot};
use toml::{Table, Value};

/// Values by unit that suit grains of a centimetre and a gram.
const SCALES: [(&str, f64, f64); 5] =
    [("N/m", 3e3, 3e4), ("Pa", 5e5, 3e6), ("N s/m", 0.03, 0.5), ("J/m²", 0.01, 0.1), ("J/m³", 500.0, 5e3)];

/// Laws that are drawn until one is found whose keys do not contradict each other.
const TRIES: usize = 60;

impl Draw {
    /// Two materials and the laws between them.
    pub(super) fn laws(&mut self) {
        for name in ["a", "b"] {
            self.line(format!("[[material]]\nname = \"{name}\""));
            self.key(1.0, "density", 1000.0, 4000.0);
            self.key(1.0, "young", 1e6, 8e6);
            let poisson = self.between(0.1, 0.45);
            self.line(format!("poisson = {poisson:?}"));
        }
        let pairs: &[[&str; 2]] =
            if self.chance(0.5) { &[["*", "*"]] } else { &[["a", "a"], ["a", "b"], ["b", "b"]] };
        for between in pairs {
            let law = self.law(*between);
            let mut list = Table::new();
            list.insert("contact".to_owned(), Value::Array(vec![Value::Table(law)]));
            self.line(toml::to_string(&list).unwrap_or_default());
        }
    }

    fn law(&mut self, between: [&str; 2]) -> Table {
        for _ in 0..TRIES {
            let law = self.candidate(between);
            if accepted(&law) {
                return law;
            }
        }
        let mut law = Table::new();
        law.insert("between".to_owned(), between.map(str::to_owned).to_vec().into());
        law.insert("restitution".to_owned(), 0.5.into());
        law
    }

    fn candidate(&mut self, between: [&str; 2]) -> Table {
        let mut law = Table::new();
        law.insert("between".to_owned(), between.map(str::to_owned).to_vec().into());
        let single = self.choices.single;
        let of = |slot: Slot| {
            DESCRIPTIONS.iter().copied().filter(move |d| d.slot == slot && (d.every_precision || !single))
        };
        let normal: Vec<_> = of(Slot::Normal).collect();
        let normal = self.pick(&normal);
        self.effect(&mut law, normal);
        for (slot, chance) in
            [(Slot::Cohesion, 0.1), (Slot::Sliding, 0.75), (Slot::Rolling, 0.4), (Slot::Twisting, 0.25)]
        {
            let all: Vec<_> = of(slot).collect();
            if !all.is_empty() && self.chance(chance) {
                let effect = self.pick(&all);
                self.effect(&mut law, effect);
            }
        }
        // The spring of friction is refused without it.
        if !law.contains_key("sliding_friction") {
            for key in ["tangential_ratio", "tangential_stiffness"] {
                law.remove(key);
            }
        }
        law
    }

    /// Adds the keys of an effect: those that it needs, and some others.
    fn effect(&mut self, law: &mut Table, effect: &Description) {
        if let Some(model) = effect.model
            && !(model.default && self.chance(0.5))
        {
            law.insert(model.key.to_owned(), model.value.into());
        }
        for key in effect.keys {
            if key.name == "stiffness" && self.chance(0.1) {
                law.insert("characteristic_velocity".to_owned(), self.scale(0.3, 2.0).into());
            } else if key.required || self.chance(0.35) {
                let value = self.coefficient(key);
                put(law, key.name, value);
            }
        }
    }

    fn coefficient(&mut self, key: &Key) -> f64 {
        let example: f64 = key.example.parse().unwrap_or(1.0);
        let scale = SCALES.iter().find(|scale| scale.0 == key.unit);
        let (low, high) = scale.map_or((example * 0.4, example * 2.0), |s| (s.1, s.2));
        if key.name == "restitution" {
            return if self.chance(0.15) { 1.0 } else { self.between(0.2, 1.0) };
        }
        let drawn = self.scale(low, high);
        if key.range.holds(drawn) { drawn } else { example }
    }
}

/// Puts a number under its name; a dot makes a table.
fn put(law: &mut Table, name: &str, value: f64) {
    match name.split_once('.') {
        None => drop(law.insert(name.to_owned(), value.into())),
        Some((outer, inner)) => {
            let entry = law.entry(outer).or_insert_with(|| Value::Table(Table::new()));
            match entry.as_table_mut() {
                Some(table) => drop(table.insert(inner.to_owned(), value.into())),
                // A number stands there: the table takes its place.
                None => *entry = Value::Table(Table::from_iter([(inner.to_owned(), value.into())])),
            }
        }
    }
}

/// Whether a scene may have this law.
fn accepted(law: &Table) -> bool {
    let mut list = Table::new();
    list.insert("contact".to_owned(), Value::Array(vec![Value::Table(law.clone())]));
    let materials = ["a", "b"]
        .map(|n| format!("[[material]]\nname = \"{n}\"\ndensity = 2000\nyoung = 2e6\npoisson = 0.3\n"));
    let text =
        format!("[time]\nuntil = 1\n{}{}", materials.concat(), toml::to_string(&list).unwrap_or_default());
    scene::Scene::new("law", text, &[], std::path::Path::new("")).is_ok()
}
