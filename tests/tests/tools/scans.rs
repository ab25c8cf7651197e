//! Coordinates of scans through the whole chain: far from the origin nothing is lost, and doubtful units print a warning.

use geom::Vec3;
use grainpipe_tests::tools::{line, succeed, tool};
use std::fs;
use std::path::Path;
use stream::{Table, Values};
use tempfile::tempdir;

/// A trough of 1.2 m with a blind spot; coordinates are whole multiples of 2⁻²⁰ m, so that a shift by whole metres is exact.
fn trough(shift: Vec3) -> cloud::Cloud {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let snap = |p: Vec3| p.map(|c| (c * f64::from(1 << 20)).round() / f64::from(1 << 20));
    let place = |(x, y): (f64, f64)| Vec3::new(x, y, (y - 0.3) * (y - 0.3));
    let all = (0..30_000).map(|_| place((1.2 * random(), 0.6 * random())));
    let points: Vec<Vec3> =
        all.filter(|p| (p.x - 0.5).hypot(p.y - 0.25) > 0.04).map(|p| snap(p) + shift).collect();
    let mut attributes = Table::with_rows(points.len());
    attributes.push("number", Values::U32((0..points.len() as u32).collect())).expect("as many");
    cloud::Cloud { points, attributes, double: true, ..cloud::Cloud::default() }
}

fn write(folder: &Path, name: &str, cloud: &cloud::Cloud) {
    let mut file = fs::File::create(folder.join(name)).expect("created");
    cloud::write_ply(&mut file, cloud, stream::ply::Encoding::BinaryLittleEndian).expect("written");
}

fn read(folder: &Path, name: &str) -> cloud::Cloud {
    cloud::read(fs::File::open(folder.join(name)).expect("written")).expect("a cloud")
}

/// Map coordinates, as surveyors have them.
const MAP: Vec3 = Vec3::new(637_000.0, 5_849_000.0, 411.0);

#[test]
fn the_last_digits_of_map_coordinates_survive_the_whole_chain() {
    let folder = tempdir().unwrap();
    let f = folder.path();
    write(f, "near.ply", &trough(Vec3::zeros()));
    write(f, "far.ply", &trough(MAP));
    let (source, mut walls) = (trough(MAP), Vec::new());
    for name in ["near", "far"] {
        let chain = format!(
            "cloud-crop {name}.ply --scale 1 --largest 0.05 | cloud-fill | tee {name}-filled.ply | bluenoise-sample --spacing 0.02 \
             | tee {name}-kept.ply | wallgen --roughness 0.002 --radius uniform -o {name}-walls.ply"
        );
        let done = line(f, &chain);
        assert_eq!(done.code, 0, "{chain}: {}", done.stderr);
        walls.push(read(f, &format!("{name}-walls.ply")));
    }
    let filled = |name: &str| read(f, name).attributes.get("filled").expect("told").to_f64();
    let added = [filled("near-filled.ply"), filled("far-filled.ply")].map(|c| c.iter().sum::<f64>());
    assert!(added[0] > 20.0 && added[0] == added[1], "{added:?}");
    let kept = read(f, "far-kept.ply");
    let scanned = filled("far-kept.ply");
    let numbers = kept.attributes.get("number").expect("passed on").to_f64();
    let mut same = 0;
    for ((p, number), filled) in kept.points.iter().zip(numbers).zip(scanned) {
        if filled == 0.0 {
            assert_eq!(*p, source.points[number as usize], "to the last bit");
            same += 1;
        }
    }
    assert!(same > 1000, "{same} points of the scan");
    let [near, far] = &walls[..] else { panic!("two") };
    assert_eq!(near.points.len(), far.points.len());
    for (a, b) in near.points.iter().zip(&far.points) {
        assert!((a + MAP - b).norm() < 1e-8, "{a} {b}");
    }
}

#[test]
fn every_method_chooses_the_same_points_on_a_map_as_at_the_origin() {
    let folder = tempdir().unwrap();
    let f = folder.path();
    write(f, "near.ply", &trough(Vec3::zeros()));
    write(f, "far.ply", &trough(MAP));
    for method in ["poisson", "eliminate", "relax", "tile"] {
        let numbers = ["near", "far"].map(|name| {
            let (from, to) = (format!("{name}.ply"), format!("{name}-{method}.ply"));
            succeed(f, "bluenoise-sample", &[&from, "--spacing", "0.03", "--method", method, "-o", &to]);
            read(f, &to).attributes.get("number").expect("passed on").to_f64()
        });
        assert!(numbers[0] == numbers[1] && numbers[0].len() > 500, "{method}");
    }
}

#[test]
fn map_coordinates_in_short_numbers_are_told() {
    let folder = tempdir().unwrap();
    write(folder.path(), "short.ply", &cloud::Cloud { double: false, ..trough(MAP) });
    for words in [&["cloud-crop"][..], &["bluenoise-sample", "--spacing", "0.05"], &["cloud-fill"]] {
        let done = tool(folder.path(), words[0], &[&["short.ply", "-o", "out.ply"], &words[1..]].concat());
        assert!(
            done.stderr.contains("4-byte numbers") && done.stderr.contains("8-byte"),
            "{words:?}: {}",
            done.stderr
        );
    }
}

/// A count that cannot be met prints a warning; small ones are met.
#[test]
fn small_counts_are_met() {
    let folder = tempdir().unwrap();
    write(folder.path(), "scan.ply", &trough(Vec3::zeros()));
    for method in ["poisson", "eliminate", "relax", "tile"] {
        for count in ["1", "2", "10", "73"] {
            succeed(
                folder.path(),
                "bluenoise-sample",
                &["scan.ply", "--count", count, "--method", method, "-o", "out.ply"],
            );
            assert_eq!(read(folder.path(), "out.ply").points.len().to_string(), count, "{method}");
        }
    }
    let done = succeed(
        folder.path(),
        "bluenoise-sample",
        &["scan.ply", "--count", "10", "--method", "grid", "-o", "out.ply"],
    );
    let found = read(folder.path(), "out.ply").points.len();
    assert!(found == 10 || done.stderr.contains(&format!("{found} points instead of 10")), "{}", done.stderr);
}
