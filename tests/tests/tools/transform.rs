//! `--transform`: geometry that is turned and shifted as it is read, in every tool that reads some.

mod shapes;

use geom::{Transform, Vec3};
use grainpipe_tests::tools::{line, succeed, tool};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::{TempDir, tempdir};

/// x̂ ↦ ŷ ↦ −x̂, then (10, 20, 30), and its inverse.
const QUARTER: &str = "0 -1 0 10\n1 0 0 20\n0 0 1 30\n0 0 0 1\n";
const BACK: &str = "0 1 0 -20 -1 0 0 10 0 0 1 -30 0 0 0 1";

/// A rotation by 0.7 rad about (1, 2, 3), made here so that its digits are those of the machine.
fn rotation() -> [f64; 16] {
    let axis = nalgebra::Unit::new_normalize(Vec3::new(1.0, 2.0, 3.0));
    let turn = nalgebra::Rotation3::from_axis_angle(&axis, 0.7).into_inner();
    let mut all = [0.0; 16];
    for row in 0..3 {
        (0..3).for_each(|column| all[4 * row + column] = turn[(row, column)]);
        all[4 * row + 3] = [637_000.25, 5_849_000.5, 411.125][row];
    }
    all[15] = 1.0;
    all
}

fn numbers(all: &[f64; 16], between: &str) -> String {
    all.map(|v| v.to_string()).join(between)
}

/// A bent sheet of 41 × 41 points 10 mm apart with normals along z, a closed box, and the matrix.
fn inputs() -> TempDir {
    let folder = tempdir().unwrap();
    let mut sheet = "x y z nx ny nz intensity\n".to_owned();
    for k in 0..41 * 41 {
        let (x, y) = (f64::from(k % 41) / 100.0, f64::from(k / 41) / 100.0);
        sheet += &format!("{x} {y} {} 0 0 1 {}\n", x * x / 4.0, k % 7);
    }
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("sheet.xyz", &sheet);
    write("quarter.txt", QUARTER);
    let mesh = geom::mesh::cuboid(Vec3::zeros(), Vec3::new(0.1, 0.2, 0.3));
    let mut bytes = Vec::new();
    cloud::write_mesh(&mut bytes, &mesh, stream::ply::Encoding::Ascii).unwrap();
    fs::write(folder.path().join("box.ply"), bytes).unwrap();
    folder
}

fn read(folder: &Path, name: &str) -> cloud::Cloud {
    cloud::read(fs::File::open(folder.join(name)).unwrap()).unwrap()
}

fn column(cloud: &cloud::Cloud, name: &str) -> Vec<f64> {
    cloud.attributes.get(name).unwrap().to_f64()
}

#[test]
fn a_cloud_is_moved_by_the_numbers_and_its_normals_turn() {
    let folder = inputs();
    let f = folder.path();
    fs::write(f.join("two.csv"), "x,y,z,nx,ny,nz,tone\n1,2,3,1,0,0,7\n-4,0.5,6,0,0.6,0.8,8\n").unwrap();
    for matrix in ["quarter.txt", &QUARTER.replace(['\n', ' '], ",")] {
        let done = tool(
            f,
            "cloud-crop",
            &["two.csv", "--transform", matrix, "-o", "moved.ply", "--report", "r.json"],
        );
        assert_eq!(done.code, 0, "{}", done.stderr);
        let file = if matrix == "quarter.txt" { " quarter.txt" } else { "" };
        assert!(
            done.stderr.contains(&format!("2 of 2 points kept; coordinates moved by --transform{file}\n")),
            "{}",
            done.stderr
        );
        let moved = read(f, "moved.ply");
        assert_eq!(moved.points, [Vec3::new(8.0, 21.0, 33.0), Vec3::new(9.5, 16.0, 36.0)]);
        assert_eq!((column(&moved, "nx"), column(&moved, "ny")), (vec![0.0, -0.6], vec![1.0, 0.0]));
        assert_eq!((column(&moved, "nz"), column(&moved, "tone")), (vec![0.0, 0.8], vec![7.0, 8.0]));
        let report: serde_json::Value = serde_json::from_slice(&fs::read(f.join("r.json")).unwrap()).unwrap();
        assert_eq!(report["transform"][3], 10.0);
    }
    succeed(f, "cloud-crop", &["moved.ply", "--transform", BACK, "-o", "back.ply"]);
    let (back, first) = (read(f, "back.ply"), read(f, "two.csv"));
    assert_eq!(back.points, first.points);
    for name in ["nx", "ny", "nz", "tone"] {
        assert_eq!(column(&back, name), column(&first, name), "{name}");
    }
}

/// Shapes, viewpoints and other places of the options are in the coordinates after the move.
#[test]
fn options_are_in_the_coordinates_after_the_move() {
    let folder = inputs();
    let f = folder.path();
    let shape = "box:9.8,20.1,29,10,20.2,31";
    succeed(f, "cloud-crop", &["sheet.xyz", "--transform", "quarter.txt", "--keep", shape, "-o", "a.ply"]);
    succeed(f, "cloud-crop", &["sheet.xyz", "--keep", "box:0.1,0,-1,0.2,0.2,1", "-o", "b.ply"]);
    let [moved, still] = ["a.ply", "b.ply"].map(|name| read(f, name));
    assert!(still.points.len() > 200 && moved.points.len() == still.points.len());
    let by = Transform::parse(QUARTER).unwrap();
    assert!(moved.points.iter().zip(&still.points).all(|(a, b)| *a == by.point(b)));
    let done = tool(
        f,
        "cloud-crop",
        &["sheet.xyz", "sheet.xyz", "--transform", "quarter.txt", "--scale", "2", "-o", "c.ply"],
    );
    assert!(
        done.code == 0 && done.stderr.contains("3362 of 3362 points kept; coordinates moved"),
        "{}",
        done.stderr
    );
    assert_eq!(
        read(f, "c.ply").points[1],
        Vec3::new(10.0, 20.02, 30.0 + 0.00005),
        "first the scale, then the move"
    );
}

/// The last digits of map coordinates stay, and the matrix back gives the scan again.
#[test]
fn map_coordinates_keep_their_digits() {
    let folder = inputs();
    let f = folder.path();
    let there = rotation();
    let turn = nalgebra::Matrix4::from_row_slice(&there);
    let back = turn.try_inverse().unwrap();
    let back: [f64; 16] = std::array::from_fn(|k| back[(k / 4, k % 4)]);
    fs::write(f.join("there.txt"), numbers(&there, " ")).unwrap();
    fs::write(f.join("back.txt"), numbers(&back, "\n")).unwrap();
    succeed(f, "cloud-crop", &["sheet.xyz", "--transform", "there.txt", "-o", "far.ply"]);
    succeed(f, "cloud-crop", &["far.ply", "--transform", "back.txt", "-o", "near.ply"]);
    let [first, far, near] = ["sheet.xyz", "far.ply", "near.ply"].map(|name| read(f, name));
    for ((p, q), r) in first.points.iter().zip(&far.points).zip(&near.points) {
        let wanted = turn * p.push(1.0);
        assert!((wanted.xyz() - q).amax() <= 1.9e-9, "{q}: two units of the last digit at 5 849 000");
        assert!((p - r).amax() < 6e-9, "{p} {r}");
    }
    let few = numbers(&there.map(|v| (v * 1e4).round() / 1e4), ",");
    let done = tool(f, "cloud-crop", &["far.ply", "--transform", &few, "-o", "off.ply"]);
    assert!(
        done.stderr.contains("--transform has few digits") && done.stderr.contains("m off"),
        "{}",
        done.stderr
    );
}

#[test]
fn every_tool_that_reads_geometry_moves_it_and_reports_it() {
    let folder = inputs();
    let f = folder.path();
    let moved = "coordinates moved by --transform quarter.txt";
    for words in [
        "cloud-fill sheet.xyz -o a.ply",
        "bluenoise-sample sheet.xyz --spacing 0.03 -o b.ply",
        "wallgen sheet.xyz --roughness 0.001 --radius uniform -o c.ply",
        "wallgen --from-mesh box.ply --radius 0.02 --roughness 0.002 -o d.ply",
        "wallgen sheet.xyz --from-mesh box.ply --roughness 0.001 --radius uniform -o e.ply",
        "stone-clean sheet.xyz -o f.ply",
        "stone-clean box.ply -o g.ply",
        "stone-clump box.ply --spheres 100 -o h.ply",
        "dem-view sheet.xyz box.ply --size 240x180 -o i.png",
        "dem-view sheet.xyz -o j.vtp",
    ] {
        let output = words.split_whitespace().last().unwrap();
        let still = line(f, words);
        assert!(still.code == 0 && !still.stderr.contains("coordinates moved"), "{words}: {}", still.stderr);
        let before = fs::read(f.join(output)).unwrap();
        let done = line(f, &format!("{words} --transform quarter.txt"));
        assert!(done.code == 0 && done.stderr.contains(moved), "{words}: {}", done.stderr);
        let after = fs::read(f.join(output)).unwrap();
        assert!(before != after || words.starts_with("dem-view"), "{words}: nothing has moved");
        if output.ends_with(".ply") {
            let of = |bytes: Vec<u8>| cloud::from_bytes(bytes).unwrap().points;
            let middle = |points: &[Vec3]| points.iter().sum::<Vec3>() / points.len() as f64;
            let (before, after) = (of(before), of(after));
            let there = Transform::parse(QUARTER).unwrap().point(&middle(&before));
            // Random samples and new surfaces of the two are not the same to the last point.
            assert!((there - middle(&after)).norm() < 5e-3, "{words}: {there} {}", middle(&after));
        }
    }
}

/// A library has the stones where the matrix puts them, with the same measures; a factor makes its stones and those of a packing larger.
#[test]
fn stones_of_a_library_and_a_packing_are_moved() {
    let folder = inputs();
    let f = folder.path();
    let library = |words: &str, to: &str| {
        let done = line(f, &format!("stone-library box.ply -o {to} {words}"));
        assert!(done.code == 0, "{}", done.stderr);
        assert_eq!(done.stderr.contains("coordinates moved by --transform"), !words.is_empty(), "{words}");
        let mesh = cloud::read_mesh(&mut fs::File::open(f.join(to).join("rock_9_1.ply")).unwrap()).unwrap();
        (mesh, fs::read_to_string(f.join(to).join("table.csv")).unwrap())
    };
    let (still, table) = library("", "still");
    let (moved, again) = library("--transform quarter.txt", "moved");
    let by = Transform::parse(QUARTER).unwrap();
    assert!(still.vertices.iter().map(|v| by.point(v)).eq(moved.vertices.iter().copied()));
    let measures = |table: &str| {
        let row = table.lines().nth(1).unwrap().split(',').skip(5).map(|v| v.parse().unwrap());
        row.collect::<Vec<f64>>()
    };
    let pairs: Vec<(f64, f64)> = measures(&table).into_iter().zip(measures(&again)).collect();
    assert!(pairs.len() > 8 && pairs.iter().all(|(a, b)| (a - b).abs() < 1e-6 * a.abs()), "{pairs:?}");
    let mut soil = "x,y,z,radius\n".to_owned();
    for k in 0..8000 {
        let [x, y, z] = [k % 20, k / 20 % 20, k / 400].map(|n| 0.1 * f64::from(n));
        soil += &format!("{x},{y},{z},0.05\n");
    }
    fs::write(f.join("soil.csv"), soil).unwrap();
    let pack = |words: &str, to: &str| {
        let words = format!(
            "stone-pack soil.csv still --content 0.02 --stone-density 2650 --soil-density 2650 --tolerance 0.9 --least-grains 1 \
             --surfaces {to}.ply -o {to}-all.ply {words}"
        );
        let done = line(f, &words);
        assert!(done.code == 0, "{}", done.stderr);
        let mesh = cloud::read_mesh(&mut fs::File::open(f.join(format!("{to}.ply"))).unwrap()).unwrap();
        (mesh.volume() / (mesh.faces.len() / 12) as f64, done.stderr)
    };
    let ((one, _), (eight, words)) =
        (pack("", "p"), pack("--transform 2,0,0,7,0,2,0,8,0,0,2,9,0,0,0,1", "q"));
    assert!((eight / one - 8.0).abs() < 1e-6, "{one} {eight}");
    assert!(words.contains("coordinates moved by --transform, lengths times 2"), "{words}");
}

#[test]
fn a_matrix_that_moves_nothing_is_refused() {
    let folder = inputs();
    let f = folder.path();
    succeed(f, "wallgen", &["sheet.xyz", "--radius", "0.01", "-o", "walls.mcap"]);
    for (words, part) in [
        ("dem-view walls.mcap -o v.png", "--transform: runs and walls (MCAP) are not moved"),
        ("stone-clump box.ply --measures", "--transform: measures of shape are the same in any position"),
    ] {
        let done = line(f, &format!("{words} --transform quarter.txt"));
        assert!(done.code == 2 && done.stderr.contains(part), "{words}: {}", done.stderr);
    }
}

/// A turned drawing encloses what it did: its faces still look to the same side.
#[test]
fn faces_keep_their_sides() {
    let folder = inputs();
    let f = folder.path();
    let there = numbers(&rotation(), ",");
    succeed(f, "stone-clean", &["box.ply", "--transform", &there, "-o", "turned.ply"]);
    let mesh = cloud::read_mesh(&mut fs::File::open(f.join("turned.ply")).unwrap()).unwrap();
    assert!((mesh.volume() - 0.006).abs() < 1e-8, "{}", mesh.volume());
    let words = ["--from-mesh", "box.ply", "--radius", "0.02", "--roughness", "0.002"];
    succeed(f, "wallgen", &[&words[..], &["-o", "still.ply"]].concat());
    succeed(f, "wallgen", &[&words[..], &["--transform", QUARTER, "-o", "moved.ply"]].concat());
    let [still, moved] = ["still.ply", "moved.ply"].map(|name| read(f, name).points.len());
    assert!(still > 50 && still.abs_diff(moved) * 20 < still, "{still} {moved}");
}

/// A matrix of a registration that also fits the size: positions follow, and the factor is reported.
#[test]
fn a_factor_is_reported() {
    let folder = inputs();
    let done = tool(
        folder.path(),
        "cloud-crop",
        &["sheet.xyz", "--transform", "0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 0 0 0 1", "-o", "half.ply"],
    );
    assert!(done.stderr.contains("coordinates moved by --transform, lengths times 0.5"), "{}", done.stderr);
    let half = read(folder.path(), "half.ply");
    assert!((half.points[40] - Vec3::new(0.2, 0.0, 0.02)).norm() < 1e-15);
    assert!(column(&half, "nz").iter().all(|nz| *nz == 1.0), "directions keep their length");
}

#[test]
fn what_is_no_rigid_motion_is_refused() {
    let folder = inputs();
    let f = folder.path();
    fs::write(f.join("short.txt"), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0\n").unwrap();
    for (matrix, part) in [
        ("short.txt", "short.txt' for '--transform <FILE|NUMBERS>': 15 numbers where a matrix has 16"),
        ("nowhere.txt", "cannot read"),
        ("1,0,0,0,0,1,0,0,0,0,1,0,0,0,0", "15 numbers"),
        ("1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2", "the last row is 0 0 0 2"),
        ("1,0,0,0,0,nan,0,0,0,0,1,0,0,0,0,1", "row 2, column 2"),
        ("1,0.5,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "the matrix distorts"),
        ("-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "the matrix mirrors"),
    ] {
        let done = tool(f, "cloud-crop", &["sheet.xyz", "--transform", matrix, "-o", "no.ply"]);
        assert!(done.code == 2 && done.stderr.contains(part), "{matrix}: {}", done.stderr);
        assert!(!f.join("no.ply").exists());
    }
    let done = tool(f, "cloud-crop", &["sheet.xyz", "--transform", "quarter.txt", "-o", "quarter.txt"]);
    assert!(done.code == 2 && done.stderr.contains("is also an input"), "{}", done.stderr);
}

/// The product of numpy, where it is installed.
#[test]
fn numpy_computes_the_same_product() {
    let folder = inputs();
    let f = folder.path();
    fs::write(f.join("there.txt"), numbers(&rotation(), " ")).unwrap();
    succeed(f, "cloud-crop", &["sheet.xyz", "--transform", "there.txt", "--ascii", "-o", "far.ply"]);
    let script = "import numpy as np\n\
        m = np.loadtxt('there.txt').reshape(4, 4)\n\
        p = np.loadtxt('sheet.xyz', skiprows=1)[:, :6]\n\
        far = open('far.ply').read().split('end_header\\n')[1]\n\
        q = np.array([line.split() for line in far.splitlines()], float)[:, :6]\n\
        print(abs(p[:, :3] @ m[:3, :3].T + m[:3, 3] - q[:, :3]).max() <= 2e-9, abs(p[:, 3:] @ m[:3, :3].T - q[:, 3:]).max() <= 1e-7)\n";
    let python = |script: &str| Command::new("python3").current_dir(f).args(["-c", script]).output().ok();
    if !python("import numpy").is_some_and(|output| output.status.success()) {
        return grainpipe_tests::skip("python3 with numpy");
    }
    let output = python(script).unwrap();
    assert_eq!(
        String::from_utf8_lossy(&output.stdout).trim(),
        "True True",
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}
