//! The scale from square tags of known size beside a stone.
//!
//! ```text
//! corner    argmin over x of  Σ |(1 − d dᵀ)(x − o)|²         rays from eyes o along d, of all photographs that see it
//! factor    size / mean of the sides of all tags
//! ```
//!
//! Rays that pass a corner by more than [`FAR`] pixels, and three times as far as most, are left out once.

use crate::camera::Camera;
use geom::Vec3;
use nalgebra::Matrix3;
use serde::Serialize;
use std::collections::BTreeMap;
use thiserror::Error;

/// Rays that pass a corner farther away may be left out [px].
const FAR: f64 = 2.0;
/// Least mean square of the sine between the rays of a corner and their mean direction, about that of 3° to both sides.
const APART: f64 = 0.003;

/// A tag on a photograph.
#[derive(Debug, Clone, PartialEq)]
pub struct Sighting {
    /// Its number, and which place of the stone it belongs to: a tag may lie elsewhere when the stone is turned over.
    pub tag: (usize, u32),
    /// Corners of the black square, in one order for all photographs [px].
    pub corners: [[f64; 2]; 4],
    /// The camera of the photograph.
    pub camera: Camera,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TagScale {
    /// What lengths are to be multiplied by [–].
    pub factor: f64,
    /// Tags that were measured; one that was seen with the stone in two places counts twice.
    pub tags: usize,
    /// How often they were seen.
    pub sightings: usize,
    /// Standard deviation of the sides over their mean [–].
    pub deviation: f64,
    /// How far rays pass the corners, over the side of the tag on the photograph (root mean square) [–].
    pub miss: f64,
    /// Share of the rays that were left out [–].
    pub left_out: f64,
}

/// No tag could be measured.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum TagError {
    #[error(
        "no tag was found: let tags of the family 36h11, of different numbers, lie beside the stone, sharp, with their white margins, and some 30 \
         pixels wide or more"
    )]
    None,
    #[error("tags were seen {sightings} times, but none from two directions: let more photographs show them")]
    OneDirection { sightings: usize },
}

/// A corner of a tag.
struct Corner {
    /// Where it is [m].
    at: Vec3,
    /// How far each ray passes it [px], those that were left out as well.
    misses: Vec<f64>,
    /// Rays that pass farther are left out [px].
    limit: f64,
}

/// The scale at which the sides of tags are `size` [m] long.
///
/// # Errors
/// When no tag was seen from two directions.
pub fn scale(sightings: &[Sighting], size: f64) -> Result<TagScale, TagError> {
    let mut by_tag: BTreeMap<(usize, u32), Vec<&Sighting>> = BTreeMap::new();
    sightings.iter().for_each(|s| by_tag.entry(s.tag).or_default().push(s));
    let mut sides = Vec::new();
    let (mut tags, mut seen, mut squares, mut rays, mut left_out) = (0, 0, 0.0, 0, 0);
    for sightings in by_tag.values() {
        let corner = |k: usize| place(sightings.iter().map(|s| (&s.camera, s.corners[k])).collect());
        let [Some(a), Some(b), Some(c), Some(d)] = [0, 1, 2, 3].map(corner) else { continue };
        sides.extend([(&a, &b), (&b, &c), (&c, &d), (&d, &a)].map(|(p, q)| (p.at - q.at).norm()));
        tags += 1;
        seen += sightings.len();
        for corner in [a, b, c, d] {
            let used = corner.misses.iter().zip(sightings).filter(|(miss, _)| **miss <= corner.limit);
            let relative: Vec<f64> = used.map(|(miss, s)| (miss / s.side()).powi(2)).collect();
            left_out += corner.misses.len() - relative.len();
            rays += corner.misses.len();
            squares += relative.iter().sum::<f64>();
        }
    }
    if sides.is_empty() {
        return Err(match sightings.len() {
            0 => TagError::None,
            sightings => TagError::OneDirection { sightings },
        });
    }
    let n = sides.len() as f64;
    let mean = sides.iter().sum::<f64>() / n;
    let deviation = (sides.iter().map(|s| (s / mean - 1.0).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    let miss = (squares / (rays - left_out).max(1) as f64).sqrt();
    let left_out = left_out as f64 / rays as f64;
    Ok(TagScale { factor: size / mean, tags, sightings: seen, deviation, miss, left_out })
}

impl Sighting {
    /// Mean side on the photograph [px].
    fn side(&self) -> f64 {
        let [a, b, c, d] = self.corners;
        let length = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        (length(a, b) + length(b, c) + length(c, d) + length(d, a)) / 4.0
    }
}

/// A corner, from where it was seen; `None` of fewer than two directions.
fn place(seen: Vec<(&Camera, [f64; 2])>) -> Option<Corner> {
    let misses = |at: &Vec3| -> Vec<f64> {
        let miss = |(camera, [x, y]): &(&Camera, [f64; 2])| {
            let ([u, v], _) = camera.project(at);
            (u - x).hypot(v - y)
        };
        seen.iter().map(miss).collect()
    };
    let first = misses(&nearest(&seen)?);
    let mut sorted = first.clone();
    sorted.sort_by(f64::total_cmp);
    let limit = FAR.max(3.0 * sorted[sorted.len() / 2]);
    let near: Vec<_> =
        seen.iter().zip(&first).filter(|(_, miss)| **miss <= limit).map(|(one, _)| *one).collect();
    let at = nearest(&near)?;
    Some(Corner { misses: misses(&at), at, limit })
}

/// The point nearest to all rays.
fn nearest(seen: &[(&Camera, [f64; 2])]) -> Option<Vec3> {
    let (mut across, mut sum) = (Matrix3::zeros(), Vec3::zeros());
    for (camera, pixel) in seen {
        let d = camera.ray(*pixel);
        let one = Matrix3::identity() - d * d.transpose();
        across += one;
        sum += one * camera.eye();
    }
    let least = across.symmetric_eigenvalues().min() / seen.len().max(1) as f64;
    if least < APART { None } else { across.try_inverse().map(|inverse| inverse * sum) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twelve cameras around a tag whose side is 0.02.
    fn seen(noise: f64) -> Vec<Sighting> {
        let corners = [[0.1, 0.0], [0.12, 0.0], [0.12, 0.02], [0.1, 0.02]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let mut k = 0u32;
        let mut off = || {
            k += 1;
            noise * (f64::from(k * 7919 % 1000) / 500.0 - 1.0)
        };
        let around = (0..12).map(|n| f64::from(n) * 0.5);
        around
            .map(|angle| {
                let eye = Vec3::new(angle.cos(), angle.sin(), 0.6);
                let camera = Camera::looking(eye, Vec3::zeros(), Vec3::z(), 4000.0, [2000.0, 1500.0]);
                let pixel = |p: &Vec3| camera.project(p).0.map(|x| x + off());
                let corners = corners.iter().map(pixel).collect::<Vec<_>>();
                Sighting { tag: (0, 5), corners: [corners[0], corners[1], corners[2], corners[3]], camera }
            })
            .collect()
    }

    #[test]
    fn a_tag_gives_the_scale() {
        let exact = scale(&seen(0.0), 0.03).unwrap();
        assert!((exact.factor - 1.5).abs() < 1e-9 && exact.deviation < 1e-9, "{exact:?}");
        assert!(exact.miss < 1e-9 && exact.left_out == 0.0, "{exact:?}");
        let rough = scale(&seen(0.5), 0.03).unwrap();
        assert!((rough.factor - 1.5).abs() < 0.003 && rough.deviation < 0.005, "{rough:?}");
        // One sighting is of another tag.
        let mut wrong = seen(0.1);
        wrong[3].corners.iter_mut().for_each(|c| c[0] += 300.0);
        let left_out = scale(&wrong, 0.03).unwrap();
        assert!((left_out.factor - 1.5).abs() < 0.003 && left_out.miss < 0.01, "{left_out:?}");
        assert!((left_out.left_out - 1.0 / 12.0).abs() < 1e-9, "{left_out:?}");
        // The tag was moved after half of the photographs: its sides agree, and its places do not.
        let mut moved = seen(0.1);
        let shifted = |camera: &Camera| Camera {
            translation: camera.translation + camera.rotation * Vec3::x() * 0.01,
            ..*camera
        };
        let cameras: Vec<Camera> = moved[6..].iter().map(|s| shifted(&s.camera)).collect();
        moved[6..].iter_mut().zip(cameras).for_each(|(s, camera)| s.camera = camera);
        let moved = scale(&moved, 0.03).unwrap();
        assert!(moved.miss > 0.05, "{moved:?}");
    }

    #[test]
    fn one_direction_gives_none() {
        let all = seen(0.0);
        assert_eq!(scale(&[], 0.03).unwrap_err(), TagError::None);
        assert_eq!(scale(&all[..1], 0.03).unwrap_err(), TagError::OneDirection { sightings: 1 });
        assert_eq!(
            scale(&vec![all[0].clone(); 5], 0.03).unwrap_err(),
            TagError::OneDirection { sightings: 5 }
        );
        // The same number elsewhere, when the stone lay on its other side, is another tag.
        let second = Sighting { tag: (1, 5), ..all[6].clone() };
        assert!(scale(&[all[0].clone(), second], 0.03).is_err());
    }
}
