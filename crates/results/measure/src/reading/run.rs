//! A run, event by event: its metadata and its data.

use super::scene_value::vector;
use super::table::Columns;
use crate::bonds::Crack;
use crate::periodic::PeriodicBox;
use crate::reading::frame::{Contacts, Crossing, Frame};
use crate::settled::Settled;
use crate::{Bonds, MeasureError, WallForces};
use geom::mesh::{TriMesh, area};
use geom::{Motion, Plane, Shape, Transform, Vec3};
use record::column::{POSITION, RADIUS, WALL};
use record::metadata::{MATERIALS, OUTLETS, PLACES, SCENE, TIME, WALLS_END};
use record::topic::{
    BODIES, BONDS, CONTACTS, CRACKS, CROSSINGS, DOMAIN, ENERGY, PARTICLES, SETTLING, SURFACES, WALL_FORCES,
    WALL_WEAR, WALLS,
};
use record::{DomainRecord, Ending, RunTimes, SurfaceShape, WallRecord, WallsEnd};
use serde_json::Value;
use std::collections::BTreeMap;
use stream::{Table, mcap::Event};
use wear::WallWear;

/// A hair of slack [s]: frames have their times in nanoseconds.
pub const SLACK: f64 = 1e-9;

/// Wall spheres as they are now.
#[derive(Debug, Clone, Default)]
pub struct WallSpheres {
    /// Centres [m].
    pub position: Vec<Vec3>,
    /// Radii [m].
    pub radius: Vec<f64>,
    /// Index of the wall of each.
    pub wall: Vec<u64>,
    /// When they are there [s].
    pub time: f64,
}

/// The energy ledger at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Ledger {
    /// Time [s].
    pub time: f64,
    /// Name and value [J] of each term, by name; without time and balance.
    pub terms: BTreeMap<String, f64>,
    /// Everything that was there at the start, as the run sums it up [J].
    pub balance: f64,
}

/// Something to measure.
#[derive(Debug, Clone)]
pub enum RunMessage {
    /// Grains at one time.
    Frame(Frame),
    /// Contacts at one time.
    Contacts(Contacts),
    /// Grains that crossed storage planes.
    Crossings(Vec<Crossing>),
    /// The energy ledger at one time.
    Ledger(Ledger),
    /// The force on each wall at one time.
    WallForces(WallForces),
    /// What grains did to parts of walls since the message before.
    WallWear(WallWear),
    /// How far the grains are from rest at one time.
    Settled(Settled),
    /// The periodic domain, where it changes.
    Domain(DomainRecord),
    /// All bonds at one time.
    Bonds(Bonds),
    /// Bonds that broke since the message before.
    Cracks(Vec<Crack>),
}

impl RunMessage {
    /// Its channel, and the time of which it holds the state [s]; `None` for lists of events, which have their own times.
    pub fn at(&self) -> Option<(&'static str, f64)> {
        match self {
            RunMessage::Frame(m) => Some((PARTICLES, m.time)),
            RunMessage::Contacts(m) => Some((CONTACTS, m.time)),
            RunMessage::Ledger(m) => Some((ENERGY, m.time)),
            RunMessage::WallForces(m) => Some((WALL_FORCES, m.time)),
            RunMessage::WallWear(m) => Some((WALL_WEAR, m.time)),
            RunMessage::Settled(m) => Some((SETTLING, m.time)),
            RunMessage::Domain(m) => Some((DOMAIN, m.time)),
            RunMessage::Bonds(m) => Some((BONDS, m.time)),
            RunMessage::Crossings(_) | RunMessage::Cracks(_) => None,
        }
    }
}

/// What the messages of a run have said about it so far.
#[derive(Debug, Clone, Default)]
pub struct Run {
    /// Time step [s]; 0 where it is not known.
    pub step: f64,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Densities of the materials [kg/m³]; NaN where there is none.
    pub densities: Vec<f64>,
    /// Storage planes of its outlets.
    pub outlets: Vec<Plane>,
    /// Direction against gravity [–]; `None` without gravity.
    pub up: Option<Vec3>,
    /// How far along gravity any wall reaches; `None` where grains cannot fall past all of them, or it is not known.
    pub walls_end: Option<WallsEnd>,
    /// Acceleration of free fall [m/s²]; 0 where it is not known.
    pub gravity: f64,
    /// The periodic box as it is now.
    pub periodic: PeriodicBox,
    /// Names of the walls.
    pub walls: Vec<String>,
    /// Indices of their materials, where the run tells them.
    pub wall_materials: Vec<Option<usize>>,
    /// Indices of the walls that are planes.
    pub(crate) planes: Vec<usize>,
    /// Motions of the walls, without those of servos.
    pub motions: Vec<Motion>,
    /// Triangles of the walls that have some, at t = 0.
    pub meshes: Vec<Option<TriMesh>>,
    /// By index of a wall: from where its file has a point to where it is at t = 0.
    pub places: BTreeMap<usize, Transform>,
    pub spheres: WallSpheres,
    /// Changes whenever `spheres` does.
    pub spheres_seen: u64,
    /// Whether it came to its end.
    pub ending: Ending,
    /// A frame with clumps, whose message comes next.
    pub(crate) waiting: Option<Frame>,
}

impl Run {
    /// Takes an event of the stream; gives what can be measured.
    ///
    /// # Errors
    /// Messages that lack columns or hold numbers that cannot be.
    pub fn take(&mut self, event: Event) -> Result<Option<RunMessage>, MeasureError> {
        self.ending.take(&event);
        let seconds = |ns: u64| ns as f64 / 1e9;
        Ok(match event {
            Event::Metadata { name, map } => {
                self.metadata(&name, &map);
                None
            }
            Event::Points { topic, time_ns, table } => self.points(&topic, seconds(time_ns), table)?,
            Event::Bytes { topic, time_ns, data } if topic == ENERGY => {
                Some(RunMessage::Ledger(ledger(seconds(time_ns), &data)?))
            }
            Event::Bytes { topic, time_ns, data } if topic == WALL_FORCES => {
                Some(RunMessage::WallForces(WallForces::new(seconds(time_ns), &data)?))
            }
            Event::Bytes { topic, time_ns, data } if topic == SETTLING => {
                Some(RunMessage::Settled(Settled::new(seconds(time_ns), &data)?))
            }
            Event::Bytes { topic, time_ns, data } if topic == DOMAIN => {
                let time = seconds(time_ns);
                let wrong = |why: String| MeasureError::Message { topic: DOMAIN.to_owned(), time, why };
                let record = DomainRecord::read(&data).map_err(wrong)?;
                self.periodic.range = record.range();
                Some(RunMessage::Domain(record))
            }
            Event::Bytes { topic, data, .. } if topic == SURFACES => {
                self.surfaces(&data);
                None
            }
            Event::Bytes { .. } => None,
        })
    }

    fn points(&mut self, topic: &str, time: f64, table: Table) -> Result<Option<RunMessage>, MeasureError> {
        Ok(match topic {
            PARTICLES => {
                let frame = Frame { periodic: self.periodic, ..Frame::new(time, table, &self.densities)? };
                if frame.has_members() {
                    self.waiting = Some(frame);
                    return Ok(None);
                }
                Some(RunMessage::Frame(frame))
            }
            BODIES => {
                let frame = self.waiting.take().filter(|frame| frame.time == time);
                let whole = frame.map(|frame| frame.with_clumps(&table, &self.densities)).transpose()?;
                whole.map(RunMessage::Frame)
            }
            CONTACTS => Some(RunMessage::Contacts(Contacts::new(time, &table)?)),
            WALL_WEAR => {
                let wrong = |e: record::RecordError| MeasureError::Message {
                    topic: WALL_WEAR.to_owned(),
                    time,
                    why: e.why,
                };
                Some(RunMessage::WallWear(WallWear::new(time, &table).map_err(wrong)?))
            }
            CRACKS => Some(RunMessage::Cracks(Crack::list(time, &table)?)),
            BONDS => Some(RunMessage::Bonds(Bonds::new(time, &table)?)),
            CROSSINGS => Some(RunMessage::Crossings(Crossing::list(time, &table, &self.densities)?)),
            WALLS => {
                let columns = Columns { topic: WALLS, time, table: &table };
                let (position, radius) = (columns.vectors(POSITION)?, columns.positive(RADIUS)?);
                let wall = columns.or_zero(WALL)?.into_iter().map(|w| w as u64).collect();
                self.spheres = WallSpheres { position, radius, wall, time };
                self.spheres_seen += 1;
                None
            }
            _ => None,
        })
    }

    /// What is not understood stays unknown: a run of another program may lack it.
    fn metadata(&mut self, name: &str, map: &BTreeMap<String, String>) {
        let json = |k: usize| serde_json::from_str(map.get(&k.to_string())?).ok();
        let all: Vec<Value> = (0..map.len()).map_while(json).collect();
        match name {
            MATERIALS => {
                let name = |(k, m): (usize, &Value)| m["name"].as_str().map_or(k.to_string(), str::to_owned);
                self.materials = all.iter().enumerate().map(name).collect();
                self.densities = all.iter().map(|m| m["density"].as_f64().unwrap_or(f64::NAN)).collect();
            }
            TIME => self.step = RunTimes::read(map).dt.unwrap_or(0.0),
            WALLS_END => self.walls_end = WallsEnd::read(map),
            PLACES => {
                let place =
                    |(k, text): (&String, &String)| Some((k.parse().ok()?, Transform::parse(text).ok()?));
                self.places = map.iter().filter_map(place).collect();
            }
            OUTLETS => self.outlets = all.iter().filter_map(plane).collect(),
            SCENE => {
                let text = map.get("toml").map_or("", String::as_str);
                if let Ok(scene) = text.parse::<toml::Table>() {
                    self.scene(&scene);
                }
            }
            _ => {}
        }
    }

    fn scene(&mut self, scene: &toml::Table) {
        let gravity = scene.get("gravity").and_then(|g| vector(g, "m/s²"));
        self.gravity = gravity.map_or(0.0, |g| g.norm());
        self.up = gravity.filter(|g| g.norm() > 0.0).map(|g| -g.normalize());
        let Some(domain) = scene.get("domain").and_then(toml::Value::as_table) else { return };
        let [low, high] = ["low", "high"].map(|key| domain.get(key).and_then(|corner| vector(corner, "m")));
        let (Some(low), Some(high)) = (low, high) else { return };
        let axes = domain.get("periodic").and_then(toml::Value::as_array);
        for axis in axes.into_iter().flatten().filter_map(toml::Value::as_str) {
            if let Some(k) = ["x", "y", "z"].iter().position(|name| *name == axis) {
                self.periodic.range[k] = Some((low[k], high[k]));
            }
        }
    }

    fn surfaces(&mut self, data: &[u8]) {
        let walls: Value = serde_json::from_slice(data).unwrap_or_default();
        let name = |(k, w): (usize, &Value)| w["name"].as_str().map_or(k.to_string(), str::to_owned);
        self.walls = walls.as_array().into_iter().flatten().enumerate().map(name).collect();
        let material = |w: &Value| w["material"].as_u64().map(|k| k as usize);
        self.wall_materials = walls.as_array().into_iter().flatten().map(material).collect();
        let is_plane = |w: &Value| w["shape"].get("plane").is_some();
        let rows = walls.as_array().into_iter().flatten().enumerate();
        self.planes = rows.filter(|(_, w)| is_plane(w)).map(|(k, _)| k).collect();
        let mesh = |surface: Option<SurfaceShape>| match surface {
            Some(SurfaceShape::Mesh(mesh)) => Some(mesh),
            Some(SurfaceShape::Plane(_)) | None => None,
        };
        let walls = WallRecord::read_all(data).unwrap_or_default();
        (self.motions, self.meshes) = walls.into_iter().map(|w| (w.motion, mesh(w.surface))).unzip();
    }

    /// Where the file of each wall sphere has it, and its radius there [m]: without the motion of the wall so far, and where it was put. What a servo has
    /// moved stays.
    pub fn spheres_of_files(&self) -> Vec<(Vec3, f64)> {
        let WallSpheres { position, radius, wall, time } = &self.spheres;
        let place =
            |k: usize| self.of_file(wall[k] as usize, self.home(wall[k], *time, &position[k]), radius[k]);
        (0..position.len()).map(place).collect()
    }

    /// Where a point of a wall was at t = 0 [m], that is at `place` at a `time` [s]; what a servo has moved stays.
    pub fn home(&self, wall: u64, time: f64, place: &Vec3) -> Vec3 {
        let moved = self.motions.get(wall as usize).filter(|motion| motion.moves());
        moved.map_or(*place, |motion| motion.pose(time).home(place))
    }

    /// Where the file of a wall has a point that is at `home` at t = 0, and how long a length is there [m].
    fn of_file(&self, wall: usize, home: Vec3, length: f64) -> (Vec3, f64) {
        let Some(back) = self.places.get(&wall).map(Transform::inverse) else { return (home, length) };
        (back.point(&home), length * back.factor().unwrap_or(1.0))
    }

    /// Centroid of each triangle of a wall as its file has it, and the radius of a disk of its area there [m]; none of other walls.
    pub fn triangles_of_file(&self, wall: usize) -> Vec<(Vec3, f64)> {
        let triangles = self.meshes.get(wall).into_iter().flatten().flat_map(TriMesh::triangles);
        let place = |corners: [Vec3; 3]| {
            let [a, b, c] = corners;
            self.of_file(wall, (a + b + c) / 3.0, (area(corners) / std::f64::consts::PI).sqrt())
        };
        triangles.map(place).collect()
    }

    /// Whether a wall is one plane, which has no parts.
    pub fn is_plane(&self, wall: usize) -> bool {
        self.planes.contains(&wall)
    }

    /// Whether a time lies between two [s], these included. What is due at a time is written at the step nearest to it, so half a step more counts.
    pub fn is_between(&self, (from, until): (f64, f64), time: f64) -> bool {
        let slack = 0.5 * self.step + SLACK;
        from - slack <= time && time <= until + slack
    }

    /// Whether a point or one of its images [m] lies in a shape, in the periodic box of now.
    pub fn holds(&self, shape: &Shape, point: &Vec3) -> bool {
        self.periodic.holds(shape, point)
    }
}

fn plane(json: &Value) -> Option<Plane> {
    let vector = |v: &Value| Some(Vec3::new(v[0].as_f64()?, v[1].as_f64()?, v[2].as_f64()?));
    Plane::new(vector(&json["plane"]["point"])?, vector(&json["plane"]["normal"])?).ok()
}

fn ledger(time: f64, data: &[u8]) -> Result<Ledger, MeasureError> {
    let wrong = |why: &str| MeasureError::Message { topic: ENERGY.to_owned(), time, why: why.to_owned() };
    let message: Value = serde_json::from_slice(data).map_err(|e| wrong(&e.to_string()))?;
    let map = message.as_object().ok_or_else(|| wrong("no JSON object"))?;
    let number = |(name, value): (&String, &Value)| Some((name.clone(), value.as_f64()?));
    let mut terms: BTreeMap<String, f64> = map.iter().filter_map(number).collect();
    let balance = terms.remove("balance").ok_or_else(|| wrong("its 'balance' is missing"))?;
    let time = terms.remove("time").unwrap_or(time);
    Ok(Ledger { time, terms, balance })
}
