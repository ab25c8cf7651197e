//! Regions, materials and what the stream says of them.

use super::*;

#[test]
fn regions_decide_roughness_material_and_velocity() {
    let text = "roughness = 0.0005\n[[region]]\nname = \"worn\"\nshape = \"box:-1,-1,-1,0.05,1,1\"\nroughness = 0.001\n\
                friction = 0.4\nvelocity = [1, 0, 0]\n";
    let none = |_: &str| Err("no files here".to_owned());
    let regions = Regions::parse(text, steel(), Vec3::zeros(), &none, &|_| Ok(String::new())).unwrap();
    let points = lattice(12, 0.01);
    let (wall, _) = build(&points, &regions, &with(Radius::Solve)).unwrap();
    let table = wall.table(&regions).unwrap();
    let names: Vec<&str> = table.columns().iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "radius", "material", "roughness", "region", "vx", "vy", "vz"]);
    let worn = |i: usize| points[i].x <= 0.05;
    for i in 0..points.len() {
        assert_eq!(table.get("region").unwrap().get(i), f64::from(worn(i)));
        assert_eq!(table.get("roughness").unwrap().get(i), if worn(i) { 0.001 } else { 0.0005 });
        assert_eq!(table.get("vx").unwrap().get(i), f64::from(worn(i)));
    }
    assert_eq!(regions.materials[1].name, "steel-worn");
    assert_eq!((regions.materials[1].friction, regions.materials[1].young), (Some(0.4), Some(2e8)));
    for (bad, says) in [
        ("roughness = 1e-3\nwear = 1", "wear"),
        ("rouhgness = 1e-3", "rouhgness"),
        ("[[region]]\nshape = \"cube:1\"", "region 1"),
        ("[[region]]\nshape = \"sphere:0,0,0,1\"\nfriction = -1", "friction"),
        ("roughness = -1", "roughness"),
    ] {
        let error = Regions::parse(bad, steel(), Vec3::zeros(), &none, &|_| Ok(String::new()))
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{bad}: {error}");
    }
}

/// A class of the scan, or a range of a colour, decides as a shape does; a range that no point has is refused.
#[test]
fn a_column_of_the_cloud_decides_as_a_shape_does() {
    let text = "roughness = 0.0005\n[[region]]\nname = \"red\"\ncolumn = \"r\"\nvalues = [200, 255]\nfriction = 0.8\n\
                [[region]]\nname = \"six\"\nshape = \"box:0,0,-1,0.055,1,1\"\ncolumn = \"class\"\nvalues = 6\nroughness = 0.001\n";
    let none = |_: &str| Err("no files here".to_owned());
    let points = lattice(12, 0.01);
    let red = |i: usize| i.is_multiple_of(5);
    let six = |i: usize| i.is_multiple_of(2);
    let property = |name: &str| match name {
        "r" => Some((0..points.len()).map(|i| if red(i) { 220.0 } else { 10.0 }).collect()),
        "class" => Some((0..points.len()).map(|i| if six(i) { 6.0 } else { 2.0 }).collect()),
        _ => None,
    };
    let parse = |text: &str| Regions::parse(text, steel(), Vec3::zeros(), &none, &|_| Ok(String::new()));
    let mut regions = parse(text).unwrap();
    assert!(regions.measure(&points, &property).unwrap().is_none());
    let (wall, _) = build(&points, &regions, &with(Radius::Solve)).unwrap();
    for (i, p) in points.iter().enumerate() {
        let wanted = if red(i) { 1 } else { 2 * u16::from(six(i) && p.x <= 0.055) };
        assert_eq!(wall.regions[i], wanted, "point {i}");
    }
    assert_eq!(regions.materials[1].friction, Some(0.8));
    for (bad, says) in [
        ("[[region]]\nname = \"a\"\nfriction = 1", "region 1 'a': give shape, or column and values"),
        ("[[region]]\ncolumn = \"r\"", "column without values"),
        ("[[region]]\nvalues = 3", "values without column"),
        ("[[region]]\ncolumn = \"r\"\nvalues = [3, 2]", "the smallest, then the largest"),
        ("[[region]]\ncolumn = \"g\"\nvalues = 3", "no property 'g'"),
        ("[[region]]\ncolumn = \"r\"\nvalues = [20, 30]", "its values are 10 to 220"),
    ] {
        let message = match parse(bad) {
            Err(e) => e.to_string(),
            Ok(mut regions) => regions.measure(&points, &property).unwrap_err().to_string(),
        };
        assert!(message.contains(says), "{bad}: {message}");
    }
}

#[test]
fn the_stream_says_what_the_wall_is_made_of() {
    use stream::mcap::{Event, Provenance, Reader};
    let regions = everywhere(0.001);
    let (wall, _) = build(&lattice(4, 0.01), &regions, &with(Radius::Uniform)).unwrap();
    let provenance =
        Provenance { tool: "wallgen".into(), version: "0".into(), arguments: vec![], inputs: vec![] };
    let bytes = wall::write_mcap(Vec::new(), &wall.table(&regions).unwrap(), &regions, &provenance).unwrap();
    let (mut materials, mut rows) = (false, 0);
    for event in Reader::new(bytes.as_slice()) {
        match event.unwrap() {
            Event::Metadata { name, map, .. } if name == "materials" => {
                assert_eq!(map["0"], r#"{"name":"steel","young":200000000.0}"#);
                materials = true;
            }
            Event::Points { topic, time_ns, table, .. } => {
                assert!(materials && topic == "/walls" && time_ns == 0, "materials come first");
                rows = table.rows();
            }
            _ => {}
        }
    }
    assert_eq!(rows, 16);
}
