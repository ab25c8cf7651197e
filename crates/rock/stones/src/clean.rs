//! Any triangles or points → a stone: one closed, oriented manifold without crossings, of a given number of faces.
//!
//! A mesh that is closed stays as it is, but for faces that look inwards and pieces apart. Anything else is sampled by its winding number
//! ([`remesh::soup`]), and the surface of the samples is taken. Then faces are thinned out ([`remesh::decimate`]) with the volume as it is.

mod weld;

use crate::crossing;
use crate::stone::{MOST_FACES, Stone, StoneError, around};
use geom::mesh::{MeshError, TriMesh, closest_point};
use geom::{Boxes, Vec3};
use remesh::{Samples, Winding, decimate, pieces, soup, surface, surfels};
use serde::Serialize;
use std::collections::BTreeSet;
use thiserror::Error;

/// How often crossings are smoothed away.
const SMOOTHED: usize = 12;
/// How often a decimated mesh that crosses itself is taken with half as many faces more.
const RETRIES: usize = 6;
/// Pieces of less than this share of the area of the largest are noise.
const NOISE: f64 = 0.05;
/// A body of less volume than this times its area to the power of 3/2 is a sheet; a ball has 0.094, a plate of 50 : 50 : 1 has 0.007.
const SHEET: f64 = 1e-3;
/// A hollow of less than this share of the volume is no hollow.
const HOLLOW: f64 = 1e-6;
/// Finest and coarsest cells of a cloud, as cells along the longest side.
const CELLS: [f64; 2] = [16.0, 400.0];

/// Cells of a mesh along the longest side, at least and at most, and how many lie along an edge of usual length in between: finer ones show nothing more.
const CELLS_OF_MESH: [f64; 2] = [60.0, 200.0];
const CELLS_AN_EDGE: f64 = 8.0;

/// How a stone is cleaned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CleanSettings {
    /// Faces of the result, at most; none: as many as come.
    pub faces: Option<usize>,
    /// Cells along the longest side when the surface is rebuilt; none: 200 or as many as the edges of a coarse mesh need, and for a cloud its spacing.
    pub cells: Option<usize>,
}

/// What was found and changed.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct Changes {
    /// Faces that came.
    pub faces_before: usize,
    /// Corners that were joined because rounding had parted them, and how far apart they were at most [m].
    pub welded: usize,
    /// See `welded`.
    pub welded_within: Option<f64>,
    /// Hollows inside that are filled now, and their volume [m³].
    pub hollows: usize,
    /// See `hollows`.
    pub hollow_volume: f64,
    /// Normals of a cloud that were turned, because those of neighbours looked to opposite sides.
    pub normals_turned: usize,
    /// Edges that did not join two faces.
    pub open_edges: usize,
    /// Faces turned to the other side.
    pub turned: usize,
    /// Pieces removed as noise, and their share of the area [–].
    pub islands: usize,
    /// Share of the area that they had [–].
    pub islands_area: f64,
    /// Why the surface was rebuilt; none when it was kept.
    pub rebuilt: Option<String>,
    /// Cells along the longest side, when it was rebuilt.
    pub cells: Option<usize>,
    /// Share of the area of the surface rebuilt that is not on the surface that came: closed holes [–].
    pub closed_area: Option<f64>,
    /// Volume before faces were thinned out [m³].
    pub volume_before: f64,
    /// Volume of the result [m³].
    pub volume: f64,
    /// Faces of the result.
    pub faces: usize,
}

/// Why there is no stone.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CleanError {
    #[error("{0}")]
    Mesh(#[from] MeshError),
    #[error("{0} faces, more than {MOST_FACES}: thin the scan first")]
    Faces(usize),
    #[error("{0} points are too few for a surface: a cloud needs at least 100, all around the stone")]
    Points(usize),
    #[error(
        "the surface encloses no space: scan the other sides of the stone, too, and give one stone, whose pieces do not lie far apart"
    )]
    Nothing,
    #[error("the result is no stone: {0}")]
    Stone(#[from] StoneError),
}

/// Cleans a mesh.
///
/// # Errors
/// A mesh that encloses nothing.
pub fn clean_mesh(mesh: &TriMesh, settings: &CleanSettings) -> Result<(Stone, Changes), CleanError> {
    if mesh.faces.len() > MOST_FACES {
        return Err(CleanError::Faces(mesh.faces.len()));
    }
    let mut changes = Changes { faces_before: mesh.faces.len(), ..Changes::default() };
    let mut mesh = distinct(&mesh.welded());
    if mesh.faces.is_empty() {
        return Err(MeshError::Empty.into());
    }
    if let Some(welded) = weld::welded(&mesh, usual_edge(&mesh)) {
        (changes.welded, changes.welded_within) = (welded.corners, Some(welded.within));
        mesh = distinct(&welded.mesh);
    }
    changes.turned = soup::orient(&mut mesh).turned;
    mesh = without_hollows(mesh, &mut changes);
    mesh = without_noise(&mesh, &mut changes);
    changes.open_edges = mesh.open_edges();
    let reason = match Stone::new(&mesh, true) {
        Ok(_) => match remesh::pieces::pinched(&mesh) {
            0 => None,
            n => Some(format!("it touches itself at {n} vertices")),
        },
        Err(StoneError::Crossing { pairs, .. }) => Some(format!("{pairs} pairs of its faces cross")),
        Err(_) if changes.open_edges > 0 => {
            Some(format!("{} of its edges do not join two faces", changes.open_edges))
        }
        Err(error) => Some(error.to_string()),
    };
    if let Some(reason) = reason.or_else(|| settings.cells.map(|_| "cells were given".to_owned())) {
        let cells = settings.cells.unwrap_or_else(|| cells_of(&mesh));
        (changes.rebuilt, changes.cells) = (Some(reason), Some(cells));
        let made = rebuilt(soup::sample(&mesh, cells), &mut changes)?;
        changes.closed_area = Some(added(&made, &mesh, cells));
        mesh = made;
    } else {
        mesh = largest(mesh, &mut changes);
    }
    thinned(mesh, settings, changes)
}

/// Length of the edge in the middle of all [m].
fn usual_edge(mesh: &TriMesh) -> f64 {
    let corner = |face: &[u32; 3], k: usize| mesh.vertices[face[k % 3] as usize];
    let edges =
        mesh.faces.iter().flat_map(|face| [0, 1, 2].map(|k| (corner(face, k) - corner(face, k + 1)).norm()));
    let mut edges: Vec<f64> = edges.collect();
    edges.sort_by(f64::total_cmp);
    edges.get(edges.len() / 2).copied().unwrap_or(0.0)
}

/// Without closed pieces that lie inside the largest one: they are filled.
fn without_hollows(mesh: TriMesh, changes: &mut Changes) -> TriMesh {
    let all = pieces::pieces(&mesh);
    let Some(outer) = all.iter().max_by(|a, b| a.volume().total_cmp(&b.volume())) else { return mesh };
    if all.len() == 1 || outer.open_edges() > 0 {
        return mesh;
    }
    let (inside, least) = (Winding::new(outer), HOLLOW * outer.volume());
    let is_hollow = |piece: &&TriMesh| {
        let all_inside = || piece.vertices.iter().all(|v| inside.at(v) > 0.5);
        (least..outer.volume()).contains(&piece.volume()) && piece.open_edges() == 0 && all_inside()
    };
    let (hollows, others): (Vec<&TriMesh>, Vec<&TriMesh>) = all.iter().partition(is_hollow);
    if hollows.is_empty() {
        return mesh;
    }
    changes.hollows = hollows.len();
    changes.hollow_volume = hollows.iter().map(|piece| piece.volume()).sum();
    joined(others)
}

fn joined<'a>(pieces: impl IntoIterator<Item = &'a TriMesh>) -> TriMesh {
    let mut all = TriMesh::default();
    for piece in pieces {
        let first = all.vertices.len() as u32;
        all.vertices.extend(&piece.vertices);
        all.faces.extend(piece.faces.iter().map(|f| f.map(|v| v + first)));
    }
    all
}

/// Cells along the longest side that show the edges of a mesh.
fn cells_of(mesh: &TriMesh) -> usize {
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    let wanted = CELLS_AN_EDGE * (hi - lo).max() / usual_edge(mesh);
    if wanted.is_finite() {
        wanted.clamp(CELLS_OF_MESH[0], CELLS_OF_MESH[1]).round() as usize
    } else {
        CELLS_OF_MESH[1] as usize
    }
}

/// Cleans a cloud, with its normals if it has some.
///
/// # Errors
/// A cloud that encloses nothing.
pub fn clean_cloud(
    points: &[Vec3],
    normals: Option<&[Vec3]>,
    settings: &CleanSettings,
) -> Result<(Stone, Changes), CleanError> {
    let few = || CleanError::Points(points.len());
    let surfels =
        if points.len() < 100 { None } else { surfels::squares(points, normals) }.ok_or_else(few)?;
    let spacing = surfels.spacing;
    let (lo, hi) = geom::grid::bounds(points);
    let cells = settings
        .cells
        .unwrap_or_else(|| ((hi - lo).max() / spacing).clamp(CELLS[0], CELLS[1]).round() as usize);
    let reason = format!("{} points came", points.len());
    let mut changes = Changes { rebuilt: Some(reason), cells: Some(cells), ..Changes::default() };
    changes.normals_turned = surfels.turned;
    let mesh = rebuilt(soup::sample(&surfels.squares, cells), &mut changes)?;
    thinned(mesh, settings, changes)
}

/// Each face once.
fn distinct(mesh: &TriMesh) -> TriMesh {
    let mut seen = BTreeSet::new();
    let sorted = |f: &[u32; 3]| {
        let mut sorted = *f;
        sorted.sort_unstable();
        sorted
    };
    let faces = mesh.faces.iter().filter(|f| seen.insert(sorted(f))).copied().collect();
    TriMesh { vertices: mesh.vertices.clone(), faces }
}

/// Without the pieces that are noise.
fn without_noise(mesh: &TriMesh, changes: &mut Changes) -> TriMesh {
    let all = pieces::pieces(mesh);
    let areas: Vec<f64> = all.iter().map(TriMesh::area).collect();
    let (total, most) = (areas.iter().sum::<f64>(), areas.iter().copied().fold(0.0, f64::max));
    let (noise, large): (Vec<_>, Vec<_>) =
        all.iter().zip(&areas).partition(|(_, area)| **area < NOISE * most);
    changes.islands += noise.len();
    changes.islands_area += noise.iter().map(|(_, area)| **area / total).sum::<f64>();
    let kept = joined(large.into_iter().map(|(piece, _)| piece));
    // A soup of triangles, each a piece.
    if changes.islands_area > NOISE * all.len() as f64 || kept.area() < 0.5 * total {
        (changes.islands, changes.islands_area) = (0, 0.0);
        return pieces::used(mesh);
    }
    kept
}

/// The piece of the largest volume.
fn largest(mesh: TriMesh, changes: &mut Changes) -> TriMesh {
    let (all, area) = (pieces::pieces(&mesh), mesh.area());
    if all.len() == 1 {
        return mesh;
    }
    changes.islands += all.len() - 1;
    // Of equal ones the first.
    let best = all.into_iter().rev().max_by(|a, b| a.volume().total_cmp(&b.volume())).unwrap_or(mesh);
    changes.islands_area += 1.0 - best.area() / area;
    best
}

/// The surface of samples, one piece, without crossings.
fn rebuilt(samples: Samples, changes: &mut Changes) -> Result<TriMesh, CleanError> {
    let mesh = closed(samples).ok_or(CleanError::Nothing)?;
    let mesh = largest(mesh, changes);
    if mesh.volume() < SHEET * mesh.area().powf(1.5) { Err(CleanError::Nothing) } else { Ok(mesh) }
}

/// The surface of samples, without crossings where cells are fine enough for it.
pub fn closed(samples: Samples) -> Option<TriMesh> {
    let (origin, step) = (samples.origin, samples.step);
    let mut mesh = surface(samples)?;
    for _ in 0..SMOOTHED {
        let crossings = crossings(&mesh);
        if crossings.is_empty() {
            break;
        }
        let vertices: BTreeSet<u32> =
            crossings.iter().flat_map(|(f, g)| [mesh.faces[*f], mesh.faces[*g]]).flatten().collect();
        remesh::nets::towards_middles(&mut mesh, &origin, step, vertices);
    }
    Some(mesh)
}

fn crossings(mesh: &TriMesh) -> Vec<(usize, usize)> {
    crossing::of_itself(mesh, &Boxes::new(&mesh.triangles().map(around).collect::<Vec<_>>()))
}

/// Share of the area of a mesh that is farther from another than two cells.
fn added(mesh: &TriMesh, other: &TriMesh, cells: usize) -> f64 {
    let (lo, hi) = geom::grid::bounds(&other.vertices);
    let reach = 2.0 * (hi - lo).max() / cells as f64;
    let boxes = Boxes::new(&other.triangles().map(around).collect::<Vec<_>>());
    let is_far = |[a, b, c]: &[Vec3; 3]| {
        let (middle, mut near) = ((a + b + c) / 3.0, false);
        boxes.near(middle, reach, |f| {
            near |= (closest_point(other.triangle(f as usize), middle) - middle).norm() <= reach
        });
        !near
    };
    mesh.triangles().filter(is_far).map(geom::mesh::area).sum::<f64>() / mesh.area()
}

/// Thins faces out; the result is checked.
fn thinned(
    mesh: TriMesh,
    settings: &CleanSettings,
    mut changes: Changes,
) -> Result<(Stone, Changes), CleanError> {
    changes.volume_before = mesh.volume();
    let mut stone = Stone::new(&mesh, true);
    if let Some(mut faces) = settings.faces.filter(|f| *f < mesh.faces.len()) {
        for _ in 0..RETRIES {
            stone = Stone::new(&decimate(&mesh, faces), true);
            if stone.is_ok() {
                break;
            }
            faces += faces / 2;
        }
    }
    let stone = stone?;
    (changes.volume, changes.faces) = (stone.moments.volume, stone.mesh.faces.len());
    Ok((stone, changes))
}

#[cfg(test)]
mod tests;
