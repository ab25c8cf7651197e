//! What can be varied: keys of the scene, short names for the usual ones, and blanks {KEY} in lines.

use crate::study::CurveError;
use scene::keys::DRAWN;
use scene::nearest;
use toml::Value;

/// Which of several values is the finest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finest {
    Least,
    /// The greatest.
    Most,
    Word(&'static str),
    /// Not known.
    Unknown,
}

/// A knob that has a short name.
struct Known {
    name: &'static str,
    /// Key of the scene; empty: none.
    key: &'static str,
    finest: Finest,
    /// Value when the scene has no such key; empty: unknown.
    default: &'static str,
}

const fn known(name: &'static str, key: &'static str, finest: Finest, default: &'static str) -> Known {
    Known { name, key, finest, default }
}

const KNOWN: [Known; 12] = [
    known("safety", "time.safety", Finest::Least, "0.5"),
    known("dt", "time.dt", Finest::Least, "auto"),
    known("accuracy", "time.accuracy", Finest::Least, ""),
    known("stiffness", "", Finest::Most, "1"),
    known("young", "material.*.young", Finest::Most, ""),
    known("precision", "precision", Finest::Word("f64"), "f64"),
    known("skin", "neighbours.skin", Finest::Most, ""),
    known("sleep", "sleep.speed", Finest::Least, ""),
    known("every", "output.every", Finest::Least, ""),
    known("zone", "outlet.*.length", Finest::Unknown, ""),
    known("threads", "", Finest::Least, ""),
    known("spacing", "", Finest::Least, ""),
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
        let known = KNOWN.iter().find(|k| k.name == name || k.key == name && !k.key.is_empty());
        let (finest, own) = known.map_or((Finest::Unknown, ""), |k| (k.finest, k.default));
        let target = match (blank, known, name) {
            (true, ..) => Target::Blank,
            (_, _, "stiffness") => Target::Stiffness,
            (_, _, "threads") => Target::Threads,
            (_, Some(known), _) if !known.key.is_empty() => Target::Key(known.key.to_owned()),
            _ => Target::Key(name.to_owned()),
        };
        Knob { name: name.to_owned(), finest, target, own: own.to_owned() }
    }

    /// Whether its value stands in a line and not in the scene.
    pub fn is_blank(&self) -> bool {
        self.target == Target::Blank
    }

    /// Its value in the scene; `None` when the scene has no such key, or several values of it.
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
    /// Which is the finest is not known, or they are not numbers.
    pub fn finest(&self, values: &[String]) -> Result<usize, CurveError> {
        let unknown = || {
            let first = values.first().map_or("V", String::as_str);
            CurveError::Usage(format!(
                "--vary {name}: which of its values is right is not known: say --reference {name}={first}, --exact or \
                 --laboratory",
                name = self.name
            ))
        };
        let number = |v: &String| v.parse::<f64>().map_err(|_| unknown());
        let numbers = || values.iter().map(number).collect::<Result<Vec<f64>, CurveError>>();
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

    /// Refuses a name that is almost a short one: as a key of the scene it would be refused later, without this hint.
    ///
    /// # Errors
    /// Such a name.
    pub fn known_name(&self) -> Result<(), CurveError> {
        let name = &self.name;
        let unknown = self.target == Target::Key(name.clone()) && self.finest == Finest::Unknown;
        let near = nearest(name, KNOWN.iter().map(|k| k.name)).filter(|_| unknown && !name.contains('.'));
        match near {
            Some(near) => {
                Err(CurveError::Usage(format!("--vary {name}: there is no such key; did you mean '{near}'?")))
            }
            None => Ok(()),
        }
    }

    /// The overrides of the scene (`KEY=VALUE`) that give it a value.
    ///
    /// # Errors
    /// A key that the scene has no place for, a factor that is not a number.
    pub fn overrides(&self, scene: &Value, value: &str) -> Result<Vec<String>, CurveError> {
        let name = &self.name;
        match &self.target {
            Target::Threads | Target::Blank => Ok(Vec::new()),
            Target::Key(key) => match &expand(scene, key)[..] {
                [] => {
                    let why =
                        format!("--vary {name}: the scene has no entry for {key}: choose a key that it has");
                    Err(CurveError::Failed(why))
                }
                keys => Ok(keys.iter().map(|key| format!("{key}={value}")).collect()),
            },
            Target::Stiffness => {
                let factor: f64 =
                    value.parse().ok().filter(|f: &f64| *f > 0.0 && f.is_finite()).ok_or_else(|| {
                        CurveError::Usage(format!(
                            "--vary {name}={value}: stiffness is a factor above 0, such as 0.1"
                        ))
                    })?;
                let keys = [
                    "material.*.young",
                    "contact.*.stiffness",
                    "contact.*.tangential_stiffness",
                    "contact.*.contact_modulus",
                    "contact.*.effective_modulus",
                ]
                .map(|key| expand(scene, key))
                .concat();
                let one = |key: &String| {
                    let unit = if key.ends_with("stiffness") { "N/m" } else { "Pa" };
                    let text = |v: &Value| v.as_str().and_then(|text| geom::units::parse(text, unit).ok());
                    let now = get(scene, key).and_then(|v| {
                        v.as_float().or(v.as_integer().map(|i| i as f64)).or_else(|| text(v))
                    })?;
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

/// Overrides that give every fill, insertion and bond of drawn strength other random numbers; none for the first.
pub fn seeds(scene: &Value, repeat: u64) -> Vec<String> {
    let mut keys = ["fill.*", "insert.*", "bond.*"].map(|key| expand(scene, key)).concat();
    let is_drawn = |bond: &String| DRAWN.iter().any(|key| get(scene, &format!("{bond}.{key}")).is_some());
    keys.retain(|entry| !entry.starts_with("bond") || is_drawn(entry));
    let seed = |entry: &String| {
        let now = get(scene, &format!("{entry}.seed")).and_then(Value::as_integer).unwrap_or(0);
        format!("{entry}.seed={}", now + repeat as i64)
    };
    keys.iter().filter(|_| repeat > 0).map(seed).collect()
}

/// Whether a scene uses random numbers.
pub fn is_random(scene: &Value) -> bool {
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
                    [[contact]]\nstiffness = 1000\n[[fill]]\nseed = 5\n[[fill]]\n\
                    [[bond]]\nkind = \"beam\"\n[[bond]]\nweibull_modulus = 3\n";
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
        assert_eq!(seeds(&scene, 3), ["fill.0.seed=8", "fill.1.seed=3", "bond.1.seed=3"]);
    }

    #[test]
    fn the_value_of_the_scene_is_in_use() {
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
        assert!(
            Knob::new("gravity", false).known_name().is_ok() && Knob::new("dt", false).known_name().is_ok()
        );
        let why = Knob::new("safty", false).known_name().unwrap_err().to_string();
        assert_eq!(why, "--vary safty: there is no such key; did you mean 'safety'?");
    }
}
