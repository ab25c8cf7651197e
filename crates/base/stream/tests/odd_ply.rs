//! PLY files as other programs write them: what must be read, and what must be refused.
//!
//! Each file is here with its name. The reasons for a reader of our own are in `crates/base/stream/README.md`.

use stream::{Values, ply};

/// A file with its name.
type File = (&'static str, &'static [u8]);

/// Header of an ASCII file with two rows of `x` (float) and `label` (int).
macro_rules! two_rows {
    ($($rows:literal),+) => {
        concat!(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty int label\nend_header\n",
            $($rows),+
        ).as_bytes()
    };
}

/// Odd but clear: read.
const READ: [File; 13] = [
    ("plain", two_rows!("0.5 2\n", "1.5 3\n")),
    ("nan", two_rows!("nan 2\n", "NaN 3\n")),
    ("-nan of glibc", two_rows!("-nan 2\n", "nan(0x8000) 3\n")),
    ("infinities", two_rows!("inf 2\n", "-Infinity 3\n")),
    ("-1.#IND of Windows", two_rows!("-1.#IND 2\n", "1.#QNAN 3\n")),
    ("1.#INF of Windows", two_rows!("1.#INF 2\n", "-1.#INF 3\n")),
    ("no digit before or after the point", two_rows!(".5 2\n", "1. 3\n")),
    ("an integer with a point", two_rows!("0.5 2.0\n", "1.5 3e0\n")),
    ("empty lines", two_rows!("\n0.5 2\n", "  \n\n", "1.5 3\n\n\n")),
    ("a last line without its end", two_rows!("0.5 2\n", "1.5 3")),
    (
        "CR line ends",
        b"ply\rformat ascii 1.0\relement vertex 2\rproperty float x\rproperty int label\rend_header\r0.5 2\r1.5 3\r",
    ),
    (
        "a comment in Latin-1",
        b"ply\nformat ascii 1.0\ncomment Aufl\xf6sung 1 \xb5m\nelement vertex 2\nproperty float x\nproperty int label\n\
          end_header\n0.5 2\n1.5 3\n",
    ),
    (
        "a property name with brackets",
        b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty int label\n\
          property float Height_[m](1)\nend_header\n0.5 2 7\n1.5 3 8\n",
    ),
];

/// The two numbers of `x` in each file of [`READ`].
const X: [[f32; 2]; READ.len()] = {
    const NAN: [f32; 2] = [f32::NAN; 2];
    const INFINITE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];
    const PLAIN: [f32; 2] = [0.5, 1.5];
    const POINT: [f32; 2] = [0.5, 1.0];
    [PLAIN, NAN, NAN, INFINITE, NAN, INFINITE, POINT, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN]
};

#[test]
fn odd_files_are_read() {
    for ((name, bytes), expected) in READ.iter().zip(X) {
        let file = ply::parse(bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        let vertex = file.element("vertex").expect(name);
        let Some(Values::F32(x)) = vertex.table.get("x") else { panic!("{name}: x") };
        let same = |a: f32, b: f32| a == b || (a.is_nan() && b.is_nan());
        assert!(x.len() == 2 && same(x[0], expected[0]) && same(x[1], expected[1]), "{name}: {x:?}");
        assert_eq!(vertex.table.get("label"), Some(&Values::I32(vec![2, 3])), "{name}");
    }
    let (_, brackets) = READ[READ.len() - 1];
    let file = ply::parse(brackets).expect("read above");
    assert_eq!(file.elements[0].table.get("Height_[m](1)"), Some(&Values::F32(vec![7.0, 8.0])));
}

/// Wrong: refused, with a message that has these words.
const REFUSED: [(File, &str); 9] = [
    (
        ("a row too many", two_rows!("0.5 2\n", "1.5 3\n", "2.5 4\n")),
        "6 bytes follow the last row (from byte 97): the header's counts do not fit",
    ),
    (
        ("a value too many in a row", two_rows!("0.5 2 9\n", "1.5 3\n")),
        "line 7: element 'vertex', row 0 has 1 values too many, from '9' on",
    ),
    (
        ("a value too many in the last row", two_rows!("0.5 2\n", "1.5 3 9\n")),
        "line 8: element 'vertex', row 1 has 1 values too many, from '9' on",
    ),
    (
        ("a row too few", two_rows!("0.5 2\n")),
        "the header promises 2 rows, the data ends in row 1",
    ),
    (
        ("a value too few in a row", two_rows!("0.5\n", "1.5 3\n")),
        "line 7: element 'vertex', row 0, property 'label': 'nothing' is not a int",
    ),
    (
        ("a fraction in an integer column", two_rows!("0.5 2.5\n", "1.5 3\n")),
        "line 7: element 'vertex', row 0, property 'label': '2.5' is not a int",
    ),
    (
        (
            "bytes after binary rows",
            b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty uchar x\nend_header\n\x01\x02\x03",
        ),
        "1 bytes follow the last row",
    ),
    (
        (
            "one property name twice",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float x\nend_header\n1 2\n",
        ),
        "line 5: this name occurs twice in its element: 'property float x'",
    ),
    (
        (
            "one element name twice",
            b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement vertex 1\nproperty float x\n\
              end_header\n1\n2\n",
        ),
        "line 5: a second element of this name: 'element vertex 1'",
    ),
];

#[test]
fn wrong_files_are_refused_with_the_place() {
    for ((name, bytes), expected) in REFUSED {
        let message = match ply::parse(bytes) {
            Err(error) => error.to_string(),
            Ok(file) => panic!("{name}: read as {file:?}"),
        };
        assert!(message.contains(expected), "{name}: {message:?} should say {expected:?}");
    }
}
