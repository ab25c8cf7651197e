//! Drawings in 4-byte numbers at map coordinates: every tool that reads a mesh warns.

use grainpipe_tests::tools::line;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// A closed box of 0.4 m with 12 × 8² triangles, its corner at `x` [m], as binary STL and as PLY with 4-byte numbers.
fn write(folder: &Path, x: f32) {
    let mut corners: Vec<[f32; 3]> = Vec::new();
    for face in 0..6 {
        for k in 0..64u8 {
            let at = |i: u8, j: u8| {
                let (u, v) = (0.05 * f32::from(i), 0.05 * f32::from(j));
                let w = if face % 2 == 0 { 0.0 } else { 0.4 };
                let mut p = [[w, u, v], [v, w, u], [u, v, w]][face / 2];
                p[0] += x;
                p
            };
            let (i, j) = (k % 8, k / 8);
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let order = if face % 2 == 0 { [0, 3, 2, 2, 1, 0] } else { [0, 1, 2, 2, 3, 0] };
            corners.extend(order.map(|c| quad[c]));
        }
    }
    let bytes = |c: &[f32; 3]| c.map(f32::to_le_bytes).concat();
    let mut stl = [&[0u8; 80][..], &((corners.len() / 3) as u32).to_le_bytes()].concat();
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        corners.len(),
        corners.len() / 3
    );
    corners.iter().for_each(|[x, y, z]| ply += &format!("{x} {y} {z}\n"));
    for (k, face) in corners.chunks(3).enumerate() {
        stl.extend([&[0; 12][..], &face.iter().map(bytes).collect::<Vec<_>>().concat(), &[0; 2]].concat());
        ply += &format!("3 {} {} {}\n", 3 * k, 3 * k + 1, 3 * k + 2);
    }
    fs::write(folder.join("box.stl"), stl).unwrap();
    fs::write(folder.join("box.ply"), ply).unwrap();
}

const SCENE: &str = "[time]\nuntil = 0.01\n[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n[[contact]]\n\
    between = [\"*\", \"*\"]\nrestitution = 0.5\n[[wall]]\nmesh = \"box.stl\"\nmaterial = \"m\"\n[[fill]]\nmaterial = \"m\"\n\
    shape = \"sphere:-10,0,0,0.1\"\ndiameter = 0.05\ncount = 1\n";

#[test]
fn drawings_in_short_numbers_at_map_coordinates_are_named() {
    let folder = tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("s.toml"), SCENE).unwrap();
    let mut tools: Vec<String> = ["box.stl", "box.ply"]
        .iter()
        .flat_map(|mesh| {
            [
                format!("wallgen --from-mesh {mesh} --radius 0.02 --roughness 0.002 -o a.ply"),
                format!("stone-clean {mesh} -o b.ply"),
                format!("dem-view {mesh} --size 64x64 -o c.png"),
                format!("stone-clump {mesh} --spheres 20 -o d.toml"),
                format!("stone-library {mesh} -o rocks"),
            ]
        })
        .collect();
    tools.extend(["cloud-crop box.stl -o e.ply".to_owned(), "dem-run s.toml -o f.mcap".to_owned()]);
    for (x, lost) in [(0.0, false), (5_849_000.0, true)] {
        write(f, x);
        for words in &tools {
            let _ = fs::remove_dir_all(f.join("rocks"));
            let done = line(f, words);
            // What has lost its digits may be no stone any more.
            assert!(done.code == 0 || lost, "{words}: {}", done.stderr);
            assert_eq!(done.stderr.contains("stand in 4-byte numbers"), lost, "{words}: {}", done.stderr);
            assert_eq!(done.stderr.contains("export the drawing with all digits"), lost, "{words}");
        }
    }
}
