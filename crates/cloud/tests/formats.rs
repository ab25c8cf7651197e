//! Every format is read back from bytes made here, and broken bytes are refused with their place.

use cloud::{Cloud, from_bytes};
use geom::Vec3;
use std::io::Cursor;
use stream::Values;

fn read(bytes: impl AsRef<[u8]>) -> Cloud {
    from_bytes(bytes.as_ref().to_vec()).unwrap()
}

/// The error and its causes on one line.
fn refused(bytes: impl AsRef<[u8]>) -> String {
    let error = from_bytes(bytes.as_ref().to_vec()).unwrap_err();
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(&error);
    while let Some(c) = cause {
        text += &format!(": {c}");
        cause = c.source();
    }
    text
}

fn column(cloud: &Cloud, name: &str) -> Vec<f64> {
    cloud.attributes.get(name).unwrap_or_else(|| panic!("no column {name}")).to_f64()
}

#[test]
fn ply_keeps_every_property_in_its_place() {
    let text = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty uchar red\nproperty float x\n\
                property float y\nproperty float z\nproperty int label\nelement face 0\n\
                property list uchar int vertex_indices\nend_header\n1 0.5 1 2 -7\n255 3 nan 5 8\n";
    let cloud = read(text);
    assert_eq!(cloud.points[0], Vec3::new(0.5, 1.0, 2.0));
    assert!(cloud.points[1].y.is_nan() && !cloud.double);
    assert_eq!(cloud.attributes.get("label"), Some(&Values::I32(vec![-7, 8])));
    let mut bytes = Vec::new();
    cloud::write_ply(&mut bytes, &cloud, stream::ply::Encoding::BinaryLittleEndian).unwrap();
    let header = String::from_utf8_lossy(&bytes[..bytes.len().min(250)]).into_owned();
    assert!(
        header
            .contains("uchar red\nproperty float x\nproperty float y\nproperty float z\nproperty int label")
    );
    let (again, bad) = read(&bytes).finite();
    assert_eq!((again.points.len(), bad), (1, 1));
    assert_eq!(again.comments, ["made by hand"]);
}

#[test]
fn ply_meshes_come_back_and_squares_become_fans() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    let mesh = cloud::read_mesh(&mut text.as_bytes()).unwrap();
    assert_eq!((mesh.faces.len(), mesh.area()), (2, 1.0));
    let mut bytes = Vec::new();
    cloud::write_mesh(&mut bytes, &mesh, stream::ply::Encoding::Ascii).unwrap();
    assert_eq!(cloud::read_mesh(&mut bytes.as_slice()).unwrap(), mesh);
    let wrong = text.replace("4 0 1 2 3", "3 0 1 9");
    assert!(cloud::read_mesh(&mut wrong.as_bytes()).unwrap_err().to_string().contains("vertex 9 of 4"));
}

fn las_bytes(compressed: bool) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 2));
    builder.point_format = las::point::Format::new(3).unwrap();
    builder.point_format.is_compressed = compressed;
    let header = builder.into_header().unwrap();
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for i in 0..300u16 {
        let point = las::Point {
            x: f64::from(i),
            y: 0.5 * f64::from(i),
            z: -f64::from(i),
            intensity: i,
            gps_time: Some(10.0 + f64::from(i)),
            color: Some(las::Color::new(i, 2 * i, 3 * i)),
            ..las::Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.into_inner().unwrap().into_inner()
}

#[test]
fn las_and_laz() {
    for compressed in [false, true] {
        let bytes = las_bytes(compressed);
        assert_eq!(cloud::formats::name_of(&bytes), Some("LAS/LAZ"));
        let cloud = read(&bytes);
        assert_eq!(cloud.points.len(), 300);
        assert!((cloud.points[200] - Vec3::new(200.0, 100.0, -200.0)).norm() < 1e-3);
        assert_eq!(column(&cloud, "intensity")[200], 200.0);
        assert_eq!((column(&cloud, "gps_time")[5], column(&cloud, "blue")[5]), (15.0, 15.0));
        let message = refused(&bytes[..bytes.len() * 2 / 3]);
        assert!(message.starts_with("LAS/LAZ"), "{message}");
        assert!(refused(&bytes[..40]).starts_with("LAS/LAZ"));
    }
}

fn e57_bytes() -> Vec<u8> {
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

#[test]
fn pcd_states_its_viewpoint() {
    let text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n\
                VIEWPOINT 1.5 -2 0.25 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n";
    let cloud = read(text);
    assert_eq!(cloud.viewpoints().collect::<Vec<_>>(), [Vec3::new(1.5, -2.0, 0.25)]);
    let mut ply = Vec::new();
    cloud::write_ply(&mut ply, &cloud, Default::default()).unwrap();
    assert_eq!(read(ply).viewpoints().collect::<Vec<_>>(), [Vec3::new(1.5, -2.0, 0.25)], "PLY passes it on");
}

#[test]
fn pcd_as_text_and_binary() {
    let header = |data: &str| {
        format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 2\nTYPE F F F U U\nCOUNT 1 1 1 1 1\n\
             WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA {data}\n"
        )
    };
    let text = header("ascii") + "1 2 3 16711935 7\n4 nan 6 255 8\n";
    let mut binary = header("binary").into_bytes();
    for (p, rgb, label) in [([1f32, 2.0, 3.0], 16711935u32, 7u16), ([4.0, f32::NAN, 6.0], 255, 8)] {
        p.iter().for_each(|c| binary.extend(c.to_le_bytes()));
        binary.extend(rgb.to_le_bytes());
        binary.extend(label.to_le_bytes());
    }
    for bytes in [text.as_bytes(), &binary] {
        let cloud = read(bytes);
        assert_eq!(cloud.points[0], Vec3::new(1.0, 2.0, 3.0));
        assert!(cloud.points[1].y.is_nan() && !cloud.double);
        assert_eq!((column(&cloud, "red")[0], column(&cloud, "green")[0]), (255.0, 0.0));
        assert_eq!(cloud.attributes.get("label"), Some(&Values::U16(vec![7, 8])));
        assert_eq!(cloud.viewpoints().count(), 0, "zero is no viewpoint");
        assert!(refused(&bytes[..bytes.len() - 6]).starts_with("PCD"));
    }
    assert!(refused(text.replace(" x y z ", " a y z ")).contains("no fields x, y, z"));
}

/// As ROS and PCL write it: bytes that only fill a point up, several values of a name, a remark before the head.
#[test]
fn pcd_with_padding_and_several_values() {
    let head = |data: &str| {
        format!(
            "# exported\nVERSION 0.7\nFIELDS _ x y z _ hist ring _\nSIZE 4 4 4 4 1 4 2 1\nTYPE F F F F U F U U\n\
             COUNT 1 1 1 1 4 2 1 10\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA {data}\n"
        )
    };
    let mut binary = head("binary").into_bytes();
    for k in [0u8, 1] {
        [9.0, 1.0, 2.0, 3.0].iter().for_each(|c: &f32| binary.extend((c + f32::from(k)).to_le_bytes()));
        binary.extend([255; 4]);
        [5.0, 6.0].iter().for_each(|c: &f32| binary.extend((c + f32::from(k)).to_le_bytes()));
        binary.extend([7 + k, 0]);
        binary.extend([255; 10]);
    }
    let blank = "0 ".repeat(10);
    let text = head("ascii") + &format!("9 1 2 3 0 0 0 0 5 6 7 {blank}\n10 2 3 4 0 0 0 0 6 7 8 {blank}\n");
    for bytes in [&binary, text.as_bytes()] {
        let cloud = read(bytes);
        assert_eq!(cloud.points, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 3.0, 4.0)]);
        let names: Vec<&str> = cloud.attributes.columns().iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["hist_0", "hist_1", "ring"]);
        assert_eq!((column(&cloud, "hist_1"), column(&cloud, "ring")), (vec![6.0, 7.0], vec![7.0, 8.0]));
    }
    let more = [&binary[..], &binary[binary.len() - 42..]].concat();
    for told in [refused(more), refused(text.replace("POINTS 2", "POINTS 1"))] {
        assert!(told.contains("points, and there are") && told.contains("correct POINTS"), "{told}");
    }
}

/// A header that counts too few points loses the others.
#[test]
fn las_with_more_points_than_its_header_says_is_refused() {
    for told in [200u32, 0] {
        let mut bytes = las_bytes(false);
        bytes[107..111].copy_from_slice(&told.to_le_bytes());
        let message = refused(bytes);
        assert!(message.contains(&format!("promises {told} points, and there are 300")), "{message}");
        assert!(message.contains("repair_counters"), "{message}");
    }
    let behind = [&las_bytes(false)[..], b"a remark"].concat();
    assert_eq!(read(behind).points.len(), 300, "what follows is not a point");
}

/// Extra bytes are columns, in LAS and LAZ.
#[test]
fn las_extra_bytes_are_columns() {
    let description = |kind: u8, options: u8, name: &str, scale: f64, offset: f64| {
        let mut bytes = vec![0; 192];
        (bytes[2], bytes[3]) = (kind, options);
        bytes[4..4 + name.len()].copy_from_slice(name.as_bytes());
        bytes[112..120].copy_from_slice(&scale.to_le_bytes());
        bytes[136..144].copy_from_slice(&offset.to_le_bytes());
        bytes
    };
    let described = [
        description(3, 0, "Amplitude", 0.0, 0.0),
        description(6, 24, "Deviation (mm)", 0.5, 100.0),
        description(2, 0, "intensity", 0.0, 0.0),
        description(0, 2, "reserve", 0.0, 0.0),
        description(22, 0, "side", 0.0, 0.0),
    ];
    for compressed in [false, true] {
        let mut builder = las::Builder::from((1, 4));
        builder.point_format = las::point::Format::new(1).unwrap();
        builder.point_format.is_compressed = compressed;
        builder.point_format.extra_bytes = 13;
        builder.vlrs.push(las::Vlr {
            user_id: "LASF_Spec".to_owned(),
            record_id: 4,
            description: String::new(),
            data: described.concat(),
        });
        let mut writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
        for k in 0..300u16 {
            let mut extra_bytes =
                [&k.to_le_bytes()[..], &(-i32::from(k)).to_le_bytes(), &[0xfe, 9, 9]].concat();
            extra_bytes.extend([1, 2, 255, 77]);
            let point =
                las::Point { x: f64::from(k), gps_time: Some(0.0), extra_bytes, ..las::Point::default() };
            writer.write_point(point).unwrap();
        }
        let cloud = read(writer.into_inner().unwrap().into_inner());
        assert_eq!(cloud.attributes.get("Amplitude"), Some(&Values::U32((0..300).collect())));
        assert_eq!(column(&cloud, "Deviation_(mm)")[299], 100.0 - 0.5 * 299.0);
        assert_eq!(cloud.attributes.get("extra_intensity"), Some(&Values::I8(vec![-2; 300])));
        assert_eq!([0, 1, 2].map(|k| column(&cloud, &format!("side_{k}"))[7]), [1.0, 2.0, -1.0]);
        assert_eq!(cloud.comments, ["3 extra bytes of each point were left out: nothing describes them"]);
    }
}

/// Degrees are not lengths.
#[test]
fn las_in_degrees_is_refused() {
    let with = |text: &str| {
        let mut builder = las::Builder::from((1, 4));
        builder.point_format = las::point::Format::new(6).unwrap();
        builder.vlrs.push(las::Vlr {
            user_id: "LASF_Projection".to_owned(),
            record_id: 2112,
            description: String::new(),
            data: text.as_bytes().to_vec(),
        });
        builder.has_wkt_crs = true;
        let writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap());
        writer.unwrap().into_inner().unwrap().into_inner()
    };
    let degrees = "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\"],UNIT[\"degree\",0.0174532925199433]]";
    let message = refused(with(degrees));
    assert!(message.contains("degrees") && message.contains("reprojection"), "{message}");
    let metres = format!("PROJCS[\"UTM\",{degrees},UNIT[\"metre\",1]]");
    assert!(read(with(&metres)).comments[0].contains("PROJCS"));
}

/// Binary STL has 4-byte numbers: at map coordinates they have lost their digits, and near the origin they have not.
#[test]
fn binary_stl_at_map_coordinates_prints_a_warning() {
    let stl = |x: f32| {
        let mut bytes = [&[0u8; 80][..], &200u32.to_le_bytes()].concat();
        for k in 0..200u8 {
            let (i, j) = (x + 0.1 * f32::from(k / 10), 0.1 * f32::from(k % 10));
            let corners =
                [0.0, 0.0, 1.0, i, j, 0.0, i + 0.1, j, 0.0, i, j + 0.1, 0.0].map(|c: f32| c.to_le_bytes());
            bytes.extend([&corners.concat()[..], &[0; 2]].concat());
        }
        read(bytes).warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(stl(0.0), [""; 0]);
    assert!(stl(5_849_000.0)[0].contains("4-byte numbers"), "{:?}", stl(5_849_000.0));
}

/// The numbers of EPSG alone say that a state plane counts in feet.
#[test]
fn las_in_feet_by_its_codes_prints_a_warning() {
    let with = |keys: &[(u16, u16)]| {
        let mut data = [1u16, 1, 0, keys.len() as u16].to_vec();
        keys.iter().for_each(|(id, value)| data.extend([*id, 0, 1, *value]));
        let mut builder = las::Builder::from((1, 2));
        builder.vlrs.push(las::Vlr {
            user_id: "LASF_Projection".to_owned(),
            record_id: 34735,
            description: String::new(),
            data: data.iter().flat_map(|n| n.to_le_bytes()).collect(),
        });
        let writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap());
        let bytes = writer.unwrap().into_inner().unwrap().into_inner();
        read(bytes).warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    for (keys, part) in [
        (&[(1024, 1), (3072, 2263)][..], "'US survey foot' of 0.30480060960121924 m"),
        (&[(1024, 1), (3072, 2994)], "'foot' of 0.3048 m"),
        (&[(1024, 1), (3072, 2263), (4096, 6360)], "'US survey foot' of"),
        (&[(1024, 1), (3072, 2263), (4096, 5703)], "heights in 'metre'"),
        (&[(1024, 1), (3072, 32633), (4096, 6360)], "x and y in 'metre'"),
        (&[(1024, 1), (3072, 2263), (3076, 9002)], "'foot' of 0.3048 m"),
    ] {
        let said = with(keys);
        assert!(said.contains(part), "{keys:?}: {said}");
    }
    for keys in [
        &[(1024, 1), (3072, 32633)][..],
        &[(1024, 1), (3072, 2263), (3076, 9001)],
        &[(1024, 1), (3072, 32767)],
    ] {
        assert_eq!(with(keys), "", "{keys:?}");
    }
}

/// A line end behind binary data, and capitals.
#[test]
fn ply_as_other_programs_write_it() {
    let head = |axes: [&str; 3]| {
        let properties: String = axes.iter().map(|a| format!("property float {a}\n")).collect();
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex 2\n{properties}property uchar k\nend_header\n"
        )
    };
    let rows = [1f32, 2.0, 3.0, 4.0, 5.0, 6.0].map(f32::to_le_bytes);
    let rows = [&rows[..3].concat()[..], &[7], &rows[3..].concat(), &[8]].concat();
    for axes in [["x", "y", "z"], ["X", "Y", "Z"]] {
        for end in ["", "\n", "\r\n"] {
            let bytes = [head(axes).as_bytes(), &rows, end.as_bytes()].concat();
            for cloud in [read(&bytes), cloud::read(bytes.as_slice()).unwrap()] {
                assert_eq!(cloud.points, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)]);
                assert_eq!(cloud.attributes.columns().len(), 1);
            }
        }
        for end in ["\n\n", " ", "\r\n\n", "12345678901234567"] {
            let bytes = [head(axes).as_bytes(), &rows, end.as_bytes()].concat();
            assert!(refused(&bytes).contains(&format!("{} bytes follow", end.len())));
            assert!(cloud::read(bytes.as_slice()).is_err(), "{end:?}");
        }
    }
}

#[test]
fn text_with_any_separator_header_and_count() {
    let plain = read("1 2 3\n4\t5\t6\r\n\n7, 8, 9\n1e1;11;12\n");
    assert_eq!(plain.points.len(), 4);
    assert_eq!(plain.points[3], Vec3::new(10.0, 11.0, 12.0));
    let named = read("//X Y Z Intensity R\n# a comment\n1 2 3 0.25 200\n4 5 6 nan 100\n");
    assert_eq!(named.comments, ["a comment"]);
    assert_eq!(column(&named, "Intensity")[0], 0.25);
    assert_eq!(named.attributes.get("red"), Some(&Values::U8(vec![200, 100])));
    let csv = read("\"x\",\"y\",\"z\",\"depth [m]\"\n1,2,3,4\n");
    assert_eq!(csv.attributes.columns()[0].name, "depth");
    let pts = read("2\n1 2 3 -500 10 20 30\n4 5 6 -400 40 50 60\n1\n7 8 9 0 0 0 0\n");
    assert_eq!((pts.points.len(), column(&pts, "intensity")[1], column(&pts, "blue")[1]), (3, -400.0, 60.0));
    let unnamed = read("1 2 3 4 5\n");
    assert_eq!((column(&unnamed, "c4")[0], column(&unnamed, "c5")[0]), (4.0, 5.0));
    assert_eq!(read("1 2 3\r4 5 6\r").points.len(), 2);
    assert_eq!(read("\u{feff}1 2 3\n").points.len(), 1);
}

#[test]
fn wrong_text_names_line_and_words() {
    for (text, parts) in [
        ("1 2 3\n4 five 6\n", ["line 2", "'five' (column 2)"]),
        ("1 2 3\n4 5\n", ["line 2", "2 numbers where"]),
        ("1 2 3 4\n4 5 6\n", ["line 2", "3 columns where the first point has 4"]),
        ("1 2 3\n4 5 6 7\n", ["line 2", "4 columns where the first point has 3"]),
        ("3\n1 2 3\n4 5 6\n", ["end of file", "3 points promised, 2 there"]),
        ("1\n1 2 3\n4 5 6\n", ["line 3", "a point after the 1"]),
        ("Hello, world 1\n", ["line 1", "'Hello' (column 1)"]),
        ("# only comments 1\n", ["without a point", "end of file"]),
    ] {
        let message = refused(text);
        assert!(parts.iter().all(|part| message.contains(part)), "{text}: {message}");
    }
}

#[test]
fn other_content_is_refused_by_name() {
    for (bytes, part) in [
        (&b""[..], "nothing to read"),
        (b"\x1f\x8b\x08\0\0\0", "gunzip"),
        (b"\x89MCAP0\r\n", "MCAP"),
        (b"PK\x03\x04....", "zip"),
        (b"\0\0\0\0\0\0", "\\x00"),
        (b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nend_header\n1\n", "no element has"),
        (b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "no 'y'"),
        (b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n", "PLY"),
    ] {
        let message = refused(bytes);
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// Whatever a byte is changed to, the reader comes back, with a cloud or with an error.
#[test]
fn flipped_bytes_never_end_the_program() {
    let ply = b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
                property float z\nend_header\n123412341234123412341234";
    let text = b"2\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n";
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    for whole in [las_bytes(false), las_bytes(true), e57_bytes(), ply.to_vec(), text.to_vec()] {
        for _ in 0..400 {
            let mut bytes = whole.clone();
            // Headers are short: half of the changes go there.
            let reach = if next() % 2 == 0 { bytes.len().min(400) } else { bytes.len() };
            let at = next() % reach;
            bytes[at] ^= 1 << (next() % 8);
            let _ = from_bytes(bytes);
        }
    }
}

/// Numbers as laspy reads them.
#[test]
fn a_scan_of_terrain_has_the_numbers_that_another_reader_finds() {
    for file in ["autzen_400.las", "autzen_400.laz"] {
        let path = format!("{}/../../sample-data/autzen/{file}", env!("CARGO_MANIFEST_DIR"));
        let cloud = read(std::fs::read(path).unwrap());
        assert_eq!(cloud.points.len(), 400);
        assert!((cloud.points[123] - Vec3::new(636758.36, 849026.5, 426.28)).norm() < 1e-6);
        let at = |name: &str| column(&cloud, name)[123];
        assert_eq!((at("intensity"), at("classification"), at("red")), (167.0, 1.0, 146.0));
        assert_eq!((at("gps_time"), at("point_source_id")), (245382.3918436729, 7326.0));
        assert_eq!(column(&cloud, "intensity").iter().sum::<f64>(), 38630.0);
        assert_eq!((column(&cloud, "scan_flags").iter().sum::<f64>(), at("scan_flags")), (13184.0, 64.0));
        assert!(cloud.comments[0].starts_with("coordinate reference system PROJCS["), "{:?}", cloud.comments);
        assert!((cloud.points.iter().map(|p| p.z).sum::<f64>() - 171997.38).abs() < 1e-6);
    }
}

/// STL and OBJ are clouds of their corners, each once, and STEP says what to do.
#[test]
fn a_drawing_is_a_cloud_of_its_corners() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mut binary = b"a part".to_vec();
    binary.resize(80, 0);
    binary.extend(4u32.to_le_bytes());
    let mut ascii = "solid part\n".to_owned();
    let mut obj: String = corners.iter().map(|c| format!("v {} {} {}\n", c[0], c[1], c[2])).collect();
    for face in faces {
        binary.extend([0u8; 12]);
        face.iter()
            .flat_map(|&v: &usize| corners[v])
            .for_each(|c: f64| binary.extend((c as f32).to_le_bytes()));
        binary.extend([0u8; 2]);
        let vertex = |&v: &usize| format!("vertex {} {} {}\n", corners[v][0], corners[v][1], corners[v][2]);
        let three: String = face.iter().map(vertex).collect();
        ascii += &format!("facet normal 0 0 0\nouter loop\n{three}endloop\nendfacet\n");
        obj += &format!("f {} {} {}\n", face[0] + 1, face[1] + 1, face[2] + 1);
    }
    ascii += "endsolid part\n";
    for bytes in [binary, ascii.into_bytes(), obj.into_bytes()] {
        let mut points = cloud::read(bytes.as_slice()).unwrap().points;
        points.sort_by(|a, b| a.z.total_cmp(&b.z).then(a.y.total_cmp(&b.y)).then(a.x.total_cmp(&b.x)));
        assert_eq!(points, corners.map(geom::Vec3::from));
    }
    let remarks = cloud::read(&b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nl 1 4\n"[..]).unwrap();
    assert_eq!(
        (remarks.points.len(), &remarks.comments[..]),
        (
            3,
            &[
                "the corners of 1 triangles".to_owned(),
                "1 lines (l) were left out: they are no surface".to_owned()
            ][..]
        )
    );
    let vertices = cloud::read(&b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"[..]).unwrap();
    assert_eq!(
        (vertices.points.len(), &vertices.comments[0][..]),
        (3, "the vertices of a drawing without faces")
    );
    let told = cloud::read(&b"ISO-10303-21;\nHEADER;\n"[..]).unwrap_err().to_string();
    assert!(told.contains("this is STEP") && told.contains("export STL"), "{told}");
}
