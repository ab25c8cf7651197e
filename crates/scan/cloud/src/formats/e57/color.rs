//! Limits of the colours of E57 scans: where they differ, every scan is brought to 0 to 255.
//!
//! ```text
//! colorLimits   the least and the largest number of each colour that a scan can have; without them those of its fields
//! ```
//!
//! ASTM E2807-11 (2019), table 8.

use e57::{PointCloud, RecordDataType, RecordName, RecordValue};

/// Least and largest number of red, green and blue.
type Limits = [[f64; 2]; 3];
/// Largest number of a colour that is scaled.
const LARGEST: f64 = 255.0;

/// How the colours of a scan become those of the cloud.
#[derive(Clone, Copy, Default)]
pub(crate) struct ColorScale(Option<Limits>);

impl ColorScale {
    /// Of each scan: none where all have the same limits, or one does not state them.
    pub(crate) fn of(scans: &[PointCloud]) -> Vec<ColorScale> {
        let coloured = scans.iter().filter(|scan| scan.has_color()).map(limits);
        let all: Option<Vec<Limits>> = coloured.collect();
        let differ = all.is_some_and(|all| all.iter().any(|limits| *limits != all[0]));
        scans.iter().map(|scan| ColorScale(limits(scan).filter(|_| differ && scan.has_color()))).collect()
    }

    /// A colour of the scan as one of the cloud.
    pub(crate) fn apply(&self, color: [f64; 3]) -> [f32; 3] {
        let Some(limits) = self.0 else { return color.map(|c| c as f32) };
        [0, 1, 2].map(|k| {
            let [low, high] = limits[k];
            (LARGEST * (color[k] - low) / (high - low)).round().clamp(0.0, LARGEST) as f32
        })
    }
}

fn limits(scan: &PointCloud) -> Option<Limits> {
    let stated = scan.color_limits.as_ref();
    let of = |name: RecordName, low: Option<&RecordValue>, high: Option<&RecordValue>| {
        let record = scan.prototype.iter().find(|record| record.name == name)?;
        let own = match record.data_type {
            RecordDataType::Integer { min, max } => Some([min as f64, max as f64]),
            _ => None,
        };
        let number = |value: &RecordValue| value.to_f64(&record.data_type).ok();
        let stated = low.and_then(number).zip(high.and_then(number)).map(|(low, high)| [low, high]);
        stated.or(own).filter(|[low, high]| low < high)
    };
    let of = |name,
              low: fn(&e57::ColorLimits) -> &Option<RecordValue>,
              high: fn(&e57::ColorLimits) -> &Option<RecordValue>| {
        of(name, stated.and_then(|s| low(s).as_ref()), stated.and_then(|s| high(s).as_ref()))
    };
    Some([
        of(RecordName::ColorRed, |s| &s.red_min, |s| &s.red_max)?,
        of(RecordName::ColorGreen, |s| &s.green_min, |s| &s.green_max)?,
        of(RecordName::ColorBlue, |s| &s.blue_min, |s| &s.blue_max)?,
    ])
}
