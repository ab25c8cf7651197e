//! Reads what is to be shown: runs and walls (MCAP), and clouds, told apart by their content.

use anyhow::Context;
use cli::Source;
use serde_json::{Value, json};
use std::{
    collections::{BTreeMap, HashMap},
    io::{Cursor, Read},
};
use stream::{
    Table, Values,
    mcap::{Event, Reader},
};
use view::{Page, Role, ViewError};

/// The bytes that every MCAP stream begins with.
const MCAP: &[u8] = b"\x89MCAP";

/// Whatever shows layers.
pub trait Show {
    /// Adds a layer.
    fn layer(&mut self, role: Role, name: &str) -> usize;
    /// Names the layer's materials.
    fn kinds(&mut self, layer: usize, kinds: Vec<String>);
    /// Adds a state of a layer.
    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError>;
}

impl Show for Page {
    fn layer(&mut self, role: Role, name: &str) -> usize {
        Page::layer(self, role, name)
    }
    fn kinds(&mut self, layer: usize, kinds: Vec<String>) {
        Page::kinds(self, layer, kinds);
    }
    fn push(&mut self, layer: usize, time: f64, table: Table) -> Result<(), ViewError> {
        Page::push(self, layer, time, &table)
    }
}

/// The name without its folder.
pub fn short_name(source: &Source) -> String {
    let file = source.path().and_then(|path| path.file_name());
    file.map_or_else(|| source.to_string(), |name| name.to_string_lossy().into_owned())
}

/// Reads every input into `show`; what was found, for the report.
pub fn read_all(sources: &[Source], show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mut found = Vec::new();
    for source in sources {
        let mut from = source.open()?;
        let mut head = Vec::new();
        from.by_ref()
            .take(MCAP.len() as u64)
            .read_to_end(&mut head)
            .with_context(|| format!("{source}: cannot read"))?;
        let is_mcap = head == MCAP;
        let whole = Cursor::new(head).chain(from);
        let name = short_name(source);
        let layers = if is_mcap { run(whole, &name, show) } else { scan(whole, &name, show) };
        found.extend(layers.with_context(|| source.to_string())?);
    }
    Ok(found)
}

/// A run, or walls: every `/particles` and `/walls` message; other topics are not for the eye.
fn run(from: impl Read, name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let mut layers: HashMap<String, (usize, usize)> = HashMap::new();
    let mut materials = Vec::new();
    let mut others = Vec::new();
    for event in Reader::new(from) {
        match event? {
            Event::Metadata { name, map } if name == "materials" => materials = names(&map),
            Event::Points { topic, time_ns, table } => {
                let (role, word) = match topic.as_str() {
                    "/particles" => (Role::Grains, "grains"),
                    "/walls" => (Role::Walls, "walls"),
                    _ => {
                        others.push(topic);
                        continue;
                    }
                };
                let (layer, messages) = layers.entry(topic).or_insert_with(|| {
                    let layer = show.layer(role, &format!("{word} ({name})"));
                    show.kinds(layer, materials.clone());
                    (layer, 0)
                });
                *messages += 1;
                show.push(*layer, time_ns as f64 / 1e9, table)?;
            }
            _ => {}
        }
    }
    if layers.is_empty() {
        others.dedup();
        let seen = if others.is_empty() { "no point clouds at all".to_owned() } else { others.join(", ") };
        anyhow::bail!("no /particles and no /walls in this MCAP, but {seen}: give a run or walls");
    }
    let sorted: BTreeMap<_, _> = layers.into_iter().collect();
    Ok(sorted.into_iter().map(|(t, (_, n))| json!({ "input": name, "topic": t, "messages": n })).collect())
}

/// Names of the materials by number; a number without one is its own name.
fn names(map: &BTreeMap<String, String>) -> Vec<String> {
    let known = |key: &str| {
        let material: Value = serde_json::from_str(map.get(key)?).ok()?;
        material["name"].as_str().map(str::to_owned)
    };
    let count = map.keys().filter_map(|k| k.parse::<u16>().ok()).max().map_or(0, |k| usize::from(k) + 1);
    (0..count).map(|k| known(&k.to_string()).unwrap_or_else(|| k.to_string())).collect()
}

/// A cloud; one whose points have a radius is a set of wall spheres.
fn scan(from: impl Read, name: &str, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let (cloud, dropped) = cloud::read(from)?.finite();
    if dropped > 0 {
        cli::warn(&format!("{name}: {dropped} points without finite coordinates are not shown"));
    }
    let axis = |k: usize| Values::F64(cloud.points.iter().map(|p| p[k]).collect());
    let mut table = Table::with_rows(cloud.points.len());
    for (k, column) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(column, axis(k))?;
    }
    for column in cloud.attributes.columns() {
        table.push(&column.name, column.values.clone())?;
    }
    let role = if table.get("radius").is_some() { Role::Walls } else { Role::Cloud };
    let points = table.rows();
    let layer = show.layer(role, name);
    show.push(layer, 0.0, table)?;
    Ok(vec![json!({ "input": name, "points": points })])
}
