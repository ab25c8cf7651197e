//! What scans state of themselves: where their scanner stood, colours that are not there, limits, degrees, long numbers.

mod geotiff;

use cloud::{Cloud, from_bytes};
use e57::{Record, RecordDataType, RecordName, RecordValue as Value, Transform};
use geom::{Transform as Move, Vec3};
use std::io::Cursor;
use stream::{Table, Values};

fn read(bytes: impl AsRef<[u8]>) -> Cloud {
    from_bytes(bytes.as_ref().to_vec()).unwrap()
}

fn eyes(cloud: &Cloud) -> Vec<[f64; 3]> {
    cloud.viewpoints().map(Into::into).collect()
}

fn column(cloud: &Cloud, name: &str) -> Vec<f64> {
    cloud.attributes.get(name).unwrap_or_else(|| panic!("{name}")).iter().collect()
}

fn warnings(cloud: &Cloud) -> String {
    cloud.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// A scan of `columns` × 2 cells, its scanner as the third line says, moved by `shift`.
fn ptx(columns: usize, place: &str, shift: &str, point: &str) -> String {
    let points = format!("{point}\n").repeat(2 * columns);
    format!("{columns}\n2\n{place}\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n{shift} 1\n{points}")
}

#[test]
fn the_scanner_of_a_ptx_grid_has_a_place_also_at_the_origin() {
    let cell = "1 2 3 0.5";
    for (text, found, told) in [
        (ptx(2, "0 0 0", "0 0 0", cell), &[[0.0; 3]][..], ""),
        (ptx(2, "0 0 0", "10 20 30", cell), &[[10.0, 20.0, 30.0]], ""),
        (ptx(2, "10 20 30", "10 20 30", cell), &[[10.0, 20.0, 30.0]], ""),
        (ptx(2, "10 20 30", "0 0 0", cell), &[[10.0, 20.0, 30.0]], ""),
        (
            ptx(2, "1 1 1", "10 20 30", cell),
            &[[1.0; 3]],
            "scan 0: its third line says that the scanner stood at 1 1 1 m",
        ),
        // Scans that were merged are one column.
        (ptx(1, "0 0 0", "0 0 0", cell), &[], ""),
        (ptx(1, "0 0 0", "10 20 30", cell), &[[10.0, 20.0, 30.0]], ""),
    ] {
        let cloud = read(&text);
        assert_eq!(eyes(&cloud), found, "{text}");
        let said = warnings(&cloud);
        assert!(said.contains(told) && said.is_empty() == told.is_empty(), "{text}: {said}");
    }
    let two = ptx(2, "0 0 0", "0 0 0", cell) + &ptx(2, "4 0 0", "4 0 0", cell);
    assert_eq!(eyes(&read(two)), [[0.0; 3], [4.0, 0.0, 0.0]]);
}

#[test]
fn a_ptx_scan_without_colours_has_none() {
    let two = ptx(2, "1 0 0", "1 0 0", "1 2 3 0.5 7 8 9") + &ptx(1, "4 0 0", "4 0 0", "1 2 3 0.5");
    let red = column(&read(two), "red");
    assert_eq!(red[..4], [7.0; 4]);
    assert!(red[4..].iter().all(|c| c.is_nan()) && red.len() == 6, "{red:?}");
    let all = read(ptx(2, "1 0 0", "1 0 0", "1 2 3 0.5 7 8 9"));
    assert_eq!(all.attributes.get("red"), Some(&Values::U8(vec![7; 4])));
}

/// A scan of two points.
struct Scan {
    shift: Option<f64>,
    is_grid: bool,
    /// The largest number of a colour, and whether the second point has none.
    color: Option<(i64, bool)>,
}

fn e57(scans: &[Scan]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut file, "file").unwrap();
    let whole =
        |name: RecordName, max: i64| Record { name, data_type: RecordDataType::Integer { min: 0, max } };
    for (number, scan) in scans.iter().enumerate() {
        let mut fields = vec![Record::CARTESIAN_X_F64, Record::CARTESIAN_Y_F64, Record::CARTESIAN_Z_F64];
        if scan.is_grid {
            fields.extend([whole(RecordName::RowIndex, 9), whole(RecordName::ColumnIndex, 9)]);
        }
        if let Some((top, _)) = scan.color {
            let colors = [RecordName::ColorRed, RecordName::ColorGreen, RecordName::ColorBlue];
            fields.extend(colors.map(|name| whole(name, top)));
            fields.push(whole(RecordName::IsColorInvalid, 1));
        }
        let mut points = writer.add_pointcloud(&format!("scan {number}"), fields).unwrap();
        if let Some(x) = scan.shift {
            let translation = e57::Translation { x, y: 0.0, z: 0.0 };
            points.set_transform(Some(Transform { translation, ..Transform::default() }));
        }
        for k in 0..2 {
            let mut row = [1.0, 2.0, 3.0].map(Value::Double).to_vec();
            if scan.is_grid {
                row.extend([0, k].map(Value::Integer));
            }
            if let Some((top, lacks)) = scan.color {
                row.extend([top, 0, top].map(Value::Integer));
                row.push(Value::Integer(i64::from(lacks && k == 1)));
            }
            points.add_point(row).unwrap();
        }
        points.finalize().unwrap();
    }
    writer.finalize().unwrap();
    drop(writer);
    file.into_inner()
}

#[test]
fn a_pose_of_an_e57_scan_is_where_its_scanner_stood() {
    let scan = |shift: Option<f64>, is_grid: bool| Scan { shift, is_grid, color: None };
    for (scans, found) in [
        (vec![scan(Some(0.0), false), scan(Some(3.0), false)], &[[0.0; 3], [3.0, 0.0, 0.0]][..]),
        (vec![scan(Some(0.0), true)], &[[0.0; 3]]),
        (vec![scan(Some(3.0), false)], &[[3.0, 0.0, 0.0]]),
        // Scans that were merged state it as well.
        (vec![scan(Some(0.0), false)], &[]),
        (vec![scan(None, true)], &[]),
    ] {
        assert_eq!(eyes(&read(e57(&scans))), found);
    }
}

#[test]
fn colours_that_an_e57_scan_lacks_are_nan() {
    let scan = |color| Scan { shift: None, is_grid: false, color };
    let cloud = read(e57(&[scan(None), scan(Some((255, true)))]));
    for (name, value) in [("red", 255.0), ("green", 0.0), ("blue", 255.0)] {
        let found = column(&cloud, name);
        assert!(found[0].is_nan() && found[1].is_nan() && found[3].is_nan(), "{name}: {found:?}");
        assert_eq!(found[2], value, "{name}");
    }
}

#[test]
fn colours_of_e57_scans_with_other_limits_become_those_of_bytes() {
    let scan = |top| Scan { shift: None, is_grid: false, color: Some((top, false)) };
    let mixed = read(e57(&[scan(65535), scan(255), scan(1023)]));
    assert_eq!(mixed.attributes.get("red"), Some(&Values::U8(vec![255; 6])));
    assert_eq!(mixed.attributes.get("green"), Some(&Values::U8(vec![0; 6])));
    for top in [255, 65535] {
        assert_eq!(column(&read(e57(&[scan(top), scan(top)])), "red"), [top as f64; 4], "limits of all stay");
    }
}

/// LAS 1.2 with one point at x, y, and keys of GeoTIFF.
fn las(keys: &[[u16; 2]], (x, y): (f64, f64)) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 2));
    builder.vlrs.push(geotiff::record(keys));
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    writer.write_point(las::Point { x, y, ..las::Point::default() }).unwrap();
    writer.into_inner().unwrap().into_inner()
}

#[test]
fn las_in_degrees_is_refused_also_without_the_model_of_its_coordinates() {
    for keys in [&[[2048, 4326]][..], &[[1024, 2], [2048, 4326]]] {
        let told = from_bytes(las(keys, (11.5, 48.1))).unwrap_err().to_string();
        assert!(told.contains("degrees") && told.contains("4326"), "{keys:?}: {told}");
    }
    for (keys, place) in [
        (&[[2048, 4326]][..], (691_000.0, 334_000.0)),
        (&[[2048, 4326], [3072, 32632]], (11.5, 48.1)),
        (&[[2048, 4326], [3076, 9001]], (11.5, 48.1)),
        (&[[1024, 1], [2048, 4326]], (11.5, 48.1)),
    ] {
        assert!(from_bytes(las(keys, place)).is_ok(), "{keys:?}");
    }
}

fn pcd(field: &str, size: u8, kind: char, values: &[&str]) -> String {
    let rows: String = values.iter().map(|value| format!("1 2 3 {value}\n")).collect();
    let count = values.len();
    format!(
        "VERSION 0.7\nFIELDS x y z {field}\nSIZE 4 4 4 {size}\nTYPE F F F {kind}\nCOUNT 1 1 1 1\nWIDTH {count}\nHEIGHT 1\n\
         POINTS {count}\nDATA ascii\n{rows}"
    )
}

/// An 8-byte number holds every whole number up to 2⁵³.
#[test]
fn whole_numbers_that_lose_digits_are_named() {
    let (long, short) = ("1700000000123456789", "1700000000123456");
    for (text, name) in [
        (pcd("t", 8, 'U', &["5", long]), "'t'"),
        (pcd("t", 8, 'I', &["-9007199254740993"]), "'t'"),
        (format!("x,y,z,time\n1,2,3,{long}\n"), "'time'"),
    ] {
        let told = warnings(&read(&text));
        assert!(
            told.contains(name) && told.contains("above 2^53") && told.contains("subtract"),
            "{text}: {told}"
        );
    }
    for text in [
        pcd("t", 8, 'U', &[short]),
        format!("1 2 3 {short}\n"),
        "1 2 3 3.4e38\n".to_owned(),
        format!("1 2 3 {long}\n1 2 3 0.5\n"),
    ] {
        assert_eq!(warnings(&read(&text)), "", "{text}");
    }
}

#[test]
fn pcd_with_alpha_keeps_it() {
    let packed = |alpha: u32| (alpha << 24 | 0x10_20_30).to_string();
    let cloud = read(pcd("rgba", 4, 'U', &[&packed(7), &packed(255)]));
    assert_eq!(column(&cloud, "alpha"), [7.0, 255.0]);
    assert_eq!(column(&cloud, "red"), [16.0; 2]);
    for fills in [0, 255] {
        let cloud = read(pcd("rgba", 4, 'U', &[&packed(fills), &packed(fills)]));
        assert!(cloud.attributes.get("alpha").is_none(), "{fills} everywhere says nothing");
    }
}

#[test]
fn an_obj_without_faces_is_all_its_vertices_and_says_what_it_left_out() {
    let cloud = read("v 0 0 0 1 0 0\nv 0 0 0 0 1 0\nv 1 0 0 0 0 1\n");
    assert_eq!(cloud.points.len(), 3);
    let told = warnings(&cloud);
    assert!(told.contains("the colours of 3 vertices were left out"), "{told}");
    assert_eq!(warnings(&read("v 0 0 0\nv 1 0 0 1\n")), "");
    assert_eq!(read("v 0 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 4\nf 2 3 4\n").points.len(), 3);
}

/// ParaView writes `Normals:0`, extra bytes of LAS and fields of PCD `normal_0`.
#[test]
fn numbered_directions_turn_as_those_with_letters() {
    let quarter = Move::parse("0 -1 0 0 1 0 0 0 0 0 1 0 0 0 0 1").unwrap();
    let moved = |names: [&str; 4]| {
        let mut attributes = Table::with_rows(1);
        for (name, value) in names.iter().zip([1.0, 0.0, 0.0, 5.0]) {
            attributes.push(name, Values::F64(vec![value])).unwrap();
        }
        let mut cloud = Cloud { points: vec![Vec3::zeros()], attributes, ..Cloud::default() };
        let told = cloud.transform(&quarter);
        (names.map(|name| column(&cloud, name)[0]), told)
    };
    for names in [
        ["Normals:0", "Normals:1", "Normals:2", "i"],
        ["normal_0", "normal_1", "normal_2", "i"],
        ["Normals[0]", "Normals[1]", "Normals[2]", "i"],
        ["velocity 0", "velocity 1", "velocity 2", "i"],
        ["nx", "ny", "nz", "i"],
    ] {
        assert_eq!(moved(names), ([0.0, 1.0, 0.0, 5.0], vec![]), "{names:?}");
    }
    let stays = [1.0, 0.0, 0.0, 5.0];
    assert_eq!(moved(["beam_0", "beam_1", "beam_2", "i"]), (stays, vec!["beam_0".to_owned()]));
    for names in [["n_0", "n_1", "n_2", "n_3"], ["v10", "v11", "v12", "i"]] {
        assert_eq!(moved(names), (stays, vec![]), "{names:?}: a list of numbers");
    }
}
