//! Spheres that stand for a stone, and how well they do.

use crate::samples::{Samples, surface};
use crate::stone::Stone;
use crate::{distance, tangent};
use geom::{Shown, Vec3};
use nalgebra::Matrix3;
use serde::Serialize;
use thiserror::Error;

/// Centre and radius [m].
pub type Sphere = (Vec3, f64);

/// Most spheres of a clump, as in scenes.
pub const MOST_SPHERES: usize = 2000;
/// Points of the surface that spheres start from and that distances are measured from.
const SURFACE_POINTS: usize = 4000;
/// Smallest radius over the diameter of a sphere of the stone's volume, by default [–].
const LEAST_RADIUS: f64 = 0.01;

/// How spheres are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// By the inner distance, greedily.
    Distance,
    /// Tangent to the surface.
    Tangent,
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ClumpSettings {
    /// How spheres are found.
    pub method: Method,
    pub spheres: Option<usize>,
    /// Share of the volume that may stay uncovered [–]; without a number of spheres.
    pub error: Option<f64>,
    /// Smallest radius [m]; `None`: [`LEAST_RADIUS`] of the diameter.
    pub least_radius: Option<f64>,
    /// Deepest overlap of two spheres over the diameter of the smaller one [–].
    pub overlap: f64,
    /// Surface within this distance of a sphere is done [m]; `None`: as the number or the error needs it.
    pub distance: Option<f64>,
    /// Seed of the order of the surface points.
    pub seed: u64,
}

/// How well spheres stand for a stone; a share each [–].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Fit {
    /// Volume that no sphere covers, over that of the stone.
    pub volume: f64,
    /// Mean distance from the surface of the stone to that of the spheres, over the diameter of a sphere of its volume.
    pub mean_distance: f64,
    /// The largest such distance.
    pub most_distance: f64,
    /// The largest error of a principal moment of inertia, if the union of the spheres had the density of the stone.
    pub inertia: f64,
}

/// The spheres of a stone.
#[derive(Debug, Clone, PartialEq)]
pub struct Clump {
    /// Centre and radius [m] in the frame of the mesh, in the order in which they were found.
    pub spheres: Vec<Sphere>,
    /// How well they stand for it.
    pub fit: Fit,
}

/// Why there are no such spheres.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ClumpError {
    #[error("no sphere of radius {} m or more fits into the stone: lower --min-radius", Shown(*.0))]
    NoSphere(f64),
    #[error(
        "{spheres} spheres leave {} of the volume uncovered, more than the allowed {}: allow a larger --error, a smaller --min-radius, or more overlap",
        Shown(*found), Shown(*asked)
    )]
    Error { spheres: usize, found: f64, asked: f64 },
}

impl Clump {
    /// Finds spheres inside a stone.
    ///
    /// # Errors
    /// No sphere fits; the error is not reached with [`MOST_SPHERES`].
    pub fn of(stone: &Stone, settings: &ClumpSettings) -> Result<Clump, ClumpError> {
        let least = settings.least_radius.unwrap_or(LEAST_RADIUS * stone.diameter());
        let (mut samples, points) = (Samples::new(stone), surface(stone, SURFACE_POINTS));
        let most = settings.spheres.unwrap_or(MOST_SPHERES).min(MOST_SPHERES);
        let enough =
            |count: usize, uncovered: f64| count >= most || settings.error.is_some_and(|e| uncovered <= e);
        let spheres = match settings.method {
            Method::Distance => distance::spheres(stone, settings, &mut samples, least, enough),
            Method::Tangent => tangent::spheres(stone, settings, &points, &mut samples, least, enough),
        };
        if spheres.is_empty() {
            return Err(ClumpError::NoSphere(least));
        }
        let gap =
            |p: &Vec3| spheres.iter().map(|(c, r)| (p - c).norm() - r).fold(f64::INFINITY, f64::min).max(0.0);
        let gaps: Vec<f64> = points.iter().map(|p| gap(&p.place) / stone.diameter()).collect();
        let fit = Fit {
            volume: samples.uncovered(),
            mean_distance: gaps.iter().sum::<f64>() / gaps.len().max(1) as f64,
            most_distance: gaps.iter().copied().fold(0.0, f64::max),
            inertia: inertia_error(samples.inertia()),
        };
        match settings.error {
            Some(asked) if fit.volume > asked => {
                Err(ClumpError::Error { spheres: spheres.len(), found: fit.volume, asked })
            }
            _ => Ok(Clump { spheres, fit }),
        }
    }
}

/// Principal moments, ascending; the largest difference over the moment of the first.
fn inertia_error(both: [Matrix3<f64>; 2]) -> f64 {
    let [whole, union] = both.map(|m| {
        let mut values: [f64; 3] = m.symmetric_eigenvalues().into();
        values.sort_by(f64::total_cmp);
        values
    });
    (0..3).map(|k| (union[k] - whole[k]).abs() / whole[k]).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::overlap;
    use crate::stone::tests::{ball, block};

    fn settings(method: Method, spheres: usize) -> ClumpSettings {
        ClumpSettings {
            method,
            spheres: Some(spheres),
            error: None,
            least_radius: None,
            overlap: 0.9,
            distance: None,
            seed: 1,
        }
    }

    #[test]
    fn one_sphere_is_a_ball() {
        let stone = Stone::new(&ball(0.05, 3), false).unwrap();
        let clump = Clump::of(&stone, &settings(Method::Distance, 1)).unwrap();
        let (centre, radius) = clump.spheres[0];
        assert!(centre.norm() < 1e-3 && (radius - 0.05).abs() < 1e-3, "{centre} {radius}");
        assert!(clump.fit.volume < 0.05 && clump.fit.mean_distance < 0.01 && clump.fit.inertia < 0.08);
    }

    /// No sphere leaves the stone, none overlaps another more than allowed, and more spheres fit better.
    #[test]
    fn spheres_are_inscribed_and_more_of_them_fit_better() {
        let stone = block(0.1, 0.06, 0.04);
        for method in [Method::Distance, Method::Tangent] {
            let mut last = 1.0;
            for count in [2, 10, 50] {
                let clump = Clump::of(&stone, &settings(method, count)).unwrap();
                assert!(clump.spheres.len() <= count);
                for (k, s) in clump.spheres.iter().enumerate() {
                    assert!(
                        stone.inside.contains(&s.0) && s.1 <= stone.inside.distance(&s.0) * (1.0 + 1e-12)
                    );
                    let others = &clump.spheres[..k];
                    assert!(method == Method::Tangent || others.iter().all(|o| overlap(s, o) <= 0.9));
                }
                assert!(clump.fit.volume < last, "{method:?} {count}: {:?}", clump.fit);
                last = clump.fit.volume;
            }
            // Two spheres of radius 0.02 in a box: what they leave is known.
            let two = Clump::of(&stone, &settings(Method::Distance, 2)).unwrap();
            let covered = 2.0 * geom::sphere::volume(0.02) / 2.4e-4;
            assert!((1.0 - two.fit.volume - covered).abs() < 0.01, "{:?}", two.fit);
        }
    }

    #[test]
    fn an_error_is_reached_or_refused() {
        let stone = Stone::new(&ball(0.05, 3), false).unwrap();
        for method in [Method::Distance, Method::Tangent] {
            let asked = ClumpSettings { spheres: None, error: Some(0.05), ..settings(method, 0) };
            assert!(Clump::of(&stone, &asked).unwrap().fit.volume <= 0.05);
            let asked = ClumpSettings { least_radius: Some(0.045), error: Some(1e-6), ..asked };
            let refused = Clump::of(&stone, &asked).unwrap_err();
            assert!(matches!(refused, ClumpError::Error { .. }), "{refused}");
            let asked = ClumpSettings { least_radius: Some(0.06), ..asked };
            assert!(matches!(Clump::of(&stone, &asked), Err(ClumpError::NoSphere(_))));
        }
    }

    #[test]
    fn overlap_goes_from_touching_to_enclosed() {
        let at = |x: f64, r: f64| (Vec3::new(x, 0.0, 0.0), r);
        assert_eq!(overlap(&at(0.0, 2.0), &at(3.0, 1.0)), 0.0);
        assert_eq!(overlap(&at(0.0, 2.0), &at(1.0, 1.0)), 1.0);
        assert_eq!(overlap(&at(0.0, 2.0), &at(2.0, 1.0)), 0.5);
    }
}
