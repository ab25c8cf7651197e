//! `[[particles]]`: spheres from CSV, PLY, or the last frame of a run.

use crate::columns::Columns;
use crate::error::SceneError;
use crate::material_info::{self, MATERIALS, MaterialInfo};
use dem::setup::Particle;
use std::path::Path;
use stream::mcap::{Event, Reader};
use stream::{Table, Values};

/// Columns of a CSV or PLY that are read.
const KNOWN: [&str; 12] = ["id", "x", "y", "z", "radius", "diameter", "vx", "vy", "vz", "wx", "wy", "wz"];

/// Particles of a file. Their materials are indices of `materials`, when the file names its own.
#[derive(Debug, Clone)]
pub(crate) struct ParticleFile {
    /// Particles; ids are those of the file, when it has them.
    pub particles: Vec<Particle>,
    /// Whether the file has ids.
    pub has_ids: bool,
    /// The materials that the file names.
    pub materials: Vec<MaterialInfo>,
    /// SHA-256 of the columns.
    pub hash: String,
    /// Columns that are not used, for the user to know.
    pub note: Option<String>,
}

/// Reads particles; the format is told by content.
///
/// # Errors
/// A file of another kind, columns that are missing or wrong; a run with clumps.
pub(crate) fn read(path: &Path) -> Result<ParticleFile, SceneError> {
    let name = path.display().to_string();
    let (table, materials, run) = table(path)?;
    if run && table.get("body").is_some() {
        let why = "is a run with clumps, and a frame does not hold their shapes";
        return Err(SceneError::file(&name, why, "go on with dem-run --resume, or place them with [[body]]"));
    }
    let file = from_table(&name, &table, materials)?;
    // A run has columns of its own that nobody wrote by hand.
    Ok(ParticleFile { note: file.note.filter(|_| !run), ..file })
}

/// The columns of a file, the materials that it names, and whether it is a run.
///
/// # Errors
/// A file of another kind.
pub(crate) fn table(path: &Path) -> Result<(Table, Vec<MaterialInfo>, bool), SceneError> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| SceneError::Read { name: name.clone(), source })?;
    if bytes.starts_with(b"\x89MCAP") {
        let (table, materials) = last_frame(&name, &bytes)?;
        return Ok((table, materials, true));
    }
    if !bytes.starts_with(b"ply") {
        return Ok((csv(&name, &bytes)?, Vec::new(), false));
    }
    let content = |e: stream::ply::PlyError| SceneError::Content {
        name: name.clone(),
        wanted: "particles",
        source: e.into(),
    };
    let ply = stream::ply::parse(&bytes).map_err(content)?;
    let vertex = ply.elements.into_iter().find(|e| e.name == "vertex");
    let none = || SceneError::file(&name, "has no element 'vertex'", "give particles as vertices");
    Ok((vertex.ok_or_else(none)?.table, Vec::new(), false))
}

fn from_table(name: &str, table: &Table, materials: Vec<MaterialInfo>) -> Result<ParticleFile, SceneError> {
    let columns = Columns { name, table };
    let positions = columns.vectors(["x", "y", "z"])?;
    let radii = columns.radii()?;
    let velocities = columns.vectors_or_zero(["vx", "vy", "vz"])?;
    let spins = columns.vectors_or_zero(["wx", "wy", "wz"])?;
    let ids = columns.indices("id", f64::from(u32::MAX - 1))?;
    let material = if materials.is_empty() {
        None
    } else {
        columns.indices("material", materials.len() as f64 - 1.0)?
    };
    let particle = |i: usize| Particle {
        id: ids.as_ref().map_or(i as u32, |ids| ids[i]),
        material: material.as_ref().map_or(0, |m| m[i] as u16),
        radius: radii[i],
        position: positions[i],
        velocity: velocities[i],
        spin: spins[i],
    };
    let particles = (0..positions.len()).map(particle).collect();
    let empty = || Some(format!("{name}: holds no particle: it has names of columns and no row"));
    let note = if table.rows() == 0 { empty() } else { columns.unused(&KNOWN) };
    let hash = crate::wall_file::hash(table);
    Ok(ParticleFile { particles, has_ids: ids.is_some(), materials, hash, note })
}

fn last_frame(name: &str, bytes: &[u8]) -> Result<(Table, Vec<MaterialInfo>), SceneError> {
    let (mut frame, mut materials) = (None, Vec::new());
    for event in Reader::new(bytes) {
        let content = |e: stream::mcap::McapError| SceneError::Content {
            name: name.to_owned(),
            wanted: "a run",
            source: e.into(),
        };
        match event.map_err(content)? {
            Event::Metadata { name: record, map } if record == MATERIALS => {
                materials = material_info::from_map(name, &map)?;
            }
            Event::Points { topic, table, .. } if topic == "/particles" => frame = Some(table),
            _ => {}
        }
    }
    let none = || SceneError::file(name, "has no message on /particles", "give a run that dem-run wrote");
    Ok((frame.ok_or_else(none)?, materials))
}

/// A table of text: names on the first line, commas or blanks between, `#` starts a comment.
fn csv(name: &str, bytes: &[u8]) -> Result<Table, SceneError> {
    let wrong = |why: String| {
        SceneError::file(name, why, "wanted: a line of names such as id,x,y,z,radius, then numbers")
    };
    // Spreadsheets mark UTF-8 with three bytes in front.
    let text = std::str::from_utf8(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes));
    let text = text.map_err(|e| wrong(format!("byte {}: is no text, PLY or MCAP", e.valid_up_to())))?;
    let split = |line: &str| -> Vec<String> {
        line.split(|c: char| c == ',' || c == ';' || c.is_whitespace())
            .filter(|f| !f.is_empty())
            .map(str::to_owned)
            .collect()
    };
    let lines = text.lines().enumerate().map(|(n, l)| (n + 1, l.split('#').next().unwrap_or("").trim()));
    let mut lines = lines.filter(|(_, l)| !l.is_empty());
    let Some((_, head)) = lines.next() else { return Err(wrong("is empty".into())) };
    let names = split(head);
    if names.first().is_none_or(|name| name.parse::<f64>().is_ok()) {
        return Err(wrong("line 1: begins without a name, the line of names is missing".into()));
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for (n, line) in lines {
        let fields = split(line);
        if fields.len() != names.len() {
            return Err(wrong(format!(
                "line {n}: {} numbers where there are {} names",
                fields.len(),
                names.len()
            )));
        }
        for (column, field) in columns.iter_mut().zip(&fields) {
            column.push(field.parse().map_err(|_| wrong(format!("line {n}: '{field}' is no number")))?);
        }
    }
    let mut table = Table::default();
    for (column, values) in names.iter().zip(columns) {
        table.push(column, Values::F64(values)).map_err(|e| wrong(e.to_string()))?;
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_csv_has_names_and_numbers() {
        let table = csv("a.csv", b"# pile\nid,x,y,z,radius,vx,vy,vz\n4, 0,1,2,0.5, 1,0,0\n").unwrap();
        let file = from_table("a.csv", &table, Vec::new()).unwrap();
        assert_eq!(
            (file.particles[0].id, file.particles[0].position.z, file.particles[0].velocity.x),
            (4, 2.0, 1.0)
        );
        assert_eq!(file.note, None);
        let table = csv("pl.csv", b"x,y,z,radius,vz,wy,v_z\n0,1,2,0.5,-3,4,5\n").unwrap();
        let file = from_table("pl.csv", &table, Vec::new()).unwrap();
        let (velocity, spin) = (file.particles[0].velocity, file.particles[0].spin);
        assert_eq!((velocity.x, velocity.z, spin.y, spin.z), (0.0, -3.0, 4.0, 0.0));
        let note = "pl.csv: column 'v_z' is not used; known: id x y z radius diameter vx vy vz wx wy wz";
        assert_eq!(file.note.as_deref(), Some(note));
        for (text, part) in
            [("1,2,3", "names is missing"), ("x,y\n1", "line 2: 1 numbers"), ("x\na", "'a' is no number")]
        {
            let message = csv("a.csv", text.as_bytes()).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        let table = csv("a.csv", b"x,y,z,radius\n0,0,0,-1").unwrap();
        assert!(from_table("a.csv", &table, Vec::new()).unwrap_err().to_string().contains("radius -1 m"));
    }
}
