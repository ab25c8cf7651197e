//! Files whose numbers would change a scan silently, or take memory and time out of proportion to their length: refused.

mod shared;

use cloud::fill::{FillError, Settings};
use cloud::{Cloud, from_bytes};
use geom::Vec3;
use shared::refused;
use std::io::Cursor;

/// One point, in a pose that is turned by this quaternion (w, x).
fn e57(w: f64, x: f64) -> Vec<u8> {
    use e57::{Quaternion, Record, RecordValue, Transform, Translation};
    let mut file = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut file, "file").unwrap();
    let prototype = vec![Record::CARTESIAN_X_F64, Record::CARTESIAN_Y_F64, Record::CARTESIAN_Z_F64];
    let mut points = writer.add_pointcloud("scan", prototype).unwrap();
    let translation = Translation { x: 10.0, y: 0.0, z: 0.0 };
    points.set_transform(Some(Transform { rotation: Quaternion { w, x, y: 0.0, z: 0.0 }, translation }));
    points.add_point([1.0, 2.0, 3.0].map(RecordValue::Double).to_vec()).unwrap();
    points.finalize().unwrap();
    writer.finalize().unwrap();
    drop(writer);
    file.into_inner()
}

#[test]
fn a_pose_of_e57_does_not_scale_the_scan() {
    for (w, x) in [(5.0, 0.0), (0.0, 0.0), (0.7, 0.7)] {
        let message = refused(e57(w, x));
        assert!(message.contains("scan 0") && message.contains("it would scale the scan"), "{message}");
    }
    // Half a turn about x, written with few digits.
    let cloud = from_bytes(e57(0.0, 1.0001)).unwrap();
    assert!((cloud.points[0] - Vec3::new(11.0, -2.0, -3.0)).norm() < 1e-12, "{}", cloud.points[0]);
}

/// Three points in a LAS file, with eight bytes of its header replaced.
fn las(at: usize, value: f64) -> Vec<u8> {
    let header = las::Builder::from((1, 2)).into_header().unwrap();
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for i in 0..3 {
        let i = f64::from(i);
        writer.write_point(las::Point { x: i, y: 2.0 * i, z: 3.0 * i, ..las::Point::default() }).unwrap();
    }
    let mut bytes = writer.into_inner().unwrap().into_inner();
    bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
    bytes
}

#[test]
fn scales_of_zero_and_boxes_of_nan_in_las() {
    // x, y, z: scales from byte 131, offsets from 155, then for each axis the highest and the lowest coordinate.
    for (at, value, part) in [
        (131, 0.0, "gives x a scale of 0"),
        (147, f64::NAN, "gives z a scale of NaN"),
        (163, f64::INFINITY, "gives y a scale of 0.001 and an offset of inf m"),
        (179, f64::NAN, "bounding box in the header goes from x = 0 m to NaN m"),
    ] {
        let message = refused(las(at, value));
        assert!(message.contains(part), "{part}: {message}");
    }
    assert_eq!(from_bytes(las(131, 0.001)).unwrap().points.len(), 3);
}

#[test]
fn two_clouds_in_one_ply() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let ply = |other: &str, rows: usize| {
        let data = "1 2 3\n".repeat(1 + rows);
        format!(
            "ply\nformat ascii 1.0\nelement vertex 1\n{xyz}element {other} {rows}\n{xyz}end_header\n{data}"
        )
    };
    let message = refused(ply("vertex", 1));
    assert!(message.contains("a second element of this name"), "{message}");
    let message = refused(ply("camera", 1));
    assert!(message.contains("'vertex' and 'camera'") && message.contains("file of its own"), "{message}");
    assert_eq!(from_bytes(ply("camera", 0).into_bytes()).unwrap().points.len(), 1);
}

/// Names of columns are compared one by one: without a limit these took a minute.
#[test]
fn columns_without_end() {
    let message = refused("1 ".repeat(100_000));
    assert!(message.contains("line 1: more than 4096 columns"), "{message}");
    let properties: String = (0..100_000).map(|k| format!("property float p{k}\n")).collect();
    let message = refused(format!(
        "ply\nformat ascii 1.0\nelement vertex 1\n{properties}end_header\n{}\n",
        "1 ".repeat(100_000)
    ));
    assert!(message.contains("line 4100") && message.contains("more than 4096 properties"), "{message}");
}

#[test]
fn what_has_no_known_format_is_not_read_to_its_end() {
    let error = cloud::read(std::io::repeat(0)).unwrap_err().to_string();
    assert!(error.contains("no known cloud format"), "{error}");
}

#[test]
fn points_too_far_away_to_be_filled() {
    let mut points: Vec<Vec3> =
        (0..400).map(|k| Vec3::new(0.01 * f64::from(k % 20), 0.01 * f64::from(k / 20), 0.0)).collect();
    points[7] = Vec3::new(1e308, 0.0, 0.0);
    points[9] = Vec3::new(-1e308, 0.0, 0.0);
    let cloud = Cloud { attributes: stream::Table::with_rows(points.len()), points, ..Cloud::default() };
    let error = cloud::fill(cloud, &Settings::default()).unwrap_err();
    assert!(matches!(&error, FillError::TooFar(far) if far.index == 7), "{error}");
}
