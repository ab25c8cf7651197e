//! The surface: a scanned cloud, the spheres' places of a drawing, or a cloud with a drawing where it is sparse.

use crate::args::Args;
use anyhow::Context;
use cloud::Cloud;
use geom::Shown;
use geom::mesh::TriMesh;
use std::path::Path;
use stream::{Table, Values};
use wall::drawn::{DrawnReport, beside, place};
use wall::{Regions, WallSettings};

/// Share of a scan off its drawing [–] above which the two do not lie on each other.
const OFF: f64 = 0.5;

/// Points that become spheres.
pub struct WallPoints {
    pub cloud: Cloud,
    /// The name that messages use.
    pub name: String,
    /// Roles and hashes, for provenance.
    pub hashes: Vec<(String, String)>,
    /// What a drawing holds that stands for the whole wall.
    pub drawn: Option<DrawnReport>,
    /// Points that a drawing added to the cloud.
    pub added: Option<usize>,
}

pub fn read(args: &Args, regions: &Regions, settings: &WallSettings) -> anyhow::Result<WallPoints> {
    let Some(path) = &args.from_mesh else {
        let (cloud, hash) = args.input.read_cloud_hashed()?;
        return Ok(WallPoints {
            cloud,
            name: args.input.name(),
            hashes: vec![hash],
            drawn: None,
            added: None,
        });
    };
    if !args.is_drawing() {
        return cloud_with_drawing(args, path, settings);
    }
    let drawing = args.drawing(regions)?;
    let name = path.display().to_string();
    let (mesh, hash) = read_mesh(args, path)?;
    let drawn = place(&mesh, &drawing).with_context(|| name.clone())?;
    warn(&drawn.report, drawing.radius);
    let attributes = Table::with_rows(drawn.centres.len());
    let cloud = Cloud { points: drawn.centres, attributes, double: true, ..Cloud::default() };
    Ok(WallPoints { cloud, name, hashes: vec![hash], drawn: Some(drawn.report), added: None })
}

fn read_mesh(args: &Args, path: &Path) -> anyhow::Result<(TriMesh, (String, String))> {
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).with_context(|| format!("{name}: cannot read"))?;
    let mesh = cli::read_mesh(&bytes, &name, &args.input.lengths, &args.input.placing)
        .with_context(|| name.clone())?;
    Ok((mesh, ("mesh".to_owned(), stream::sha256(&bytes))))
}

/// The cloud, and points of the drawing where it is sparse; they take their properties from the nearest point of the cloud.
fn cloud_with_drawing(args: &Args, path: &Path, settings: &WallSettings) -> anyhow::Result<WallPoints> {
    let (mut cloud, hash) = args.input.read_cloud_hashed()?;
    let (name, drawing) = (args.input.name(), path.display());
    let (mesh, mesh_hash) = read_mesh(args, path)?;
    cloud.check_reach().with_context(|| name.clone())?;
    let spacing = wall::spacing(&cloud.points, settings).with_context(|| name.clone())?;
    let found = beside(&mesh, &cloud.points, spacing).with_context(|| drawing.to_string())?;
    if found.off > OFF {
        cli::warn(&format!(
            "{drawing}: {:.0} % of the cloud's points are not on the drawing: is it in the same coordinates and unit?",
            100.0 * found.off
        ));
    }
    let (count, added) = (cloud.points.len(), found.positions.len());
    if added == 0 {
        cli::warn(&format!(
            "{drawing}: the cloud covers all of it, with {} m between neighbours: it adds nothing; leave --from-mesh out",
            Shown(spacing)
        ));
    }
    let mut filled: Vec<u8> = match cloud.attributes.get("filled") {
        Some(before) => (0..count).map(|i| u8::from(before.get(i) != 0.0)).collect(),
        None => vec![0; count],
    };
    filled.resize(count + added, 1);
    let rows: Vec<u32> = (0..count as u32).chain(found.nearest).collect();
    cloud.attributes = cloud.attributes.select(&rows);
    cloud.attributes.replace("filled", Values::U8(filled))?;
    cloud.points.extend(found.positions);
    Ok(WallPoints { cloud, name, hashes: vec![hash, mesh_hash], drawn: None, added: Some(added) })
}

fn warn(report: &DrawnReport, radius: f64) {
    if let Some(at) = report.too_thin_at {
        let [x, y, z] = at.map(|c| format!("{c:.4}"));
        cli::warn(&format!(
            "under {:.0} % of the surface, as at ({x}, {y}, {z}) m, the structure is thinner than a sphere ({} m): spheres touch \
             their own face and stick out of the opposite one; if particles touch that face, too, use a smaller radius, or --place centre",
            (100.0 * report.too_thin).max(1.0),
            Shown(2.0 * radius)
        ));
    }
    if report.undecided_faces > 0 {
        cli::warn(&format!(
            "{} faces of open parts are drawn on both sides: the flow is taken on the side of the first of the two; give --flow-at x,y,z if \
             it is on the other one",
            report.undecided_faces
        ));
    } else if report.doubled_faces > 0 {
        cli::warn(&format!("{} faces are drawn more than once: each is used once", report.doubled_faces));
    }
    if report.one_sided_edges > 0 {
        cli::warn(&format!(
            "at {} edges the faces have no common side (the drawing is one-sided or torn there): check on which side the spheres are",
            report.one_sided_edges
        ));
    }
}
