//! Matrices and points by hand.

use super::*;

/// A quarter turn about z, then (10, 20, 30): x̂ ↦ ŷ, ŷ ↦ −x̂.
const QUARTER: &str = "0 -1 0 10\n1 0 0 20\n0 0 1 30\n0 0 0 1\n";

#[test]
fn a_quarter_turn_and_a_shift_by_hand() {
    let forms = [
        QUARTER,
        "0,-1,0,10, 1,0,0,20, 0,0,1,30, 0,0,0,1",
        "# registration\n0 -1 0 10 1 0 0 20\n// of a scan\n0 0 1 30 0 0 0 1",
        "\u{feff}[[0. -1. 0. 10.]\r\n [1. 0. 0. 20.]\r\n [0. 0. 1. 30.]\r\n [0. 0. 0. 1.]]",
        "0;-1;0;1e1\t1;0;0;2e1\t0;0;1;3e1\t0;0;0;1",
    ];
    for text in forms {
        let moved = Transform::parse(text).unwrap();
        assert_eq!(moved.point(&Vec3::new(1.0, 2.0, 3.0)), Vec3::new(8.0, 21.0, 33.0), "{text}");
        assert_eq!(moved.direction(&Vec3::x()), Vec3::y());
        assert_eq!((moved.factor(), moved.rounding()), (None, 0.0));
        assert_eq!(Transform::of_rows(&moved.rows()), Ok(moved));
    }
    assert!(
        Transform::is_numbers(forms[1]) && Transform::is_numbers("1 2") && Transform::is_numbers("nan,1")
    );
    assert!(
        !Transform::is_numbers("scan 1.txt") && !Transform::is_numbers("7") && !Transform::is_numbers("")
    );
}

#[test]
fn a_factor_moves_points_and_turns_directions_alone() {
    let moved = Transform::parse("0 0 0.002 1  0.002 0 0 2  0 0.002 0 3  0 0 0 1").unwrap();
    assert_eq!(moved.point(&Vec3::new(1e3, 2e3, 3e3)), Vec3::new(7.0, 4.0, 7.0));
    assert!((moved.factor().unwrap() - 0.002).abs() < 1e-17);
    assert!((moved.direction(&Vec3::new(0.6, 0.0, 0.8)) - Vec3::new(0.8, 0.6, 0.0)).norm() < 1e-15);
}

#[test]
fn few_digits_turn_directions_without_stretching_them() {
    let moved = Transform::parse("0.866 -0.5 0 0 0.5 0.866 0 0 0 0 1 0 0 0 0 1").unwrap();
    assert_eq!(moved.point(&Vec3::x()), Vec3::new(0.866, 0.5, 0.0), "positions follow the numbers");
    assert!((moved.direction(&Vec3::x()).norm() - 1.0).abs() < 1e-15, "directions keep their length");
    assert_eq!(moved.factor(), None);
    // Columns of length √0.999956 and 1, their mean 0.999985: 1 / 0.999985² − 1.
    assert!((moved.rounding() - 2.93e-5).abs() < 1e-7, "{}", moved.rounding());
}

#[test]
fn what_is_no_rigid_motion_is_refused_with_its_place_and_a_cure() {
    let cases = [
        ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0", "15 numbers where a matrix has 16"),
        ("", "0 numbers"),
        ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 7", "17 numbers"),
        ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", "the last row is 0 0 0 2: it must be 0 0 0 1"),
        ("1 0 0 5 0 1 0 0 0 0 1 0 0.5 0 0 1", "the last row is 0.5 0 0 1"),
        ("1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1", "the shift stands in the last row (5 6 7 1)"),
        ("1 0 0 0 0 nan 0 0 0 0 1 0 0 0 0 1", "number 6 (row 2, column 2) is 'nan'"),
        ("1 0 0 1e101 0 1 0 0 0 0 1 0 0 0 0 1", "number 4 (row 1, column 4) is '1e101'"),
        ("1 0 0 inf 0 1 0 0 0 0 1 0 0 0 0 1", "is 'inf'"),
        ("1 0 0 zero 0 1 0 0 0 0 1 0 0 0 0 1", "is 'zero'"),
        ("1 0.1 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "the matrix distorts"),
        ("1 0 0 0 0 2 0 0 0 0 1 0 0 0 0 1", "2.000000 and 1.000000 long"),
        ("-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "the matrix mirrors (its determinant is -1.000000)"),
        ("0 1 0 0 1 0 0 0 0 0 1 0 0 0 0 1", "the matrix mirrors"),
        ("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1", "multiplies lengths by 0"),
        ("1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1", "the matrix"),
    ];
    for (text, part) in cases {
        let why = Transform::parse(text).unwrap_err().to_string();
        assert!(why.contains(part), "{text}: {why}");
    }
}
