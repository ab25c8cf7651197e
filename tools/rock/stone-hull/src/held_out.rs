//! Photographs that did not carve, against the mesh.

use crate::views::Found;
use crate::words::percent;
use geom::mesh::TriMesh;
use rayon::prelude::*;
use serde::Serialize;

/// The mesh on a photograph that it was not made from.
#[derive(Debug, Clone, Serialize)]
pub struct HeldOut {
    pub photograph: String,
    /// Pixels of both mesh and mask over pixels of either [–].
    pub union: f64,
    /// Share of the mask that the mesh does not cover [–].
    pub missed: f64,
}

/// Compares a mesh with the masks of all photographs that were held out.
pub fn compared(found: &Found, mesh: &TriMesh) -> Vec<HeldOut> {
    let of = |(name, view): &(String, photos::View)| {
        let agreement = view.agreement(mesh);
        HeldOut { photograph: name.clone(), union: agreement.union, missed: agreement.missed }
    };
    found.held_out.par_iter().map(of).collect()
}

/// The end of the summary; empty when none was held out.
pub fn words(all: &[HeldOut]) -> String {
    let Some(worst) = all.iter().min_by(|a, b| a.union.total_cmp(&b.union)) else { return String::new() };
    let mean = all.iter().map(|h| h.union).sum::<f64>() / all.len() as f64;
    format!(
        "; it covers {} held-out masks by {} % on average, {} % on {}",
        all.len(),
        percent(mean),
        percent(worst.union),
        worst.photograph
    )
}
