//! Pieces of a mesh, and whether it is a manifold.

use geom::mesh::TriMesh;
use geom::{Parts, Vec3};
use std::collections::HashMap;

/// Meshes of the pieces that share vertices, in the order of their first faces.
pub fn pieces(mesh: &TriMesh) -> Vec<TriMesh> {
    let mut parts = Parts::new(mesh.vertices.len());
    for &[a, b, c] in &mesh.faces {
        parts.join(a, b);
        parts.join(b, c);
    }
    let mut number: HashMap<u32, usize> = HashMap::new();
    let mut faces: Vec<Vec<[u32; 3]>> = Vec::new();
    for f in &mesh.faces {
        let r = parts.root(f[0]);
        let piece = *number.entry(r).or_insert_with(|| {
            faces.push(Vec::new());
            faces.len() - 1
        });
        faces[piece].push(*f);
    }
    faces.iter().map(|faces| with_used(&mesh.vertices, faces)).collect()
}

/// Without vertices that no face has.
pub fn used(mesh: &TriMesh) -> TriMesh {
    with_used(&mesh.vertices, &mesh.faces)
}

/// A mesh of some faces, with those of the vertices that they have.
fn with_used(all: &[Vec3], faces: &[[u32; 3]]) -> TriMesh {
    let mut renamed: HashMap<u32, u32> = HashMap::new();
    let mut vertices = Vec::new();
    let mut name = |v: u32| {
        *renamed.entry(v).or_insert_with(|| {
            vertices.push(all[v as usize]);
            vertices.len() as u32 - 1
        })
    };
    let faces = faces.iter().map(|f| f.map(&mut name)).collect();
    TriMesh { vertices, faces }
}

/// Vertices at which a closed, oriented mesh touches itself: its faces there are more than one fan.
pub fn pinched(mesh: &TriMesh) -> usize {
    let mut fans: Vec<Vec<[u32; 2]>> = vec![Vec::new(); mesh.vertices.len()];
    for f in &mesh.faces {
        (0..3).for_each(|k| fans[f[k] as usize].push([f[(k + 1) % 3], f[(k + 2) % 3]]));
    }
    let is_pinched = |fan: &&Vec<[u32; 2]>| {
        let Some(first) = fan.first() else { return false };
        let (mut at, mut steps) = (first[1], 1);
        while at != first[0] && steps <= fan.len() {
            match fan.iter().find(|e| e[0] == at) {
                Some(next) => at = next[1],
                None => return true,
            }
            steps += 1;
        }
        steps != fan.len()
    };
    fans.iter().filter(is_pinched).count()
}
