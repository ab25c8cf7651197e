//! How well a mesh agrees with a mask.

use super::View;
use crate::rendered::raster::{NONE, faces};
use geom::mesh::TriMesh;

/// Longest side of the picture on which they are compared [px].
const LONGEST: f64 = 640.0;

/// Pixels of a mesh and of a mask, on a picture of one size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Pixels of both over pixels of either [–].
    pub union: f64,
    /// Share of the mask that the mesh does not cover [–].
    pub missed: f64,
}

impl View {
    /// Compares the silhouette of a mesh with the mask, on a smaller picture where the photograph is large.
    pub fn agreement(&self, mesh: &TriMesh) -> Agreement {
        let [w, h] = self.field.frame();
        let factor = (LONGEST / w.max(h)).min(1.0);
        let (width, height) = ((w * factor).round() as usize, (h * factor).round() as usize);
        let seen = faces(mesh, &self.camera.resized(factor), width, height, 1);
        let (mut both, mut either, mut mask) = (0.0, 0.0, 0.0);
        for (k, face) in seen.iter().enumerate() {
            let at = |p: usize| (p as f64 + 0.5) / factor - 0.5;
            let (stone, hull) = (self.field.at(at(k % width), at(k / width)) > 0.0, *face != NONE);
            mask += f64::from(u8::from(stone));
            both += f64::from(u8::from(stone && hull));
            either += f64::from(u8::from(stone || hull));
        }
        Agreement { union: both / either, missed: 1.0 - both / mask }
    }
}
