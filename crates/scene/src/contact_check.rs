//! What a `[[contact]]` is refused for: numbers out of range, keys that contradict each other.

use crate::check::{Check, Checked};
use crate::model::{Contact, Friction, Law, Model};

impl Check<'_> {
    pub(crate) fn contacts(&self, m: &Model) -> Checked {
        for (i, c) in m.contact.iter().enumerate() {
            let at = format!("contact.{i}");
            self.within(&format!("{at}.restitution"), c.restitution, 0.0, 1.0, "")?;
            self.normal_law(&at, c)?;
            self.cohesion(&at, c)?;
            self.resistances(&at, c)?;
        }
        Ok(())
    }

    /// Keys of one normal law are refused with another.
    fn normal_law(&self, at: &str, c: &Contact) -> Checked {
        let key = |k: &str| format!("{at}.{k}");
        self.positive_if(&key("stiffness"), c.stiffness, "N/m")?;
        self.positive_if(&key("characteristic_velocity"), c.characteristic_velocity, "m/s")?;
        self.positive_if(&key("tangential_ratio"), c.tangential_ratio, "")?;
        self.within(&key("work_of_adhesion"), c.work_of_adhesion.unwrap_or(0.0), 0.0, 1e9, "J/m²")?;
        let linear = [
            ("stiffness", c.stiffness.is_some()),
            ("characteristic_velocity", c.characteristic_velocity.is_some()),
        ];
        let foreign = |given: &[(&str, bool)], why: &str, cure: &str| match given.iter().find(|k| k.1) {
            Some((k, _)) => Err(self.wrong(&key(k), "(given)", why, cure)),
            None => Ok(()),
        };
        if c.law == Law::Hooke {
            self.one_of(at, &linear)?;
        } else {
            let why = "law = \"hertz\" and \"jkr\" take their stiffness from young and poisson";
            let also = [linear[0], linear[1], ("tangential_ratio", c.tangential_ratio.is_some())];
            foreign(&also, why, "take it out, or use law = \"hooke\"")?;
        }
        if c.law != Law::Jkr {
            let why = "only law = \"jkr\" has a work of adhesion";
            let given = [("work_of_adhesion", c.work_of_adhesion.is_some())];
            return foreign(
                &given,
                why,
                "use law = \"jkr\", or cohesion = \"sjkr\" with cohesion_energy_density",
            );
        }
        if c.work_of_adhesion.is_none() {
            let why = "law = \"jkr\" needs the energy to part a square metre of contact";
            let cure =
                "add work_of_adhesion in J/m²: twice the surface energy where both are of one material";
            return Err(self.wrong(&key("work_of_adhesion"), "(absent)", why, cure));
        }
        Ok(())
    }

    fn cohesion(&self, at: &str, c: &Contact) -> Checked {
        let key = |k: &str| format!("{at}.{k}");
        self.within(
            &key("cohesion_energy_density"),
            c.cohesion_energy_density.unwrap_or(0.0),
            0.0,
            1e15,
            "J/m³",
        )?;
        match (c.cohesion, c.cohesion_energy_density) {
            (Some(_), _) if c.law == Law::Jkr => Err(self.wrong(
                &key("cohesion"),
                "\"sjkr\"",
                "law = \"jkr\" adheres by itself",
                "take cohesion out, or use law = \"hertz\"",
            )),
            (Some(_), None) => Err(self.wrong(
                &key("cohesion_energy_density"),
                "(absent)",
                "cohesion = \"sjkr\" needs it",
                "add cohesion_energy_density in J/m³",
            )),
            (None, Some(_)) => Err(self.wrong(
                &key("cohesion_energy_density"),
                "(given)",
                "no cohesion is asked for",
                "add cohesion = \"sjkr\", or take it out",
            )),
            _ => Ok(()),
        }
    }

    fn resistances(&self, at: &str, c: &Contact) -> Checked {
        let key = |k: &str| format!("{at}.{k}");
        let turning =
            [("rolling_resistance", c.rolling_resistance), ("twisting_resistance", c.twisting_resistance)];
        for (name, value) in turning {
            self.within(&key(name), value.unwrap_or(0.0), 0.0, 1e3, "")?;
        }
        match c.sliding_friction {
            None => {}
            Some(Friction::Constant(mu)) => self.within(&key("sliding_friction"), mu, 0.0, 1e3, "")?,
            Some(Friction::Weakening(w)) => {
                self.within(&key("sliding_friction.static"), w.at_rest, 0.0, 1e3, "")?;
                self.within(&key("sliding_friction.dynamic"), w.dynamic, 0.0, 1e3, "")?;
                self.positive(&key("sliding_friction.speed"), w.speed, "m/s")?;
                if w.dynamic > w.at_rest {
                    let why = format!("is above static = {}: friction weakens with speed", w.at_rest);
                    let cure = "swap them, or give one number for both";
                    return Err(self.wrong(&key("sliding_friction.dynamic"), w.dynamic, &why, cure));
                }
            }
        }
        let rubs = match c.sliding_friction {
            None => false,
            Some(Friction::Constant(mu)) => mu > 0.0,
            Some(Friction::Weakening(w)) => w.at_rest > 0.0,
        };
        for (name, value) in turning {
            if let Some(value) = value.filter(|value| *value > 0.0 && !rubs) {
                let why = "acts on grains that turn, and nothing turns them without sliding_friction";
                let cure = format!("add sliding_friction, such as 0.5, or take {name} out");
                return Err(self.wrong(&key(name), value, why, &cure));
            }
        }
        if c.rolling_model.is_some() && c.rolling_resistance.is_none() {
            let why = "a model of rolling resistance without rolling resistance";
            return Err(self.wrong(
                &key("rolling_model"),
                "(given)",
                why,
                "add rolling_resistance, or take it out",
            ));
        }
        Ok(())
    }
}
