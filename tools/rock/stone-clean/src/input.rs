//! A mesh or a cloud, whichever the bytes are.

use crate::{Args, nine};
use anyhow::Context;
use geom::Vec3;
use geom::mesh::{MeshError, TriMesh};
use mesh::MeshFileError;

pub enum Read {
    Mesh(TriMesh),
    Cloud { points: Vec<Vec3>, normals: Option<Vec<Vec3>> },
}

/// Reads a mesh; bytes that are none are read as a cloud.
pub fn read(bytes: &[u8], args: &Args) -> anyhow::Result<Read> {
    let factor = args.lengths.factor().unwrap_or(1.0);
    // Text with nine numbers a line may be either.
    let mesh = match args.columns.given() {
        Some(_) => Err(MeshFileError::NoFaces),
        None if nine::is_cloud(bytes) => Err(MeshFileError::NoFaces),
        None => cli::read_mesh(bytes, &args.input.to_string(), &args.lengths, &args.placing),
    };
    match mesh {
        Ok(mesh) => return Ok(Read::Mesh(mesh)),
        Err(MeshFileError::NoFaces | MeshFileError::Unknown { .. } | MeshFileError::Ply(_)) => {}
        // Some programs give the faces of a cloud, too, which are none.
        Err(MeshFileError::Mesh(MeshError::Empty)) => {}
        Err(error) => return Err(error.into()),
    }
    let cloud = cloud::formats::from_bytes_as(bytes.to_vec(), args.columns.given())
        .context("neither a mesh nor a cloud")?;
    let is_scaled = args.lengths.factor().is_some();
    let open = cloud.warnings.iter().filter(|w| !(is_scaled && w.is_answered_by_scale()));
    open.for_each(|warning| cli::warn(&warning.to_string()));
    let (mut cloud, _) = cloud.finite();
    cloud.check_reach()?;
    let places = cloud::points::places::distinct(&cloud.points, 0.0);
    if places.len() < cloud.points.len() {
        let repeated = geom::counted_as(cloud.points.len() - places.len(), "point", ["lies", "lie"]);
        cli::warn(&format!("{repeated} where another one lies: each place counts once"));
        cloud = cloud.select(&places);
    }
    cloud.scale(factor);
    cloud_cli::place(&mut cloud, &args.placing, "the cloud");
    let column = |name| cloud.attributes.get(name);
    let normals = match (column("nx"), column("ny"), column("nz")) {
        (Some(x), Some(y), Some(z)) => {
            let all: Vec<Vec3> =
                (0..cloud.points.len()).map(|k| Vec3::new(x.get(k), y.get(k), z.get(k))).collect();
            // Normals of no length are none.
            all.iter().all(|n| n.norm() > 0.5 && n.norm() < 2.0).then_some(all)
        }
        _ => None,
    };
    Ok(Read::Cloud { points: cloud.points, normals })
}
