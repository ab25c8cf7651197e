//! PTX of Leica: scans in their poses, cells without an echo, and what is refused with its line.

use cloud::{Cloud, from_bytes};
use geom::Vec3;

/// Two scans of 2 × 2 cells: one turned by a quarter about z and shifted, one as it is, with colours.
const TWO: &str = "2\n2\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n\
    1 0 0 0.5\n0 0 0 0.5\n0 2 0 0.25\n0 0 3 1\n\
    1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.1 255 0 7\n4 5 6 0.2 1 2 3\n";

fn column(cloud: &Cloud, name: &str) -> Vec<f64> {
    cloud.attributes.get(name).unwrap_or_else(|| panic!("{name}")).iter().collect()
}

fn refused(text: &str) -> String {
    from_bytes(text.as_bytes().to_vec()).expect_err(text).to_string()
}

#[test]
fn ptx_scans_stand_in_their_poses() {
    for text in [TWO.to_owned(), TWO.replace('\n', "\r\n"), format!("\u{feff}{TWO}\n\n")] {
        assert_eq!(cloud::formats::name_of(text.as_bytes()), Some("PTX"));
        let cloud = from_bytes(text.into_bytes()).unwrap();
        assert_eq!(cloud.points.len(), 6);
        // x of the scanner is y of the plant.
        assert_eq!(cloud.points[0], Vec3::new(10.0, 21.0, 30.0));
        assert!(cloud.points[1].x.is_nan(), "no echo");
        assert_eq!(cloud.points[2], Vec3::new(8.0, 20.0, 30.0));
        assert_eq!(cloud.points[5], Vec3::new(4.0, 5.0, 6.0));
        assert_eq!(column(&cloud, "scan"), [0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
        assert_eq!(column(&cloud, "row"), [0.0, 1.0, 0.0, 1.0, 0.0, 1.0]);
        assert_eq!(column(&cloud, "column"), [0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
        assert_eq!(column(&cloud, "intensity")[3], 1.0);
        assert_eq!(column(&cloud, "red")[4..], [255.0, 1.0]);
        assert!(column(&cloud, "red")[..4].iter().all(|red| red.is_nan()), "the first scan has no colours");
        assert_eq!(cloud.viewpoints().collect::<Vec<_>>(), [Vec3::new(10.0, 20.0, 30.0)]);
    }
}

#[test]
fn ptx_that_is_wrong_names_its_line() {
    let lines: Vec<&str> = TWO.lines().collect();
    for keep in 11..lines.len() {
        // The first scan is whole there.
        if keep != 14 {
            let told = refused(&lines[..keep].join("\n"));
            assert!(told.contains("cut off"), "{keep}: {told}");
        }
    }
    let told = refused(&TWO.replace("0 1 0 0\n", "0 2 0 0\n"));
    assert!(told.contains("line 7") && told.contains("no rotation"), "{told}");
    assert!(refused(&TWO.replace("0 2 0 0.25", "0 2 0 0.25 1 2 3")).contains("line 13: PTX: 7 numbers"));
    assert!(refused(&TWO.replace("0 2 0 0.25", "0 2 zero 0.25")).contains("line 13: PTX: x y z intensity"));
    assert!(refused(&TWO.replace("255 0 7", "256 0 7")).contains("from 0 to 255"));
    assert!(refused(&TWO.replace("2\n2\n10", "4000000000\n4000000000\n10")).contains("fewer"));
}
