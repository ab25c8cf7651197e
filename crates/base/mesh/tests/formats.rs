//! One tetrahedron in every format is one mesh.

use geom::mesh::TriMesh;

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

fn ascii_stl() -> String {
    let facet = |f: &[usize; 3]| {
        let corner = |&v: &usize| format!("vertex {} {} {}\n", CORNERS[v][0], CORNERS[v][1], CORNERS[v][2]);
        format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            f.iter().map(corner).collect::<String>()
        )
    };
    format!("solid a b\n{}endsolid a b\n", FACES.iter().map(facet).collect::<String>())
}

fn binary_stl(head: &[u8]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0u8; 12]);
        face.iter().flat_map(|&v| CORNERS[v]).for_each(|c| bytes.extend((c as f32).to_le_bytes()));
        bytes.extend([0u8; 2]);
    }
    bytes
}

fn obj() -> String {
    let v: String = CORNERS.iter().map(|c| format!("v {} {} {}\r\n", c[0], c[1], c[2])).collect();
    let f = |f: &[usize; 3]| format!("f {}//1 {}//1 {}//1\r\n", f[0] + 1, f[1] + 1, f[2] + 1);
    format!(
        "# drawn\nmtllib none.mtl\no part\n{v}vn 0 0 1\nusemtl x\n{}",
        FACES.iter().map(f).collect::<String>()
    )
}

fn triangles() -> String {
    let line = |f: &[usize; 3]| {
        f.iter().flat_map(|&v| CORNERS[v]).map(|c| c.to_string()).collect::<Vec<_>>().join("\t") + "\n"
    };
    format!("vertex1_X[m] and so on\n{}", FACES.iter().map(line).collect::<String>())
}

fn ply() -> String {
    let v: String = CORNERS.iter().map(|c| format!("{} {} {}\n", c[0], c[1], c[2])).collect();
    let f: String = FACES.iter().map(|f| format!("3 {} {} {}\n", f[0], f[1], f[2])).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 4\nproperty list uchar int vertex_indices\nend_header\n{v}{f}"
    )
}

fn all() -> [(&'static str, Vec<u8>); 6] {
    [
        ("PLY", ply().into_bytes()),
        ("ASCII STL", ascii_stl().into_bytes()),
        ("binary STL", binary_stl(b"made by a program")),
        ("binary STL that begins with solid", binary_stl(b"solid part")),
        ("OBJ", obj().into_bytes()),
        ("triangles", triangles().into_bytes()),
    ]
}

fn check(name: &str, mesh: &TriMesh) {
    let mesh = mesh.welded();
    assert_eq!((mesh.vertices.len(), mesh.faces.len(), mesh.open_edges()), (4, 4, 0), "{name}");
    assert!((mesh.volume() - 1.0).abs() < 1e-12, "{name}: {}", mesh.volume());
}

#[test]
fn every_format_gives_the_same_closed_tetrahedron() {
    for (name, bytes) in all() {
        check(name, &mesh::from_bytes(&bytes).unwrap_or_else(|e| panic!("{name}: {e}")));
    }
}

#[test]
fn a_file_cut_anywhere_is_an_error_or_a_mesh_of_whole_faces_and_never_a_panic() {
    for (name, bytes) in all() {
        for cut in 0..bytes.len() {
            if let Ok(mesh) = mesh::from_bytes(&bytes[..cut]) {
                // Text without an end mark may lose whole lines unseen, and nothing else.
                assert!(
                    ["OBJ", "triangles"].contains(&name) || cut + 12 > bytes.len(),
                    "{name} cut at {cut}"
                );
                assert!(!mesh.faces.is_empty() && mesh.faces.len() <= 4, "{name} cut at {cut}");
            }
        }
    }
    let told = mesh::from_bytes(&binary_stl(b"x")[..200]).unwrap_err().to_string();
    assert!(told.contains("promises 4") && told.contains("holds 2"), "{told}");
}

/// A solid with these corners, a face for each three.
fn solid(name: &str, corners: &[[f64; 3]]) -> String {
    let facet = |face: &[[f64; 3]]| {
        let corner = |c: &[f64; 3]| format!("  vertex {:.4} {:.4} {:.4}\n", c[0], c[1], c[2]);
        let corners: String = face.iter().map(corner).collect();
        format!("facet normal nan nan nan\n outer loop\n{corners} endloop\nendfacet\n")
    };
    format!("solid {name}\n{}endsolid {name}\n", corners.chunks(3).map(facet).collect::<String>())
}

/// A drawing of several parts is all of them, whatever they are called, and one that ends within any of them is cut off.
#[test]
fn all_solids_of_a_file_are_read() {
    let at = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    let names = ["", "hopper", "facet normal 1 2 3", "endsolid", "G\u{fc}te solid", "a vertex 1"];
    let parts: Vec<String> =
        names.iter().zip(0..).map(|(name, k)| solid(name, &at(3.0 * f64::from(k)))).collect();
    let all = parts.concat();
    let same = |text: &[u8], what: &str| {
        let mesh = mesh::from_bytes(text).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!((mesh.vertices.len(), mesh.faces.len()), (18, 6), "{what}");
    };
    same(all.as_bytes(), "as it is");
    same(all.replace('\n', "\r\n").as_bytes(), "CRLF");
    same(all.replace('\n', "\r").as_bytes(), "CR");
    same(format!("\u{feff}\n  {all}").as_bytes(), "a mark, a blank line");
    same(all.replace("endsolid hopper", "# made by hand\nendsolid hopper").as_bytes(), "a remark");
    let latin = all.bytes().map(|b| if b == b'h' { 0xE9 } else { b }).collect::<Vec<u8>>();
    assert!(mesh::from_bytes(&latin).is_ok(), "a name in another encoding");
    for (n, part) in parts.iter().enumerate() {
        let cut: usize = parts[..n].iter().map(String::len).sum::<usize>() + part.len() / 2;
        let told = mesh::from_bytes(&all.as_bytes()[..cut]).unwrap_err().to_string();
        assert!(told.contains("cut off") || told.contains("STL"), "part {n}: {told}");
    }
    let broken = all.replacen("vertex 3.0000 0.0000 0.0000", "vertex 3.0000 0,5 0.0000", 1);
    let told = mesh::from_bytes(broken.as_bytes()).unwrap_err().to_string();
    assert!(told.contains("line 13") && told.contains("three numbers"), "{told}");
}

/// Map coordinates keep their digits in text; a name may be longer than a block of any reader.
#[test]
fn numbers_of_text_are_read_in_double_precision() {
    let corners =
        [[500_000.1, 5_849_000.1, 0.0], [500_000.2, 5_849_000.1, 0.0], [500_000.1, 5_849_000.2, 0.0]];
    let mesh = mesh::from_bytes(solid(&"long".repeat(2000), &corners).as_bytes()).expect("sound");
    let read: Vec<[f64; 3]> = mesh.vertices.iter().map(|v| [v.x, v.y, v.z]).collect();
    assert_eq!(read, corners);
}

/// What a binary file is follows from its length and its count, whatever its head says.
#[test]
fn heads_of_binary_files_say_nothing() {
    let heads: [&[u8]; 4] =
        [b"solid part\nfacet normal 0 0 0\n", b"solid", b"  solid endsolid", b"facet normal"];
    for head in heads {
        let whole = binary_stl(head);
        for end in [&b""[..], b"\0\0", b"endsolid\n"] {
            let told = String::from_utf8_lossy(head).into_owned();
            let bytes = [&whole[..], end].concat();
            // With something behind, text in the head is taken at its word.
            if !end.is_empty() && (head.starts_with(b"solid") || head.starts_with(b"  solid")) {
                continue;
            }
            let mesh = mesh::from_bytes(&bytes).unwrap_or_else(|e| panic!("{told:?}: {e}"));
            assert_eq!(mesh.faces.len(), 4, "{told:?}");
        }
    }
    let mut none = binary_stl(b"x");
    none[80..84].fill(0);
    let told = mesh::from_bytes(&none).unwrap_err().to_string();
    assert!(told.contains("promises 0") && told.contains("holds 4"), "{told}");
}

#[test]
fn what_is_no_mesh_is_named() {
    let cloud = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
    for (bytes, words) in [
        (&b""[..], "input is empty"),
        (b"ISO-10303-21;\nHEADER;\n", "this is STEP"),
        (b"\nISO-10303-21;\nHEADER;\n", "export STL"),
        (b"hello world", "'hello world'"),
        (cloud.as_bytes(), "a cloud, not a mesh"),
        (b"v 0 0 0\nv 1 0 0\nf 1 2 9\n", "OBJ"),
        (b"v 0 0 0\nv 1 0 nan\nv 1 1 1\nf 1 2 3\n", "not finite"),
        (b"0 0 0 1 0 0 0 1 0\n1 2 3\n", "line 2"),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no face"),
    ] {
        let told = mesh::from_bytes(bytes).unwrap_err().to_string();
        assert!(told.contains(words), "{told}");
    }
}
