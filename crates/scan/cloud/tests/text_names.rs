//! What lines of text in front of the points say: names behind a mark of a comment, units, and what is no name.

use cloud::formats::from_bytes_as;
use cloud::{Cloud, TextColumns, from_bytes};
use geom::Vec3;

fn read(text: &str) -> Cloud {
    from_bytes(text.as_bytes().to_vec()).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn refused(text: &str) -> String {
    from_bytes(text.as_bytes().to_vec()).expect_err(text).to_string()
}

fn named(columns: &str, text: &str) -> Result<Cloud, String> {
    let columns = columns.parse::<TextColumns>().unwrap();
    from_bytes_as(text.as_bytes().to_vec(), Some(&columns)).map_err(|e| e.to_string())
}

fn warnings(cloud: &Cloud) -> String {
    cloud.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

fn names(cloud: &Cloud) -> Vec<&str> {
    cloud.attributes.columns().iter().map(|column| column.name.as_str()).collect()
}

/// As numpy.savetxt writes a header, and others in front of it.
#[test]
fn names_behind_a_mark_are_those_of_the_columns_as_without_it() {
    for (head, rest) in [
        ("# id x y z", "9 1 2 3"),
        ("# id x y z", "9;1;2;3"),
        ("# N E H", "2 1 3"),
        ("# y x z", "2 1 3"),
        ("// t X Y Z", "9 1 2 3"),
        ("# intensity x y z", "9 1 2 3"),
        ("# Columns: id x y z", "9 1 2 3"),
        ("# 3 scans in x y z\n# id x y z\n# tool 7", "9 1 2 3"),
        ("# x y z of the plant\n# id x y z", "9 1 2 3"),
        ("# z y x\n# y x z", "2 1 3"),
    ] {
        let cloud = read(&format!("{head}\n{rest}\n{rest}\n"));
        assert_eq!(cloud.points, [Vec3::new(1.0, 2.0, 3.0); 2], "{head}");
        assert_eq!(cloud.attributes.columns().len(), rest.split([' ', ';']).count() - 3, "{head}");
        assert_eq!(warnings(&cloud), "", "{head}");
    }
    let cloud = read("# made by hand\n# z y x\n# id x y z\n# tool 7\n9 1 2 3\n");
    assert_eq!(cloud.comments, ["made by hand", "z y x", "tool 7"], "the others stay, in order");
    assert_eq!(names(&cloud), ["id"]);
}

#[test]
fn a_sentence_is_a_comment_and_names_that_do_not_fit_are_said() {
    for text in ["# z is up, as seen\n1 2 3\n", "# x y z of the plant\n1 2 3\n", "# N E\n1 2 3\n"] {
        let cloud = read(text);
        assert_eq!((cloud.points[0], warnings(&cloud)), (Vec3::new(1.0, 2.0, 3.0), String::new()), "{text}");
        assert_eq!(cloud.comments.len(), 1, "{text}");
    }
    let cloud = read("# note\n# id x y z\n9 1 2 3 4\n");
    let told = warnings(&cloud);
    let parts = ["line 2 ('id x y z')", "4 words", "5 columns", "--columns"];
    assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    assert_eq!(cloud.comments, ["note", "id x y z"]);
    let told = refused("# height elevation easting northing\n1 2 3 4\n");
    assert!(told.contains("line 1: both 'height' and 'elevation'"), "{told}");
}

/// Names are words: what begins as a number does is a point, in the first line as in the second.
#[test]
fn a_first_line_that_is_no_point_is_refused_as_a_second_one_is() {
    for (columns, good, bad, part) in [
        ("x,y,z", "4 5 6", "1 2 abc", "'abc' (column 3) is not a number"),
        ("x,y,z", "4 5 6", "1 2 3m", "'3m' (column 3) is not a number"),
        ("x,y,z", "4;5;6", "1,5;2;3", "decimal commas"),
        ("x,y,z", "4,5,6", "1'234.5,2,3", "'1'234.5' (column 1) is not a number"),
        ("x,y,z", "4,5,6", "+1.5k,a,b", "'+1.5k' (column 1) is not a number"),
        ("-,x,y,z", "P2,4,5,6", "P1,\"1\",.2q,3", "'.2q' (column 3) is not a number"),
    ] {
        for (line, text) in [(1, format!("{bad}\n{good}\n")), (2, format!("{good}\n{bad}\n"))] {
            let told = named(columns, &text).unwrap_err();
            assert!(told.contains(&format!("line {line}: {part}")), "{text}: {told}");
        }
    }
    for (columns, text) in [("x,y,z", "a b c\n1 2 3\n"), ("-,x,y,z", "1st;R;H;Z\nP1;1;2;3\n")] {
        assert_eq!(named(columns, text).unwrap().points, [Vec3::new(1.0, 2.0, 3.0)], "{text}");
    }
}

#[test]
fn a_column_that_is_left_out_may_hold_any_text() {
    for (columns, text) in [
        ("-,x,y,z,-", "P1,1,2,3,wall left\nP2,1,2,3,wall\n"),
        ("id,x,y,z,-", "id,x,y,z,note\n1,1,2,3,wall\n2,1,2,3,wall left\n"),
        ("id,x,y,z,-", "1,1,2,3,\"a, b\"\n2,1,2,3,\"c; d\"\n"),
        ("x,y,z,-", "1 2 3 \"on the left\"\n1 2 3 right\n"),
        ("-,x,y,z", "2024-05-01 10:00:00,1,2,3\n2024-05-01 10:00:01,1,2,3\n"),
        ("-,x,y,z", "1,5;1;2;3\n2,5;1;2;3\n"),
        ("-,x,y,z", "a,b\t1\t2\t3\nc d\t1\t2\t3\n"),
    ] {
        let cloud = named(columns, text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(cloud.points, [Vec3::new(1.0, 2.0, 3.0); 2], "{text}");
    }
    let quoted = read("x\ty\tz\tn\tm\n1\t2\t3\t\t\"5\"\n1\t2\t3\t 4\t \"5\"\n");
    assert_eq!(
        quoted.attributes.get("m"),
        Some(&stream::Values::F64(vec![5.0; 2])),
        "behind an empty column"
    );
    assert!(named("-,x,y,z", "a b;1,5;2;3\n").unwrap_err().contains("decimal commas"));
}

#[test]
fn an_index_of_a_data_frame_is_a_column() {
    for text in [",x,y,z,i\n0,1,2,3,5\n", ";x;y;z;i\n0;1;2;3;5\n", "\tx\ty\tz\ti\n0\t1\t2\t3\t5\n"] {
        let cloud = read(text);
        assert_eq!((cloud.points[0], names(&cloud)), (Vec3::new(1.0, 2.0, 3.0), vec!["c1", "i"]), "{text}");
    }
    assert_eq!(names(&named("-,x,y,z,i", ",x,y,z,i\n0,1,2,3,5\n").unwrap()), ["i"]);
}

#[test]
fn units_in_the_names_are_left_out_and_said_where_they_are_no_metres() {
    for (head, rest, factor) in [
        ("x [mm],y [mm],z [mm]", "", "0.001"),
        ("x(mm);y(mm);z(mm)", "", "0.001"),
        ("# x[cm],y[cm],z[cm]", "", "0.01"),
        ("x y z", "[ft] [ft] [ft]\n", "0.3048"),
        ("Easting (US-ft),Northing (US-ft),Height (US-ft)", "", "0.304800609"),
        ("x[in],y[in],z[in],Amplitude[dB]", "", "0.0254"),
    ] {
        let row = if head.contains("dB") { "1,2,3,4\n" } else { "1,2,3\n" };
        let cloud = read(&format!("{head}\n{rest}{row}"));
        assert_eq!(cloud.points[0], Vec3::new(1.0, 2.0, 3.0), "{head}");
        let told = warnings(&cloud);
        assert!(told.contains(&format!("--scale {factor}")), "{head}: {told}");
        assert!(cloud.warnings[0].is_answered_by_scale(), "{head}");
    }
    for head in ["x(m),y(m),z(m)", "X[m],Y[m],Z[m]", "x [m],y [m],z [m]", "x [px],y [px],z [px]"] {
        let cloud = read(&format!("{head}\n1,2,3\n"));
        assert_eq!((cloud.points[0], warnings(&cloud)), (Vec3::new(1.0, 2.0, 3.0), String::new()), "{head}");
    }
    let told = warnings(&read("x [m],y [m],z [mm]\n1,2,3\n"));
    assert!(told.contains("x in 'm', y in 'm' and z in 'mm'"), "{told}");
    let cloud = read("x,y,z,Amplitude[dB],v[0],v[1],f(x),Range[m],Range[dB]\n1,2,3,4,5,6,7,8,9\n");
    assert_eq!(names(&cloud), ["Amplitude", "v[0]", "v[1]", "f(x)", "Range[m]", "Range[dB]"]);
}

#[test]
fn small_letters_are_colours_only_together_and_a_coordinate_has_one_name() {
    for (columns, found) in [
        ("x,y,z,r", &["r"][..]),
        ("x,y,z,b,t", &["b", "t"]),
        ("x,y,z,r,g,b", &["red", "green", "blue"]),
        ("x,y,z,R,G,B", &["red", "green", "blue"]),
    ] {
        let row = (0..columns.split(',').count()).map(|k| k.to_string()).collect::<Vec<_>>().join(",");
        assert_eq!(names(&read(&format!("{columns}\n{row}\n"))), found, "{columns}");
        assert_eq!(names(&named(columns, &format!("{row}\n")).unwrap()), found, "{columns}");
    }
    let told = refused("x,y,z,X\n1,2,3,4\n");
    assert!(
        told.contains("line 1: columns 1 and 4 are both named 'x'") && told.contains("--columns"),
        "{told}"
    );
}
