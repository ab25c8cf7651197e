//! Spheres of one radius inside a drawn structure, touching its surface: equipment that is known as a mesh.
//!
//! ```text
//! c = p − r n                      p on the surface, n its normal on the flow side: the sphere touches p from inside
//! |c − q| ≥ r for all q            and nothing of it stands out elsewhere: at an edge it touches both faces, at a corner three
//! P = 2 √(2rζ − ζ²)                distance of neighbours along a straight stretch, from roughness ζ and radius r
//! ```
//!
//! Japanese patent application JP2012-037937: spheres stand at both ends of every nearly straight stretch, and between them at spacing
//! P. In space the stretches are edges of the drawing (creases and open rims) between their corners, see [`stretches`]; the faces
//! between them are covered by spheres at distances whose mean is P, spread randomly (darts), so that no direction is preferred.
//! On which side the structure is, see [`sides`].

use super::candidate::{Candidate, Drawing, MOST};
use super::{cover, settle, sides, stretches};
use crate::radii::equation;
use crate::settings::WallError;
use geom::{Vec3, mesh::TriMesh};
use rayon::prelude::*;
use serde::Serialize;

/// Candidates for a sphere's position in a square of side P.
const CANDIDATES: f64 = 10.0;
/// The spheres of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Centres [m].
    pub centres: Vec<Vec3>,
    /// What was found.
    pub report: DrawnReport,
}

/// What was found in a drawing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnReport {
    /// Triangles with an area, each once.
    pub faces: usize,
    /// Triangles left out because an earlier one has the same corners.
    pub doubled_faces: usize,
    /// Of them in the opposite order, on open parts without a position in the flow: the first drawn decides on their side.
    pub undecided_faces: usize,
    /// Parts that hang together, and how many of them are closed.
    pub parts: usize,
    pub closed_parts: usize,
    /// Parts turned round, against the order of their corners in the file.
    pub turned_parts: usize,
    /// Edges where two faces could not be made to agree on a side.
    pub one_sided_edges: usize,
    /// Nearly straight stretches, and positions where they end.
    pub stretches: usize,
    /// Ends of stretches.
    pub corners: usize,
    /// Distance of neighbours P that roughness and radius ask for [m].
    pub spacing_asked: f64,
    /// Share of the surface under which a sphere of this radius stands out elsewhere, the structure being too thin [–].
    pub too_thin: f64,
    /// One position of that [m].
    pub too_thin_at: Option<[f64; 3]>,
    /// Deepest dent: the greatest distance from the surface to the spheres [m].
    pub deepest: f64,
    /// Where [m].
    pub deepest_at: [f64; 3],
}

/// Places spheres under the surface of a mesh [m].
///
/// # Errors
/// A radius or roughness that give no spacing, a mesh without area, a spacing far too small for it.
pub fn place(mesh: &TriMesh, drawing: &Drawing) -> Result<Drawn, WallError> {
    let Drawing { radius, roughness, .. } = *drawing;
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(WallError::BadRadius(radius));
    }
    let spacing =
        equation::spacing(radius, roughness).ok_or(WallError::DeeperThanRadius { roughness, radius })?;
    let surface = sides::DrawnSurface::new(mesh, drawing.flow_at).ok_or(WallError::NoArea)?;
    let wanted = CANDIDATES * surface.area / (spacing * spacing);
    if wanted > MOST {
        return Err(WallError::TooManySpheres { spacing, area: surface.area, count: wanted / CANDIDATES });
    }
    let settle = settle::Settle::new(&surface, drawing);
    let stretches = stretches::find(&surface, spacing, &|at, normal| settle.candidate(at, normal).centre);
    let on_faces = surface.scattered(wanted as usize);
    let with_centre = |&(at, normal): &(Vec3, Vec3)| settle.candidate(at, normal);
    let on_stretches: Vec<Candidate> = stretches.positions.par_iter().map(with_centre).collect();
    let on_faces: Vec<Candidate> = on_faces.par_iter().map(with_centre).collect();
    let centres = cover::cover(&on_stretches, &on_faces, spacing);
    let (deepest, at) = cover::deepest(&on_faces, &centres, radius, drawing.centred);
    let thin = on_faces.iter().filter(|c| c.thin);
    let report = DrawnReport {
        faces: surface.mesh.faces.len(),
        doubled_faces: surface.doubled.faces,
        undecided_faces: surface.doubled.undecided,
        parts: surface.parts,
        closed_parts: surface.closed,
        turned_parts: surface.turned,
        one_sided_edges: surface.one_sided,
        stretches: stretches.count,
        corners: stretches.corners,
        spacing_asked: spacing,
        too_thin: thin.clone().count() as f64 / on_faces.len().max(1) as f64,
        too_thin_at: thin.clone().next().map(|c| c.at.into()),
        deepest,
        deepest_at: at.into(),
    };
    Ok(Drawn { centres, report })
}
