//! The tool as a user meets it.

use std::process::{Command, Output};

const CHUTE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../sample-data/chute/chute.ply");

/// Runs the tool on the chute without its mounting end.
fn fill(args: &[&str]) -> Output {
    let whole = cloud::from_bytes(std::fs::read(CHUTE).unwrap()).unwrap();
    let mounting = mesh::shape("halfspace:0,0,0,-0.766,0,0.643").unwrap();
    let rules = cloud::crop::Rules { remove: vec![mounting], ..Default::default() };
    let mut file = tempfile::NamedTempFile::new().unwrap();
    cloud::write_ply(&mut file, &cloud::crop(&whole, &rules).unwrap().0, Default::default()).unwrap();
    Command::new(env!("CARGO_BIN_EXE_cloud-fill")).arg(file.path()).args(args).output().unwrap()
}

#[test]
fn the_blind_spot_of_the_chute_is_filled_and_only_that() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let output =
        fill(&["--mesh", &path("mesh.ply"), "--report", &path("report.json"), "-o", &path("out.ply")]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let cloud = cloud::from_bytes(std::fs::read(path("out.ply")).unwrap()).unwrap();
    assert!(cloud.attributes.get("intensity").is_some());
    let filled = cloud.attributes.get("filled").unwrap();
    let added: Vec<_> = (0..cloud.points.len()).filter(|&i| filled.get(i) == 1.0).collect();
    assert!((190..310).contains(&added.len()), "{}", added.len());
    for i in added {
        let (p, (sin, cos)) = (cloud.points[i], 40f64.to_radians().sin_cos());
        let p = geom::Vec3::new(p.x * cos - p.z * sin, p.y, p.x * sin + p.z * cos);
        let (radius, theta) = (0.45 - 0.05 * p.x / 3.0, p.y.atan2(-p.z));
        assert!((p.x - 1.7).hypot(radius * (theta - 0.2)) < 0.145, "{p}");
        assert!((p.y.hypot(p.z) - radius).abs() < 0.0024, "{p}");
    }
    let mesh = cloud::read_mesh(&mut std::fs::read(path("mesh.ply")).unwrap().as_slice()).unwrap();
    assert!(mesh.area() > 0.04 && mesh.area() < 0.1, "{}", mesh.area());
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path("report.json")).unwrap()).unwrap();
    assert!(report["below"].as_f64().unwrap() > 0.0 && report["holes"].as_array().unwrap().len() == 1);
}

#[test]
fn threads_and_seeds() {
    let one = fill(&["--threads", "1"]).stdout;
    assert!(!one.is_empty() && one == fill(&["--threads", "3"]).stdout);
    assert!(one != fill(&["--seed", "5"]).stdout);
    for method in ["random", "grid"] {
        assert_eq!(fill(&["--fill", method]).status.code(), Some(0));
    }
}

#[test]
fn wrong_use_is_named() {
    for (args, part) in [
        (["--fill", "sand"], "blue-noise, random or grid"),
        (["--ball", "0.1,-2"], "above 0"),
        (["--region", "sphere:1,2,3"], "4 numbers"),
        (["--below", "0"], "above 0"),
    ] {
        let output = fill(&args);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(part), "{said}");
    }
}
