//! Clumps that are polyhedra, in a page: a mesh for each shape, and which rows of a frame are one of them.
//!
//! The page places a mesh by four of the spheres, q₀ … q₃ of the shape and p₀ … p₃ of the frame:
//!
//! ```text
//! x ↦ p₀ + M (x − q₀)      M = [p₁ − p₀, p₂ − p₀, p₃ − p₀] Q⁻¹,   Q = [q₁ − q₀, q₂ − q₀, q₃ − q₀]
//! ```

use super::pack::Packed;
use crate::things::{solid::Solid, spheres::Spheres};
use geom::Vec3;
use record::ClumpRecord;
use serde_json::{Value, json};
use std::sync::Arc;

/// A shape, packed.
struct PageSolid {
    solid: Solid,
    /// Triangles: x, y, z [m] and the normal of each corner, as 4-byte numbers.
    mesh: Arc<Vec<u8>>,
}

/// The shapes of a layer.
#[derive(Default)]
pub(crate) struct PageSolids(Vec<PageSolid>);

impl PageSolids {
    /// Those of clumps that are polyhedra.
    pub fn of(clumps: &[ClumpRecord]) -> PageSolids {
        let packed = |solid: Solid| {
            let flat = solid.panes().into_iter().map(|(corners, n)| corners.map(|corner| (corner, n)));
            let corners = flat.chain(solid.bevels()).flatten();
            let numbers = corners.flat_map(|(p, n)| [p.x, p.y, p.z, n.x, n.y, n.z]);
            let mesh = Arc::new(numbers.flat_map(|v| (v as f32).to_le_bytes()).collect());
            PageSolid { solid, mesh }
        };
        PageSolids(clumps.iter().filter_map(Solid::of).map(packed).collect())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// First row and shape of each clump of a frame that is one of these, as 4-byte numbers; the same place in memory
    /// as the last frame's when they are the same.
    pub fn find(&self, spheres: &Spheres, bodies: &[Vec<u32>], last: Option<&Packed>) -> Arc<Vec<u8>> {
        let of = |rows: &Vec<u32>| {
            let in_order = rows.iter().zip(rows[0]..).all(|(row, wanted)| *row == wanted);
            let shape = self.0.iter().position(|s| in_order && s.solid.fits(spheres, rows))?;
            Some([rows[0], shape as u32])
        };
        let found = bodies.iter().filter_map(of).flatten();
        let bytes: Vec<u8> = found.flat_map(u32::to_le_bytes).collect();
        let same = last.filter(|l| *l.solids == bytes);
        same.map_or_else(|| Arc::new(bytes), |l| Arc::clone(&l.solids))
    }

    /// The shapes in the page's header; `number` gives that of a column of bytes.
    pub fn header<'a>(&'a self, mut number: impl FnMut(&'a Arc<Vec<u8>>) -> usize) -> Vec<Value> {
        let one = |PageSolid { solid, mesh }: &'a PageSolid| {
            let [(a, origin), b, c, d] = solid.frame();
            let plane = |(corners, n): ([Vec3; 3], Vec3)| [n.x, n.y, n.z, n.dot(&corners[0])];
            json!({
                "spheres": solid.len(), "mesh": number(mesh), "corners": mesh.len() / 24,
                "frame": [a, b.0, c.0, d.0], "origin": [origin.x, origin.y, origin.z],
                "inverse": inverse([b.1 - origin, c.1 - origin, d.1 - origin]),
                "planes": solid.panes().into_iter().map(plane).collect::<Vec<_>>(),
            })
        };
        self.0.iter().map(one).collect()
    }
}

/// The rows of the inverse of the matrix with these columns.
fn inverse([a, b, c]: [Vec3; 3]) -> Vec<f64> {
    let rows = [b.cross(&c), c.cross(&a), a.cross(&b)].map(|row| row / a.dot(&b.cross(&c)));
    rows.iter().flat_map(|row| [row.x, row.y, row.z]).collect()
}
