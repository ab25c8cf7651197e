//! Text with any separator, header and count.

use super::{column, read, refused};
use geom::Vec3;
use stream::Values;

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
