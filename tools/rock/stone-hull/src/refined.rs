//! Photographs for the refinement.

use crate::args::Args;
use crate::views::Found;
use anyhow::Context;
use geom::mesh::TriMesh;
use photos::Photograph;
use photos::refine::{Crop, Refinement, Shot, refine};
use rayon::prelude::*;
use remesh::pieces::pieces;

/// Photographs in memory at a time, at most.
const AT_ONCE: usize = 8;
/// A refinement of which fewer vertices agree is doubtful.
const AGREED: f64 = 0.3;

/// The hull, moved to where photographs agree.
pub fn refined(args: &Args, found: &Found, hull: &TriMesh) -> anyhow::Result<(TriMesh, Refinement)> {
    let progress = cli::Progress::new("refinement", found.names.len() as u64);
    let mut shots = Vec::with_capacity(found.names.len());
    let pairs: Vec<_> = found.names.iter().zip(&found.views).collect();
    for some in pairs.chunks(AT_ONCE) {
        let read: Vec<anyhow::Result<Shot>> = some
            .par_iter()
            .map(|(name, view)| {
                let path = args.photographs.join(name);
                let bytes = stream::whole::file(&path)
                    .with_context(|| format!("{}: cannot open it", path.display()))?;
                let photograph = Photograph::read(&bytes).with_context(|| path.display().to_string())?;
                let size = [photograph.width as f64, photograph.height as f64];
                if size != view.field.frame() {
                    anyhow::bail!(
                        "{}: its mask has another size: --refine needs the photographs of the masks",
                        path.display()
                    );
                }
                let crop = Crop::new(&photograph, &view.field);
                progress.add(1);
                Ok(Shot { view: (*view).clone(), crop })
            })
            .collect();
        for shot in read {
            shots.push(shot?);
        }
    }
    let (mesh, refinement) =
        refine(hull, &shots, args.cells, |round| progress.say(format!("refinement {round}")));
    if refinement.agreed < AGREED {
        cli::warn(&format!(
            "--refine: photographs agree on {} % of the surface only: the stone needs speckle, and the poses must be right",
            geom::Shown((100.0 * refinement.agreed).round())
        ));
    }
    let largest = pieces(&mesh).into_iter().max_by(|a, b| a.volume().total_cmp(&b.volume())).unwrap_or(mesh);
    Ok((largest, refinement))
}
