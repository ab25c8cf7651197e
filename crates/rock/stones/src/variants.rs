//! Stones between measured ones, for a library that needs more shapes than were scanned.
//!
//! A variant lies between two measured stones (or one and its mirror image), by their spherical harmonics in their principal axes. Its measures
//! of shape are within the range of the measured stones, and so is its sieve size. It is a variant, not a scan, and smooth below a twentieth of its
//! circumference.

use crate::harmonics::Harmonics;
use crate::random::even;
use crate::shape::ShapeMeasures;
use crate::sphere::sphere;
use crate::stone::Stone;
use geom::mesh::TriMesh;
use geom::random::{generator, orientation, unit};
use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

/// Tries for each variant.
const TRIES: u64 = 60;
/// Halvings of an octahedron: 2048 faces.
const LEVELS: u32 = 4;
/// The range of a measure is this much wider on both sides than that of the measured stones, as a share of its middle value.
const WIDER: f64 = 0.05;
/// Least radius over the mean one: a surface nearer to the centre is a notch that the harmonics do not show.
const LEAST: f64 = 0.15;

/// A stone that variants come from.
#[derive(Debug, Clone)]
pub struct Measured {
    pub harmonics: Harmonics,
    pub shape: ShapeMeasures,
}

#[derive(Debug, Clone)]
pub struct Variant {
    pub stone: Stone,
    pub shape: ShapeMeasures,
    /// Numbers of the measured stones between which it lies.
    pub between: [usize; 2],
    /// Share of the second [–].
    pub share: f64,
}

/// Least and largest values of the measured stones, a little wider.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ranges {
    /// Elongation [–].
    pub elongation: [f64; 2],
    /// Flatness [–].
    pub flatness: [f64; 2],
    /// Convexity [–].
    pub convexity: [f64; 2],
    /// Sphericity [–].
    pub sphericity: [f64; 2],
    /// Sieve size [m].
    pub sieve_size: [f64; 2],
}

/// Why there are no variants.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum VariantError {
    #[error(
        "variant {number}: none of {TRIES} tries had measures of shape in the range of the measured stones: give more measured stones, or fewer variants"
    )]
    None { number: usize },
}

impl Ranges {
    /// Of measured stones.
    pub fn of(measured: &[Measured]) -> Ranges {
        let range = |of: fn(&ShapeMeasures) -> f64, wider: f64| {
            let values = measured.iter().map(|m| of(&m.shape));
            let (lo, hi) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
            let by = wider * (lo + hi) / 2.0;
            [lo - by, hi + by]
        };
        Ranges {
            elongation: range(|s| s.elongation, WIDER),
            flatness: range(|s| s.flatness, WIDER),
            convexity: range(|s| s.convexity, WIDER),
            sphericity: range(|s| s.sphericity, WIDER),
            sieve_size: range(|s| s.sieve_size, 0.0),
        }
    }

    /// Whether the shape of a stone, whatever its size, is within.
    pub fn holds(&self, shape: &ShapeMeasures) -> bool {
        let within = |v: f64, [lo, hi]: [f64; 2]| (lo..=hi).contains(&v);
        within(shape.elongation, self.elongation)
            && within(shape.flatness, self.flatness)
            && within(shape.convexity, self.convexity)
            && within(shape.sphericity, self.sphericity)
    }
}

/// `count` variants of measured stones, by `seed`.
///
/// # Errors
/// A variant that no try brings into the range.
pub fn variants(
    measured: &[Measured],
    count: usize,
    seed: u64,
    done: impl Fn() + Sync,
) -> Result<Vec<Variant>, VariantError> {
    let (ranges, sphere) = (Ranges::of(measured), sphere(&orientation(even(0)), LEVELS));
    let one = |number: usize| {
        let found = (0..TRIES)
            .find_map(|attempt| tried(measured, &ranges, &sphere, seed, number as u64 * TRIES + attempt));
        done();
        found.ok_or(VariantError::None { number: number + 1 })
    };
    (0..count).into_par_iter().map(one).collect()
}

fn tried(
    measured: &[Measured],
    ranges: &Ranges,
    sphere: &TriMesh,
    seed: u64,
    stream: u64,
) -> Option<Variant> {
    let mut random = generator(seed, 0x7661_7269, stream);
    let mut next = || unit(&mut random);
    let mut pick = || ((next() * measured.len() as f64) as usize).min(measured.len() - 1);
    let between = [pick(), pick()];
    let share = 0.15 + 0.7 * next();
    let flips = [next() < 0.5, next() < 0.5, next() < 0.5];
    let [a, b] = between.map(|k| &measured[k].harmonics);
    let mixed = a.between(&b.mirrored(flips), share);
    let mean = mixed.coefficients[0] * (0.25 / std::f64::consts::PI).sqrt();
    let radii: Vec<f64> = sphere.vertices.iter().map(|v| mixed.radius(v)).collect();
    if radii.iter().any(|r| !(*r > LEAST * mean)) {
        return None;
    }
    let vertices = sphere.vertices.iter().zip(&radii).map(|(v, r)| v * *r).collect();
    let mut mesh = TriMesh { vertices, faces: sphere.faces.clone() };
    let shape = ShapeMeasures::of(&Stone::new(&mesh, true).ok()?);
    if !ranges.holds(&shape) {
        return None;
    }
    // Even in the logarithm of the size.
    let [lo, hi] = ranges.sieve_size.map(libm::log);
    mesh.scale(libm::exp(lo + next() * (hi - lo)) / shape.sieve_size);
    let stone = Stone::new(&mesh, true).ok()?;
    let shape = ShapeMeasures::of(&stone);
    Some(Variant { stone, shape, between, share })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stone::tests::ball;
    use geom::Vec3;

    fn measured(x: f64, y: f64, z: f64) -> Measured {
        let mut mesh = ball(1.0, 3);
        // With a dent, so that it is no ellipsoid.
        mesh.vertices
            .iter_mut()
            .for_each(|v| *v = Vec3::new(x * v.x, y * v.y, z * v.z) * (1.0 - 0.2 * v.x.max(0.0).powi(4)));
        let stone = Stone::new(&mesh, false).unwrap();
        Measured { harmonics: Harmonics::of(&stone).unwrap().0, shape: ShapeMeasures::of(&stone) }
    }

    #[test]
    fn variants_lie_between_the_measured_stones_and_differ() {
        let measured = [measured(0.05, 0.04, 0.03), measured(0.03, 0.025, 0.022)];
        let found = variants(&measured, 3, 7, || ()).unwrap();
        let ranges = Ranges::of(&measured);
        for v in &found {
            assert!(ranges.holds(&v.shape), "{:?} {ranges:?}", v.shape);
            let [lo, hi] = ranges.sieve_size;
            assert!(v.shape.sieve_size > 0.999 * lo && v.shape.sieve_size < 1.001 * hi);
        }
        assert!(found[0].shape != found[1].shape && found[1].shape != found[2].shape);
        assert_eq!(found[0].shape, variants(&measured, 1, 7, || ()).unwrap()[0].shape);
    }
}
