//! Every key of every scene that the test of keys runs: left out, as it stands, and with other values.

use super::super::example_scenes;
use super::call::Call;
use super::{Findings, Shop, Trial, run};
use grainpipe_tests::tools::line;
use rayon::prelude::*;
use record::metadata;
use std::collections::{BTreeMap, BTreeSet};
use toml::{Table, Value};

/// Keys that may change nothing in a run of 2 ms: where they stand, why.
pub const FREE: &[(&str, &str)] = &[];

/// Metadata that repeats what the scene says.
const ECHOES: &[&str] = &[metadata::SCENE, metadata::MATERIALS, metadata::TIME];

/// A step on the way to a key.
#[derive(Debug, Clone)]
enum Step {
    Key(String),
    Entry(usize),
}

/// A key of a scene.
struct Leaf {
    way: Vec<Step>,
    value: Value,
}

impl Leaf {
    /// Its dotted name, without numbers of entries.
    fn name(&self) -> String {
        let names = self.way.iter().filter_map(|step| match step {
            Step::Key(name) => Some(name.as_str()),
            Step::Entry(_) => None,
        });
        names.collect::<Vec<_>>().join(".")
    }

    /// Its dotted name, as `--set` has it.
    fn path(&self) -> String {
        let names = self.way.iter().map(|step| match step {
            Step::Key(name) => name.clone(),
            Step::Entry(n) => n.to_string(),
        });
        names.collect::<Vec<_>>().join(".")
    }

    /// A scene with another value of it, or without it.
    fn put(&self, scene: &Table, value: Option<&Value>) -> Table {
        let mut changed = Value::Table(scene.clone());
        set(&mut changed, &self.way, value);
        changed.as_table().cloned().unwrap_or_default()
    }
}

fn set(at: &mut Value, way: &[Step], value: Option<&Value>) {
    match (way, at) {
        ([Step::Key(name)], Value::Table(table)) => match value {
            Some(value) => drop(table.insert(name.clone(), value.clone())),
            None => drop(table.remove(name)),
        },
        ([Step::Key(name), rest @ ..], Value::Table(table)) => {
            if let Some(inner) = table.get_mut(name) {
                set(inner, rest, value);
            }
        }
        ([Step::Entry(n), rest @ ..], Value::Array(list)) => {
            if let Some(inner) = list.get_mut(*n) {
                set(inner, rest, value);
            }
        }
        _ => {}
    }
}

/// Keys whose value is no table.
fn leaves(way: &[Step], value: &Value, found: &mut Vec<Leaf>) {
    let further = |step: Step| [way, &[step]].concat();
    match value {
        Value::Table(table) => {
            table.iter().for_each(|(name, inner)| leaves(&further(Step::Key(name.clone())), inner, found))
        }
        Value::Array(list) if !list.is_empty() && list.iter().all(Value::is_table) => {
            list.iter().enumerate().for_each(|(n, inner)| leaves(&further(Step::Entry(n)), inner, found));
        }
        value => found.push(Leaf { way: way.to_vec(), value: value.clone() }),
    }
}

/// Other values of the kind of one. Only limits get far smaller ones, which stop a run; elsewhere these would make it long.
fn others(name: &str, value: &Value) -> Vec<Value> {
    let scaled = |factor: f64| -> Option<Value> {
        match value {
            Value::Float(x) => Some(Value::Float(x * factor)),
            Value::Integer(n) => Some(Value::Integer((*n as f64 * factor) as i64)),
            Value::Array(list) => {
                let of = |v: &Value| v.as_float().or(v.as_integer().map(|n| n as f64));
                let numbers: Option<Vec<f64>> = list.iter().map(of).collect();
                Some(Value::Array(numbers?.into_iter().map(|x| Value::Float(x * factor)).collect()))
            }
            _ => None,
        }
    };
    match value {
        Value::Boolean(is) => vec![Value::Boolean(!is)],
        _ if name.starts_with("guards") => [0.5, 1e-3].into_iter().filter_map(scaled).collect(),
        _ => [0.5, 2.0].into_iter().filter_map(scaled).collect(),
    }
}

/// Runs every `one_in`-th case.
///
/// # Panics
/// When a scene is not TOML, or a file that one reads cannot be made.
pub fn find(one_in: usize, found: &mut Findings) {
    let scenes: Vec<(String, Table)> = example_scenes::scenes()
        .into_iter()
        .map(|(name, text)| (name, toml::from_str(&text).expect("TOML")))
        .collect();
    let shop = shop();
    let mut all = Vec::new();
    for (scene, table) in &scenes {
        let mut keys = Vec::new();
        leaves(&[], &Value::Table(table.clone()), &mut keys);
        all.extend(keys.into_iter().map(|leaf| (scene, table, leaf)));
    }
    let mut values: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    for (_, _, leaf) in &all {
        let known = values.entry(leaf.name()).or_default();
        let more = [vec![leaf.value.clone()], others(&leaf.name(), &leaf.value)].concat();
        more.into_iter().for_each(|v| {
            if !known.contains(&v) {
                known.push(v)
            }
        });
    }
    let free = |leaf: &Leaf| FREE.iter().any(|f| f.0 == leaf.name());
    let chosen = all.iter().filter(|(_, _, leaf)| !free(leaf)).step_by(one_in);
    let chosen: Vec<_> = chosen.collect();
    let trials: Vec<Trial> = chosen
        .into_par_iter()
        .map(|(scene, table, leaf)| trial(&shop, scene, table, leaf, &values[&leaf.name()]))
        .collect();
    run(&shop, trials, found);
}

/// A folder with what the scenes read.
fn shop() -> Shop {
    let folder = grainpipe_tests::scenes::folder(&example_scenes::FILES);
    let path = folder.path();
    for (name, text) in example_scenes::scenes() {
        std::fs::write(path.join(format!("{name}.toml")), text).expect("written");
    }
    std::fs::write(path.join("flat.xyz"), example_scenes::FLAT).expect("written");
    for command in example_scenes::before() {
        let done = line(path, &command);
        assert_eq!(done.code, 0, "{command}: {}", done.stderr);
    }
    let entries = std::fs::read_dir(path).expect("a folder").flatten();
    let inputs: BTreeSet<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    Shop { folder, inputs, unseen: ECHOES }
}

/// The scene without the key if that runs, else as it is; then with all values that the key has in any scene, and others.
fn trial(shop: &Shop, scene: &str, table: &Table, leaf: &Leaf, values: &[Value]) -> Trial {
    let file = |n: usize, table: &Table| {
        let name = format!("{scene}-{}-{n}.toml", leaf.path());
        std::fs::write(shop.folder.path().join(&name), toml::to_string(table).expect("TOML"))
            .expect("written");
        let options = vec![("-o".to_owned(), Some("made.mcap".to_owned()))];
        Call { tool: "dem-run".to_owned(), reads: vec![name], options }
    };
    let without = file(0, &leaf.put(table, None));
    let needed = shop.answer(&without).code != 0;
    let base = if needed { file(1, table) } else { without };
    let own = std::iter::once(&leaf.value).filter(|_| !needed);
    let others = values.iter().filter(|v| **v != leaf.value);
    let more = own.chain(others).take(MOST).enumerate();
    Trial {
        group: "further keys",
        added: format!("{scene}: {}", leaf.path()),
        base,
        more: more.map(|(n, value)| file(n + 2, &leaf.put(table, Some(value)))).collect(),
    }
}

/// Values tried of a key.
const MOST: usize = 8;
