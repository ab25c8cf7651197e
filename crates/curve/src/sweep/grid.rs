//! The grid of settings, with the reference and the setting in use.

use crate::args::{Args, pair, values};
use crate::knob::Knob;
use cli::usage;
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
    /// The grid of the command line. `blank` tells whether {KEY} stands in a line, `scene` what it says, when it is one.
    ///
    /// # Errors
    /// A key twice, a reference that is not known.
    pub fn new(args: &Args, blank: &dyn Fn(&str) -> bool, scene: Option<&Value>) -> anyhow::Result<Grid> {
        let mut knobs: Vec<Knob> = Vec::new();
        let mut lists: Vec<Vec<String>> = Vec::new();
        for text in &args.vary {
            let (key, all) = pair("--vary", text)?;
            if knobs.iter().any(|k| k.name == key) {
                return Err(usage(format!("--vary {key}: is given twice: list all of its values in one")));
            }
            lists.push(values(&key, &all)?);
            knobs.push(Knob::new(&key, blank(&key)));
        }
        let mut grid = Grid { settings: product(&knobs, &lists), knobs, reference: None, in_use: None };
        if args.exact.is_none() && args.laboratory.is_none() {
            let setting = grid.finest(&pairs("--reference", &args.reference, &grid.knobs)?, &lists)?;
            grid.reference = Some(grid.place(setting));
        }
        let given = pairs("--in-use", &args.in_use, &grid.knobs)?;
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
    fn finest(&self, given: &Setting, lists: &[Vec<String>]) -> anyhow::Result<Setting> {
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

fn pairs(option: &str, texts: &[String], knobs: &[Knob]) -> anyhow::Result<Setting> {
    let all = texts.iter().map(|text| pair(option, text)).collect::<anyhow::Result<Setting>>()?;
    let names: Vec<&str> = knobs.iter().map(|k| k.name.as_str()).collect();
    match all.iter().find(|(key, _)| !names.contains(&key.as_str())) {
        Some((key, _)) => {
            Err(usage(format!("{option} {key}: is not varied: vary it, or name one of {}", names.join(", "))))
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    fn grid(options: &[&str]) -> anyhow::Result<Grid> {
        let scene: Value = Value::Table("[time]\nsafety = 0.5\n".parse()?);
        let args = ["cost-curve", "s.toml", "--measure", "heap-angle"].iter().chain(options);
        Grid::new(&Args::try_parse_from(args)?, &|key| key == "spacing", Some(&scene))
    }

    #[test]
    fn the_grid_has_every_combination_and_marks_reference_and_use() {
        let found = grid(&["--vary", "safety=0.1,0.50", "--vary", "precision=f64,mixed"]).unwrap();
        assert_eq!(found.settings.len(), 4);
        assert_eq!((found.reference, found.in_use), (Some(0), Some(2)));
        let found = grid(&["--vary", "safety=0.1,0.2", "--reference", "safety=0.01"]).unwrap();
        assert_eq!(found.settings.len(), 4, "{found:?}");
        assert_eq!((found.reference, found.in_use), (Some(2), Some(3)));
    }

    #[test]
    fn what_only_a_line_knows_is_in_use_when_it_is_said() {
        assert_eq!(grid(&["--vary", "spacing=1,2"]).unwrap().in_use, None);
        assert_eq!(grid(&["--vary", "spacing=1,2", "--in-use", "spacing=2"]).unwrap().in_use, Some(1));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let why = |options: &[&str]| grid(options).unwrap_err().to_string();
        assert!(why(&["--vary", "safety"]).contains("write KEY=VALUE"));
        assert!(why(&["--vary", "safety=1,1"]).contains("1 is there twice"));
        assert!(why(&["--vary", "safety=1,,2"]).contains("one value is empty"));
        assert!(why(&["--vary", "safety=1", "--vary", "safety=2"]).contains("given twice"));
        assert!(why(&["--vary", "safety=1", "--reference", "dt=2"]).contains("is not varied"));
        assert!(why(&["--vary", "gravity=[0,0,-1],[0,0,-2]"]).contains("say --reference gravity=[0,0,-1]"));
    }
}
