//! Reads a run, or walls: grains and wall spheres over time, planes and meshes, how walls move, and what is shown besides.

use crate::reading::history::History;
use crate::reading::show::{LayerHead, Show};
use crate::reading::worn::{ShownPart, WornWalls};
use crate::things::chains::{self, MOST};
use crate::things::extras;
use crate::{Arrows, Extras, Motion, Role, ViewError, WallSurface};
use geom::Vec3;
use record::column::{BROKEN, RADIUS, WALL};
use record::metadata::{CLUMPS, MATERIALS, WALLS_END};
use record::topic::{BONDS, CONTACTS, PARTICLES, SURFACES, WALL_WEAR, WALLS};
use record::{ClumpRecord, Map, MaterialRecord, SurfaceShape, WallRecord, WallsEnd};
use std::collections::{BTreeMap, HashMap};
use stream::mcap::{Event, McapError};
use stream::{Table, Values};

/// What is known of a run so far.
struct ViewedRun<'a, S> {
    name: &'a str,
    extras: Extras,
    show: &'a mut S,
    /// Names of the materials.
    kinds: Vec<String>,
    /// Shapes of clumps.
    clumps: Vec<ClumpRecord>,
    /// The layer of a topic.
    layers: HashMap<&'static str, usize>,
    /// Grains that wait for the bonds or contacts of their time.
    frame: Option<(f64, Table)>,
    /// Mean radius of the grains [m].
    usual: f64,
    /// Wall spheres that came before their motion is known.
    waiting: Option<(f64, Table)>,
    /// All walls, once the run has named them.
    walls: Option<Vec<WallHead>>,
    /// When grains were first seen, where that is shown.
    history: Option<History>,
    /// What grains did to walls, where that is shown.
    worn: Option<WornWalls>,
    /// Messages of each topic that is shown.
    messages: BTreeMap<&'static str, usize>,
}

/// The layer of the arrows that are made of frames.
const VELOCITIES: &str = "velocities";

/// Name and motion of a wall.
struct WallHead {
    name: String,
    motion: Motion,
}

/// Shows every `/particles`, `/walls` and `/surfaces` message of a run, and the `extras`; gives the number of messages
/// by topic.
///
/// # Errors
/// A stream that breaks off, holds neither particles nor walls nor what is asked for besides, or has a message that
/// cannot be shown.
pub fn show_run(
    events: impl Iterator<Item = Result<Event, McapError>>,
    name: &str,
    extras: Extras,
    show: &mut impl Show,
) -> Result<BTreeMap<&'static str, usize>, ViewError> {
    let mut run = ViewedRun {
        name,
        extras,
        show,
        kinds: Vec::new(),
        clumps: Vec::new(),
        layers: HashMap::new(),
        frame: None,
        usual: 0.0,
        waiting: None,
        walls: None,
        history: extras.history.then(History::default),
        worn: extras.wear.map(WornWalls::new),
        messages: BTreeMap::new(),
    };
    let mut others = Vec::new();
    for event in events {
        match event? {
            Event::Metadata { name, map } if name == MATERIALS => run.kinds = names(&map),
            Event::Metadata { name, map } if name == WALLS_END => {
                WallsEnd::read(&map).into_iter().for_each(|end| run.show.walls_end(end));
            }
            // A record that cannot be read is one of spheres, as without it.
            Event::Metadata { name: of, map } if of == CLUMPS => {
                run.clumps = ClumpRecord::from_map(name, &map).unwrap_or_default();
            }
            Event::Points { topic, time_ns, table } => match topic.as_str() {
                PARTICLES => run.grains(time_ns as f64 / 1e9, table)?,
                WALLS => run.wall_spheres(time_ns as f64 / 1e9, table)?,
                BONDS if extras.needs_bonds() => run.bonds(time_ns as f64 / 1e9, &table)?,
                CONTACTS if extras.needs_contacts() => {
                    run.contacts(time_ns as f64 / 1e9, &table)?;
                }
                WALL_WEAR if extras.wear.is_some() => run.wear(time_ns as f64 / 1e9, &table)?,
                _ => others.push(topic),
            },
            Event::Bytes { topic, data, .. } if topic == SURFACES => run.surfaces(&data)?,
            _ => {}
        }
    }
    run.settle()?;
    run.release(None)?;
    if run.messages.is_empty() {
        others.dedup();
        return Err(ViewError::NoTopic { others });
    }
    run.has_extras()?;
    Ok(run.messages)
}

impl<S: Show> ViewedRun<'_, S> {
    fn count(&mut self, topic: &'static str) {
        *self.messages.entry(topic).or_default() += 1;
    }

    fn layer(&mut self, role: Role, word: &str, motion: Motion) -> usize {
        let (kinds, clumps) = (self.kinds.clone(), self.clumps.clone());
        self.show.layer(LayerHead { role, name: format!("{word} ({})", self.name), kinds, clumps, motion })
    }

    /// Pushes to the one layer of a topic.
    fn push(&mut self, topic: &'static str, role: Role, time: f64, table: Table) -> Result<(), ViewError> {
        let word = match role {
            Role::Arrows(of) => of.word(),
            role => role.word(),
        };
        let layer = match self.layers.get(topic) {
            Some(layer) => *layer,
            None => self.layer(role, word, Motion::default()),
        };
        self.layers.insert(topic, layer);
        self.show.push(layer, time, table)
    }

    fn grains(&mut self, time: f64, table: Table) -> Result<(), ViewError> {
        self.settle()?;
        self.count(PARTICLES);
        self.release(None)?;
        if let Some(radius) = table.get(RADIUS).map(Values::to_f64).filter(|r| !r.is_empty()) {
            self.usual = radius.iter().sum::<f64>() / radius.len() as f64;
        }
        self.frame = Some((time, table));
        if self.extras.waits() { Ok(()) } else { self.release(None) }
    }

    /// Shows the grains that wait, with the share of their bonds that are broken, and their arrows.
    fn release(&mut self, broken: Option<Vec<f64>>) -> Result<(), ViewError> {
        let Some((time, mut table)) = self.frame.take() else { return Ok(()) };
        if self.extras.needs_bonds() {
            let share = broken.unwrap_or_else(|| vec![0.0; table.rows()]);
            table.replace(BROKEN, Values::F64(share)).map_err(|e| ViewError::Table { why: e.to_string() })?;
        }
        self.history.as_mut().map_or(Ok(()), |history| history.add(time, &mut table))?;
        let arrows = match self.extras.arrows {
            Some(Arrows::Velocity) => Some(extras::velocities(&table)?),
            _ => None,
        };
        self.push(PARTICLES, Role::Grains, time, table)?;
        // After the grains: what shows one moment takes the arrows of the grains that it shows.
        match arrows {
            Some(arrows) => self.push(VELOCITIES, Role::Arrows(Arrows::Velocity), time, arrows),
            None => Ok(()),
        }
    }

    fn bonds(&mut self, time: f64, table: &Table) -> Result<(), ViewError> {
        self.count(BONDS);
        let Some((_, grains)) = self.frame.as_ref().filter(|(of, _)| *of == time) else { return Ok(()) };
        let (rods, share) = extras::bonds(table, grains)?;
        self.release(Some(share))?;
        if self.extras.bonds { self.push(BONDS, Role::Bonds, time, rods) } else { Ok(()) }
    }

    fn contacts(&mut self, time: f64, table: &Table) -> Result<(), ViewError> {
        self.count(CONTACTS);
        let of_frame = self.frame.as_ref().filter(|(of, _)| self.extras.chains && *of == time);
        let chains = of_frame.map(|(_, grains)| chains::chains(table, grains, MOST)).transpose()?;
        self.release(None)?;
        match chains {
            Some(rods) => self.push(CONTACTS, Role::ForceChains, time, rods),
            None if self.extras.chains => Ok(()),
            None => {
                let arrows = extras::forces(table, self.usual)?;
                self.push(CONTACTS, Role::Arrows(Arrows::Force), time, arrows)
            }
        }
    }

    /// An error if something is asked for that the run does not hold.
    fn has_extras(&self) -> Result<(), ViewError> {
        let grains = self.messages.contains_key(PARTICLES);
        let none = |topic| grains && !self.messages.contains_key(topic);
        if self.extras.needs_bonds() && none(BONDS) {
            let option = if self.extras.bonds { "--bonds" } else { "--colour broken" }.to_owned();
            let cure = "give a run whose scene has a [[bond]] that joins grains, or leave it out";
            return Err(ViewError::NoSuch { option, what: "bonds", cure });
        }
        if self.extras.needs_contacts() && none(CONTACTS) {
            let (option, cure) = match self.extras.chains {
                true => (
                    "--force-chains",
                    "set output.contacts = true and run again (dem-run SCENE --set output.contacts=true -o RUN)",
                ),
                false => (
                    "--vectors force",
                    "set [output] contacts = true and run again, or show --vectors velocity",
                ),
            };
            return Err(ViewError::NoSuch { option: option.to_owned(), what: "contacts", cure });
        }
        if let Some(worn) = &self.worn {
            let option = "--walls-colour".to_owned();
            if !self.messages.contains_key(WALL_WEAR) {
                let cure =
                    "set output.wear = true and run again (dem-run SCENE --set output.wear=true -o RUN)";
                return Err(ViewError::NoSuch { option, what: "wear of walls (/wall_wear)", cure });
            }
            if worn.is_empty() {
                let cure = "planes have no parts: give a wall as mesh = FILE, or measure the plane with dem-measure --wall-force all";
                return Err(ViewError::NoSuch { option, what: "walls of triangles or spheres", cure });
            }
            if !worn.is_touched() {
                return Err(ViewError::Untouched);
            }
        }
        Ok(())
    }

    /// A run writes its wall spheres first, then how they move, and again with every frame when they do.
    fn wall_spheres(&mut self, time: f64, table: Table) -> Result<(), ViewError> {
        self.count(WALLS);
        if self.walls.is_some() && table.get(WALL).is_some() {
            return Ok(()); // their positions follow from their motion
        }
        match self.waiting.replace((time, table)) {
            Some((time, table)) => self.push(WALLS, Role::Walls, time, table),
            None => Ok(()),
        }
    }

    /// Planes, meshes and motions; wall spheres that wait get theirs.
    fn surfaces(&mut self, data: &[u8]) -> Result<(), ViewError> {
        if self.walls.is_some() {
            return Ok(());
        }
        self.count(SURFACES);
        let mut heads = Vec::new();
        for WallRecord { name, motion, surface } in WallRecord::read_all(data).map_err(ViewError::Surfaces)? {
            if let Some(shape) = surface {
                let areas = match &shape {
                    SurfaceShape::Mesh(mesh) if self.worn.is_some() => Some(wear::of_triangles(mesh)),
                    _ => None,
                };
                let surface =
                    self.show.surface(WallSurface { name: name.clone(), shape, motion: motion.clone() });
                if let (Some(worn), Some(areas)) = (&mut self.worn, areas) {
                    worn.show(ShownPart::Surface(surface), vec![(heads.len() as u64, areas)]);
                }
            }
            heads.push(WallHead { name, motion });
        }
        if let Some((time, table)) = self.waiting.take() {
            self.place(time, &table, &heads)?;
        }
        self.walls = Some(heads);
        match &self.worn {
            // Before the first interval nothing was done.
            Some(worn) => self.show.wear(0.0, worn.state()),
            None => Ok(()),
        }
    }

    /// What grains did to parts of walls since the frame before.
    fn wear(&mut self, time: f64, table: &Table) -> Result<(), ViewError> {
        self.count(WALL_WEAR);
        let Some(worn) = &mut self.worn else { return Ok(()) };
        worn.take(time, table).map_err(|e| ViewError::Wear { time, why: e.why })?;
        self.show.wear(time, worn.state())
    }

    /// A layer of wall spheres with the walls of its rows.
    fn show_worn(&mut self, layer: usize, table: &Table, wall: &[f64]) {
        let Some(worn) = &mut self.worn else { return };
        let column = |name: &str| table.get(name).map(Values::to_f64).unwrap_or_default();
        let [x, y, z, radius] = ["x", "y", "z", RADIUS].map(column);
        let mut walls = Vec::new();
        let mut first = 0;
        for of_wall in wall.chunk_by(|a, b| a == b) {
            let rows = first..first + of_wall.len();
            let centres: Vec<Vec3> = rows.clone().map(|k| Vec3::new(x[k], y[k], z[k])).collect();
            walls.push((of_wall[0] as u64, wear::of_spheres(&centres, &radius[rows])));
            first += of_wall.len();
        }
        worn.show(ShownPart::Layer(layer), walls);
    }

    /// Wall spheres at rest are one layer; each wall that moves is a separate one, kept as it is at t = 0.
    fn place(&mut self, time: f64, table: &Table, walls: &[WallHead]) -> Result<(), ViewError> {
        let Some(number) = table.get(WALL).map(Values::to_f64) else {
            return self.push(WALLS, Role::Walls, time, table.clone());
        };
        let rows = |keep: &dyn Fn(usize) -> bool| -> Vec<u32> {
            (0..table.rows()).filter(|&i| keep(number[i] as usize)).map(|i| i as u32).collect()
        };
        let still = rows(&|wall| walls.get(wall).is_none_or(|w| !w.motion.moves()));
        let of = |rows: &[u32]| rows.iter().map(|row| number[*row as usize]).collect::<Vec<f64>>();
        if !still.is_empty() {
            let own = table.select(&still);
            self.push(WALLS, Role::Walls, time, own.clone())?;
            if let Some(layer) = self.layers.get(WALLS).copied() {
                self.show_worn(layer, &own, &of(&still));
            }
        }
        for (wall, WallHead { name, motion }) in walls.iter().enumerate().filter(|(_, w)| w.motion.moves()) {
            let own = rows(&|n| n == wall);
            if !own.is_empty() {
                let layer = self.layer(Role::Walls, name, motion.clone());
                let home = record::home(&table.select(&own), &motion.pose(time));
                self.show_worn(layer, &home, &of(&own));
                self.show.push(layer, 0.0, home)?;
            }
        }
        Ok(())
    }

    /// Shows wall spheres that wait as they are: nothing says how they move.
    fn settle(&mut self) -> Result<(), ViewError> {
        match self.waiting.take() {
            Some((time, table)) => self.push(WALLS, Role::Walls, time, table),
            None => Ok(()),
        }
    }
}

/// Names of the materials by number; a number without one is its own name.
fn names(map: &Map) -> Vec<String> {
    let known =
        |key: &str| serde_json::from_str::<MaterialRecord>(map.get(key)?).ok().map(|material| material.name);
    let count = map.keys().filter_map(|k| k.parse::<u16>().ok()).max().map_or(0, |k| usize::from(k) + 1);
    (0..count).map(|k| known(&k.to_string()).unwrap_or_else(|| k.to_string())).collect()
}
