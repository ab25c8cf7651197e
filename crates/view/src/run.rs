//! Reads a run, or walls: grains and wall spheres over time, planes and meshes, and how walls move.

use crate::inputs::{Show, short_name};
use anyhow::Context;
use cli::Source;
use record::WallRecord;
use serde_json::{Value, json};
use std::{
    collections::{BTreeMap, HashMap},
    io::Read,
};
use stream::{
    Table,
    mcap::{Event, Reader},
};
use view::{Motion, Role, Surface};

/// What is known of a run so far.
struct Run<'a, S> {
    name: &'a str,
    show: &'a mut S,
    /// Names of the materials.
    kinds: Vec<String>,
    /// The layer of a topic.
    layers: HashMap<String, usize>,
    /// Wall spheres that came before it is known how they move [s].
    waiting: Option<(f64, Table)>,
    /// Name and motion of every wall, once the run has said.
    walls: Option<Vec<(String, Motion)>>,
    /// Messages of each topic that is shown.
    messages: BTreeMap<String, usize>,
}

/// Every `/particles`, `/walls` and `/surfaces` message; other topics are not for the eye.
pub fn read(from: impl Read, source: &Source, show: &mut impl Show) -> anyhow::Result<Vec<Value>> {
    let name = &short_name(source)[..];
    let mut run = Run {
        name,
        show,
        kinds: Vec::new(),
        layers: HashMap::new(),
        waiting: None,
        walls: None,
        messages: BTreeMap::new(),
    };
    let mut others = Vec::new();
    for event in Reader::new(from) {
        let Some(event) = source.as_far_as_it_goes(event)? else { break };
        match event {
            Event::Metadata { name, map } if name == "materials" => run.kinds = names(&map),
            Event::Points { topic, time_ns, table } => match topic.as_str() {
                "/particles" => run.grains(time_ns as f64 / 1e9, table)?,
                "/walls" => run.wall_spheres(time_ns as f64 / 1e9, table)?,
                _ => others.push(topic),
            },
            Event::Bytes { topic, data, .. } if topic == "/surfaces" => {
                run.surfaces(&data).context("/surfaces")?;
            }
            _ => {}
        }
    }
    run.settle()?;
    if run.messages.is_empty() {
        others.dedup();
        let seen = if others.is_empty() { "no point clouds at all".to_owned() } else { others.join(", ") };
        anyhow::bail!("no /particles and no /walls in this MCAP, but {seen}: give a run or walls");
    }
    Ok(run.messages.iter().map(|(t, n)| json!({ "input": name, "topic": t, "messages": n })).collect())
}

impl<S: Show> Run<'_, S> {
    fn count(&mut self, topic: &str) {
        *self.messages.entry(topic.to_owned()).or_default() += 1;
    }

    fn layer(&mut self, role: Role, word: &str) -> usize {
        let layer = self.show.layer(role, &format!("{word} ({})", self.name));
        self.show.kinds(layer, self.kinds.clone());
        layer
    }

    /// Pushes to the one layer of a topic.
    fn push(&mut self, topic: &str, role: Role, time: f64, table: Table) -> anyhow::Result<()> {
        let layer = match self.layers.get(topic) {
            Some(layer) => *layer,
            None => self.layer(role, if role == Role::Grains { "grains" } else { "walls" }),
        };
        self.layers.insert(topic.to_owned(), layer);
        Ok(self.show.push(layer, time, table)?)
    }

    fn grains(&mut self, time: f64, table: Table) -> anyhow::Result<()> {
        self.settle()?;
        self.count("/particles");
        self.push("/particles", Role::Grains, time, table)
    }

    /// A run writes its wall spheres first, then how they move, and again with every frame when they do.
    fn wall_spheres(&mut self, time: f64, table: Table) -> anyhow::Result<()> {
        self.count("/walls");
        if self.walls.is_some() && table.get("wall").is_some() {
            return Ok(()); // where they are follows from their motion
        }
        match self.waiting.replace((time, table)) {
            Some((time, table)) => self.push("/walls", Role::Walls, time, table),
            None => Ok(()),
        }
    }

    /// Planes, meshes and motions; wall spheres that wait get theirs.
    fn surfaces(&mut self, data: &[u8]) -> anyhow::Result<()> {
        if self.walls.is_some() {
            return Ok(());
        }
        self.count("/surfaces");
        let mut heads = Vec::new();
        for wall in WallRecord::read_all(data).map_err(anyhow::Error::msg)? {
            let WallRecord { name, motion, surface } = wall;
            if let Some(shape) = surface {
                self.show.surface(Surface { name: name.clone(), shape, motion });
            }
            heads.push((name, motion));
        }
        let waiting = self.waiting.take();
        if let Some((time, table)) = waiting {
            self.place(time, &table, &heads)?;
        }
        self.walls = Some(heads);
        Ok(())
    }

    /// Wall spheres at rest are one layer; each wall that moves is its own, kept as it is at t = 0.
    fn place(&mut self, time: f64, table: &Table, walls: &[(String, Motion)]) -> anyhow::Result<()> {
        let Some(number) = table.get("wall").map(stream::Values::to_f64) else {
            return self.push("/walls", Role::Walls, time, table.clone());
        };
        let rows = |keep: &dyn Fn(usize) -> bool| -> Vec<u32> {
            (0..table.rows()).filter(|&i| keep(number[i] as usize)).map(|i| i as u32).collect()
        };
        let still = rows(&|wall| walls.get(wall).is_none_or(|(_, motion)| !motion.moves()));
        if !still.is_empty() {
            self.push("/walls", Role::Walls, time, table.select(&still))?;
        }
        for (wall, (name, motion)) in walls.iter().enumerate().filter(|(_, (_, m))| m.moves()) {
            let own = rows(&|n| n == wall);
            if !own.is_empty() {
                let layer = self.layer(Role::Walls, name);
                self.show.moves(layer, *motion);
                self.show.push(layer, 0.0, record::home(&table.select(&own), &motion.pose(time)))?;
            }
        }
        Ok(())
    }

    /// Shows wall spheres that wait as they are: nothing says how they move.
    fn settle(&mut self) -> anyhow::Result<()> {
        match self.waiting.take() {
            Some((time, table)) => self.push("/walls", Role::Walls, time, table),
            None => Ok(()),
        }
    }
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
