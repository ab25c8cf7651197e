//! `[[particles]]`: spheres from CSV, PLY, or the last frame of a run.

use super::csv::csv;
use super::run_walls::{RunContacts, run_walls};
use crate::error::{Result, SceneError};
use dem::setup::{KeptContact, Particle};
use geom::Shown;
use record::column::{
    BODY, CLUSTER, DIAMETER, ID, MATERIAL, ORIENTATION, ORIENTATION_REAL, POSITION, RADIUS, SCALE,
};
use record::column::{SPIN, VELOCITY};
use record::{ClumpRecord, Columns, LogMessage, MaterialRecord, WallRecord, metadata, topic};
use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::Path;
use stream::mcap::{Event, Reader, in_order};
use stream::{Table, Values};

/// Particles of a file. Their materials are indices of `materials`, when the file names its own.
#[derive(Debug, Clone)]
pub struct ParticleFile {
    /// Particles; ids are those of the file, when it has them.
    pub particles: Vec<Particle>,
    /// Whether the file has ids.
    pub has_ids: bool,
    /// Cluster of each; `None` where the file has none.
    pub clusters: Option<Vec<u32>>,
    /// The materials that the file names.
    pub materials: Vec<MaterialRecord>,
    /// SHA-256 of the columns.
    pub hash: String,
    /// Warning about columns that are not used, or about a run that did not reach its end.
    pub warning: Option<String>,
    /// Histories of the contacts of a run, with its walls.
    pub kept: RunContacts,
    /// Rigid clumps of a run; their spheres are not among the particles.
    pub clumps: Option<RunClumps>,
}

/// Rigid clumps of the last frame of a run.
#[derive(Debug, Clone, Default)]
pub struct RunClumps {
    /// Their shapes, by index.
    pub shapes: Vec<ClumpRecord>,
    /// A row for each clump: the topic `/bodies`.
    pub rows: Table,
}

/// The columns of a file.
pub struct ParticleTable {
    /// Name of the file.
    pub name: String,
    /// Its columns.
    pub table: Table,
    /// The materials that it names.
    pub materials: Vec<MaterialRecord>,
    /// Whether it is a run.
    pub is_run: bool,
    /// Why that run was stopped before its end.
    pub stopped: Option<LogMessage>,
    /// Its contact histories, with its walls.
    pub kept: RunContacts,
    /// The rigid clumps of that run.
    pub clumps: Option<RunClumps>,
}

impl ParticleTable {
    /// Reads a file; its format is detected by content.
    ///
    /// # Errors
    /// A file of another kind; a factor for a run, which is in metres.
    pub fn read(path: &Path, factor: f64) -> Result<ParticleTable> {
        let name = path.display().to_string();
        let bytes = stream::whole::file(path).map_err(|e| SceneError::read(path, e))?;
        if bytes.starts_with(b"\x89MCAP") {
            if factor != 1.0 {
                let why = "is a run: its lengths are in metres";
                return Err(SceneError::file(&name, why, "take scale or units out of its [[particles]]"));
            }
            return last_frame(name, &bytes);
        }
        let mut table =
            if bytes.starts_with(b"ply") { vertices(&name, &bytes)? } else { csv(&name, &bytes, is_unused)? };
        if factor != 1.0 {
            for column in [&POSITION[..], &VELOCITY, &[RADIUS, DIAMETER]].concat() {
                let Some(values) = table.get(column).map(Values::to_f64) else { continue };
                let values = Values::F64(values.iter().map(|v| v * factor).collect());
                table.replace(column, values).map_err(|e| SceneError::content(&name, "particles", e))?;
            }
        }
        Ok(ParticleTable::listed(name, table))
    }

    /// Of a file other than a run.
    fn listed(name: String, table: Table) -> ParticleTable {
        let (materials, kept) = Default::default();
        ParticleTable { name, table, materials, is_run: false, stopped: None, kept, clumps: None }
    }

    /// Its columns as numbers.
    pub fn columns(&self) -> Columns<'_> {
        Columns { name: &self.name, table: &self.table }
    }

    fn particles(self) -> Result<ParticleFile> {
        let columns = self.columns();
        let positions = columns.vectors(POSITION)?;
        let radii = columns.radii()?;
        let (velocities, spins) = (columns.vectors_or_zero(VELOCITY)?, columns.vectors_or_zero(SPIN)?);
        let ids = columns.indices(ID, f64::from(u32::MAX - 1))?;
        let clusters = columns.indices(CLUSTER, f64::from(u32::MAX))?;
        let material = match self.materials.len() {
            0 => None,
            count => columns.indices(MATERIAL, count as f64 - 1.0)?,
        };
        let particle = |i: usize| Particle {
            id: ids.as_ref().map_or(i as u32, |ids| ids[i]),
            material: material.as_ref().map_or(0, |m| m[i] as u16),
            radius: radii[i],
            position: positions[i],
            velocity: velocities[i],
            spin: spins[i],
        };
        let free = self.free(&columns)?;
        let clusters = clusters.map(|all| free.iter().map(|&i| all[i]).collect());
        let particles = free.into_iter().map(particle).collect();
        let warning = match self.table.rows() {
            0 => Some(format!("{}: holds no particle: it has names of columns and no row", self.name)),
            // A run has columns that are not read here.
            _ if self.is_run => self.stopped.as_ref().map(|stop| {
                let (name, time, text) = (&self.name, Shown(stop.time), &stop.text);
                format!("{name}: the run was stopped at t = {time} s ({text}); its last frame is used all the same")
            }),
            _ if self.materials.is_empty() => columns.unused(&known()),
            _ => columns.unused(&[&known()[..], &[MATERIAL, CLASS]].concat()),
        };
        let hash = record::hash(&self.table);
        let has_ids = ids.is_some();
        let (materials, mut kept, clumps) = (self.materials, self.kept, self.clumps);
        if !kept.contacts.is_empty() {
            let id = |i: usize| ids.as_ref().map_or(i as u32, |ids| ids[i]);
            kept.grains = (0..positions.len()).map(|i| (id(i), positions[i], radii[i])).collect();
            kept.grains.sort_unstable_by_key(|grain| grain.0);
        }
        Ok(ParticleFile { particles, has_ids, clusters, materials, hash, warning, kept, clumps })
    }

    /// Rows that are no sphere of a clump.
    fn free(&self, columns: &Columns) -> Result<Vec<usize>> {
        let rows = 0..self.table.rows();
        let Some(clumps) = &self.clumps else { return Ok(rows.collect()) };
        let any = f64::from(u32::MAX);
        let bodies = Columns { name: &self.name, table: &clumps.rows }.needed(ID, any)?;
        let (bodies, of) = (BTreeSet::from_iter(bodies), columns.needed(BODY, any)?);
        Ok(rows.filter(|&row| !bodies.contains(&of[row])).collect())
    }
}

/// Size class of stones, which stone-pack writes for other tools; not used here.
const CLASS: &str = "class";

/// Columns of a CSV or PLY that are read.
fn known() -> Vec<&'static str> {
    let sizes: &[&str] = &[RADIUS, DIAMETER];
    [&[ID], &POSITION[..], sizes, &VELOCITY, &SPIN, &[CLUSTER]].concat()
}

/// Whether no particle and no clump has a column of this name: it may lack values.
fn is_unused(column: &str) -> bool {
    let of_clumps = [&ORIENTATION[..], &[ORIENTATION_REAL, SCALE]].concat();
    !known().contains(&column) && column != MATERIAL && !of_clumps.contains(&column)
}

impl ParticleFile {
    /// Reads spheres.
    ///
    /// # Errors
    /// A file of another kind, columns that are missing or wrong; a run with clumps.
    pub fn read(path: &Path, factor: f64) -> Result<ParticleFile> {
        let file = ParticleFile::read_with(path, factor, &[])?;
        if file.clumps.is_some() {
            let why = "is a run with clumps: only dem-run places these";
            return Err(SceneError::file(&path.display().to_string(), why, "give a run of spheres"));
        }
        Ok(file)
    }

    /// Reads spheres and, of a run, clumps; `materials` are those that the numbers in the column `material` of a CSV or PLY stand for.
    ///
    /// # Errors
    /// As [`ParticleFile::read`]; no such column, or a run, which names its own.
    pub fn read_with(path: &Path, factor: f64, materials: &[String]) -> Result<ParticleFile> {
        let mut table = ParticleTable::read(path, factor)?;
        if !materials.is_empty() {
            if table.is_run || table.table.get(MATERIAL).is_none() {
                let why = if table.is_run {
                    "is a run, which names its materials"
                } else {
                    "has no column 'material'"
                };
                return Err(SceneError::file(&table.name, why, "give 'material' instead of 'materials'"));
            }
            let named = |name: &String| MaterialRecord { name: name.clone(), ..MaterialRecord::default() };
            table.materials = materials.iter().map(named).collect();
        }
        table.particles()
    }
}

fn vertices(name: &str, bytes: &[u8]) -> Result<Table> {
    let ply = stream::ply::parse(bytes).map_err(|e| SceneError::content(name, "particles", e))?;
    let vertex = ply.elements.into_iter().find(|e| e.name == "vertex");
    let none = || SceneError::file(name, "has no element 'vertex'", "give particles as vertices");
    Ok(vertex.ok_or_else(none)?.table)
}

fn last_frame(name: String, bytes: &[u8]) -> Result<ParticleTable> {
    let (mut frame, mut materials, mut stopped) = (None, Vec::new(), None);
    let (mut history, mut walls, mut spheres) = (Vec::new(), Vec::new(), None);
    let (mut shapes, mut bodies) = (Vec::new(), None);
    let from = in_order(Cursor::new(bytes)).map_err(|e| SceneError::content(&name, "a run", e))?;
    for event in Reader::new(from) {
        match event.map_err(|e| SceneError::content(&name, "a run", e))? {
            Event::Metadata { name: record, map } if record == metadata::MATERIALS => {
                materials = MaterialRecord::from_map(&name, &map)?;
            }
            Event::Points { topic, time_ns, table } if topic == topic::PARTICLES => {
                frame = Some((time_ns, table))
            }
            Event::Metadata { name: record, map } if record == metadata::CLUMPS => {
                shapes = ClumpRecord::from_map(&name, &map)?;
            }
            Event::Points { topic, time_ns, table } if topic == topic::BODIES => {
                bodies = Some((time_ns, table))
            }
            // Large runs write it in several messages.
            Event::Points { topic, time_ns, table } if topic == topic::HISTORY => {
                history.retain(|(at, _)| *at == time_ns);
                history.push((time_ns, table));
            }
            Event::Bytes { topic, data, .. } if topic == topic::SURFACES => {
                let read = WallRecord::read_all(&data)
                    .map_err(|e| SceneError::file(&name, &e, "give a run that dem-run wrote"))?;
                walls = read;
            }
            Event::Points { topic, time_ns, table } if topic == topic::WALLS => {
                spheres.get_or_insert((time_ns, table));
            }
            Event::Bytes { topic, data, .. } if topic == topic::LOG => {
                stopped = LogMessage::read_stop(&data).or(stopped);
            }
            _ => {}
        }
    }
    let none = || SceneError::file(&name, "has no message on /particles", "give a run that dem-run wrote");
    let (time, table) = frame.ok_or_else(none)?;
    let mut kept = RunContacts { source: name.clone(), ..RunContacts::default() };
    for (_, rows) in history.into_iter().filter(|(at, _)| *at == time) {
        kept.contacts.extend(super::history::from_table(&name, &rows)?);
    }
    if kept.contacts.iter().any(KeptContact::is_of_wall) {
        kept.walls = run_walls(&name, walls, spheres, time)?;
    }
    let clumps = match bodies {
        Some((at, rows)) if at == time => Some(RunClumps { shapes, rows }),
        _ if table.get(BODY).is_some() => {
            let why = "has clumps, and no message on /bodies with its last frame";
            return Err(SceneError::file(&name, why, "give a run that dem-run wrote"));
        }
        _ => None,
    };
    Ok(ParticleTable { table, name, materials, is_run: true, stopped, kept, clumps })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str, text: &[u8]) -> Result<ParticleFile> {
        let (name, table) = (name.to_owned(), csv(name, text, is_unused)?);
        ParticleTable::listed(name, table).particles()
    }

    /// Messages on `/history` with the last frame add up; those of an earlier frame do not count.
    #[test]
    fn histories_of_a_large_run_come_in_several_messages() {
        use super::super::history::to_table;
        use dem::setup::{ContactHistory, KeptPartner};
        use record::FRAME;
        use stream::mcap::{Provenance, Writer};
        let contact = |id: u32| KeptContact {
            id,
            partner: KeptPartner::Particle(id + 1),
            history: ContactHistory::default(),
        };
        let mut writer = Writer::new(Vec::new(), &Provenance::default()).unwrap();
        for (time, ids) in [(1, 0..2), (2, 10..13), (2, 20..21)] {
            let table = csv("a.csv", b"x,y,z,radius\n0,1,2,0.5\n", is_unused).unwrap();
            writer.points(topic::PARTICLES, time, FRAME, table).unwrap();
            let rows: Vec<KeptContact> = ids.map(contact).collect();
            writer.points(topic::HISTORY, time, FRAME, to_table(&rows)).unwrap();
        }
        let read = last_frame("run.mcap".to_owned(), &writer.finish().unwrap()).unwrap();
        let ids: Vec<u32> = read.kept.contacts.iter().map(|k| k.id).collect();
        assert_eq!(ids, [10, 11, 12, 20]);
    }

    #[test]
    fn a_csv_has_names_and_numbers() {
        let found = file("a.csv", b"# pile\nid,x,y,z,radius,vx,vy,vz\n4, 0,1,2,0.5, 1,0,0\n").unwrap();
        let first = found.particles[0];
        assert_eq!((first.id, first.position.z, first.velocity.x, found.warning), (4, 2.0, 1.0, None));
        let found = file("pl.csv", b"x,y,z,radius,vz,wy,v_z\n0,1,2,0.5,-3,4,5\n").unwrap();
        let (velocity, spin) = (found.particles[0].velocity, found.particles[0].spin);
        assert_eq!((velocity.x, velocity.z, spin.y, spin.z), (0.0, -3.0, 4.0, 0.0));
        let note =
            "pl.csv: column 'v_z' is not used; known: id x y z radius diameter vx vy vz wx wy wz cluster";
        assert_eq!(found.warning.as_deref(), Some(note));
        // The index of a data frame, and notes.
        let found = file("i.csv", b",x,y,z,radius,note\n0,1,2,3,0.5,\n1,4,5,6,0.5,wet\n").unwrap();
        assert_eq!(found.particles[1].position.x, 4.0);
        assert!(found.warning.is_some_and(|told| told.contains("'(unnamed)', 'note' are not used")));
        // As spreadsheets and data frames write it.
        let quoted = b"\"id\",\"x\",\"y\",\"z\",\"radius\"\n\"4\",0,1,\"2\",0.5\n";
        let first = file("q.csv", quoted).unwrap().particles[0];
        assert_eq!((first.id, first.position.z, first.radius), (4, 2.0, 0.5));
        for (text, part) in
            [("1,2,3", "names is missing"), ("x,y\n1", "line 2: 1 numbers"), ("x\na", "'a' is not a number")]
        {
            let message = file("a.csv", text.as_bytes()).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        let names: String = (0..200_000).map(|k| format!("c{k},")).collect();
        let message = file("a.csv", names.as_bytes()).unwrap_err().to_string();
        assert!(message.contains("200000 names are more than 4096 columns"), "{message}");
        let message = file("a.csv", b"x,y,z,radius\n0,0,0,1e308").unwrap_err().to_string();
        assert!(message.contains("radius = 1e308 is too large"), "{message}");
        let message = file("a.csv", b"x,y,z,radius\n0,0,0,-1").unwrap_err().to_string();
        assert!(message.contains("radius -1 m"), "{message}");
    }
}
