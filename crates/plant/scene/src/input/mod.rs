//! Files that a scene names or a run is given: walls, inlets, particles, meshes.
//!
//! Walls and inlets are MCAP and detected by their content ([`Input::open`]). Walls, particles and meshes are read whole; of an inlet
//! only the head is read here, and the stages read the rest as the run needs it. Uses `record` for all formats; knows no keys of scenes.

mod csv;
mod head;
pub mod history;
mod load;
mod particles;
mod run_walls;
mod walls;
mod zone;

pub use head::{InletSource, Source};
pub use load::{LOAD_COLUMNS, STRAIN_COLUMNS, read_domain, read_load};
pub use particles::{ParticleFile, ParticleTable, RunClumps};
pub use run_walls::{RunContacts, RunWall};
pub use walls::{WallFile, WallSphere};
pub use zone::ZoneRecord;

use crate::error::{Result, SceneError};
use geom::Vec3;
use geom::mesh::TriMesh;
use geom::motion::PathRow;
use head::StreamHead;
use record::{metadata, topic};
use std::path::Path;
use stream::Table;
use stream::mcap::{Event, McapError, Reader};

/// A stream, as far as it had to be read to know what it is.
pub enum Input {
    /// Wall spheres; read whole.
    Walls(WallFile),
    /// Recorded particles; read as the run needs them.
    Inlet(Box<InletSource>),
}

/// A table of text with a line of names, and the name that messages use.
///
/// # Errors
/// A file that cannot be read, or is none.
pub fn table_of(path: &Path) -> Result<(String, Table)> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).map_err(|e| SceneError::read(path, e))?;
    let table = csv::csv(&name, &bytes, |_| false)?;
    Ok((name, table))
}

const GIVE: &str = "give walls (wallgen) or an inlet (stage-replay)";

impl Input {
    /// Opens a stream under the name that messages use, the path of a file.
    ///
    /// # Errors
    /// A stream that breaks off, or holds neither walls nor crossings.
    pub fn open(name: &str, source: Source) -> Result<Input> {
        let mut reader = Reader::new(source);
        let mut head = StreamHead::default();
        loop {
            let event = reader.next().ok_or_else(|| SceneError::file(name, "holds no message", GIVE))?;
            match event.map_err(|e| broken(name, e))? {
                Event::Metadata { name: record, .. } if record == metadata::SCENE => {
                    let cure = "pass it through stage-replay to let its particles in";
                    return Err(SceneError::file(name, "is a run, neither walls nor an inlet", cure));
                }
                Event::Metadata { name: record, map } => {
                    head.take(name, &record, &map)?;
                    // The last record of an inlet: messages after it may come as late as a run upstream makes them.
                    if record == metadata::INLET {
                        return InletSource::input(name, reader, None, head);
                    }
                }
                event => return Input::by_topic(name, reader, event, head),
            }
        }
    }

    /// Opens a file that a scene names.
    ///
    /// # Errors
    /// As [`Input::open`], and a file that cannot be read.
    pub fn open_file(path: &Path) -> Result<Input> {
        let name = path.display().to_string();
        let file = std::fs::File::open(path).and_then(stream::mcap::in_order);
        Input::open(&name, file.map_err(|e| SceneError::read(path, e))?)
    }

    fn by_topic(name: &str, reader: Reader<Source>, first: Event, head: StreamHead) -> Result<Input> {
        let found = match &first {
            Event::Metadata { .. } => "",
            Event::Points { topic, .. } | Event::Bytes { topic, .. } => topic,
        };
        match (found, &first) {
            (topic::CROSSINGS | topic::WATERMARK | topic::CROSSING_CONTACTS | topic::CROSSING_BONDS, _) => {
                InletSource::input(name, reader, Some(first), head)
            }
            (topic::WALLS, Event::Points { table, .. }) => {
                let walls = WallFile::new(name, table, head.materials)?;
                only_walls(name, reader)?;
                Ok(Input::Walls(walls))
            }
            (other, _) => {
                let why = format!("begins with messages on '{other}', neither /walls nor /crossings");
                Err(SceneError::file(name, why, GIVE))
            }
        }
    }
}

/// Reads walls to the end: the last record distinguishes a whole stream from a broken one.
fn only_walls(name: &str, reader: Reader<Source>) -> Result<()> {
    for event in reader {
        if matches!(event.map_err(|e| broken(name, e))?, Event::Points { topic, .. } if topic == topic::WALLS)
        {
            let cure = "give still walls, and their motion in the scene";
            return Err(SceneError::file(name, "has walls at several times", cure));
        }
    }
    Ok(())
}

fn broken(name: &str, error: McapError) -> SceneError {
    SceneError::content(name, "walls or an inlet", error)
}

/// Reads a motion as a table over time, and its hash; columns `t`, any of `x y z`, and `angle` where there is an axis.
///
/// # Errors
/// A file of another kind, columns that are missing or not used.
pub fn read_path(path: &Path, has_axis: bool) -> Result<(Vec<PathRow>, String)> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).map_err(|e| SceneError::read(path, e))?;
    let table = csv::csv(&name, &bytes, |_| false)?;
    let known: &[&str] = if has_axis { &["t", "x", "y", "z", "angle"] } else { &["t", "x", "y", "z"] };
    if let Some(column) = table.columns().iter().find(|c| !known.contains(&c.name.as_str())) {
        let why = format!("has the column '{}', which a motion does not use", column.name);
        let cure = if column.name == "angle" {
            "give the axis of the angle: path = { source, about, through }"
        } else {
            "wanted: t [s], x, y, z [m], and angle [rad] about an axis"
        };
        return Err(SceneError::file(&name, why, cure));
    }
    let missing = |column: &str| {
        SceneError::file(
            &name,
            format!("has no column '{column}'"),
            "wanted: t [s], x, y, z [m], angle [rad]",
        )
    };
    let time = table.get("t").ok_or_else(|| missing("t"))?;
    if has_axis && table.get("angle").is_none() {
        return Err(missing("angle"));
    }
    let value = |column: &str, row: usize| table.get(column).map_or(0.0, |v| v.get(row));
    let row = |k: usize| PathRow {
        time: time.get(k),
        shift: Vec3::new(value("x", k), value("y", k), value("z", k)),
        angle: value("angle", k),
    };
    Ok(((0..table.rows()).map(row).collect(), record::hash(&table)))
}

/// Reads a mesh (PLY, STL, OBJ; polygons are cut into triangles); `factor` makes its lengths metres.
///
/// # Errors
/// A file of another kind, faces without vertices.
pub fn read_mesh(path: &Path, factor: f64) -> Result<TriMesh> {
    read_mesh_warned(path, factor, &mut Vec::new())
}

/// As [`read_mesh`], with what the user is to know of the file.
///
/// # Errors
/// As [`read_mesh`].
pub(crate) fn read_mesh_warned(path: &Path, factor: f64, warnings: &mut Vec<String>) -> Result<TriMesh> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).map_err(|e| SceneError::read(path, e))?;
    let surface = mesh::contents(&bytes).and_then(mesh::Contents::surface);
    let (mut mesh, noticed) = surface.map_err(|e| SceneError::content(&name, "a mesh", e))?;
    warnings.extend(noticed.into_iter().map(|warning| format!("{name}: {warning}")));
    if factor != 1.0 {
        mesh.scale(factor);
    }
    Ok(mesh)
}
