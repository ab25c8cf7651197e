//! OBJ as other programs write it.

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn refused(text: &str) -> String {
    mesh::from_bytes(text.as_bytes()).expect_err(text).to_string()
}

#[test]
fn lines_and_points_are_no_faces() {
    let text = format!("{SQUARE}v 5 0 0\nv 5 0 2\nv 6 0 2\nf 1 2 3 4\nl 5 6 7\nl 5 6\np 5\n");
    let contents = mesh::contents(text.as_bytes()).expect("sound");
    assert_eq!((contents.mesh.vertices.len(), contents.mesh.faces.len()), (4, 2));
    assert_eq!(
        contents.notes,
        ["2 lines (l) were left out: they are no surface", "1 points (p) were left out: they are no surface"]
    );
    let only = mesh::contents(format!("{SQUARE}l 1 2 3\n").as_bytes()).expect("sound");
    assert_eq!((only.mesh.vertices.len(), only.mesh.faces.len()), (4, 0));
    assert!(refused(SQUARE).contains("no face"));
}

#[test]
fn a_file_that_ends_within_a_face_is_refused_with_its_line() {
    for end in
        ["f 2 3", "f 2", "f", "f 1/1/1 2/2/2 3/", "f 1/1/1 2/2/2 3", "f 1//1 2//1 3//1 4/", "f 1 2 3 \\"]
    {
        let told = refused(&format!("{SQUARE}f 1 2 3\n{end}"));
        assert!(told.contains("line 6") && told.contains("cut off"), "{end}: {told}");
    }
    for (text, words) in [
        ("f 1 2 x", "'x' is not the number of a vertex"),
        ("f 1 2 0", "no vertex 0"),
        ("f 1 2 -9", "no vertex -9"),
    ] {
        let told = refused(&format!("{SQUARE}f 1 2 3\n{text}\n"));
        assert!(told.contains("line 6: face 2") && told.contains(words), "{text}: {told}");
    }
    let told = refused(&format!("{SQUARE}f 1 2 3\n\nf 1 2 9\n"));
    assert!(told.contains("line 7: face 2: vertex 9 of 4"), "{told}");
    assert!(refused("v 0 0 0\nv 1 0\nf 1 1 1\n").contains("line 2: a vertex is not three numbers"));
}

#[test]
fn any_encoding_continued_lines_and_indices_from_the_end() {
    let mut latin = b"# Geh\xe4use\ng K\xf6rper\n".to_vec();
    latin.extend(SQUARE.as_bytes());
    latin.extend(b"f 1/1 2/2 \\\n 3/3 4/4 # the floor\ns off\nf -4 -2 -1\n");
    let mesh = mesh::from_bytes(&latin).expect("sound");
    assert_eq!(mesh.faces, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
    // A vertex may carry a colour or a weight, and stand behind the face.
    let later = mesh::from_bytes(b"v 0 0 0 1 0 0\nf 1 2 3\nv 1 0 0 0.5\nv 0 1 0\n").expect("sound");
    assert_eq!((later.faces.len(), later.area()), (1, 0.5));
}

/// A mark in front of the first `v` took that vertex, and with it the number of all others.
#[test]
fn a_byte_order_mark_takes_no_vertex() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf -3 -2 -1\n";
    let plain = mesh::from_bytes(text.as_bytes()).expect("sound");
    let marked = mesh::from_bytes(format!("\u{feff}{text}").as_bytes()).expect("sound");
    assert_eq!((plain.vertices, plain.faces), (marked.vertices, marked.faces));
}
