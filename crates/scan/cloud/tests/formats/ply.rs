//! PLY: every property, meshes, and what other programs write.

use super::{read, refused};
use geom::Vec3;
use stream::Values;

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
