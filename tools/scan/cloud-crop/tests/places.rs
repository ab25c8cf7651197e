//! Many points in one place: returns without an echo at the scanner, scans that were merged twice.

use std::process::{Command, Output};
use std::time::{Duration, Instant};

fn crop(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cloud-crop")).args(args).output().unwrap()
}

/// A sheet of 50 × 50 points 0.02 m apart, 3 m from the scanner, and `many` points at the scanner.
fn scan(many: usize) -> String {
    let sheet = (0..2500).map(|k| {
        let (i, j) = (f64::from(k % 50), f64::from(k / 50));
        format!("{} {} {}\n", 3.0 + 0.02 * i + 0.001 * (7.0 * j).sin(), 3.0 + 0.02 * j, 1.0 + 0.01 * i.sin())
    });
    sheet.chain((0..many).map(|_| "0 0 0\n".to_owned())).collect()
}

#[test]
fn points_without_an_echo_are_one_place() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scan.xyz");
    std::fs::write(&file, scan(60_000)).unwrap();
    let file = file.to_str().unwrap();
    let start = Instant::now();
    for rule in [&["--outliers", "12,3"][..], &["--largest", "0.1"], &["--scattered", "0.1,0.2"]] {
        let done = crop(&[&[file][..], rule].concat());
        let told = String::from_utf8_lossy(&done.stderr).into_owned();
        let kept = cloud::from_bytes(done.stdout).unwrap().points;
        let scanned = kept.iter().filter(|p| p.x > 1.0).count();
        assert!(scanned > 2300, "{rule:?}: {scanned} points of the scan stay");
        assert!(told.contains("60000 points lie in one place, (0, 0, 0) m"), "{told}");
        if rule[0] != "--scattered" {
            assert_eq!(kept.len(), scanned, "{rule:?}: points at the scanner go");
        }
    }
    let eyes = crop(&[file, "--grazing", "75", "--seen-from", "4,4,4"]);
    assert!(eyes.status.success());
    // Each took minutes when all pairs were looked at.
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    let none = crop(&[file]);
    assert!(String::from_utf8_lossy(&none.stderr).contains("96 % of the points lie in one place"));
}

#[test]
fn distinct_points_are_apart() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("twice.xyz");
    std::fs::write(&file, format!("{}{}", scan(0), scan(0))).unwrap();
    let file = file.to_str().unwrap();
    let kept = |rule: &[&str]| cloud::from_bytes(crop(&[&[file][..], rule].concat()).stdout).unwrap().points;
    assert_eq!(kept(&[]).len(), 5000);
    let once = kept(&["--distinct", "0"]);
    assert!(once == kept(&[])[..2500]);
    let few = kept(&["--distinct", "0.05"]);
    assert!(few.len() < 1000 && few.len() > 100, "{}", few.len());
    let nearest = |k: usize| {
        let others = few.iter().enumerate().filter(|(other, _)| *other != k);
        others.map(|(_, q)| (q - few[k]).norm()).fold(f64::INFINITY, f64::min)
    };
    assert!((0..few.len()).all(|k| nearest(k) > 0.05));
}

#[test]
fn points_are_chosen_by_their_properties() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scan.csv");
    std::fs::write(&file, "x,y,z,class,Wall ID\n0,0,0,2,1\n1,0,0,7,1\n2,0,0,2,3\n").unwrap();
    let file = file.to_str().unwrap();
    let done = crop(&[file, "--where", "class != 7 && 'Wall_ID' < 2"]);
    assert!(
        String::from_utf8_lossy(&done.stderr).contains("1 of 3 points kept: 2 by their properties"),
        "{done:?}"
    );
    assert_eq!(cloud::from_bytes(done.stdout).unwrap().points.len(), 1);
    for (condition, code, part) in [
        ("colour > 1", 1, "--where: the cloud has no property 'colour': it has x, y, z, class, Wall_ID"),
        ("class = 7", 2, "==, !=, <, <=, > or >= is expected at character 7"),
    ] {
        let done = crop(&[file, "--where", condition]);
        let told = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.code() == Some(code) && told.contains(part), "{told}");
    }
}

#[test]
fn several_clouds_become_one() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (first, second) = (file("a.csv", "x,y,z,tone\n0,0,0,2\n1,0,0,7\n"), file("b.xyz", "5 0 0\n"));
    let both = cloud::from_bytes(crop(&[&first, &second, &first]).stdout).unwrap();
    assert_eq!(both.points.len(), 5);
    assert_eq!(both.attributes.get("scan").unwrap().to_f64(), [0.0, 0.0, 1.0, 2.0, 2.0]);
    let some =
        cloud::from_bytes(crop(&[&first, &second, "--where", "scan == 1 || tone == 7"]).stdout).unwrap();
    assert_eq!(some.points.iter().map(|p| p.x).collect::<Vec<_>>(), [1.0, 5.0]);
    let twice = crop(&["-", &first, "-"]);
    assert_eq!(twice.status.code(), Some(2), "{twice:?}");
}
