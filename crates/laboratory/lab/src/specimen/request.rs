//! What the user asks for, and what follows from it for a specimen: its size, amount, and how fast it is sheared.

use crate::error::{LabError, Result};
use crate::grains::Grains;
use crate::sample::Sample;
use geom::Vec3;

/// What the user asks for.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Stresses [Pa]: one specimen for each, or the path of one specimen.
    pub stress: Vec<f64>,
    /// Lengths of the specimen [m].
    pub size: Option<Vec<f64>>,
    /// Grains of the specimen, about; instead of its size.
    pub grains: Option<u64>,
    /// Where the test ends [–].
    pub strain: Option<f64>,
    /// Inertial number of the test [–].
    pub inertial: Option<f64>,
    /// Speed of the wall that drives the test [m/s], instead of the inertial number.
    pub speed: Option<f64>,
    /// Sliding friction while the specimen is prepared [–].
    pub friction: Option<f64>,
    /// Mean unbalanced over mean contact force at which the specimen counts as prepared [–].
    pub rest: Option<f64>,
    /// Time between two rows of the curve over the time of the test [–].
    pub rows: u64,
}

/// Solid fraction that a filling comes to, about [–].
pub(crate) const DENSE: f64 = 0.6;
/// Solid fraction of the spheres around grains before they fall [–].
const LOOSE: f64 = 0.25;
/// Most grains of a specimen.
const MOST_GRAINS: f64 = 1e7;
/// Inertial number of slow flow: below it friction no longer depends on the rate (GDR MiDi 2004, doi:10.1140/epje/i2003-10153-0) [–].
pub(crate) const SLOW: f64 = 1e-3;
/// Thickness of a shear band over the grain diameter [–].
pub(crate) const BAND: f64 = 10.0;
/// Way of a plate in one time step over the grain diameter, where no stress sets the rate [–].
const WAY: f64 = 4e-5;
/// Time between two rows over a time step, at least: the step of the test differs a little from that of its grains alone [–].
const ROOM: f64 = 1.05;
/// Passes of a wave through a specimen of bonded grains while it is loaded up to its strength.
const PASSES: f64 = 20.0;

/// The space of a specimen: an upright box, or the cylinder in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Specimen {
    /// Lowest corner [m].
    pub low: Vec3,
    /// Highest corner before the preparation [m].
    pub high: Vec3,
    /// Height that it will have, about [m].
    pub height: f64,
    /// Mass to fill in [kg]; `None`: the grains are there.
    pub mass: Option<f64>,
}

impl Specimen {
    /// Lengths along x and y [m].
    pub fn sides(&self) -> [f64; 2] {
        [self.high.x - self.low.x, self.high.y - self.low.y]
    }

    /// Radius of the cylinder in it [m].
    pub fn radius(&self) -> f64 {
        0.5 * self.sides()[0]
    }

    /// Mass of its grains [kg].
    pub(crate) fn mass(&self, grains: &Grains) -> f64 {
        self.mass
            .unwrap_or_else(|| grains.packed.as_ref().map_or(0.0, |packed| packed.solid * grains.density))
    }

    /// The space of a sample: as asked, or as many grains as asked in the given proportions (x, y, z) with a share of the box that they fill.
    pub(crate) fn of(
        sample: &Sample,
        request: &Request,
        (proportions, share, usual): ([f64; 3], f64, u64),
        all_round: bool,
    ) -> Result<Specimen> {
        let grains = &sample.grains;
        if let Some(packed) = &grains.packed {
            return match (&request.size, request.grains) {
                (None, None) => Ok(Specimen {
                    low: packed.low,
                    high: packed.high,
                    height: packed.high.z - packed.low.z,
                    mass: None,
                }),
                (Some(_), _) => Err(unused("--size", sample)),
                _ => Err(unused("--grains", sample)),
            };
        }
        let [x, y, z] = match &request.size {
            Some(size) => lengths(size, proportions)?,
            None => {
                let solid = grains.volume * request.grains.unwrap_or(usual) as f64;
                let unit = (solid / (DENSE * share * proportions.iter().product::<f64>())).cbrt();
                proportions.map(|p| rounded(p * unit))
            }
        };
        let across = x.min(y).min(z);
        if across < 3.0 * grains.largest {
            return Err(LabError::Usage(format!(
                "the specimen measures {:.4} × {:.4} × {:.4} m, and its largest grains {:.4} m: give a larger --size or more --grains",
                x, y, z, grains.largest
            )));
        }
        let count = x * y * z * share * DENSE / grains.volume;
        if count > MOST_GRAINS {
            return Err(LabError::Usage(format!(
                "the specimen measures {x:.4} × {y:.4} × {z:.4} m and would have {count:.2e} grains, more than {MOST_GRAINS:e}: give a smaller --size"
            )));
        }
        let mass = rounded(x * y * z * share * DENSE * grains.density);
        let loose = DENSE * grains.around / LOOSE;
        let high = match all_round {
            true => Vec3::new(x, y, z).map(|length| rounded(length * loose.cbrt())),
            false => Vec3::new(x, y, rounded(z * loose)),
        };
        Ok(Specimen { low: Vec3::zeros(), high, height: z, mass: Some(mass) })
    }
}

/// A length or mass with four digits: a scene is read by people, too.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn unused(option: &str, sample: &Sample) -> LabError {
    LabError::Usage(format!(
        "{option} has no effect: the grains of {} are packed already: leave it out",
        sample.name
    ))
}

/// Three lengths from those that were given: all three; width and height; or the width alone.
fn lengths(size: &[f64], [x, y, z]: [f64; 3]) -> Result<[f64; 3]> {
    match *size {
        [a] => Ok([a, a * y / x, a * z / x]),
        [a, c] => Ok([a, a * y / x, c]),
        [a, b, c] => Ok([a, b, c]),
        _ => Err(LabError::Usage(format!(
            "--size has {} lengths: give width; width,height; or x,y,z",
            size.len()
        ))),
    }
}

impl Request {
    /// Refuses a test that ends after `until` [s], before each of its rows has had a time step [s].
    pub(crate) fn refuse_short(&self, until: f64, step: f64) -> Result<()> {
        let rows = self.rows;
        if until >= ROOM * rows as f64 * step {
            return Ok(());
        }
        let (until, step) = (geom::Shown(until), geom::Shown(step));
        Err(LabError::Usage(format!(
            "the test would end after {until} s, and {rows} rows of it need as many time steps of {step} s: test more slowly (--inertial, --speed), farther \
             (--strain), or with fewer --rows"
        )))
    }

    /// Strain rate [1/s] at an inertial number I = ε̇ d √(ρ/p).
    pub(crate) fn rate(&self, grains: &Grains, pressure: f64) -> f64 {
        self.inertial.unwrap_or(SLOW) / grains.diameter * (pressure / grains.density).sqrt()
    }

    /// Speed of a wall [m/s] that strains a length at the inertial number; the strain gathers in a band of ten grains.
    pub(crate) fn speed_over(&self, grains: &Grains, pressure: f64, length: f64) -> f64 {
        self.speed.unwrap_or_else(|| self.rate(grains, pressure) * length.min(BAND * grains.diameter))
    }

    /// Speed of a plate on bonded grains [m/s]: so slow that waves pass many times before bonds break.
    pub(crate) fn speed_of_plate(&self, grains: &Grains) -> f64 {
        let fast = WAY * grains.diameter / grains.step;
        let slow = grains.breaking.map_or(fast, |breaking| fast.min(breaking / PASSES));
        self.speed.unwrap_or(slow)
    }

    /// Speed limit of a servo that presses on the specimen [m/s].
    pub(crate) fn speed_limit(&self, grains: &Grains, stress: f64, length: f64) -> f64 {
        (0.03 * length / grains.diameter).min(0.2) * (stress / grains.density).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_given_as_one_two_or_three_lengths() {
        assert_eq!(lengths(&[2.0], [1.0, 1.0, 0.5]).unwrap(), [2.0, 2.0, 1.0]);
        assert_eq!(lengths(&[2.0, 3.0], [1.0, 1.0, 0.5]).unwrap(), [2.0, 2.0, 3.0]);
        assert!(lengths(&[1.0; 4], [1.0; 3]).is_err());
    }
}
