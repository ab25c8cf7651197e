//! E57 with scans and points without an echo.

use super::{column, read, refused};
use geom::Vec3;
use std::io::Cursor;

pub fn e57_bytes() -> Vec<u8> {
    use e57::{Record, RecordValue as Value};
    let mut file = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut file, "file").unwrap();
    for scan in 0..2 {
        let prototype = vec![
            Record::CARTESIAN_X_F64,
            Record::CARTESIAN_Y_F64,
            Record::CARTESIAN_Z_F64,
            Record {
                name: e57::RecordName::CartesianInvalidState,
                data_type: e57::RecordDataType::Integer { min: 0, max: 2 },
            },
            Record::COLOR_RED_U8,
            Record::COLOR_GREEN_U8,
            Record::COLOR_BLUE_U8,
        ];
        let mut points = writer.add_pointcloud(&format!("scan {scan}"), prototype).unwrap();
        for i in 0..50i64 {
            let coordinate = |a: i64| Value::Double((i * a + scan) as f64);
            let invalid = Value::Integer(if i == 9 { 2 } else { 0 });
            let color = |c: i64| Value::Integer(c);
            points
                .add_point(vec![
                    coordinate(1),
                    coordinate(2),
                    coordinate(3),
                    invalid,
                    color(i),
                    color(1),
                    color(255),
                ])
                .unwrap();
        }
        points.finalize().unwrap();
    }
    writer.finalize().unwrap();
    drop(writer);
    file.into_inner()
}

#[test]
fn e57_with_two_scans_and_points_without_an_echo() {
    let bytes = e57_bytes();
    let cloud = read(&bytes);
    assert_eq!(cloud.points.len(), 100);
    assert_eq!(cloud.points[60], Vec3::new(11.0, 21.0, 31.0));
    assert!(cloud.points[9].x.is_nan());
    assert_eq!(cloud.attributes.get("red").map(|v| v.get(7)), Some(7.0));
    assert_eq!(column(&cloud, "scan")[60], 1.0);
    assert_eq!(cloud.finite().1, 2);
    assert!(refused(&bytes[..bytes.len() / 2]).starts_with("E57"));
}
