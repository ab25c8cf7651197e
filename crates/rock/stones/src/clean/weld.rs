//! Corners that are nearly in one place, as rounding leaves them, become one: faces then share edges.

use geom::Vec3;
use geom::mesh::TriMesh;
use std::collections::HashMap;

/// Corners may be apart by this share of the longest side …
const OF_SIZE: f64 = 1e-4;
/// … and of the usual edge.
const OF_EDGE: f64 = 0.02;

/// How corners were joined.
pub(super) struct Welded {
    pub(super) mesh: TriMesh,
    /// Corners that lie at another one now.
    pub(super) corners: usize,
    /// How far apart two of them were at most [m].
    pub(super) within: f64,
}

/// The mesh with corners joined, if fewer edges are open then.
pub(super) fn welded(mesh: &TriMesh, usual_edge: f64) -> Option<Welded> {
    let open = mesh.open_edges();
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    let within = (OF_SIZE * (hi - lo).max()).min(OF_EDGE * usual_edge);
    if open == 0 || !(within > 0.0) {
        return None;
    }
    let renamed = nearest_before(&mesh.vertices, within);
    let faces = mesh.faces.iter().map(|f| f.map(|v| renamed[v as usize]));
    // What had an edge as short is no face any more.
    let faces: Vec<[u32; 3]> = faces.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let corners = (0u32..).zip(&renamed).filter(|(own, name)| own != *name).count();
    let mesh = remesh::pieces::used(&TriMesh { vertices: mesh.vertices.clone(), faces });
    (corners > 0 && mesh.open_edges() < open).then_some(Welded { mesh, corners, within })
}

/// Of each place the first one within a distance [m] that is not joined to another itself; its own if there is none.
fn nearest_before(places: &[Vec3], within: f64) -> Vec<u32> {
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut names = Vec::with_capacity(places.len());
    for (own, p) in (0u32..).zip(places) {
        let cell: [i64; 3] = [p.x, p.y, p.z].map(|c| (c / within).floor() as i64);
        let around = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        let at = |[a, b, c]: [i64; 3]| {
            [cell[0].saturating_add(a), cell[1].saturating_add(b), cell[2].saturating_add(c)]
        };
        let candidates = around.filter_map(|off| cells.get(&at(off))).flatten();
        let near = candidates.filter(|&&other| (places[other as usize] - p).norm() <= within);
        let name = near.min().copied().unwrap_or(own);
        if name == own {
            cells.entry(cell).or_default().push(own);
        }
        names.push(name);
    }
    names
}
