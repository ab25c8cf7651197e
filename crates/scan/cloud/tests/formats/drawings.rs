//! STL and OBJ as clouds of their corners.

use super::read;

/// Binary STL has 4-byte numbers: at map coordinates they have lost their digits, and near the origin they have not.
#[test]
fn binary_stl_at_map_coordinates_prints_a_warning() {
    let stl = |x: f32| {
        let mut bytes = [&[0u8; 80][..], &200u32.to_le_bytes()].concat();
        for k in 0..200u8 {
            let (i, j) = (x + 0.1 * f32::from(k / 10), 0.1 * f32::from(k % 10));
            let corners =
                [0.0, 0.0, 1.0, i, j, 0.0, i + 0.1, j, 0.0, i, j + 0.1, 0.0].map(|c: f32| c.to_le_bytes());
            bytes.extend([&corners.concat()[..], &[0; 2]].concat());
        }
        read(bytes).warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(stl(0.0), [""; 0]);
    assert!(stl(5_849_000.0)[0].contains("4-byte numbers"), "{:?}", stl(5_849_000.0));
}

/// STL and OBJ are clouds of their corners, each once, and STEP says what to do.
#[test]
fn a_drawing_is_a_cloud_of_its_corners() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mut binary = b"a part".to_vec();
    binary.resize(80, 0);
    binary.extend(4u32.to_le_bytes());
    let mut ascii = "solid part\n".to_owned();
    let mut obj: String = corners.iter().map(|c| format!("v {} {} {}\n", c[0], c[1], c[2])).collect();
    for face in faces {
        binary.extend([0u8; 12]);
        face.iter()
            .flat_map(|&v: &usize| corners[v])
            .for_each(|c: f64| binary.extend((c as f32).to_le_bytes()));
        binary.extend([0u8; 2]);
        let vertex = |&v: &usize| format!("vertex {} {} {}\n", corners[v][0], corners[v][1], corners[v][2]);
        let three: String = face.iter().map(vertex).collect();
        ascii += &format!("facet normal 0 0 0\nouter loop\n{three}endloop\nendfacet\n");
        obj += &format!("f {} {} {}\n", face[0] + 1, face[1] + 1, face[2] + 1);
    }
    ascii += "endsolid part\n";
    for bytes in [binary, ascii.into_bytes(), obj.into_bytes()] {
        let mut points = cloud::read(bytes.as_slice()).unwrap().points;
        points.sort_by(|a, b| a.z.total_cmp(&b.z).then(a.y.total_cmp(&b.y)).then(a.x.total_cmp(&b.x)));
        assert_eq!(points, corners.map(geom::Vec3::from));
    }
    let remarks = cloud::read(&b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nl 1 4\n"[..]).unwrap();
    assert_eq!(
        (remarks.points.len(), &remarks.comments[..]),
        (
            3,
            &[
                "the corners of 1 triangles".to_owned(),
                "1 lines (l) were left out: they are no surface".to_owned()
            ][..]
        )
    );
    let vertices = cloud::read(&b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"[..]).unwrap();
    assert_eq!(
        (vertices.points.len(), &vertices.comments[0][..]),
        (3, "the vertices of a drawing without faces")
    );
    let told = cloud::read(&b"ISO-10303-21;\nHEADER;\n"[..]).unwrap_err().to_string();
    assert!(told.contains("this is STEP") && told.contains("export STL"), "{told}");
}
