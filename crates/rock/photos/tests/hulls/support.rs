//! A scanned stone on a turntable.

use geom::Vec3;
use geom::mesh::TriMesh;
use photos::rendered::silhouette;
use photos::{Camera, Field, View};

/// The scanned quarry stone of the samples, about its middle, with a diagonal of 0.2 m.
pub fn stone() -> TriMesh {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../sample-data/stones/quarry.ply");
    let mut mesh = mesh::load(path).unwrap();
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    mesh.vertices.iter_mut().for_each(|v| *v -= (lo + hi) / 2.0);
    mesh.scale(DIAGONAL / (hi - lo).norm());
    mesh
}

/// Diagonal of the stone's box [m].
const DIAGONAL: f64 = 0.2;

/// Photographs of 320 × 240 pixels.
pub const SIZE: [usize; 2] = [320, 240];

/// Cameras of one turn at a tilt.
pub fn ring(count: u32, tilt_deg: f64) -> Vec<Camera> {
    let tilt = tilt_deg.to_radians();
    let at = |k: u32| {
        let angle = -std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let eye = Vec3::new(angle.cos() * tilt.cos(), angle.sin() * tilt.cos(), tilt.sin()) * 0.7;
        Camera::looking(eye, Vec3::zeros(), Vec3::z(), 700.0, [159.5, 119.5])
    };
    (0..count).map(at).collect()
}

/// Views with perfect masks.
pub fn views(mesh: &TriMesh, cameras: &[Camera]) -> Vec<View> {
    let view = |camera: &Camera| {
        let mask = silhouette(mesh, camera, SIZE[0], SIZE[1]);
        assert_eq!(mask.on_frame(), 0);
        View { camera: *camera, field: Field::new(&mask, 1000).unwrap().into() }
    };
    cameras.iter().map(view).collect()
}
