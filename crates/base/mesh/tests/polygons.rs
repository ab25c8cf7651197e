//! Faces of more than three corners are covered by their triangles, whichever corner is first.

use geom::{Vec3, mesh::TriMesh};

fn obj(corners: &[[f64; 3]], first: usize) -> String {
    let n = corners.len();
    let vertices: String = corners.iter().map(|c| format!("v {} {} {}\n", c[0], c[1], c[2])).collect();
    let face: String = (0..n).map(|k| format!(" {}", (k + first) % n + 1)).collect();
    format!("{vertices}f{face}\n")
}

fn ply(corners: &[[f64; 3]], first: usize) -> String {
    let n = corners.len();
    let vertices: String = corners.iter().map(|c| format!("{} {} {}\n", c[0], c[1], c[2])).collect();
    let face: String = (0..n).map(|k| format!(" {}", (k + first) % n)).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex {n}\nproperty double x\nproperty double y\nproperty double z\n\
         element face 1\nproperty list ushort int vertex_indices\nend_header\n{vertices}{n}{face}\n"
    )
}

fn read(text: &str) -> TriMesh {
    mesh::from_bytes(text.as_bytes()).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// The sum of the areas of the triangles, and the area of what they enclose as a whole [m²].
fn areas(mesh: &TriMesh) -> (f64, f64) {
    let vector: Vec3 = mesh.triangles().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a))).sum();
    (mesh.area(), vector.norm())
}

/// Corners on the plane z = 0, put onto another plane and scaled.
fn placed(flat: &[(f64, f64)], place: usize) -> Vec<[f64; 3]> {
    let at = |&(x, y): &(f64, f64)| match place {
        0 => [x, y, 0.0],
        1 => [0.0, x, y],
        2 => [500_000.0 + x, 5_800_000.0 + 0.6 * y, 0.8 * y],
        _ => [1e-3 * y, 1e-3 * x, 1e-3 * (x + y)],
    };
    flat.iter().map(at).collect()
}

/// A comb, a spiral, a star, an L with corners on its edges, a frame whose hole hangs on a bridge.
fn shapes() -> Vec<(&'static str, Vec<(f64, f64)>)> {
    let l = vec![(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let on_edges = vec![
        (0.0, 0.0),
        (1.0, 0.0),
        (2.0, 0.0),
        (2.0, 0.5),
        (2.0, 1.0),
        (1.5, 1.0),
        (1.0, 1.0),
        (1.0, 1.5),
        (1.0, 2.0),
        (0.5, 2.0),
        (0.0, 2.0),
        (0.0, 1.0),
    ];
    let mut comb = vec![(0.0, 0.0), (21.0, 0.0)];
    (0..10).rev().for_each(|k| {
        let x = 2.0 * f64::from(k);
        comb.extend([(x + 2.0, 3.0), (x + 1.0, 3.0), (x + 1.0, 1.0), (x + 0.5, 1.0)]);
    });
    let star = (0..14).map(|k| {
        let (angle, r) = (f64::from(k) * std::f64::consts::PI / 7.0, if k % 2 == 0 { 2.0 } else { 0.7 });
        (r * angle.cos(), r * angle.sin())
    });
    let arm = |k: i32, r: f64| (f64::from(k) * 0.3, r + 0.1 * f64::from(k) * 0.3);
    let outer = (0..40).map(|k| arm(k, 1.3)).collect::<Vec<_>>();
    let inner = (0..40).rev().map(|k| arm(k, 1.0));
    let spiral = outer.into_iter().chain(inner).map(|(angle, r)| (r * angle.cos(), r * angle.sin()));
    let frame = vec![
        (0.0, 0.0),
        (3.0, 0.0),
        (3.0, 3.0),
        (0.0, 3.0),
        (0.0, 0.0),
        (1.0, 1.0),
        (1.0, 2.0),
        (2.0, 2.0),
        (2.0, 1.0),
        (1.0, 1.0),
    ];
    vec![
        ("L", l),
        ("L with corners on its edges", on_edges),
        ("comb", comb),
        ("star", star.collect()),
        ("spiral", spiral.collect()),
        ("frame", frame),
    ]
}

fn shoelace(flat: &[(f64, f64)]) -> f64 {
    let next = flat.iter().skip(1).chain(flat.first());
    flat.iter().zip(next).map(|(a, b)| 0.5 * (a.0 * b.1 - b.0 * a.1)).sum::<f64>().abs()
}

#[test]
fn a_concave_face_is_covered_and_its_notch_is_not() {
    for (name, flat) in shapes() {
        let back: Vec<(f64, f64)> = flat.iter().rev().copied().collect();
        for (flat, place) in (0..4).flat_map(|place| [(&flat, place), (&back, place)]) {
            let corners = placed(flat, place);
            let scale = [1.0, 1.0, 1.0, 1e-6 * 3f64.sqrt()][place];
            for first in 0..corners.len() {
                for text in [obj(&corners, first), ply(&corners, first)] {
                    let mesh = read(&text);
                    let (sum, whole) = areas(&mesh);
                    let wanted = scale * shoelace(flat);
                    let near = |found: f64| (found / wanted - 1.0).abs() < 1e-6;
                    assert!(near(sum) && near(whole), "{name} {place} {first}: {sum} {whole} {wanted}");
                    assert_eq!(mesh.faces.len(), corners.len() - 2, "{name}: every corner stays one");
                }
            }
        }
    }
}

/// The triangles of the same face from another first corner are the same.
#[test]
fn the_first_corner_of_a_concave_face_says_nothing() {
    for (name, flat) in shapes().into_iter().filter(|(name, _)| *name != "frame") {
        // Not quite flat: other triangles would be another surface.
        let corners: Vec<[f64; 3]> = flat.iter().map(|(x, y)| [*x, *y, 0.01 * x * y]).collect();
        let set = |first: usize| {
            let mesh = read(&ply(&corners, first));
            let key = |v: u32| {
                let p = mesh.vertices[v as usize];
                [p.x.to_bits(), p.y.to_bits()]
            };
            let mut faces: Vec<_> = mesh
                .faces
                .iter()
                .map(|f| {
                    let mut three = f.map(key);
                    three.sort_unstable();
                    three
                })
                .collect();
            faces.sort_unstable();
            faces
        };
        assert!((1..corners.len()).all(|first| set(first) == set(0)), "{name}");
    }
}

#[test]
fn convex_faces_stay_fans_also_if_bent_or_rounded() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.3], [0.0, 1.0, 0.0]];
    let fan = |n: u32| (2..n).map(|k| [0, k - 1, k]).collect::<Vec<_>>();
    assert_eq!(read(&ply(&square, 0)).faces, fan(4));
    let turn = std::f64::consts::TAU / 9.0;
    let round = |k: i32| ((f64::from(k) * turn).cos() as f32, (f64::from(k) * turn).sin() as f32);
    let nine: Vec<[f64; 3]> = (0..9).map(round).map(|(x, y)| [x.into(), y.into(), 7.0]).collect();
    assert_eq!(read(&ply(&nine, 0)).faces, fan(9));
    // Corners on edges, off by the last bit of 4 bytes.
    let third = f64::from(1f32 / 3.0);
    let edge = [
        [0.0, 0.0, 0.0],
        [1.0, third, 0.0],
        [2.0, 2.0 * third + 6e-8, 0.0],
        [3.0, 1.0, 0.0],
        [0.0, 3.0, 0.0],
    ];
    assert_eq!(read(&ply(&edge, 0)).faces, fan(5));
    let flat = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.5, 0.0, 0.0]];
    assert_eq!(read(&ply(&flat, 0)).faces, fan(4), "without an area");
}

#[test]
fn a_face_that_crosses_itself_is_refused_with_its_number() {
    let bow = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let even = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let star = |k: i32| {
        let angle = f64::from(2 * k) * std::f64::consts::TAU / 5.0;
        [angle.cos(), angle.sin(), 0.0]
    };
    let star: Vec<[f64; 3]> = (0..5).map(star).collect();
    for corners in [&bow[..], &even, &star] {
        for text in [obj(corners, 1), ply(corners, 1)] {
            let told = mesh::from_bytes(text.as_bytes()).unwrap_err().to_string();
            let number = if text.starts_with("ply") { "face 0" } else { "face 1" };
            assert!(
                told.contains(number) && told.contains("cross") && told.contains("triangulate"),
                "{told}"
            );
        }
    }
    let many: Vec<[f64; 3]> = (0..5000)
        .map(|k| {
            let (angle, r) = (f64::from(k) * std::f64::consts::TAU / 5000.0, 1.0 + f64::from(k % 2));
            [r * angle.cos(), r * angle.sin(), 0.0]
        })
        .collect();
    let told = mesh::from_bytes(obj(&many, 0).as_bytes()).unwrap_err().to_string();
    assert!(told.contains("5000 corners") && told.contains("4096"), "{told}");
}
