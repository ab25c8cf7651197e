//! Checks the claims of an E57 file before its points are read: poses, and memory against the length of the file.
//!
//! ```text
//! file     bytes 32..40: length of the XML
//! pose     x ← R(q) x + t; q has unit length, else R also scales
//! field    an integer from min to max takes ⌊log₂(max − min)⌋ + 1 bits, and none where min = max
//! ```
//!
//! ASTM E2807-11 (2019).

use super::extra::Extra;
use e57::{Point, PointCloud, Quaternion, RecordDataType, RecordValue};
use geom::Shown;

/// Memory of a point in the columns of a cloud that each has, and 8 in each other [B].
const OF_A_POINT: u64 = 54;
/// Bits of the largest packet of points.
const PACKET: u64 = 8 << 16;
/// A file may take so much memory [B], and [`RATIO`] × its length.
const FREE: u64 = 64 << 20;
/// See [`FREE`]. Scans have 4 to 20 bytes a point.
const RATIO: u64 = 64;
/// A quaternion whose length differs from 1 by less was rounded when it was written; more is another number.
const ROUNDED: f64 = 1e-3;
/// Rounding of double precision: such a quaternion is used as it is.
const EXACT: f64 = 1e-9;

/// Refuses an XML part that is longer than the file.
pub(crate) fn before_the_header(bytes: &[u8]) -> Result<(), String> {
    let claimed = bytes.get(32..40).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
    match claimed.filter(|&n| n > bytes.len() as u64) {
        Some(n) => Err(format!("{n} bytes of XML are promised in {} bytes: it is cut off", bytes.len())),
        None => Ok(()),
    }
}

/// Refuses scans of more points than the file has bits for, or whose points take more memory than is fair for its length [B].
pub(crate) fn before_the_points(scans: &[PointCloud], length: u64) -> Result<(), String> {
    let (mut promised, mut memory) = (0u64, 0u64);
    let extra = Extra::of(scans).count() as u64;
    let of_a_point = OF_A_POINT + 8 * extra;
    for (number, scan) in scans.iter().enumerate().filter(|(_, scan)| scan.records > 0) {
        let points = scan.records;
        let bits = scan.prototype.iter().map(|field| bits(&field.data_type)).sum::<u64>();
        if bits == 0 {
            return Err(format!(
                "scan {number}: all fields have min = max, so that nothing says where its {points} points end"
            ));
        }
        promised = promised.saturating_add(points.saturating_mul(bits));
        let field = size_of::<RecordValue>() as u64;
        let waiting = field * scan.prototype.len() as u64 + 2 * size_of::<Point>() as u64;
        memory = memory.saturating_add(points.saturating_mul(of_a_point));
        memory = memory.saturating_add(points.min(PACKET / bits + 1).saturating_mul(waiting));
    }
    if promised / 8 > length {
        let points = scans.iter().fold(0u64, |sum, scan| sum.saturating_add(scan.records));
        return Err(format!("the header promises {points} points in {length} bytes: it is cut off"));
    }
    let most = FREE + RATIO * length;
    if memory > most {
        let [memory, most] = [memory, most].map(|bytes| bytes >> 20);
        return Err(format!(
            "its points need {memory} MiB of memory, more than the {most} MiB for its length"
        ));
    }
    Ok(())
}

/// Bits of a value.
fn bits(kind: &RecordDataType) -> u64 {
    match *kind {
        RecordDataType::Single { .. } => 32,
        RecordDataType::Double { .. } => 64,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            (i128::from(max) - i128::from(min)).checked_ilog2().map_or(0, |bits| u64::from(bits) + 1)
        }
    }
}

/// A scan whose pose is a rotation and a shift: a quaternion that was rounded is normalized.
pub(crate) fn with_sound_pose(number: usize, scan: &PointCloud) -> Result<PointCloud, String> {
    let mut scan = scan.clone();
    let Some(pose) = &mut scan.transform else { return Ok(scan) };
    let t = &pose.translation;
    if ![t.x, t.y, t.z].iter().all(|v| v.is_finite()) {
        return Err(format!("scan {number}: its pose is shifted by ({}, {}, {}) m", t.x, t.y, t.z));
    }
    let q = &mut pose.rotation;
    let length = (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z).sqrt();
    if !((length - 1.0).abs() <= ROUNDED) {
        let Quaternion { w, x, y, z } = *q;
        return Err(format!(
            "scan {number}: the quaternion of its pose ({w}, {x}, {y}, {z}) has the length {}, not 1: it would scale the scan",
            Shown(length)
        ));
    }
    if (length - 1.0).abs() > EXACT {
        for part in [&mut q.w, &mut q.x, &mut q.y, &mut q.z] {
            *part /= length;
        }
    }
    Ok(scan)
}

#[cfg(test)]
mod tests {
    use super::*;
    use e57::{Record, RecordName, Transform};

    fn scan(points: u64, fields: &[(i64, i64)]) -> PointCloud {
        let field = |&(min, max): &(i64, i64)| Record {
            name: RecordName::Intensity,
            data_type: RecordDataType::Integer { min, max },
        };
        let mut scan = PointCloud::default();
        (scan.records, scan.prototype) = (points, fields.iter().map(field).collect());
        scan
    }

    #[test]
    fn points_that_a_file_cannot_hold_are_refused() {
        let refused = |scan: PointCloud, length: u64, part: &str| {
            let why = before_the_points(&[scan], length).unwrap_err();
            assert!(why.contains(part), "{why}");
        };
        refused(scan(1 << 60, &[(7, 7), (0, 0)]), 5000, "min = max");
        refused(scan(u64::MAX, &[(0, 1)]), 5000, "points in 5000 bytes");
        // One bit a point, and many fields that take none.
        refused(scan(500_000, &[&[(0, 1)][..], &vec![(3, 3); 200]].concat()), 70_000, "MiB of memory");
        assert_eq!(before_the_points(&[scan(8, &[(0, 255)])], 100), Ok(()));
        assert_eq!(before_the_points(&[scan(100_000, &[(0, 1 << 19); 3])], 900_000), Ok(()));
        assert_eq!(bits(&RecordDataType::Integer { min: i64::MIN, max: i64::MAX }), 64);
    }

    #[test]
    fn a_pose_is_no_scale() {
        let posed = |w: f64, x: f64| {
            let mut scan = PointCloud::default();
            scan.transform =
                Some(Transform { rotation: Quaternion { w, x, y: 0.0, z: 0.0 }, ..Transform::default() });
            with_sound_pose(3, &scan).map(|scan| scan.transform.unwrap().rotation)
        };
        for (w, x) in [(5.0, 0.0), (0.0, 0.0), (f64::NAN, 0.0), (0.7, 0.7)] {
            let why = posed(w, x).unwrap_err();
            assert!(why.contains("scan 3") && why.contains("not 1"), "{why}");
        }
        // Few digits, as some programs write them.
        assert_eq!(posed(0.0, 1.0001).map(|q| (q.w, q.x)), Ok((0.0, 1.0)));
        // Digits of double precision stay.
        let exact = (0.6f64 + 1e-12, 0.8f64);
        assert_eq!(posed(exact.0, exact.1).map(|q| (q.w, q.x)), Ok(exact));
    }
}
