//! Nearly straight stretches of a drawing: its creases and open rims, from corner to corner.
//!
//! An edge is a crease when its faces turn by more than 25° there, and a rim when it has one face. Creases and rims that follow
//! each other form a stretch until the next corner: a vertex where not two of them meet, or where they turn by more than 25°. Places
//! stand at both ends of a stretch, and between them at equal distances of at most the spacing; on a closed one (the rim of a
//! pipe) at equal distances all around. Each position stands once for every face that it lies on.

use super::sides::DrawnSurface;
use geom::Vec3;
use std::collections::BTreeMap;

/// cos 25° [–].
const STRAIGHT: f64 = 0.906_307_787_036_65;

/// Places on the stretches of a surface.
pub(crate) struct Stretches {
    /// Place [m] and unit normal of a face there; ends first.
    pub positions: Vec<(Vec3, Vec3)>,
    pub count: usize,
    pub corners: usize,
}

/// A crease or rim: its vertices and faces.
struct Edge {
    ends: [u32; 2],
    faces: Vec<u32>,
}

/// The stretches of a surface. `centre` gives the sphere of a position and a normal: where those of the ends stand off from the ends (in a
/// corner), the others stand between them.
pub(crate) fn find(surface: &DrawnSurface, spacing: f64, centre: &dyn Fn(Vec3, Vec3) -> Vec3) -> Stretches {
    let edges: Vec<Edge> =
        surface.edges.iter().filter_map(|(ends, faces)| crease(surface, *ends, faces)).collect();
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (number, edge) in edges.iter().enumerate() {
        edge.ends.iter().for_each(|&end| at.entry(end).or_default().push(number));
    }
    let position = |v: u32| surface.mesh.vertices[v as usize];
    let along = |edge: &Edge, from: u32| (position(other(edge, from)) - position(from)).normalize();
    let is_corner = |v: u32| match at.get(&v).map(Vec::as_slice) {
        Some(&[e, f]) => -along(&edges[e], v).dot(&along(&edges[f], v)) < STRAIGHT,
        _ => true,
    };
    let corners: Vec<u32> = at.keys().copied().filter(|&v| is_corner(v)).collect();
    let mut positions = Vec::new();
    for &v in &corners {
        let faces = at[&v].iter().flat_map(|&e| edges[e].faces.iter().copied());
        push(&mut positions, surface, position(v), faces);
    }
    let (mut used, mut count) = (vec![false; edges.len()], 0);
    let starts = corners.iter().flat_map(|&v| at[&v].iter().map(move |&e| (v, e)));
    // What is left when all stretches between corners are walked is closed.
    let loops = (0..edges.len()).map(|e| (edges[e].ends[0], e));
    for (from, first) in starts.chain(loops) {
        if used[first] {
            continue;
        }
        let (mut chain, mut vertex, mut edge) = (vec![(first, from)], other(&edges[first], from), first);
        used[first] = true;
        while !is_corner(vertex) && vertex != from {
            let Some(&next) = at[&vertex].iter().find(|&&e| e != edge && !used[e]) else { break };
            chain.push((next, vertex));
            used[next] = true;
            (edge, vertex) = (next, other(&edges[next], vertex));
        }
        let closed = vertex == from && !is_corner(from);
        let inset = |(number, from): (usize, u32)| {
            let (edge, a) = (&edges[number], position(from));
            let off = |&f: &u32| (centre(a, surface.normals[f as usize]) - a).dot(&along(edge, from));
            edge.faces.iter().map(off).fold(0.0, f64::max)
        };
        let insets = match (closed, chain.last()) {
            (false, Some(&(last, _))) => (inset((first, from)), inset((last, vertex))),
            _ => (0.0, 0.0),
        };
        between(&mut positions, surface, &edges, &chain, Split { closed, spacing, insets });
        count += 1;
    }
    Stretches { positions, count, corners: corners.len() }
}

fn crease(surface: &DrawnSurface, ends: (u32, u32), faces: &[u32]) -> Option<Edge> {
    let is_straight = match *faces {
        [f, g] => surface.normals[f as usize].dot(&surface.normals[g as usize]) >= STRAIGHT,
        _ => false,
    };
    (!is_straight).then(|| Edge { ends: [ends.0, ends.1], faces: faces.to_vec() })
}

fn other(edge: &Edge, end: u32) -> u32 {
    if edge.ends[0] == end { edge.ends[1] } else { edge.ends[0] }
}

/// How a chain of edges is divided.
struct Split {
    closed: bool,
    /// Largest distance of two positions [m].
    spacing: f64,
    /// Length that is left out at the head and at the tail [m].
    insets: (f64, f64),
}

/// Positions between the ends of a chain of edges (number and first vertex), or all around.
fn between(
    positions: &mut Vec<(Vec3, Vec3)>,
    surface: &DrawnSurface,
    edges: &[Edge],
    chain: &[(usize, u32)],
    Split { closed, spacing, insets: (head, tail) }: Split,
) {
    let position = |v: u32| surface.mesh.vertices[v as usize];
    let length = |&(e, _): &(usize, u32)| (position(edges[e].ends[1]) - position(edges[e].ends[0])).norm();
    let whole: f64 = chain.iter().map(length).sum();
    let left = (whole - head - tail).max(0.0);
    // A stretch that is a whole number of spacings long has no further part by rounding.
    let parts = (left / spacing * (1.0 - 1e-9)).ceil().max(1.0) as usize;
    let first = usize::from(!closed);
    let (mut edge, mut before) = (0, 0.0);
    for k in first..parts {
        let goal = head + left * k as f64 / parts as f64;
        while edge + 1 < chain.len() && before + length(&chain[edge]) < goal {
            before += length(&chain[edge]);
            edge += 1;
        }
        let (number, from) = chain[edge];
        let (a, b) = (position(from), position(other(&edges[number], from)));
        let share = ((goal - before) / (b - a).norm()).clamp(0.0, 1.0);
        push(positions, surface, a + (b - a) * share, edges[number].faces.iter().copied());
    }
}

/// A position, once for each direction that its faces look to.
fn push(
    positions: &mut Vec<(Vec3, Vec3)>,
    surface: &DrawnSurface,
    at: Vec3,
    faces: impl Iterator<Item = u32>,
) {
    let mut seen: Vec<Vec3> = Vec::new();
    for face in faces {
        let normal = surface.normals[face as usize];
        if seen.iter().all(|n| n.dot(&normal) < STRAIGHT) {
            seen.push(normal);
            positions.push((at, normal));
        }
    }
}
