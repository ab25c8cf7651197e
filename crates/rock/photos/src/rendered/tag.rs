//! A tag beside the stone.

use crate::camera::Camera;
use crate::mask::Mask;
use crate::photograph::Photograph;
use geom::Vec3;

/// Samples of a pixel along each side.
const SAMPLES: usize = 4;
/// Tag 0 of the family 36h11 (Olson 2011, doi:10.1109/ICRA.2011.5979561) in its white margin: # is black.
const CELLS: [&[u8]; 10] = [
    b"..........",
    b".########.",
    b".#..#.#.#.",
    b".##...#.#.",
    b".##..####.",
    b".#.#.####.",
    b".##.#..##.",
    b".####.###.",
    b".########.",
    b"..........",
];

/// A tag that lies level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tag {
    /// Middle [m].
    pub at: Vec3,
    /// Side of the black square [m].
    pub size: f64,
}

impl Tag {
    /// Draws it on a photograph; a stone of this mask is in front of it.
    pub fn draw(&self, photograph: &mut Photograph, stone: &Mask, camera: &Camera) {
        let each = (SAMPLES * SAMPLES) as f32;
        for k in (0..stone.coverage.len()).filter(|k| stone.coverage[*k] == 0) {
            let at = [k % photograph.width, k / photograph.width];
            let sample = |s: usize| {
                let off = [s % SAMPLES, s / SAMPLES].map(|s| (s as f64 + 0.5) / SAMPLES as f64 - 0.5);
                self.light(camera, [0, 1].map(|a| at[a] as f64 + off[a]))
            };
            let lights: Vec<f32> = (0..SAMPLES * SAMPLES).filter_map(sample).collect();
            let rest = photograph.light[k] * (each - lights.len() as f32);
            photograph.light[k] = (rest + lights.iter().sum::<f32>()) / each;
        }
    }

    /// Light of it at a place [px], none beside it.
    fn light(&self, camera: &Camera, pixel: [f64; 2]) -> Option<f32> {
        let (eye, ray) = (camera.eye(), camera.ray(pixel));
        let place = eye + ray * ((self.at.z - eye.z) / ray.z) - self.at;
        let cell = |x: f64| {
            let cell = (8.0 * x / self.size + 5.0).floor();
            (0.0..10.0).contains(&cell).then_some(cell as usize)
        };
        // The first row is at the far side.
        let (row, column) = cell(-place.y).zip(cell(place.x))?;
        Some(if CELLS[row][column] == b'#' { 0.02 } else { 0.7 })
    }
}
