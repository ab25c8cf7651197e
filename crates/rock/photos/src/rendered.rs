//! Photographs of a mesh, made for tests and trials: a speckled stone with light, shadow, defocus and noise, and its true mask.
//!
//! The speckle is a function of the place on the stone, so that it is the same on all photographs.

mod noise;
pub(crate) mod raster;
mod tag;

use crate::camera::Camera;
use crate::mask::Mask;
use crate::photograph::{Photograph, PhotographError, encode};
use geom::Vec3;
use geom::mesh::TriMesh;
use image::ImageEncoder;

pub use tag::Tag;

/// Samples of a pixel along each side.
const SAMPLES: usize = 4;

/// What a rendered photograph looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Studio {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Light of the paint and of its speckle when lit from the front [–].
    pub paint: [f64; 2],
    /// Extent of the speckle [m].
    pub speckle: f64,
    /// Light of the background at the left and at the right [–].
    pub background: [f64; 2],
    /// Share of the background's light that a shadow beside the stone takes [–].
    pub shadow: f64,
    /// Standard deviation of the blur [px].
    pub blur: f64,
    /// Standard deviation of the noise [–].
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u64,
}

impl Studio {
    /// White paint with dark speckle before a black cloth.
    pub fn new(width: usize, height: usize, speckle: f64) -> Studio {
        Studio {
            width,
            height,
            paint: [0.75, 0.25],
            speckle,
            background: [0.01, 0.03],
            shadow: 0.5,
            blur: 0.7,
            noise: 0.005,
            seed: 0,
        }
    }

    /// A photograph and its true mask.
    pub fn photograph(&self, mesh: &TriMesh, camera: &Camera) -> (Photograph, Mask) {
        let (w, h) = (self.width, self.height);
        let faces = raster::faces(mesh, camera, w * SAMPLES, h * SAMPLES, SAMPLES);
        let (mut light, mut coverage) = (vec![0f32; w * h], vec![0u8; w * h]);
        let each = (SAMPLES * SAMPLES) as f64;
        for k in 0..w * h {
            let behind = self.behind(k % w, k / w);
            let (mut sum, mut covered) = (0.0, 0.0);
            for s in 0..SAMPLES * SAMPLES {
                let at = (k / w * SAMPLES + s / SAMPLES) * w * SAMPLES + k % w * SAMPLES + s % SAMPLES;
                match faces[at] {
                    raster::NONE => sum += behind,
                    face => {
                        let within = |s: usize| (s as f64 + 0.5) / SAMPLES as f64 - 0.5;
                        let (x, y) =
                            ((k % w) as f64 + within(s % SAMPLES), (k / w) as f64 + within(s / SAMPLES));
                        sum += self.lit(mesh.triangle(face as usize), camera, [x, y]);
                        covered += 1.0;
                    }
                }
            }
            light[k] = (sum / each) as f32;
            coverage[k] = (255.0 * covered / each).round() as u8;
        }
        noise::blur(&mut light, w, self.blur);
        noise::add(&mut light, self.noise, self.seed);
        (Photograph { width: w, height: h, light }, Mask::given(w, h, coverage))
    }

    /// Light of the background: a slope from left to right, and a shadow below the middle.
    fn behind(&self, x: usize, y: usize) -> f64 {
        let (w, h) = (self.width as f64, self.height as f64);
        let (u, v) = (x as f64 / w, y as f64 / h);
        let slope = self.background[0] + u * (self.background[1] - self.background[0]);
        let far = ((u - 0.5) / 0.35).powi(2) + ((v - 0.75) / 0.12).powi(2);
        slope * (1.0 - self.shadow * (1.0 - far).max(0.0))
    }

    /// Light of a face at a pixel: paint or speckle, lit from the camera's upper left, softly.
    fn lit(&self, [a, b, c]: [Vec3; 3], camera: &Camera, pixel: [f64; 2]) -> f64 {
        let normal = (b - a).cross(&(c - a)).normalize();
        let (eye, ray) = (camera.eye(), camera.ray(pixel));
        let place = eye + ray * (normal.dot(&(a - eye)) / normal.dot(&ray));
        let paint = if noise::speckle(&(place / self.speckle)) { self.paint[1] } else { self.paint[0] };
        let lamp = camera.rotation.transpose() * Vec3::new(-0.5, -0.6, -0.62);
        paint * (0.45 + 0.55 * normal.dot(&lamp).max(0.0))
    }
}

/// The true mask alone.
pub fn silhouette(mesh: &TriMesh, camera: &Camera, width: usize, height: usize) -> Mask {
    let faces = raster::faces(mesh, camera, width * SAMPLES, height * SAMPLES, SAMPLES);
    let mut covered = vec![0u32; width * height];
    for (k, _) in faces.iter().enumerate().filter(|f| *f.1 != raster::NONE) {
        let (x, y) = (k % (width * SAMPLES), k / (width * SAMPLES));
        covered[y / SAMPLES * width + x / SAMPLES] += 1;
    }
    let each = (SAMPLES * SAMPLES) as f64;
    let coverage = covered.iter().map(|c| (255.0 * f64::from(*c) / each).round() as u8).collect();
    Mask::given(width, height, coverage)
}

/// A photograph as JPEG of this quality (1–100).
///
/// # Errors
/// Sizes that do not agree.
pub fn jpeg(photograph: &Photograph, quality: u8) -> Result<Vec<u8>, PhotographError> {
    let values: Vec<u8> = photograph.light.iter().map(|l| encode(*l)).collect();
    let mut out = Vec::new();
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut out, quality)
        .write_image(&values, photograph.width as u32, photograph.height as u32, image::ExtendedColorType::L8)
        .map_err(|e| PhotographError::Png(e.to_string()))?;
    Ok(out)
}
