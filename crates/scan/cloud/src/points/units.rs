//! Units of a scan: warns of coordinates that look like millimetres, and of coordinates with too few digits.

use super::cloud::Cloud;
use super::cloud::unit_is_known;
use super::places::Places;
use geom::Vec3;
use geom::digits::{Extent, LostDigits, SOME, rough};
use std::fmt;

/// Equipment is hardly wider [m] …
const WIDE: f64 = 50.0;
/// … with points as far apart [m].
const SPARSE: f64 = 0.1;

/// What looks wrong about the numbers of a cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UnitWarning {
    /// As wide [m] as a plant in millimetres, its points as far apart [m].
    Millimetres {
        /// Width along the longest axis [m].
        width: f64,
        /// Mean distance of points [m].
        spacing: f64,
    },
    /// Coordinates in 4-byte numbers have lost digits.
    Short(LostDigits),
    /// Many points lie in one place.
    Crowd {
        /// Share of all [–].
        share: f64,
        /// Where [m].
        place: [f64; 3],
    },
}

impl UnitWarning {
    /// Whether a scale that is given answers it.
    pub fn is_answered_by_scale(&self) -> bool {
        !matches!(self, UnitWarning::Crowd { .. })
    }
}

impl fmt::Display for UnitWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            UnitWarning::Millimetres { width, spacing } => write!(
                f,
                "the cloud is about {} m wide and its points are {} m apart: if it is in millimetres, read it with \
                 --scale 0.001, and with --scale 1 if it is in metres",
                rough(*width),
                rough(*spacing)
            ),
            UnitWarning::Short(lost) => write!(
                f,
                "{lost}: export the scan with 8-byte numbers (double), or with its origin near the equipment"
            ),
            UnitWarning::Crowd { share, place: [x, y, z] } => write!(
                f,
                "about {} % of the points lie in one place, ({x}, {y}, {z}) m: if a scanner writes that where it had no echo, remove them \
                 with cloud-crop --remove sphere:{x},{y},{z},0.001, or leave one of each place with cloud-crop --distinct 0",
                (100.0 * share).round()
            ),
        }
    }
}

/// What looks wrong, if anything.
pub fn warnings(cloud: &Cloud) -> Vec<UnitWarning> {
    let mut survey = Survey::new(cloud.points.len());
    survey.add(cloud.points.len(), |row| cloud.points[row]);
    survey.warnings(cloud.double, &cloud.comments)
}

/// Points that stand for all, of a cloud that comes in parts.
pub struct Survey {
    step: usize,
    count: usize,
    some: Vec<Vec3>,
}

impl Survey {
    /// Of a cloud of `count` points.
    pub fn new(count: usize) -> Survey {
        Survey { step: count.div_ceil(SOME).max(1), count: 0, some: Vec::new() }
    }

    /// Takes notice of the next `count` points.
    pub fn add(&mut self, count: usize, point: impl Fn(usize) -> Vec3) {
        let first = self.count.next_multiple_of(self.step) - self.count;
        self.some
            .extend((first..count).step_by(self.step).map(point).filter(|p| p.iter().all(|c| c.is_finite())));
        self.count += count;
    }

    /// What looks wrong, if anything; `double` coordinates have 8 bytes. Comments of the cloud may say that its unit is known.
    pub fn warnings(&self, double: bool, comments: &[String]) -> Vec<UnitWarning> {
        let mut found = look(&self.some, self.count as f64, double);
        found.extend(crowd(&self.some));
        if unit_is_known(comments) {
            found.retain(|warning| !matches!(warning, UnitWarning::Millimetres { .. }));
        }
        found
    }
}

fn look(some: &[Vec3], count: f64, double: bool) -> Vec<UnitWarning> {
    let Some(extent) = Extent::of(some) else { return Vec::new() };
    let (width, spacing) = (extent.sides[2], extent.spacing(count));
    let mut found = Vec::new();
    if width > WIDE && spacing > SPARSE {
        found.push(UnitWarning::Millimetres { width, spacing });
    }
    if !double {
        found.extend(extent.lost_digits(count).map(UnitWarning::Short));
    }
    found
}

/// A place that holds many of the points that stand for all.
fn crowd(some: &[Vec3]) -> Option<UnitWarning> {
    let found = Places::of(some)?.doubtful()?;
    Some(UnitWarning::Crowd { share: found.points as f64 / some.len() as f64, place: found.place })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of 100 × 100 points `step` [m] apart, its corner at `x`.
    fn sheet(step: f64, x: f64, double: bool) -> Cloud {
        let place = |k: i32| Vec3::new(x + step * f64::from(k % 100), step * f64::from(k / 100), 0.0);
        Cloud { points: (0..10_000).map(place).collect(), double, ..Cloud::default() }
    }

    #[test]
    fn millimetres_are_told_and_metres_are_not() {
        assert_eq!(warnings(&sheet(0.002, 0.0, false)), []);
        assert!(matches!(warnings(&sheet(2.0, 0.0, true))[..], [UnitWarning::Millimetres { .. }]));
        let said = warnings(&sheet(2.0, 0.0, true))[0].to_string();
        assert!(said.contains("about 180 m wide") && said.contains("--scale 0.001"), "{said}");
        let mut scaled = sheet(2000.0, 0.0, false);
        scaled.scale(1e-3);
        assert_eq!(warnings(&scaled), [], "its unit is known");
        let mut far = sheet(0.002, 0.0, false);
        far.points.push(Vec3::repeat(1e9));
        assert_eq!(warnings(&far), [], "an outlier is no plant");
        assert_eq!(warnings(&Cloud::default()), []);
    }

    #[test]
    fn map_coordinates_in_short_numbers_are_told() {
        assert!(matches!(warnings(&sheet(0.002, 637_000.0, false))[..], [UnitWarning::Short { .. }]));
        assert_eq!(warnings(&sheet(0.002, 637_000.0, true)), []);
        assert_eq!(warnings(&sheet(0.002, 40.0, false)), []);
    }
}
