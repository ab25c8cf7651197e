//! Walls of clouds that are too sparse for their roughness, with and without a drawing beside them; properties along a column.

use geom::Vec3;
use geom::mesh::TriMesh;
use record::MaterialRecord;
use wall::drawn::beside;
use wall::{Radius, Regions, WallSettings, build};

const STEP: f64 = 0.01;

fn steel() -> MaterialRecord {
    MaterialRecord {
        name: "steel".into(),
        density: None,
        young: Some(2e8),
        poisson: Some(0.3),
        friction: None,
        restitution: Some(0.5),
    }
}

/// A lattice of 40 by 20 points; `keeps` says which.
fn lattice(keeps: impl Fn(usize, usize) -> bool) -> Vec<Vec3> {
    let all = (0..800).map(|k| (k % 40, k / 40)).filter(|&(i, j)| keeps(i, j));
    all.map(|(i, j)| Vec3::new(STEP * i as f64, STEP * j as f64, 0.0)).collect()
}

fn square(x: f64) -> TriMesh {
    let corner = |u: f64, v: f64| Vec3::new(x + 0.39 * u, 0.19 * v, 0.0);
    let vertices = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
    TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] }
}

/// Past x = 0.25 every fourth row alone is there: dents are up to 16 times as deep.
#[test]
fn a_wall_that_cannot_have_its_roughness_says_where_and_how_deep_it_is() {
    let regions = Regions::one(Some(0.0005), steel(), Vec3::zeros()).unwrap();
    for radius in [Radius::Uniform, Radius::Solve] {
        let settings = WallSettings { radius, ..WallSettings::default() };
        let even = build(&lattice(|_, _| true), &regions, &settings).unwrap().1;
        assert!(even.deep_dents.is_none() && even.warnings.is_empty(), "{:?}", even.warnings);
        let sparse = lattice(|i, j| i < 25 || (i % 4 == 1 && j % 4 == 1));
        let report = build(&sparse, &regions, &settings).unwrap().1;
        let deep = report.deep_dents.unwrap();
        assert!(deep.at[0] > 0.24 && (deep.distance / STEP - 4.0).abs() < 1e-9, "{deep:?}");
        assert!(
            deep.deepest > 6.0 * 0.0005 && deep.asked == 0.0005 && (0.05..0.5).contains(&deep.share),
            "{deep:?}"
        );
        let told = report.warnings.join("\n");
        assert!(
            told.contains("times as deep as asked") && told.contains("cloud-fill --for-spacing"),
            "{told}"
        );
    }
    let given = WallSettings { radius: Radius::Given(0.03), ..WallSettings::default() };
    let none = Regions::one(None, steel(), Vec3::zeros()).unwrap();
    let report = build(&lattice(|i, _| i < 25 || i % 4 == 1), &none, &given).unwrap().1;
    assert!(report.deep_dents.is_none(), "no roughness was asked for");
}

#[test]
fn a_drawing_stands_in_where_the_cloud_has_no_points_and_only_there() {
    let scan = lattice(|i, j| !(10..20).contains(&i) || !(5..15).contains(&j));
    let found = beside(&square(0.0), &scan, STEP).unwrap();
    assert!((60..200).contains(&found.positions.len()) && found.off == 0.0, "{}", found.positions.len());
    for (p, &i) in found.positions.iter().zip(&found.nearest) {
        assert!(
            (0.09..0.20).contains(&p.x) && (0.04..0.15).contains(&p.y),
            "{p} is where the scan has points"
        );
        let least = scan.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        assert!(least >= 0.7 * STEP && (scan[i as usize] - p).norm() == least, "{p}");
    }
    let all = [scan.clone(), found.positions].concat();
    for k in 0..2500 {
        let at = Vec3::new(0.1 + 0.002 * f64::from(k % 50), 0.05 + 0.002 * f64::from(k / 50), 0.0);
        assert!(all.iter().any(|p| (p - at).norm() < 0.9 * STEP), "{at} has no point near by");
    }
    assert!(beside(&square(3.0), &scan, STEP).unwrap().off == 1.0);
}

#[test]
fn properties_change_along_a_column_in_steps_and_their_error_is_said() {
    let points = lattice(|_, _| true);
    let wear = |i: usize| (i % 40) as f64 / 39.0;
    let property = |name: &str| (name == "wear").then(|| (0..points.len()).map(wear).collect());
    let none = |_: &str| Err("no files here".to_owned());
    let parse = |text: &str| Regions::parse(text, steel(), Vec3::zeros(), &none, &|_| Ok(String::new()));
    let head = "roughness = 0.0005\n[[region]]\nname = \"worn\"\ncolumn = \"wear\"\n";
    let keys = "values = [0, 1]\nfriction = [0.2, 0.8]\nroughness = [0.0004, 0.0008]\nsteps = 12\n";
    let mut regions = parse(&format!("{head}{keys}")).unwrap();
    regions.measure(&points, &property).unwrap();
    let errors: Vec<f64> = regions.stepped.iter().map(|s| s.error).collect();
    assert!((errors[0] - 0.025).abs() < 1e-12 && (errors[1] - 0.0004 / 24.0).abs() < 1e-12, "{errors:?}");
    let (wall, _) = build(&points, &regions, &WallSettings::default()).unwrap();
    let mut worst = [0.0f64; 2];
    for (i, &region) in wall.regions.iter().enumerate() {
        let material = &regions.materials[regions.surfaces[region as usize].material as usize];
        assert!(material.name.starts_with("steel-worn-") && material.young == Some(2e8), "{material:?}");
        worst[0] = worst[0].max((material.friction.unwrap() - (0.2 + 0.6 * wear(i))).abs());
        worst[1] = worst[1].max((regions.roughness(i, region).unwrap() - 0.0004 * (1.0 + wear(i))).abs());
    }
    assert!((0..2).all(|k| worst[k] <= errors[k] * (1.0 + 1e-9) && worst[k] > 0.5 * errors[k]), "{worst:?}");
    assert_eq!(regions.materials.len(), 13);
    for (keys, says) in [
        ("values = [0, 1]\nsteps = 4", "steps changes nothing"),
        ("values = 1\nfriction = [0.2, 0.8]", "friction = [A, B] changes along a column"),
        ("values = [0, 1]\nfriction = [0.2, 0.8]\nsteps = 1", "steps = 1: must be 2 to 64"),
        ("values = [0, 1]\nrestitution = [0.2, 1.8]", "must be from 0 to 1"),
        ("values = [5, 6]\nfriction = [0.2, 0.8]", "from 5 to 6; its values are 0 to 1"),
    ] {
        let message = match parse(&format!("{head}{keys}")) {
            Err(e) => e.to_string(),
            Ok(mut regions) => regions.measure(&points, &property).unwrap_err().to_string(),
        };
        assert!(message.contains(says), "{keys}: {message}");
    }
}
