//! Names of the columns of text belong to the columns, whatever separates them.

use cloud::{Cloud, from_bytes};
use geom::Vec3;
use std::collections::BTreeMap;

fn read(text: &str) -> Cloud {
    from_bytes(text.as_bytes().to_vec()).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn read_bytes(bytes: &[u8]) -> Cloud {
    from_bytes(bytes.to_vec()).unwrap()
}

fn refused(text: &str) -> String {
    from_bytes(text.as_bytes().to_vec()).expect_err(text).to_string()
}

/// Value of each column in the first row.
fn columns(text: &str) -> BTreeMap<String, f64> {
    read(text).attributes.columns().iter().map(|c| (c.name.clone(), c.values.get(0))).collect()
}

fn expected<const N: usize>(of: [(&str, f64); N]) -> BTreeMap<String, f64> {
    of.map(|(name, value)| (name.to_owned(), value)).into()
}

#[test]
fn a_name_with_a_blank_is_one_name() {
    let wear = expected([("Wall_ID", 7.0), ("wear", 0.001), ("age", 30.0)]);
    for text in [
        "X,Y,Z,Wall ID,wear,age\n1,2,3,7,0.001,30\n",
        "X, Y, Z, Wall ID, wear, age\n1, 2, 3, 7, 0.001, 30\n",
        "# x,y,z,Wall ID,wear,age\n1,2,3,7,0.001,30\n",
        "\"x\";\"y\";\"z\";\"Wall ID\";wear;age\n1;2;3;7;0.001;30\n",
        "//X;Y;Z;Wall ID;wear;age\n1\n1;2;3;7;0.001;30\n",
        "X\tY\tZ\tWall ID\twear\tage\n1\t2\t3\t7\t0.001\t30\n",
        "x,y,z,Wall ID,wear,age\n1 2 3 7 0.001 30\n",
        "x y z Wall_ID wear age\n1,2,3,7,0.001,30\n",
        "x y z Wall_ID wear age\n1\t2\t3\t\t7\t0.001\t30\n",
        "x\ty\tz\tWall ID\twear\tage\n1\t\t2\t\t3\t7\t0.001\t30\n",
        "x,y,z,Wall ID,wear,age,\n1,2,3,7,0.001,30,\n",
        "x [m],y [m],z [m],Wall ID,wear [m],age [a]\n1,2,3,7,0.001,30\n",
        "X Y Z Wall_ID wear age\n[m] [m] [m] [-] [m] [a]\n1 2 3 7 0.001 30\n",
    ] {
        assert_eq!(columns(text), wear, "{text}");
    }
    let quoted = columns("x,y,z,\"a, b\",c\n1,2,3,4,5\n");
    assert_eq!(quoted, expected([("a,_b", 4.0), ("c", 5.0)]));
}

#[test]
fn x_y_and_z_may_stand_anywhere() {
    for text in [
        "id,x,y,z\n7,1,2,3\n",
        "id x y z\n7 1 2 3\n",
        "X [m];id;Y [m];Z [m]\n1;7;2;3\n",
        "Northing,Easting,id,Height\n2,1,7,3\n",
    ] {
        assert_eq!(read(text).points, [Vec3::new(1.0, 2.0, 3.0)], "{text}");
        assert_eq!(columns(text), expected([("id", 7.0)]), "{text}");
    }
}

#[test]
fn a_column_without_a_value_does_not_take_the_next_one() {
    for text in [
        "x,y,z,intensity,label\n1,2,3,,5\n",
        "x;y;z;intensity;label\n1;2;3; ;5\n",
        "x\ty\tz\tintensity\tlabel\n1\t2\t3\t\t5\n",
    ] {
        let found = columns(text);
        assert!(found["intensity"].is_nan() && found["label"] == 5.0, "{text}: {found:?}");
    }
    let last = columns("x\ty\tz\tlabel\n1\t2\t3\t\n");
    assert!(last["label"].is_nan(), "{last:?}");
    assert!(read("x,y,z,label\n1,,3,4\n").points[0].y.is_nan());
    assert_eq!(read("1,2,3,\n4,5,6,\n").attributes.columns().len(), 0, "a separator at the end is no column");
}

#[test]
fn other_numbers_of_names_than_columns_are_refused() {
    for (text, parts) in [
        ("x,y,z,a,b\n1,2,3,4\n", ["line 1", "5 names (x | y | z | a | b) for the 4 columns"]),
        ("x,y,z,a\n1,2,3,4,5\n", ["line 1", "4 names"]),
        ("x y z Wall ID wear\n1 2 3 4 5\n", ["6 names", "name every column"]),
        ("\nx,y,z,Wall ID\n1,2,3,4,5\n", ["line 2", "4 names"]),
        ("# x y z of the plant\n1 2 3 4\n", ["line 1", "6 names"]),
        ("lon,lat,alt\n1,2,3\n", ["line 1", "has x, y and z among them"]),
    ] {
        let message = refused(text);
        assert!(parts.iter().all(|part| message.contains(part)), "{text}: {message}");
    }
    let comment = read("# x y z of the plant\n1 2 3\n");
    assert_eq!(comment.comments, ["x y z of the plant"]);
}

#[test]
fn utf_16_is_named_and_latin_1_is_read() {
    let latin = read_bytes(b"# Gr\xf6\xdfe\n1 2 3\n");
    assert_eq!(latin.comments, ["Gr\u{f6}\u{df}e"]);
    assert!(refused("1 2 3\n4 5 \u{b5}\n").contains("line 2"));
    // As many bytes as a binary STL of its count would have, big-endian.
    let lines: String = (0..9).map(|k| format!("{k} 2 3\n")).collect();
    for text in ["1 2 3\n".to_owned(), lines] {
        let units = || format!("\u{feff}{text}").encode_utf16().collect::<Vec<_>>();
        for bytes in [
            units().into_iter().flat_map(u16::to_be_bytes).collect::<Vec<u8>>(),
            units().into_iter().flat_map(u16::to_le_bytes).collect(),
        ] {
            let message = from_bytes(bytes).expect_err("two bytes a letter").to_string();
            assert!(message.contains("UTF-16") && message.contains("iconv"), "{message}");
        }
    }
}

#[test]
fn numbers_and_names_as_other_programs_write_them() {
    let quoted = read("\"x\",\"y\",\"z\",\"wear\"\n\"1\",\"2\",\"3\",\"0.5\"\n");
    assert_eq!(quoted.points, [Vec3::new(1.0, 2.0, 3.0)]);
    assert_eq!(quoted.attributes.get("wear").map(|v| v.get(0)), Some(0.5));
    assert_eq!(read("1.5D+01 -2d0 3\n").points, [Vec3::new(15.0, -2.0, 3.0)]);
    for none in ["NULL", "NA", "N/A", "#N/A", "-", "nan(ind)", "-nan(ind)", "1.#QNAN", "nan"] {
        let cloud = read(&format!("x,y,z,wear\n1,2,3,4\n1,2,3,{none}\n"));
        assert!(cloud.attributes.get("wear").is_some_and(|v| v.get(1).is_nan()), "{none}");
    }
    for names in ["x (m),y (m),z (m),wear (mm)", "East,North,Up,wear", "Points:0,Points:1,Points:2,wear"] {
        let cloud = read(&format!("{names}\n1,2,3,4\n"));
        assert_eq!(cloud.points, [Vec3::new(1.0, 2.0, 3.0)], "{names}");
        assert_eq!(cloud.attributes.columns()[0].name, "wear", "{names}");
    }
    assert!(refused("1,2,3\n1,2,three\n").contains("'three' (column 3) is not a number"));
}

fn named(columns: &str, text: &str) -> Result<Cloud, String> {
    let columns = columns.parse::<cloud::TextColumns>()?;
    cloud::formats::from_bytes_as(text.as_bytes().to_vec(), Some(&columns)).map_err(|e| e.to_string())
}

/// A user names the columns where the file does not, or in words of another language.
#[test]
fn columns_get_the_names_of_the_user() {
    let at = |columns: &str, text: &str| {
        let cloud = named(columns, text).unwrap();
        assert_eq!(cloud.points[0], Vec3::new(1.0, 2.0, 3.0), "{columns}: {text}");
        let values = cloud.attributes.columns().iter().map(|c| (c.name.clone(), c.values.get(0)));
        values.collect::<BTreeMap<String, f64>>()
    };
    assert_eq!(at("id,x,y,z", "7 1 2 3\n8 4 5 6\n"), expected([("id", 7.0)]));
    assert_eq!(at("z,y,x,R", "3,2,1,9\n"), expected([("red", 9.0)]));
    assert_eq!(at("Easting, Northing, Height, tone", "1;2;3;0.5\n"), expected([("tone", 0.5)]));
    // The names of the file give way, also with units below them; a comment holds them.
    let german = "Nr;Rechts;Hoch;Höhe\n[-];[m];[m];[m]\n7;1;2;3\n";
    assert_eq!(at("id,x,y,z", german), expected([("id", 7.0)]));
    assert!(named("id,x,y,z", german).unwrap().comments[0].contains("Nr;Rechts"));
    assert_eq!(at("x=Rechts,y=hoch,z=Höhe", german), expected([("Nr", 7.0)]));
    assert_eq!(at("z=H (m),x=R,y=Y", "Y,R,H (m),x\n2,1,3,8\n"), expected([("c4", 8.0)]));
    // What is left out may be any word.
    assert_eq!(at("-,x,y,z,-", "P1,1,2,3,tree\nP2,4,5,6,house\n"), BTreeMap::new());
    assert_eq!(at("-,x,y,z", "point x y z\nP1 1 2 3\n"), BTreeMap::new());
    assert_eq!(at("x,y,z,a,tone", "1\t2\t3\t\t5\n").get("tone"), Some(&5.0), "nothing between two tabs");
    assert_eq!(
        at("x,y,z,tone", "2\n1 2 3 0.25\n4 5 6 0.5\n"),
        expected([("tone", 0.25)]),
        "a count in front"
    );
}

#[test]
fn names_of_the_user_that_do_not_fit_are_refused() {
    for (columns, text, part) in [
        ("id,x,y", "1 2 3\n", "x, y and z (or easting, northing, height) must be among the names"),
        ("x,,y,z", "1 2 3 4\n", "name 2 is empty: - leaves a column out"),
        ("x,y,z,z", "1 2 3 4\n", "'z' stands there twice"),
        ("x=a,y=b", "1 2 3\n", "give each of the three once"),
        ("x=a,y=b,z=c,id", "1 2 3\n", "give each of the three once"),
        ("id,x,y,z", "1 2 3\n", "line 1: --columns names 4 columns, and the first point has 3"),
        ("x,y,z", "a b c\nd e f\n1 2 3\n", "line 2: 'd' (column 1) is not a number"),
        (
            "x=a,y=b,z=c",
            "x y z\n1 2 3\n",
            "line 1: no line in front of the first point names the columns a, b, c",
        ),
        (
            "x,y,z",
            "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
            "this is PLY, which names them itself",
        ),
        ("x,y,z", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "this is STL/OBJ"),
    ] {
        let why = named(columns, text).unwrap_err();
        assert!(why.contains(part), "{columns}: {why}");
    }
    assert!(refused("P1 1 2 3\n").contains("name the columns with --columns, - for one that is left out"));
}

/// `height,x,y,z`: the coordinate is z, whatever stands in front.
#[test]
fn names_that_may_mean_two_columns_are_refused() {
    assert_eq!(read("height,x,y,z\n9,1,2,3\n").points[0], Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(columns("height,x,y,z\n9,1,2,3\n"), expected([("height", 9.0)]));
    assert_eq!(read("E N H id\n1 2 3 9\n").points[0], Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(read("x,y,z,e,n\n1,2,3,8,9\n").points[0], Vec3::new(1.0, 2.0, 3.0));
    let why = refused("Easting,Northing,Height,Elevation\n1,2,3,4\n");
    assert!(
        why.contains("line 1: both 'height' and 'elevation' may be a coordinate")
            && why.contains("--columns"),
        "{why}"
    );
    let both = "Easting,Northing,Height,Elevation\n1,2,4,3\n";
    assert_eq!(named("x=Easting,y=Northing,z=Elevation", both).unwrap().points[0].z, 3.0);
}
