//! Prints what the readers find in files, for comparison with other programs' readers: `make -C pipelines differential`.
//!
//! ```text
//! stdin    a line for each file: `cloud PATH` or `mesh PATH`
//! stdout   `error TEXT`, or `ok ROWS COLUMNS FACES`, a line with the name of each column, then their numbers column by column
//!          (f64, little-endian) and the corners of the faces (u32). A mesh has the columns x, y, z
//! ```
//!
//! A cloud is read twice, as a stream and from memory; both must say the same.

use cloud::Cloud;
use std::fmt::Display;
use std::fs;
use std::io::{self, BufWriter, Write};

/// What a file holds.
struct Contents {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    faces: Vec<[u32; 3]>,
}

/// An error with its sources, on one line.
fn whole(error: impl std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(inner) = source {
        text += &format!(": {inner}");
        source = inner.source();
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn xyz<'a>(points: impl Iterator<Item = &'a geom::Vec3> + Clone) -> Vec<Vec<f64>> {
    (0..3).map(|axis| points.clone().map(|p| p[axis]).collect()).collect()
}

fn cloud(path: &str) -> Result<Contents, String> {
    let text = |error: &dyn Display| error.to_string();
    let bytes = fs::read(path).map_err(|e| text(&e))?;
    let streamed = cloud::read(fs::File::open(path).map_err(|e| text(&e))?).map_err(whole);
    let at_once = cloud::from_bytes(bytes).map_err(whole);
    if streamed.is_ok() != at_once.is_ok() {
        return Err(format!("differs: {:?} as a stream, {:?} from memory", streamed.err(), at_once.err()));
    }
    let cloud = streamed?;
    if at_once.is_ok_and(|other| format!("{other:?}") != format!("{cloud:?}")) {
        return Err("differs: other contents as a stream than from memory".to_owned());
    }
    let Cloud { points, attributes, .. } = cloud;
    let mut columns = xyz(points.iter());
    let mut names: Vec<String> = ["x", "y", "z"].map(str::to_owned).into();
    for (name, values) in attributes.into_columns() {
        names.push(name);
        columns.push(values.to_f64());
    }
    Ok(Contents { names, columns, faces: Vec::new() })
}

fn mesh(path: &str) -> Result<Contents, String> {
    let bytes = fs::read(path).map_err(|e| e.to_string())?;
    let mesh = mesh::from_bytes(&bytes).map_err(whole)?;
    let names = ["x", "y", "z"].map(str::to_owned).into();
    Ok(Contents { names, columns: xyz(mesh.vertices.iter()), faces: mesh.faces })
}

fn write(out: &mut impl Write, contents: &Contents) -> io::Result<()> {
    let Contents { names, columns, faces } = contents;
    writeln!(out, "ok {} {} {}", columns[0].len(), names.len(), faces.len())?;
    names.iter().try_for_each(|name| writeln!(out, "{name}"))?;
    for value in columns.iter().flatten() {
        out.write_all(&value.to_le_bytes())?;
    }
    for corner in faces.iter().flatten() {
        out.write_all(&corner.to_le_bytes())?;
    }
    Ok(())
}

fn main() -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    for line in io::stdin().lines() {
        let line = line?;
        let contents = match line.split_once(' ') {
            Some(("cloud", path)) => cloud(path),
            Some(("mesh", path)) => mesh(path),
            _ => Err("a line is 'cloud PATH' or 'mesh PATH'".to_owned()),
        };
        match contents {
            Ok(contents) => write(&mut out, &contents)?,
            Err(why) => writeln!(out, "error {why}")?,
        }
        out.flush()?;
    }
    Ok(())
}
