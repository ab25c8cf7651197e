//! On which side of a drawn surface the flow is.
//!
//! 0. Of faces with the same corners, as a face drawn on both sides or an exported part that is there twice, the first is kept.
//! 1. Faces that share an edge are made to agree on a side, part by part.
//! 2. If a position in the flow is given, each part faces it: seen from there, its nearest face shows its front.
//! 3. Otherwise a closed part is a body, and the flow is around it, or inside it if it lies in another closed part (a cavity). An
//!    open part faces the side from which most of its corners run anticlockwise, as drawn.

use geom::Vec3;
use geom::mesh::{TriMesh, area, closest_point};
use std::collections::HashMap;

/// A distance this little longer, as a share, is as near.
const AS_NEAR: f64 = 1e-9;

/// A mesh whose faces show the flow their front.
pub(crate) struct DrawnSurface {
    pub mesh: TriMesh,
    /// Unit normal of each face, on the flow side.
    pub normals: Vec<Vec3>,
    /// Faces at each edge, lower vertex first, in order of the edges.
    pub edges: Vec<((u32, u32), Vec<u32>)>,
    pub area: f64,
    pub parts: usize,
    pub closed: usize,
    pub turned: usize,
    pub one_sided: usize,
    pub doubled: Doubled,
}

/// Faces left out because an earlier one has the same corners.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Doubled {
    pub faces: usize,
    /// Of them in the opposite order, in parts that are not closed: nothing but the order in the file says on which side the flow is.
    pub undecided: usize,
}

impl DrawnSurface {
    /// None when no face has an area.
    pub fn new(mesh: &TriMesh, flow_at: Option<Vec3>) -> Option<DrawnSurface> {
        let mut mesh = mesh.welded();
        let (lo, hi) = geom::grid::bounds(&mesh.vertices);
        let least = 1e-12 * (hi - lo).norm_squared();
        let vertices = &mesh.vertices;
        mesh.faces.retain(|f| area(f.map(|v| vertices[v as usize])) > least);
        if mesh.faces.is_empty() {
            return None;
        }
        let back = single(&mut mesh);
        let edges = edges(&mesh);
        let (part_of, parts, one_sided) = agree(&mut mesh, &edges);
        let open = open_parts(&edges, &part_of, parts);
        let turned = turn(&mut mesh, &open, &part_of, flow_at);
        let closed = open.iter().filter(|open| !**open).count();
        let is_undecided = |face: &&u32| flow_at.is_none() && open[part_of[**face as usize] as usize];
        let doubled =
            Doubled { faces: back.faces, undecided: back.opposite.iter().filter(is_undecided).count() };
        let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(&(c - a)).normalize();
        let (normals, area) = (mesh.triangles().map(normal).collect(), mesh.area());
        Some(DrawnSurface { normals, edges, area, parts, closed, turned, one_sided, doubled, mesh })
    }

    /// About `count` positions spread evenly over the faces, each with its normal: by area along the faces, and within a face by the
    /// sequence of Roberts (2018) that fills a square evenly.
    pub fn scattered(&self, count: usize) -> Vec<(Vec3, Vec3)> {
        let each = self.area / count.max(1) as f64;
        let mut positions = Vec::with_capacity(count + self.mesh.faces.len());
        // The share of a candidate that earlier faces left.
        let (mut due, mut number) = (0.5, 0u64);
        for (face, tri) in self.mesh.triangles().enumerate() {
            due += area(tri) / each;
            while due >= 1.0 {
                due -= 1.0;
                number += 1;
                positions.push((within(tri, number), self.normals[face]));
            }
        }
        positions
    }
}

/// Place `number` of a triangle.
fn within([a, b, c]: [Vec3; 3], number: u64) -> Vec3 {
    let share = |step: f64| (0.5 + number as f64 * step).fract();
    let (s, t) = (share(0.754_877_666_246_692_7), share(0.569_840_290_998_053_3));
    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
    a + (b - a) * s + (c - a) * t
}

/// Faces that were left out.
struct LeftOut {
    faces: usize,
    /// The face that stays, for each that had its corners in the opposite order.
    opposite: Vec<u32>,
}

/// Keeps the first of all faces with the same corners.
fn single(mesh: &mut TriMesh) -> LeftOut {
    let mut first: HashMap<[u32; 3], u32> = HashMap::with_capacity(mesh.faces.len());
    let (mut kept, mut opposite) = (Vec::with_capacity(mesh.faces.len()), Vec::new());
    for &face in &mesh.faces {
        let mut corners = face;
        corners.sort_unstable();
        let number = kept.len() as u32;
        match *first.entry(corners).or_insert(number) {
            new if new == number => kept.push(face),
            old if !runs(kept[old as usize], (face[0], face[1])) => opposite.push(old),
            _ => {}
        }
    }
    let faces = mesh.faces.len() - kept.len();
    mesh.faces = kept;
    LeftOut { faces, opposite }
}

fn edges(mesh: &TriMesh) -> Vec<((u32, u32), Vec<u32>)> {
    let mut all: Vec<((u32, u32), u32)> = Vec::with_capacity(3 * mesh.faces.len());
    for (face, &[a, b, c]) in (0..).zip(&mesh.faces) {
        all.extend([(a, b), (b, c), (c, a)].map(|(u, v)| ((u.min(v), u.max(v)), face)));
    }
    all.sort_unstable();
    all.chunk_by(|x, y| x.0 == y.0).map(|chunk| (chunk[0].0, chunk.iter().map(|x| x.1).collect())).collect()
}

fn runs(face: [u32; 3], (u, v): (u32, u32)) -> bool {
    [(face[0], face[1]), (face[1], face[2]), (face[2], face[0])].contains(&(u, v))
}

/// Turns faces until neighbours agree: the part of each face, the number of parts, and of edges whose faces still do not.
fn agree(mesh: &mut TriMesh, edges: &[((u32, u32), Vec<u32>)]) -> (Vec<u32>, usize, usize) {
    let mut beside: Vec<Vec<(u32, (u32, u32))>> = vec![Vec::new(); mesh.faces.len()];
    for (edge, faces) in edges {
        if let [f, g] = faces[..] {
            beside[f as usize].push((g, *edge));
            beside[g as usize].push((f, *edge));
        }
    }
    let (mut part_of, mut parts) = (vec![u32::MAX; mesh.faces.len()], 0);
    for first in 0..mesh.faces.len() {
        if part_of[first] != u32::MAX {
            continue;
        }
        let (mut members, mut next, mut turned) = (vec![first as u32], 0, Vec::new());
        part_of[first] = parts;
        while let Some(&face) = members.get(next) {
            next += 1;
            for &(other, edge) in &beside[face as usize] {
                if part_of[other as usize] == u32::MAX {
                    part_of[other as usize] = parts;
                    members.push(other);
                    // Two faces agree when they run along their edge in opposite directions.
                    if runs(mesh.faces[face as usize], edge) == runs(mesh.faces[other as usize], edge) {
                        mesh.faces[other as usize].swap(1, 2);
                        turned.push(other);
                    }
                }
            }
        }
        // The side that most faces were drawn with.
        if 2 * turned.len() > members.len() {
            members.iter().for_each(|&face| mesh.faces[face as usize].swap(1, 2));
        }
        parts += 1;
    }
    let agrees =
        |&f: &u32, &g: &u32, edge| runs(mesh.faces[f as usize], edge) != runs(mesh.faces[g as usize], edge);
    let wrong =
        edges.iter().filter(|(edge, faces)| matches!(&faces[..], [f, g] if !agrees(f, g, *edge))).count();
    (part_of, parts as usize, wrong)
}

/// Which parts are not closed.
fn open_parts(edges: &[((u32, u32), Vec<u32>)], part_of: &[u32], parts: usize) -> Vec<bool> {
    let mut open = vec![false; parts];
    for (_, faces) in edges.iter().filter(|(_, faces)| faces.len() != 2) {
        faces.iter().for_each(|&face| open[part_of[face as usize] as usize] = true);
    }
    open
}

/// Turns whole parts to the flow; how many.
fn turn(mesh: &mut TriMesh, open: &[bool], part_of: &[u32], flow_at: Option<Vec3>) -> usize {
    let parts = open.len();
    let pieces = pieces(mesh, part_of, parts);
    let boxes: Vec<(Vec3, Vec3)> = pieces.iter().map(|piece| geom::grid::bounds(&piece.vertices)).collect();
    let is_within = |p: &Vec3, (lo, hi): &(Vec3, Vec3)| (0..3).all(|a| lo[a] <= p[a] && p[a] <= hi[a]);
    let is_turned = |part: usize| match flow_at {
        Some(position) => !faces_position(&pieces[part], position),
        None if open[part] => false,
        None => {
            let (piece, inside) = (&pieces[part], pieces[part].volume() < 0.0);
            let corner = piece.faces.first().map_or(Vec3::zeros(), |f| piece.vertices[f[0] as usize]);
            let others = (0..parts).filter(|&other| other != part && !open[other]);
            let around =
                |&other: &usize| is_within(&corner, &boxes[other]) && pieces[other].contains(&corner);
            let is_cavity = others.filter(around).count() % 2 == 1;
            inside != is_cavity
        }
    };
    let turned: Vec<bool> = (0..parts).map(is_turned).collect();
    for (face, _) in mesh.faces.iter_mut().zip(part_of).filter(|(_, part)| turned[**part as usize]) {
        face.swap(1, 2);
    }
    turned.iter().filter(|turned| **turned).count()
}

/// The parts, each with its own vertices alone.
fn pieces(mesh: &TriMesh, part_of: &[u32], parts: usize) -> Vec<TriMesh> {
    let mut pieces = vec![TriMesh::default(); parts];
    let mut numbers: Vec<HashMap<u32, u32>> = vec![HashMap::new(); parts];
    for (face, &part) in mesh.faces.iter().zip(part_of) {
        let (piece, number) = (&mut pieces[part as usize], &mut numbers[part as usize]);
        let face = face.map(|v| {
            *number.entry(v).or_insert_with(|| {
                piece.vertices.push(mesh.vertices[v as usize]);
                piece.vertices.len() as u32 - 1
            })
        });
        piece.faces.push(face);
    }
    pieces
}

/// Whether the faces nearest to a position show their front to it.
fn faces_position(piece: &TriMesh, position: Vec3) -> bool {
    let near: Vec<(f64, Vec3, Vec3)> = piece
        .triangles()
        .map(|tri| {
            let to = position - closest_point(tri, position);
            (to.norm(), to, (tri[1] - tri[0]).cross(&(tri[2] - tri[0])).normalize())
        })
        .collect();
    let least = near.iter().map(|n| n.0).fold(f64::INFINITY, f64::min);
    // At an edge or a corner, its faces have a say together.
    near.iter().filter(|n| n.0 <= least * (1.0 + AS_NEAR)).map(|n| n.1.dot(&n.2)).sum::<f64>() >= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::mesh::cuboid;

    fn joined(meshes: impl IntoIterator<Item = TriMesh>) -> TriMesh {
        meshes.into_iter().fold(TriMesh::default(), |mut all, mesh| {
            let first = all.vertices.len() as u32;
            all.vertices.extend(mesh.vertices);
            all.faces.extend(mesh.faces.iter().map(|face| face.map(|v| v + first)));
            all
        })
    }

    #[test]
    fn a_part_holds_only_its_own_vertices() {
        let corner = |k: u32| Vec3::new(2.0 * f64::from(k % 100), 2.0 * f64::from(k / 100), 0.0);
        let tri = |k| TriMesh {
            vertices: [Vec3::zeros(), Vec3::x(), Vec3::y()].map(|v| v + corner(k)).to_vec(),
            faces: vec![[0, 1, 2]],
        };
        let mesh = joined((0..4000).map(tri));
        let part_of: Vec<u32> = (0..4000).collect();
        let pieces = pieces(&mesh, &part_of, 4000);
        for (k, piece) in pieces.iter().enumerate() {
            assert_eq!(piece.vertices.len(), 3);
            assert_eq!(piece.triangle(0), mesh.triangle(k));
        }
        let surface = DrawnSurface::new(&mesh, None).unwrap();
        assert_eq!((surface.parts, surface.closed, surface.turned), (4000, 0, 0));
    }

    /// A drawing whose faces are there twice is the same drawing, whichever way the second ones run.
    #[test]
    fn doubled_faces_are_one() {
        let body = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        let turned = |mesh: &TriMesh| TriMesh {
            faces: mesh.faces.iter().map(|&[a, b, c]| [c, b, a]).collect(),
            ..mesh.clone()
        };
        let floor = TriMesh {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::x() + Vec3::y(), Vec3::y()],
            faces: vec![[0, 1, 2], [0, 2, 3]],
        };
        for (mesh, closed) in [(body, 1), (floor, 0)] {
            let single = DrawnSurface::new(&mesh, None).unwrap();
            let faces = mesh.faces.len();
            for (other, opposite) in [(mesh.clone(), false), (turned(&mesh), true)] {
                let doubled = DrawnSurface::new(&joined([mesh.clone(), other]), None).unwrap();
                assert_eq!((&doubled.mesh, &doubled.normals), (&single.mesh, &single.normals));
                assert_eq!((doubled.closed, doubled.area), (closed, single.area));
                let undecided = if opposite && closed == 0 { faces } else { 0 };
                assert_eq!(doubled.doubled, Doubled { faces, undecided });
            }
        }
    }

    /// Bodies stay as drawn, and what lies in one of them is a cavity.
    #[test]
    fn many_closed_parts() {
        let at = |k: u32| Vec3::new(2.0 * f64::from(k % 40), 2.0 * f64::from(k / 40), 0.0);
        let body = |k| cuboid(at(k), at(k) + Vec3::repeat(1.0));
        let hollow =
            (0..2000).step_by(10).map(|k| cuboid(at(k) + Vec3::repeat(0.3), at(k) + Vec3::repeat(0.6)));
        let mesh = joined((0..2000).map(body).chain(hollow));
        let surface = DrawnSurface::new(&mesh, None).unwrap();
        assert_eq!((surface.parts, surface.closed, surface.turned), (2200, 2200, 200));
    }
}
