//! Files that shapes name: how they are found and read, and how a mesh is scaled and placed.
//!
//! ```text
//! mesh:FILE,units=mm,transform=MATRIX.txt       options in any order, each once; first the unit, then the matrix
//! ```

use super::{ShapeError, ShapeText};
use crate::mesh::TriMesh;
use crate::{Transform, number, units};
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;

/// Largest file of a prism or a matrix [B].
const LARGEST_FILE: u64 = 64 << 20;
/// Options that may follow the file of a mesh.
const OPTIONS: [&str; 3] = ["units", "scale", "transform"];

/// Reads the files of shapes. A function that reads a mesh is such a reader, for names relative to the current folder.
pub trait ShapeFiles {
    /// The path of a file that the text of a shape names.
    fn path(&self, file: &str) -> PathBuf {
        PathBuf::from(file)
    }

    /// Reads a mesh [m].
    ///
    /// # Errors
    /// The reason, with its causes, in one line.
    fn mesh(&self, file: &str) -> Result<TriMesh, String>;
}

impl<F: Fn(&str) -> Result<TriMesh, String>> ShapeFiles for F {
    fn mesh(&self, file: &str) -> Result<TriMesh, String> {
        self(file)
    }
}

/// Reads a small file.
pub(super) fn bytes(file: &str, files: &dyn ShapeFiles) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = |file: File| file.take(LARGEST_FILE).read_to_end(&mut bytes);
    let read = File::open(files.path(file)).and_then(read);
    read.map(|_| bytes).map_err(|e| format!("cannot read {file}: {e}"))
}

/// The text behind `mesh:`, split.
struct MeshText<'a> {
    file: &'a str,
    /// Name and value of each option.
    options: Vec<[&'a str; 2]>,
}

impl<'a> MeshText<'a> {
    /// Names of files and matrices may have commas: an option begins where its name and `=` follow one, and ends where the next begins.
    fn new(rest: &'a str) -> MeshText<'a> {
        let option = |text: &'a str| {
            let (name, value) = text.split_once('=')?;
            OPTIONS.contains(&name).then_some([name, value])
        };
        let commas = rest.match_indices(',').map(|(at, _)| at);
        let starts: Vec<usize> = commas.filter(|at| option(&rest[at + 1..]).is_some()).collect();
        let ends = starts.iter().skip(1).copied().chain([rest.len()]);
        let options = starts.iter().zip(ends).filter_map(|(start, end)| option(&rest[start + 1..end]));
        MeshText { file: &rest[..starts.first().copied().unwrap_or(rest.len())], options: options.collect() }
    }

    /// The file of its matrix, unless the text itself gives the matrix.
    fn matrix(&self) -> Option<&'a str> {
        let mut given = self.options.iter().filter(|[name, _]| *name == "transform").map(|[_, value]| *value);
        given.rfind(|value| !Transform::is_numbers(value))
    }
}

/// Kind and file of a text that names a file: the parts before and behind the colon.
fn named(text: &str) -> Option<(&str, &str)> {
    text.strip_prefix('!')
        .unwrap_or(text)
        .split_once(':')
        .filter(|(kind, _)| matches!(*kind, "prism" | "mesh"))
}

/// The files that a shape names, as text.
pub fn files_of(text: &str) -> Vec<&str> {
    match named(text) {
        Some(("mesh", rest)) => {
            let mesh = MeshText::new(rest);
            [mesh.file].into_iter().chain(mesh.matrix()).collect()
        }
        Some((_, file)) => vec![file],
        None => Vec::new(),
    }
}

/// The same shape with its files renamed.
pub fn with_files(text: &str, of: impl Fn(&str) -> String) -> String {
    let Some((kind, rest)) = named(text) else { return text.to_owned() };
    let head = &text[..text.len() - rest.len()];
    if kind == "prism" {
        return format!("{head}{}", of(rest));
    }
    let mesh = MeshText::new(rest);
    let matrix = mesh.matrix();
    let option = |[name, value]: [&str; 2]| match matrix == Some(value) {
        true => format!(",{name}={}", of(value)),
        false => format!(",{name}={value}"),
    };
    format!("{head}{}{}", of(mesh.file), mesh.options.iter().map(|o| option(*o)).collect::<String>())
}

/// Reads the mesh of a shape, converts it to metres, and applies its matrix.
pub(super) fn mesh(text: &ShapeText<'_>, files: &dyn ShapeFiles) -> Result<TriMesh, ShapeError> {
    let named = MeshText::new(text.rest);
    let load = |why| ShapeError::Load { text: text.owned(), why };
    let lengths = |why| ShapeError::Lengths { text: text.owned(), why };
    let (mut factor, mut matrix) = (None, None);
    for &[name, value] in &named.options {
        let again = match name {
            "transform" => matrix.replace(transform(text, value, files)?).is_some(),
            "units" => {
                factor.replace(units::factor(value, "m").map_err(|e| lengths(e.to_string()))?).is_some()
            }
            _ => factor.replace(number::positive(value).map_err(|e| lengths(e.to_string()))?).is_some(),
        };
        if again {
            return Err(ShapeError::Twice { text: text.owned(), name: name.to_owned() });
        }
    }
    let mut mesh = files.mesh(named.file).map_err(load)?;
    if let Some(factor) = factor.filter(|factor| *factor != 1.0) {
        mesh.scale(factor);
    }
    if let Some(matrix) = matrix {
        mesh.transform(&matrix);
    }
    Ok(mesh)
}

fn transform(text: &ShapeText<'_>, value: &str, files: &dyn ShapeFiles) -> Result<Transform, ShapeError> {
    let numbers = match Transform::is_numbers(value) {
        true => value.to_owned(),
        false => {
            let bytes = bytes(value, files).map_err(|why| ShapeError::Load { text: text.owned(), why })?;
            String::from_utf8_lossy(&bytes).into_owned()
        }
    };
    Transform::parse(&numbers).map_err(|source| ShapeError::Transform { text: text.owned(), source })
}
