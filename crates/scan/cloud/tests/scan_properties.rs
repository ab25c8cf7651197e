//! Properties of scans beside the coordinates: carried on under their names, or named where they are not.

mod geotiff;

use cloud::points::ReadWarning;
use cloud::{Cloud, from_bytes};
use e57::{Record, RecordDataType, RecordName, RecordValue as Value};
use geom::Vec3;
use std::io::Cursor;

fn column(cloud: &Cloud, name: &str) -> Vec<f64> {
    let values = cloud.attributes.get(name).unwrap_or_else(|| panic!("{name} is missing"));
    values.iter().collect()
}

/// A property of an extension.
fn unknown(namespace: &str, name: &str) -> RecordName {
    RecordName::Unknown { namespace: namespace.to_owned(), name: name.to_owned() }
}

/// Properties of a scan and its rows.
type Scan<'a> = (&'a [(RecordName, RecordDataType)], Vec<Vec<Value>>);

/// An E57 file of scans, each with a quarter turn about z and further properties.
fn e57(scans: &[Scan]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut file, "file").unwrap();
    for (space, url) in [("nor", "http://www.libe57.org/E57_NOR_surface_normals.txt"), ("ext", "http://x")] {
        writer.register_extension(e57::Extension::new(space, url)).unwrap();
    }
    for (properties, rows) in scans {
        let mut prototype = vec![Record::CARTESIAN_X_F64, Record::CARTESIAN_Y_F64, Record::CARTESIAN_Z_F64];
        let further = properties
            .iter()
            .map(|(name, data_type)| Record { name: name.clone(), data_type: data_type.clone() });
        prototype.extend(further);
        let mut points = writer.add_pointcloud("scan", prototype).unwrap();
        let half = 0.5f64.sqrt();
        points.set_transform(Some(e57::Transform {
            rotation: e57::Quaternion { w: half, x: 0.0, y: 0.0, z: half },
            translation: e57::Translation { x: 10.0, y: 0.0, z: 0.0 },
        }));
        for row in rows {
            let of = [1.0, 2.0, 3.0].map(Value::Double).into_iter();
            points.add_point(of.chain(row.iter().cloned()).collect()).unwrap();
        }
        points.finalize().unwrap();
    }
    writer.finalize().unwrap();
    drop(writer);
    file.into_inner()
}

#[test]
fn e57_times_returns_and_normals_are_columns() {
    let byte = RecordDataType::Integer { min: 0, max: 7 };
    let whole = RecordDataType::Integer { min: -9, max: 100_000 };
    let tenth = RecordDataType::ScaledInteger { min: 0, max: 1000, scale: 0.1, offset: 5.0 };
    let first = [
        (RecordName::TimeStamp, RecordDataType::F64),
        (RecordName::IsTimeStampInvalid, RecordDataType::Integer { min: 0, max: 1 }),
        (RecordName::ReturnIndex, byte.clone()),
        (RecordName::ReturnCount, byte.clone()),
        (unknown("nor", "normalX"), RecordDataType::F32),
        (unknown("nor", "normalY"), RecordDataType::F32),
        (unknown("nor", "normalZ"), RecordDataType::F32),
        (unknown("ext", "deviation"), tenth),
        (unknown("ext", "intensity"), byte.clone()),
    ];
    let row = |time: f64, hidden: i64, index: i64| {
        let mut row = vec![Value::Double(time), Value::Integer(hidden), Value::Integer(index)];
        row.push(Value::Integer(3));
        row.extend([0.6f32, 0.0, 0.8].map(Value::Single));
        row.extend([Value::ScaledInteger(20), Value::Integer(4)]);
        row
    };
    let second = [
        (RecordName::ReturnIndex, byte.clone()),
        (RecordName::ReturnCount, byte),
        (unknown("ext", "label"), whole),
    ];
    let rows = vec![[6, 7, 90_000].map(Value::Integer).to_vec()];
    let cloud = from_bytes(e57(&[(&first, vec![row(7.5, 0, 1), row(8.5, 1, 2)]), (&second, rows)])).unwrap();
    assert!((cloud.points[0] - Vec3::new(8.0, 1.0, 3.0)).norm() < 1e-12);
    let time = column(&cloud, "timeStamp");
    assert!(time[0] == 7.5 && time[1].is_nan() && time[2].is_nan(), "{time:?}");
    assert_eq!(column(&cloud, "returnIndex"), [1.0, 2.0, 6.0]);
    assert_eq!(cloud.attributes.get("returnIndex").map(|v| matches!(v, stream::Values::U8(_))), Some(true));
    // Turned by the pose of the scan.
    let normal: Vec<f64> = ["nx", "ny", "nz"].iter().map(|name| column(&cloud, name)[1]).collect();
    assert!((Vec3::from_row_slice(&normal) - Vec3::new(0.0, 0.6, 0.8)).norm() < 1e-6, "{normal:?}");
    assert!(column(&cloud, "nx")[2].is_nan(), "the second scan has none");
    assert_eq!(column(&cloud, "deviation")[0], 7.0);
    assert_eq!(column(&cloud, "intensity")[0], 4.0);
    assert_eq!(column(&cloud, "label")[2], 90_000.0);
    assert_eq!(column(&cloud, "scan"), [0.0, 0.0, 1.0]);
    assert!(cloud.warnings.is_empty() && !cloud.comments.iter().any(|line| line.contains("left out")));
}

#[test]
fn e57_properties_without_room_are_named() {
    let flat = RecordDataType::Integer { min: 0, max: 0 };
    let many: Vec<_> = (0..5000).map(|k| (unknown("ext", &format!("a{k}")), flat.clone())).collect();
    let mut properties = many;
    properties.push((RecordName::TimeStamp, RecordDataType::F64));
    let mut row = vec![Value::Integer(0); 5000];
    row.push(Value::Double(1.0));
    let cloud = from_bytes(e57(&[(&properties, vec![row])])).unwrap();
    let [ReadWarning::LeftOut(told)] = &cloud.warnings[..] else { panic!("{:?}", cloud.warnings) };
    assert!(told.starts_with("921 properties of the scans were left out: ext:a4080 ext:a4081 "), "{told}");
    assert_eq!(&cloud.comments[0], told);
}

/// A LAS file with a well-known text, or with keys of GeoTIFF.
fn las(text: Option<&str>, keys: &[[u16; 2]]) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).unwrap();
    builder.has_wkt_crs = text.is_some();
    builder.vlrs.push(match text {
        Some(text) => las::Vlr { record_id: 2112, data: text.as_bytes().to_vec(), ..geotiff::record(&[]) },
        None => geotiff::record(keys),
    });
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    let point = las::Point { gps_time: Some(0.0), ..las::Point::default() };
    writer.write_point(point).unwrap();
    writer.into_inner().unwrap().into_inner()
}

#[test]
fn las_in_feet_says_so() {
    let warnings = |text, keys: &[[u16; 2]]| from_bytes(las(text, keys)).unwrap().warnings;
    let state = r#"PROJCS["Texas",GEOGCS["NAD83",UNIT["degree",0.0174]],UNIT["US survey foot",0.3048006]]"#;
    let [ReadWarning::Unit(unit)] = &warnings(Some(state), &[])[..] else { panic!("a unit") };
    assert_eq!((unit.name.as_str(), unit.metres), ("US survey foot", 0.3048006));
    let told = ReadWarning::Unit(unit.clone()).to_string();
    assert!(told.contains("--scale 0.3048006"), "{told}");
    let metric = state.replace("US survey foot\",0.3048006", "metre\",1");
    assert!(warnings(Some(&metric), &[]).is_empty());
    let both = format!(r#"COMPD_CS["a",{state},VERT_CS["NAVD88",UNIT["metre",1]]]"#);
    let [ReadWarning::TwoUnits { vertical, .. }] = &warnings(Some(&both), &[])[..] else { panic!("two") };
    assert_eq!(vertical.metres, 1.0);
    // Projected, in international feet.
    let [ReadWarning::Unit(unit)] = &warnings(None, &[[1024, 1], [3076, 9002]])[..] else { panic!("a unit") };
    assert_eq!(unit.metres, 0.3048);
    assert!(warnings(None, &[[1024, 1], [3076, 9001]]).is_empty());
}
