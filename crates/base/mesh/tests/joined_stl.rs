//! Binary STL with more behind its triangles than its head counts.

/// A solid of `count` triangles at x, whose head counts `promised`.
fn stl(head: &[u8], count: u8, promised: u32, x: f32) -> Vec<u8> {
    let mut bytes = [head, &vec![0; 80 - head.len()], &promised.to_le_bytes()].concat();
    for k in 0..count {
        let y = f32::from(k);
        let numbers = [0.0, 0.0, 1.0, x, y, 0.0, x + 1.0, y, 0.0, x, y + 1.0, 0.0];
        bytes.extend(numbers.map(f32::to_le_bytes).concat());
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn files_that_were_joined_are_all_read() {
    for heads in [[&b"one"[..], b"two", b"three"], [b"one", b"solid two", b"solid three"]] {
        let parts = [0, 1, 2].map(|k| stl(heads[k], 4 - k as u8, 4 - k as u32, 10.0 * k as f32));
        for end in [&b""[..], b"\0\0", b"endsolid\n"] {
            let mesh = mesh::from_bytes(&[&parts.concat()[..], end].concat()).unwrap();
            assert_eq!(mesh.faces.len(), 4 + 3 + 2);
            assert!(mesh.vertices.iter().any(|v| v.x == 21.0), "the last one");
        }
    }
}

#[test]
fn more_triangles_than_the_head_counts_are_refused() {
    let short = stl(b"x", 4, 2, 0.0);
    let cut = [stl(b"one", 4, 4, 0.0), stl(b"two", 4, 4, 9.0)].concat();
    let other = [&stl(b"x", 4, 4, 0.0)[..], &[7; 200]].concat();
    for (bytes, count, left) in [(&short[..], 2, 100), (&cut[..cut.len() - 1], 4, 283), (&other, 4, 200)] {
        let told = mesh::from_bytes(bytes).unwrap_err().to_string();
        let parts = [
            format!("promises {count} triangles"),
            format!("{left} bytes follow"),
            "export it again".to_owned(),
        ];
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    }
    let less = [&stl(b"x", 4, 4, 0.0)[..], &[7; 49]].concat();
    assert_eq!(mesh::from_bytes(&less).unwrap().faces.len(), 4, "less than a triangle is none");
}
