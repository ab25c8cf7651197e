//! Checks of the values of a scene that can be judged without files: ranges, keys that exclude each other.
//!
//! [`Check`] holds the rules that many keys share (above 0, within a range, one of several keys). Each key names its range where it is declared
//! ([`crate::keys`]); each file here checks how the keys of one kind of table go together. A refused value names key, value, unit and cure ([`crate::error::ValueError`]).

mod bonds;
mod calculation;
mod clumps;
mod contacts;
mod domain;
mod materials;
mod particles;
mod servo;
mod walls;
mod zones;

use crate::error::{Result, SceneError, ValueError, nearest, shown};
use crate::keys::{Judge, Key, Range, SceneKeys, Table};
use crate::text::Text;
use dem::setup::Material;
use geom::Shown;
use std::fmt::Display;

/// How far the length of what has length 1 may be off [–]: 0.707 is written for √½.
const ROUNDED: f64 = 1e-3;

/// Refuses values, naming key, value, unit and cure.
pub struct Check<'a> {
    /// The scene, for places in it.
    pub text: &'a Text,
}

impl Judge for Check<'_> {
    fn numbers(&self, at: &str, key: &Key, numbers: &[f64]) -> Result<()> {
        let each =
            |low: f64, high: f64| numbers.iter().try_for_each(|v| self.within(at, *v, low, high, key.unit));
        let positive = || numbers.iter().try_for_each(|v| self.positive(at, *v, key.unit));
        match key.range {
            Range::Any | Range::File | Range::Name => Ok(()),
            Range::Finite => self.finite(at, numbers, key.unit),
            Range::Positive => positive(),
            Range::FromZero => each(0.0, dem::magnitudes(key.unit)[1]),
            Range::Within(low, high) => each(low, high),
            Range::Between(low, high, why) => {
                let outside = numbers.iter().find(|v| !(low < **v && **v < high));
                outside.map_or(Ok(()), |v| Err(self.not_between(at, *v, [low, high], (why, key.default))))
            }
            Range::AtLeast(low) => each(low, f64::INFINITY),
            Range::AboveZeroUpTo(high) => {
                numbers.iter().try_for_each(|v| self.above_zero(at, *v, high, key.unit))
            }
            Range::UnitLength => self.unit_length(at, numbers, key.default),
            Range::Poisson => numbers.iter().try_for_each(|v| self.poisson(at, *v)),
            Range::Pair => {
                positive()?;
                match numbers {
                    [low, high] if low > high => {
                        let value = format!("[{low}, {high}] {}", key.unit);
                        Err(self.wrong(
                            at,
                            value.trim_end(),
                            "the range is upside down",
                            "give [smallest, largest]",
                        ))
                    }
                    _ => Ok(()),
                }
            }
        }
    }

    fn once(&self, at: &str, words: &[&str]) -> Result<()> {
        let again = (1..words.len()).find(|k| words[..*k].contains(&words[*k]));
        again.map_or(Ok(()), |k| {
            let value = format!("\"{}\"", words[k]);
            Err(self.wrong(&format!("{at}.{k}"), value, "is in the list twice", "leave one of them out"))
        })
    }

    fn name(&self, key: &str, name: &str) -> Result<()> {
        let Some(c) = record::name::forbidden(name) else { return Ok(()) };
        let why = format!("has {}", record::name::in_words(c));
        Err(self.wrong(key, format!("{name:?}"), &why, record::name::CURE))
    }
}

impl Check<'_> {
    /// The error for a key's value.
    pub(crate) fn wrong(&self, key: &str, value: impl Display, why: &str, cure: &str) -> SceneError {
        SceneError::Value(Box::new(ValueError {
            place: self.text.place(key),
            key: key.to_owned(),
            value: value.to_string(),
            why: why.to_owned(),
            cure: cure.to_owned(),
        }))
    }

    /// A number above zero, where there is one.
    pub(crate) fn positive(&self, key: &str, value: impl Into<Option<f64>>, unit: &str) -> Result<()> {
        let [least, most] = dem::magnitudes(unit);
        let Some(value) = value.into().filter(|v| !(*v > 0.0 && (least..=most).contains(v))) else {
            return Ok(());
        };
        if value > most && value.is_finite() && least <= f64::MIN_POSITIVE {
            return self.above_zero(key, value, most, unit);
        }
        if value > 0.0 && value.is_finite() {
            return self.within(key, value, least, most, unit);
        }
        let value = format!("{} {unit}", shown(value));
        Err(self.wrong(key, value.trim_end(), "must be a finite number above 0", "give a positive value"))
    }

    /// A number above zero, up to `high`, and of a size that its unit allows.
    fn above_zero(&self, key: &str, value: f64, high: f64, unit: &str) -> Result<()> {
        if value > high && value.is_finite() {
            let value = format!("{} {unit}", shown(value));
            let cure = format!("give a number above 0, up to {} {unit}", Shown(high));
            return Err(self.wrong(key, value.trim_end(), "is outside the range", cure.trim_end()));
        }
        self.positive(key, value, unit)
    }

    /// A number from `low` to `high`.
    pub(crate) fn within(&self, key: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<()> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let space = if unit.is_empty() { "" } else { " " };
        let cure = match high {
            f64::INFINITY => format!("give {} or more{space}{unit}", Shown(low)),
            _ => format!("give {} to {}{space}{unit}", Shown(low), Shown(high)),
        };
        Err(self.wrong(key, format!("{} {unit}", shown(value)).trim_end(), "is outside the range", &cure))
    }

    /// The error for a number that is not between two, with the reason, and one that is.
    fn not_between(&self, at: &str, value: f64, range: [f64; 2], (why, such): (&str, &str)) -> SceneError {
        let [low, high] = range.map(Shown);
        let why = format!("is not between {low} and {high}{}{why}", if why.is_empty() { "" } else { ": " });
        self.wrong(at, shown(value), &why, &format!("give a number between {low} and {high}, such as {such}"))
    }

    /// Numbers that are finite, and no larger than a quantity of this unit may be.
    pub(crate) fn finite(&self, key: &str, value: &[f64], unit: &str) -> Result<()> {
        let [_, most] = dem::magnitudes(unit);
        let Some(worst) = value.iter().find(|v| !(v.abs() <= most)) else { return Ok(()) };
        if worst.is_finite() {
            return self.within(key, *worst, -most, most, unit);
        }
        Err(self.wrong(key, format!("{value:?} {unit}"), "must be finite", "give numbers"))
    }

    /// Numbers of length 1, which a digit or two may miss: another length is most often another mistake.
    fn unit_length(&self, key: &str, numbers: &[f64], such: &str) -> Result<()> {
        let length = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (length - 1.0).abs() <= ROUNDED {
            return Ok(());
        }
        let list = |factor: f64| numbers.iter().map(|x| Shown(x * factor).to_string()).collect::<Vec<_>>();
        let cure = match length.is_normal() {
            true => format!("give [{}]", list(length.recip()).join(", ")),
            false => format!("give numbers such as {}", such.replace(".0", "")),
        };
        let why = format!("has the length {}, and an orientation has 1", Shown(length));
        Err(self.wrong(key, format!("[{}]", list(1.0).join(", ")), &why, &cure))
    }

    /// A vector that is long enough to give a direction.
    pub(crate) fn direction(&self, key: &str, vector: [f64; 3], such: &str) -> Result<()> {
        if vector.iter().any(|x| x.abs() >= dem::magnitudes("")[0]) {
            return Ok(());
        }
        let why = if vector == [0.0; 3] { "has no direction" } else { "is too short to give a direction" };
        let [x, y, z] = vector.map(Shown);
        Err(self.wrong(key, format!("[{x}, {y}, {z}]"), why, &format!("give a direction, {such}")))
    }

    /// One and only one of several keys.
    pub(crate) fn one_of(&self, entry: &str, keys: &[(&str, bool)]) -> Result<()> {
        let names = || keys.iter().map(|k| k.0).collect::<Vec<_>>().join(" or ");
        let given: Vec<&str> = keys.iter().filter(|k| k.1).map(|k| k.0).collect();
        match given[..] {
            [_] => Ok(()),
            [] => Err(self.wrong(entry, "(without)", &format!("{} is missing", names()), "add one of them")),
            _ => {
                Err(self.wrong(entry, given.join(" and "), "only one of them can be", "take the others out"))
            }
        }
    }

    /// A time that comes after that of the key `from`, where there is one.
    pub(crate) fn until(&self, key: &str, until: Option<f64>, from: f64) -> Result<()> {
        match until.filter(|until| !(*until > from)) {
            Some(until) => {
                Err(self.wrong(key, format!("{until} s"), "is not after 'from'", "give a later time"))
            }
            None => Ok(()),
        }
    }

    /// The period of what runs from `from` to `until` again and again; it ends before it starts again. What ends `by_itself` needs no `until`.
    pub(crate) fn repeat(
        &self,
        entry: &str,
        repeat: Option<f64>,
        from: f64,
        until: Option<f64>,
        by_itself: bool,
    ) -> Result<()> {
        let (Some(period), key) = (repeat, format!("{entry}.repeat")) else { return Ok(()) };
        let value = format!("{period} s");
        match until {
            None if by_itself => Ok(()),
            None => Err(self.wrong(&key, value, "repeats what never ends", &format!("add {entry}.until"))),
            Some(until) if period < until - from => {
                let why = format!("is shorter than the {} s from 'from' to 'until'", Shown(until - from));
                Err(self.wrong(&key, value, &why, "give a longer period, or an earlier 'until'"))
            }
            Some(_) => Ok(()),
        }
    }

    /// Every value of a scene that can be judged by itself.
    pub(crate) fn keys(&self, m: &SceneKeys) -> Result<()> {
        m.check_keys(self, "")?;
        self.calculation(m)?;
        self.materials(m)?;
        self.contacts(m)?;
        self.bonds(m)?;
        self.clumps(m)?;
        self.particles(m)?;
        self.walls(m)?;
        self.outlets(m)
    }

    /// Poisson's ratio of a material or of bonds.
    pub(crate) fn poisson(&self, key: &str, value: f64) -> Result<()> {
        if record::is_poisson(value) {
            return Ok(());
        }
        Err(self.wrong(key, value, "is outside the range", &format!("give a number {}", record::POISSON)))
    }

    /// The index of a name among those `known` of the `[[table]]`s.
    pub(crate) fn named<'n>(
        &self,
        key: &str,
        name: &str,
        table: &str,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Result<usize> {
        let unknown = || {
            let cure = match nearest(name, known.clone()) {
                Some(near) => format!("did you mean '{near}'?"),
                None if known.clone().next().is_none() => format!("add a [[{table}]] with this name"),
                None => format!("known: {}", known.clone().collect::<Vec<_>>().join(", ")),
            };
            self.wrong(key, format!("\"{name}\""), &format!("no [[{table}]] has this name"), &cure)
        };
        known.clone().position(|k| k == name).ok_or_else(unknown)
    }

    /// The index of a material, by name.
    pub(crate) fn material(&self, key: &str, name: &str, known: &[Material]) -> Result<u16> {
        Ok(self.named(key, name, "material", known.iter().map(|m| m.name.as_str()))? as u16)
    }
}

#[cfg(test)]
mod tests {
    use crate::Scene;
    use std::path::Path;

    /// Names go into scripts line by line: a line break in one would be a command.
    #[test]
    fn names_with_control_characters_are_refused_by_key() {
        let read = |material: &str, clump: &str, wall: &str| {
            let [material, clump, wall] = [material, clump, wall].map(record::name::toml);
            let toml = format!(
                "[time]\nuntil = 1\n[[material]]\nname = {material}\ndensity = 2600\nyoung = 2e7\npoisson = 0.25\n\
                 [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n\
                 [[clump]]\nname = {clump}\nmaterial = {material}\nspheres = [[0, 0, 0, 0.01], [0.01, 0, 0, 0.01]]\n\
                 [[wall]]\nname = {wall}\nplane = \"0,0,0,0,0,1\"\nmaterial = {material}\n"
            );
            Scene::new("scene.toml", toml, &[], Path::new(".")).map(drop).map_err(|e| e.to_string())
        };
        assert_eq!(read("5\" clay & rock", "Stöckchen", "$wall"), Ok(()));
        let bad = "x\nshell touch PWNED\n#";
        for (key, message) in [
            ("material.0.name", read(bad, "c", "w")),
            ("clump.0.name", read("m", bad, "w")),
            ("wall.0.name", read("m", "c", bad)),
        ] {
            let message = message.unwrap_err();
            assert!(message.contains(key) && message.contains("U+000A"), "{key}: {message}");
        }
    }
}
