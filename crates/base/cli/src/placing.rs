//! Coordinates of a file that are turned and shifted as it is read: `--transform`.

use crate::exit::usage;
use crate::input::Lengths;
use geom::Transform;
use geom::mesh::TriMesh;
use mesh::MeshFileError;
use std::path::Path;

/// How far a matrix of few digits may put a point from where it belongs [m], without a warning.
const OFF: f64 = 1e-3;

/// Where the geometry of a file is put: flatten it into the arguments of a tool that reads geometry.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct Placing {
    /// Turn and shift the coordinates as they are read (after --scale): a file of 4 x 4 numbers, row by row, last row 0 0 0 1, as CloudCompare and PDAL write it, or the 16 numbers with commas; normals turn, too
    #[arg(long, value_name = "FILE|NUMBERS", value_parser = matrix, allow_hyphen_values = true)]
    transform: Option<Matrix>,
}

/// A matrix of the command line.
#[derive(Debug, Clone)]
pub(crate) struct Matrix {
    transform: Transform,
    /// Its file and the hash of it; none of numbers on the command line.
    file: Option<(String, String)>,
}

fn matrix(text: &str) -> Result<Matrix, String> {
    if Transform::is_numbers(text) {
        return Ok(Matrix { transform: Transform::parse(text).map_err(|e| e.to_string())?, file: None });
    }
    let bytes = stream::whole::file(Path::new(text)).map_err(|e| format!("cannot read: {e}"))?;
    let transform = Transform::parse(&String::from_utf8_lossy(&bytes)).map_err(|e| e.to_string())?;
    Ok(Matrix { transform, file: Some((text.to_owned(), stream::sha256(&bytes))) })
}

/// Reads a mesh of the command line: in metres, and where `--transform` puts it. Warns of what of the file is left out, and of digits that it has lost.
///
/// # Errors
/// Content that is not a mesh, or is truncated, with its place.
pub fn read_mesh(
    bytes: &[u8],
    name: &str,
    lengths: &Lengths,
    placing: &Placing,
) -> Result<TriMesh, MeshFileError> {
    let (mut mesh, warnings) = mesh::contents(bytes)?.surface()?;
    warnings.iter().for_each(|warning| crate::warn(&format!("{name}: {warning}")));
    if let Some(factor) = lengths.factor().filter(|factor| *factor != 1.0) {
        mesh.scale(factor);
    }
    placing.mesh(&mut mesh, name);
    Ok(mesh)
}

impl Placing {
    /// The matrix, if one was given.
    pub fn transform(&self) -> Option<&Transform> {
        self.transform.as_ref().map(|matrix| &matrix.transform)
    }

    /// Whether it also changes lengths.
    pub fn scales(&self) -> bool {
        self.transform().and_then(Transform::factor).is_some()
    }

    /// Moves a mesh.
    fn mesh(&self, mesh: &mut TriMesh, name: &str) {
        let Some(by) = self.transform() else { return };
        self.warn_of_digits(&mesh.vertices, name);
        mesh.transform(by);
    }

    /// Warns if the digits of the matrix are too few for coordinates as large as those of `points` [m].
    pub fn warn_of_digits(&self, points: &[geom::Vec3], name: &str) {
        let rounding = self.transform().map_or(0.0, Transform::rounding);
        let far = points
            .iter()
            .flat_map(|p| p.iter())
            .filter(|c| c.is_finite())
            .fold(0.0, |far, c| c.abs().max(far));
        let rough = |value: f64| geom::Shown(format!("{value:.1e}").parse().unwrap_or(value));
        if far * rounding > OFF {
            crate::warn(&format!(
                "{name}: --transform has few digits, and coordinates are as large as {} m: points may be {} m off; give the matrix with more \
                 digits, or a rotation about a point near the equipment",
                rough(far),
                rough(far * rounding)
            ));
        }
    }

    /// What a summary says of it, at its end.
    pub fn said(&self) -> String {
        let Some(matrix) = &self.transform else { return String::new() };
        let by = matrix.file.as_ref().map_or(String::new(), |(name, _)| format!(" {name}"));
        let factor = matrix.transform.factor();
        let scaled =
            factor.map_or(String::new(), |factor| format!(", lengths times {}", geom::Shown(factor)));
        format!("; coordinates moved by --transform{by}{scaled}")
    }

    /// A report that says it, in its summary and as `transform`: the 16 numbers, row by row.
    pub fn report(&self, report: crate::Report) -> crate::Report {
        let Some(by) = self.transform() else { return report };
        let summary = format!("{}{}", report.summary, self.said());
        crate::Report { summary, ..report }.with("transform", by.rows())
    }

    /// Role and hash of its file, for [`crate::provenance`].
    pub fn hash(&self) -> Option<(String, String)> {
        let (_, hash) = self.transform.as_ref()?.file.as_ref()?;
        Some(("transform".to_owned(), hash.clone()))
    }

    /// Refuses a matrix where nothing is moved.
    ///
    /// # Errors
    /// A matrix that was given.
    pub fn none(&self, why: &str) -> anyhow::Result<()> {
        match &self.transform {
            Some(_) => Err(usage(format!("--transform: {why}: leave it out"))),
            None => Ok(()),
        }
    }
}
