//! The grid of settings, with the reference and the setting in use.

use super::knob::Knob;
use crate::study::{CurveError, Study};
use toml::Value;

/// Values of the knobs, in their order.
pub type Setting = Vec<(String, String)>;

/// How a value is named that the scene has and that cannot be written in one word.
pub const AS_IT_IS: &str = "as-it-is";

/// What is run.
#[derive(Debug)]
pub struct Grid {
    /// What is varied.
    pub knobs: Vec<Knob>,
    /// All settings, those of the grid first.
    pub settings: Vec<Setting>,
    /// The setting that errors are measured from, unless the truth is given.
    pub reference: Option<usize>,
    /// The setting in use.
    pub in_use: Option<usize>,
}

impl Grid {
    /// The grid of a study. `blank` tells whether {KEY} stands in a line, `scene` what it says, when it is one.
    ///
    /// # Errors
    /// A key twice, a reference that is not known.
    pub fn new(
        study: &Study,
        blank: &dyn Fn(&str) -> bool,
        scene: Option<&Value>,
    ) -> Result<Grid, CurveError> {
        let mut knobs: Vec<Knob> = Vec::new();
        let mut lists: Vec<Vec<String>> = Vec::new();
        for text in &study.vary {
            let (key, all) = pair("--vary", text)?;
            if knobs.iter().any(|k| k.name == key) {
                return Err(CurveError::Usage(format!(
                    "--vary {key}: is given twice: list all its values in one option"
                )));
            }
            lists.push(values(&key, &all)?);
            let knob = Knob::new(&key, blank(&key));
            knob.known_name()?;
            knobs.push(knob);
        }
        let mut grid = Grid { settings: product(&knobs, &lists), knobs, reference: None, in_use: None };
        if study.truth.is_none() {
            let setting = grid.finest(&pairs("--reference", &study.reference, &grid.knobs)?, &lists)?;
            grid.reference = Some(grid.place(setting));
        }
        let given = pairs("--in-use", &study.in_use, &grid.knobs)?;
        let known = |knob: &Knob| {
            let own = || match scene {
                Some(scene) if !knob.is_blank() => Some(knob.own(scene).unwrap_or(AS_IT_IS.to_owned())),
                _ => None,
            };
            Some((knob.name.clone(), value_of(&given, &knob.name).or_else(own)?))
        };
        if let Some(setting) = grid.knobs.iter().map(known).collect::<Option<Setting>>() {
            grid.in_use = Some(grid.place(setting));
        }
        Ok(grid)
    }

    /// The reference: what was given, else the finest value.
    fn finest(&self, given: &Setting, lists: &[Vec<String>]) -> Result<Setting, CurveError> {
        let mut setting = Setting::new();
        for (knob, list) in self.knobs.iter().zip(lists) {
            let value = match value_of(given, &knob.name) {
                Some(value) => value,
                None => list[knob.finest(list)?].clone(),
            };
            setting.push((knob.name.clone(), value));
        }
        Ok(setting)
    }

    /// The index of a setting, which is added when the grid does not have it.
    fn place(&mut self, setting: Setting) -> usize {
        let same = |other: &Setting| other.iter().zip(&setting).all(|(a, b)| equal(&a.1, &b.1));
        self.settings.iter().position(same).unwrap_or_else(|| {
            self.settings.push(setting);
            self.settings.len() - 1
        })
    }
}

/// Numbers are equal by value, words as they are written.
fn equal(a: &str, b: &str) -> bool {
    a == b || a.parse::<f64>().ok().zip(b.parse::<f64>().ok()).is_some_and(|(a, b)| a == b)
}

fn value_of(setting: &Setting, key: &str) -> Option<String> {
    setting.iter().find(|(k, _)| k == key).map(|(_, v)| v.clone())
}

fn pairs(option: &str, texts: &[String], knobs: &[Knob]) -> Result<Setting, CurveError> {
    let all = texts.iter().map(|text| pair(option, text)).collect::<Result<Setting, CurveError>>()?;
    let names: Vec<&str> = knobs.iter().map(|k| k.name.as_str()).collect();
    match all.iter().find(|(key, _)| !names.contains(&key.as_str())) {
        Some((key, _)) => Err(CurveError::Usage(format!(
            "{option} {key}: is not varied: vary it, or name one of {}",
            names.join(", ")
        ))),
        None => Ok(all),
    }
}

/// Every combination; the last key changes fastest.
fn product(knobs: &[Knob], lists: &[Vec<String>]) -> Vec<Setting> {
    let mut all = vec![Setting::new()];
    for (knob, list) in knobs.iter().zip(lists) {
        let longer = |s: &Setting| {
            let with = |v: &String| [s.clone(), vec![(knob.name.clone(), v.clone())]].concat();
            list.iter().map(with).collect::<Vec<Setting>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}

/// `KEY=VALUE`
fn pair(option: &str, text: &str) -> Result<(String, String), CurveError> {
    let (key, value) = text
        .split_once('=')
        .filter(|(key, value)| !key.trim().is_empty() && !value.trim().is_empty())
        .ok_or_else(|| CurveError::Usage(format!("{option} {text}: write KEY=VALUE, such as safety=0.2")))?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

/// Values between commas; those inside of brackets belong to the value.
fn values(key: &str, text: &str) -> Result<Vec<String>, CurveError> {
    let (mut depth, mut list) = (0i32, vec![String::new()]);
    for c in text.chars() {
        depth += i32::from(matches!(c, '[' | '{')) - i32::from(matches!(c, ']' | '}'));
        match list.last_mut() {
            Some(value) if c != ',' || depth > 0 => value.push(c),
            _ => list.push(String::new()),
        }
    }
    let list: Vec<String> = list.iter().map(|v| v.trim().to_owned()).collect();
    if let Some(value) = list.iter().find(|v| v.is_empty()).or_else(|| list.iter().find(|v| twice(v, &list)))
    {
        let why =
            if value.is_empty() { "one value is empty".into() } else { format!("{value} is given twice") };
        return Err(CurveError::Usage(format!("--vary {key}={text}: {why}: leave it out")));
    }
    Ok(list)
}

fn twice(value: &str, list: &[String]) -> bool {
    list.iter().filter(|v| *v == value).count() > 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Norm;
    use crate::study::Work;

    fn grid(vary: &[&str], reference: &[&str], in_use: &[&str]) -> Result<Grid, CurveError> {
        let scene = Value::Table("[time]\nsafety = 0.5\n".parse().unwrap());
        let owned = |list: &[&str]| list.iter().map(|text| (*text).to_owned()).collect();
        let study = Study {
            scene: "s.toml".to_owned(),
            inputs: Vec::new(),
            vary: owned(vary),
            set: Vec::new(),
            each: None,
            reference: owned(reference),
            in_use: owned(in_use),
            truth: None,
            wanted: None,
            norm: Norm::Rms,
            repeat: 1,
            phases: Some(1),
            rounds: 1,
            work: Work::Steps,
            folder: "points".into(),
            threads: 1,
        };
        Grid::new(&study, &|key| key == "spacing", Some(&scene))
    }

    #[test]
    fn the_grid_has_every_combination_and_marks_reference_and_use() {
        let found = grid(&["safety=0.1,0.50", "precision=f64,mixed"], &[], &[]).unwrap();
        assert_eq!(found.settings.len(), 4);
        assert_eq!((found.reference, found.in_use), (Some(0), Some(2)));
        let found = grid(&["safety=0.1,0.2"], &["safety=0.01"], &[]).unwrap();
        assert_eq!(found.settings.len(), 4, "{found:?}");
        assert_eq!((found.reference, found.in_use), (Some(2), Some(3)));
    }

    #[test]
    fn a_blank_is_in_use_when_it_is_given() {
        assert_eq!(grid(&["spacing=1,2"], &[], &[]).unwrap().in_use, None);
        assert_eq!(grid(&["spacing=1,2"], &[], &["spacing=2"]).unwrap().in_use, Some(1));
    }

    #[test]
    fn errors_name_the_option() {
        let why = |vary: &[&str]| grid(vary, &[], &[]).unwrap_err().to_string();
        assert!(why(&["safety"]).contains("write KEY=VALUE"));
        assert!(why(&["safety=1,1"]).contains("1 is given twice"));
        assert!(why(&["safety=1,,2"]).contains("one value is empty"));
        assert!(why(&["safety=1", "safety=2"]).contains("given twice"));
        assert!(grid(&["safety=1"], &["dt=2"], &[]).unwrap_err().to_string().contains("is not varied"));
        assert!(why(&["gravity=[0,0,-1],[0,0,-2]"]).contains("say --reference gravity=[0,0,-1]"));
    }
}
