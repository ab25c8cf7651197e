//! The surface: a scanned cloud, or the spheres' places of a drawing.

use crate::args::Args;
use anyhow::Context;
use cloud::Cloud;
use geom::Shown;
use stream::Table;
use wall::Regions;
use wall::drawn::{DrawnReport, place};

/// Points that become spheres.
pub struct WallPoints {
    pub cloud: Cloud,
    /// The name that messages use.
    pub name: String,
    /// Role and hash, for provenance.
    pub hash: (String, String),
    /// What a drawing holds.
    pub drawn: Option<DrawnReport>,
}

pub fn read(args: &Args, regions: &Regions) -> anyhow::Result<WallPoints> {
    let Some(path) = &args.from_mesh else {
        let (cloud, hash) = args.input.read_cloud_hashed()?;
        return Ok(WallPoints { cloud, name: args.input.name(), hash, drawn: None });
    };
    let drawing = args.drawing(regions)?;
    let name = path.display().to_string();
    let bytes = stream::whole::file(path).with_context(|| format!("{name}: cannot read"))?;
    let mut mesh = mesh::from_bytes(&bytes).with_context(|| name.clone())?;
    if let Some(factor) = args.input.lengths.factor() {
        mesh.scale(factor);
    }
    let drawn = place(&mesh, &drawing).with_context(|| name.clone())?;
    warn(&drawn.report, drawing.radius);
    let attributes = Table::with_rows(drawn.centres.len());
    let cloud = Cloud { points: drawn.centres, attributes, double: true, ..Cloud::default() };
    Ok(WallPoints {
        cloud,
        name,
        hash: ("mesh".to_owned(), stream::sha256(&bytes)),
        drawn: Some(drawn.report),
    })
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
    if report.one_sided_edges > 0 {
        cli::warn(&format!(
            "at {} edges the faces have no common side (the drawing is one-sided or torn there): check on which side the spheres are",
            report.one_sided_edges
        ));
    }
}
