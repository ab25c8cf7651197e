//! What can be varied: keys of the scene, short names for the usual ones, and blanks {KEY} in lines.

use anyhow::anyhow;
use cli::usage;
use toml::Value;

/// Which of several values is the finest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finest {
    /// The least.
    Least,
    /// The greatest.
    Most,
    /// This word.
    Word(&'static str),
    /// Not known.
    Unknown,
}

/// Short name, key of the scene (empty: not a key), which value is the finest, what holds when the scene says nothing.
const KNOWN: [(&str, &str, Finest, &str); 12] = [
    ("safety", "time.safety", Finest::Least, "0.5"),
    ("dt", "time.dt", Finest::Least, "auto"),
    ("accuracy", "time.accuracy", Finest::Least, ""),
    ("stiffness", "", Finest::Most, "1"),
    ("young", "material.*.young", Finest::Most, ""),
    ("precision", "precision", Finest::Word("f64"), "f64"),
    ("skin", "neighbours.skin", Finest::Most, ""),
    ("sleep", "sleep.speed", Finest::Least, ""),
    ("every", "output.every", Finest::Least, ""),
    ("zone", "outlet.*.length", Finest::Unknown, ""),
    ("threads", "", Finest::Least, ""),
    ("spacing", "", Finest::Least, ""),
];

/// Where a value goes.
#[derive(Debug, Clone, PartialEq)]
enum Target {
    /// Keys of the scene; * stands for every entry of a list.
    Key(String),
    /// A factor on every modulus and stiffness.
    Stiffness,
    /// `--threads` of dem-run.
    Threads,
    /// A blank in a line.
    Blank,
}

/// Something that is varied.
#[derive(Debug, Clone, PartialEq)]
pub struct Knob {
    /// As the user calls it.
    pub name: String,
    /// Which of its values is the finest.
    pub finest: Finest,
    target: Target,
    own: String,
}

impl Knob {
    /// The knob of this name; `blank` when it stands as {NAME} in a line.
    pub fn new(name: &str, blank: bool) -> Knob {
        let known = KNOWN.iter().find(|(short, key, ..)| *short == name || *key == name && !key.is_empty());
        let (finest, own) = known.map_or((Finest::Unknown, ""), |k| (k.2, k.3));
        let target = match (blank, known, name) {
            (true, ..) => Target::Blank,
            (_, _, "stiffness") => Target::Stiffness,
            (_, _, "threads") => Target::Threads,
            (_, Some((_, key, ..)), _) if !key.is_empty() => Target::Key((*key).to_owned()),
            _ => Target::Key(name.to_owned()),
        };
        Knob { name: name.to_owned(), finest, target, own: own.to_owned() }
    }

    /// Whether its value stands in a line, where the scene knows nothing of it.
    pub fn is_blank(&self) -> bool {
        self.target == Target::Blank
    }

    /// What the scene says of it; `None` when it says nothing, or not one thing.
    pub fn own(&self, scene: &Value) -> Option<String> {
        let default = Some(self.own.clone()).filter(|own| !own.is_empty());
        let Target::Key(key) = &self.target else { return default };
        let found: Vec<&Value> = expand(scene, key).iter().filter_map(|key| get(scene, key)).collect();
        let first = found.first().map(|v| text(v));
        if found.iter().all(|v| Some(text(v)) == first) { first.or(default) } else { None }
    }

    /// The index of the finest of some values.
    ///
    /// # Errors
    /// Which is the finest is not known, or they are no numbers.
    pub fn finest(&self, values: &[String]) -> anyhow::Result<usize> {
        let unknown = || {
            let first = values.first().map_or("V", String::as_str);
            usage(format!(
                "--vary {name}: which of its values is right is not known: say --reference {name}={first}, --exact or \
                 --laboratory",
                name = self.name
            ))
        };
        let number = |v: &String| v.parse::<f64>().map_err(|_| unknown());
        let numbers = || values.iter().map(number).collect::<anyhow::Result<Vec<f64>>>();
        let best = |sign: f64| {
            let all = numbers()?;
            let order = (0..all.len()).min_by(|a, b| (sign * all[*a]).total_cmp(&(sign * all[*b])));
            order.ok_or_else(unknown)
        };
        match self.finest {
            Finest::Least => best(1.0),
            Finest::Most => best(-1.0),
            Finest::Word(word) => values.iter().position(|v| v == word).ok_or_else(unknown),
            Finest::Unknown => Err(unknown()),
        }
    }

    /// The overrides of the scene (`KEY=VALUE`) that give it a value.
    ///
    /// # Errors
    /// A key that the scene has no place for, a factor that is no number.
    pub fn overrides(&self, scene: &Value, value: &str) -> anyhow::Result<Vec<String>> {
        let name = &self.name;
        match &self.target {
            Target::Threads | Target::Blank => Ok(Vec::new()),
            Target::Key(key) => match &expand(scene, key)[..] {
                [] => Err(anyhow!("--vary {name}: the scene has no entry for {key}: vary something it has")),
                keys => Ok(keys.iter().map(|key| format!("{key}={value}")).collect()),
            },
            Target::Stiffness => {
                let factor: f64 =
                    value.parse().ok().filter(|f: &f64| *f > 0.0 && f.is_finite()).ok_or_else(|| {
                        usage(format!("--vary {name}={value}: stiffness is a factor above 0, such as 0.1"))
                    })?;
                let keys = ["material.*.young", "contact.*.stiffness"].map(|key| expand(scene, key)).concat();
                let one = |key: &String| {
                    let now =
                        get(scene, key).and_then(|v| v.as_float().or(v.as_integer().map(|i| i as f64)))?;
                    Some(format!("{key}={:e}", now * factor))
                };
                Ok(keys.iter().filter_map(one).collect())
            }
        }
    }

    /// `--threads` of dem-run, when that is what it is.
    pub fn threads<'a>(&self, value: &'a str) -> Option<&'a str> {
        (self.target == Target::Threads).then_some(value)
    }
}

/// Overrides that give every fill and faucet other random numbers; none for the first.
pub fn seeds(scene: &Value, repeat: u64) -> Vec<String> {
    let keys = ["fill.*", "insert.*"].map(|key| expand(scene, key)).concat();
    let seed = |entry: &String| {
        let now = get(scene, &format!("{entry}.seed")).and_then(Value::as_integer).unwrap_or(0);
        format!("{entry}.seed={}", now + repeat as i64)
    };
    keys.iter().filter(|_| repeat > 0).map(seed).collect()
}

/// Whether random numbers play a part in a scene.
pub fn by_chance(scene: &Value) -> bool {
    !seeds(scene, 1).is_empty()
}

/// The key with each * replaced by the numbers of the entries of its list.
fn expand(scene: &Value, key: &str) -> Vec<String> {
    let Some((list, rest)) = key.split_once(".*") else { return vec![key.to_owned()] };
    let entries = get(scene, list).and_then(Value::as_array).map_or(0, Vec::len);
    (0..entries).flat_map(|k| expand(scene, &format!("{list}.{k}{rest}"))).collect()
}

fn get<'a>(scene: &'a Value, key: &str) -> Option<&'a Value> {
    key.split('.').try_fold(scene, |at, part| match part.parse::<usize>() {
        Ok(index) => at.get(index),
        Err(_) => at.get(part),
    })
}

/// As it would be written behind `KEY=`.
fn text(value: &Value) -> String {
    match value {
        Value::String(word) => word.clone(),
        Value::Float(number) => geom::Shown(*number).to_string(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Value {
        let text = "precision = \"mixed\"\n[time]\nsafety = 0.20\n[[material]]\nyoung = 1e7\n[[material]]\nyoung = 2e7\n\
                    [[contact]]\nstiffness = 1000\n[[fill]]\nseed = 5\n[[fill]]\n";
        Value::Table(text.parse().unwrap())
    }

    #[test]
    fn short_names_and_stars_lead_to_keys() {
        let scene = scene();
        let sets = |name: &str, value: &str| Knob::new(name, false).overrides(&scene, value).unwrap();
        assert_eq!(sets("safety", "0.1"), ["time.safety=0.1"]);
        assert_eq!(sets("young", "1e6"), ["material.0.young=1e6", "material.1.young=1e6"]);
        assert_eq!(
            sets("stiffness", "0.1"),
            ["material.0.young=1e6", "material.1.young=2e6", "contact.0.stiffness=1e2"]
        );
        assert!(Knob::new("zone", false).overrides(&scene, "1").is_err());
        assert_eq!(seeds(&scene, 3), ["fill.0.seed=8", "fill.1.seed=3"]);
    }

    #[test]
    fn what_the_scene_says_is_in_use() {
        let scene = scene();
        let own = |name: &str| Knob::new(name, false).own(&scene);
        assert_eq!(own("safety").as_deref(), Some("0.2"));
        assert_eq!(own("precision").as_deref(), Some("mixed"));
        assert_eq!(own("young"), None);
        assert_eq!(own("dt").as_deref(), Some("auto"));
    }

    #[test]
    fn the_finest_is_known_or_asked_for() {
        let list = |all: &[&str]| all.iter().map(|v| (*v).to_owned()).collect::<Vec<_>>();
        assert_eq!(Knob::new("safety", false).finest(&list(&["0.5", "0.1", "0.2"])).unwrap(), 1);
        assert_eq!(Knob::new("stiffness", false).finest(&list(&["0.5", "1e1", "2"])).unwrap(), 1);
        assert_eq!(Knob::new("precision", false).finest(&list(&["mixed", "f64"])).unwrap(), 1);
        assert!(Knob::new("gravity", false).finest(&list(&["1", "2"])).is_err());
        assert!(Knob::new("precision", false).finest(&list(&["mixed"])).is_err());
    }
}
