//! LAS and LAZ: extra bytes, counts, units, and the numbers that another reader finds.

use super::{column, geotiff, read, refused};
use geom::Vec3;
use std::io::Cursor;
use stream::Values;

pub fn las_bytes(compressed: bool) -> Vec<u8> {
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

/// The numbers of EPSG alone say that a state plane counts in feet.
#[test]
fn las_in_feet_by_its_codes_prints_a_warning() {
    let with = |keys: &[[u16; 2]]| {
        let mut builder = las::Builder::from((1, 2));
        builder.vlrs.push(geotiff::record(keys));
        let writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap());
        let bytes = writer.unwrap().into_inner().unwrap().into_inner();
        read(bytes).warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    for (keys, part) in [
        (&[[1024, 1], [3072, 2263]][..], "'US survey foot' of 0.30480060960121924 m"),
        (&[[1024, 1], [3072, 2994]], "'foot' of 0.3048 m"),
        (&[[1024, 1], [3072, 2263], [4096, 6360]], "'US survey foot' of"),
        (&[[1024, 1], [3072, 2263], [4096, 5703]], "heights in 'metre'"),
        (&[[1024, 1], [3072, 32633], [4096, 6360]], "x and y in 'metre'"),
        (&[[1024, 1], [3072, 2263], [3076, 9002]], "'foot' of 0.3048 m"),
    ] {
        let said = with(keys);
        assert!(said.contains(part), "{keys:?}: {said}");
    }
    for keys in [
        &[[1024, 1], [3072, 32633]][..],
        &[[1024, 1], [3072, 2263], [3076, 9001]],
        &[[1024, 1], [3072, 32767]],
    ] {
        assert_eq!(with(keys), "", "{keys:?}");
    }
}

/// Numbers as laspy reads them.
#[test]
fn a_scan_of_terrain_has_the_numbers_that_another_reader_finds() {
    for file in ["autzen_400.las", "autzen_400.laz"] {
        let path = format!("{}/../../../sample-data/autzen/{file}", env!("CARGO_MANIFEST_DIR"));
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
