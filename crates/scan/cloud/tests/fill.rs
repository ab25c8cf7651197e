//! Filling is checked against surfaces that are known.

mod random;

use cloud::fill::{FillError, Filled, Settings};
use cloud::{Cloud, Method};
use geom::Vec3;
use random::Random;
use stream::{Table, Values};

/// Fills, where nothing is to be refused.
fn fill(cloud: Cloud, settings: &Settings) -> Filled {
    cloud::fill(cloud, settings).unwrap()
}

const RADIUS: f64 = 0.4;
const NOISE: f64 = 0.0008;

/// A half pipe along x, 1.5 m long, 30 000 points, with holes at (x, θ, radius along the surface).
fn half_pipe(holes: &[(f64, f64, f64)], seed: u64) -> Cloud {
    let mut random = Random(seed);
    let mut points = Vec::new();
    while points.len() < 30_000 {
        let (x, theta) = (1.5 * random.next(), 3.0 * random.next() - 1.5);
        if holes.iter().all(|h| (x - h.0).hypot(RADIUS * (theta - h.1)) >= h.2) {
            let noise = Vec3::new(random.normal(), random.normal(), random.normal()) * NOISE;
            points.push(Vec3::new(x, RADIUS * theta.sin(), -RADIUS * theta.cos()) + noise);
        }
    }
    let mut attributes = Table::with_rows(points.len());
    attributes.push("intensity", Values::U16((0..30_000).map(|i| 100 + (i % 7) as u16).collect())).unwrap();
    Cloud { points, attributes, ..Cloud::default() }
}

/// x, θ and distance from the axis of a point.
fn place(p: &Vec3) -> (f64, f64, f64) {
    (p.x, p.y.atan2(-p.z), p.y.hypot(p.z))
}

#[test]
fn holes_are_filled_within_the_noise_and_nowhere_else() {
    let holes = [(0.5, 0.2, 0.12), (1.1, -0.6, 0.08), (1.0, 0.7, 0.05)];
    for (seed, method) in [(1, Method::BlueNoise), (2, Method::Random), (3, Method::Grid)] {
        let cloud = half_pipe(&holes, seed);
        let settings = Settings { method, ..Settings::default() };
        let filled = fill(cloud.clone(), &settings);
        assert_eq!(filled.cloud.points[..30_000], cloud.points[..], "what was scanned stays");
        assert_eq!(filled.report.holes.len(), 3, "{:?}", filled.report);
        let density = 30_000.0 / (1.5 * 3.0 * RADIUS - 0.07);
        let mut count = [0.0; 3];
        let mut squares = 0.0;
        let added = &filled.cloud.points[30_000..];
        for p in added {
            let (x, theta, r) = place(p);
            let from = |h: &(f64, f64, f64)| (x - h.0).hypot(RADIUS * (theta - h.1)) - h.2;
            let near = (0..3).min_by(|&a, &b| from(&holes[a]).total_cmp(&from(&holes[b]))).unwrap();
            assert!(from(&holes[near]) < 0.02, "{method:?}: a point {} m outside a hole", from(&holes[near]));
            assert!((r - RADIUS).abs() < 3.0 * NOISE, "{method:?}: {} m off the surface", r - RADIUS);
            squares += (r - RADIUS) * (r - RADIUS);
            count[near] += 1.0;
        }
        assert!((squares / added.len() as f64).sqrt() < NOISE);
        for (hole, count) in holes.iter().zip(count) {
            let wanted = density * std::f64::consts::PI * hole.2 * hole.2;
            assert!((0.75..1.3).contains(&(count / wanted)), "{method:?}: {count} for {wanted}");
        }
        let flags = filled.cloud.attributes.get("filled").unwrap();
        assert!((0..flags.len()).all(|i| (flags.get(i) == 1.0) == (i >= 30_000)));
        let intensity = filled.cloud.attributes.get("intensity").unwrap();
        assert!((0..flags.len()).all(|i| (100.0..107.0).contains(&intensity.get(i))));
        assert!(!filled.mesh.faces.is_empty() && filled.mesh.area() > 0.04);
    }
}

#[test]
fn blue_noise_keeps_its_distance_also_from_the_scan() {
    let settings = Settings { spacing: Some(0.006), ..Settings::default() };
    let filled = fill(half_pipe(&[(0.7, 0.0, 0.1)], 5), &settings);
    let (scanned, added) = filled.cloud.points.split_at(30_000);
    assert!(added.len() > 450, "{}", added.len());
    for (i, p) in added.iter().enumerate() {
        let near = |q: &Vec3| (p - q).norm() < 0.006 * 0.999;
        assert!(!scanned.iter().any(near) && !added[..i].iter().any(near));
    }
}

#[test]
fn a_rim_is_no_hole_even_with_a_notch() {
    // No hole, and then one that the rim cuts in half.
    for holes in [&[][..], &[(0.7, 1.5, 0.15)][..]] {
        let filled = fill(half_pipe(holes, 4), &Settings::default());
        assert_eq!(filled.report.added, 0, "{:?}", filled.report.holes);
        assert_eq!(filled.cloud.points.len(), 30_000);
        assert!(filled.cloud.attributes.get("filled").is_some());
    }
}

#[test]
fn an_operator_may_point_at_a_notch() {
    let theta: f64 = 1.45;
    let shape = format!("sphere:0.7,{},{},0.1", RADIUS * theta.sin(), -RADIUS * theta.cos());
    let settings = Settings { regions: vec![shape.parse().unwrap()], ..Settings::default() };
    let filled = fill(half_pipe(&[(0.7, 1.5, 0.15), (0.5, -0.5, 0.1)], 4), &settings);
    assert!(filled.report.added > 50, "{:?}", filled.report);
    let (scanned, added) = filled.cloud.points.split_at(30_000);
    assert!(added.iter().all(|p| settings.regions[0].contains(p)));
    // Off the rim of the notch the surface goes on smoothly.
    assert!(added.iter().all(|p| (place(p).2 - RADIUS).abs() < 0.01));
    assert_eq!(scanned.len(), 30_000);
}

#[test]
fn what_is_too_wide_or_not_asked_for_stays_open() {
    let cloud = half_pipe(&[(0.5, 0.2, 0.12), (1.1, -0.6, 0.06)], 6);
    let narrow = fill(cloud.clone(), &Settings { max_hole: Some(0.18), ..Settings::default() });
    assert_eq!(narrow.report.holes.len(), 1);
    let small_ball = fill(cloud.clone(), &Settings { balls: vec![0.01], ..Settings::default() });
    assert!(small_ball.report.holes.iter().all(|h| h.open));
    let sparse = fill(cloud, &Settings { below: Some(20.0), ..Settings::default() });
    assert_eq!(sparse.report.added, 0);
}

#[test]
fn the_same_seed_gives_the_same_points_on_any_number_of_threads() {
    let cloud = half_pipe(&[(0.5, 0.2, 0.12), (1.1, -0.6, 0.08)], 7);
    let run = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fill(cloud.clone(), &Settings { seed, ..Settings::default() }).cloud.points)
    };
    assert_eq!(run(1, 0), run(4, 0));
    assert_ne!(run(2, 0), run(2, 1));
}

#[test]
fn bad_clouds_come_back_as_they_were() {
    let line: Vec<Vec3> = (0..2000).map(|i| Vec3::x() * f64::from(i)).collect();
    let mut random = Random(1);
    let mut volume: Vec<Vec3> =
        (0..3000).map(|_| Vec3::new(random.next(), random.next(), random.next())).collect();
    volume.push(Vec3::repeat(1e9));
    let plate: Vec<Vec3> = (0..2500).map(|i| Vec3::new(f64::from(i % 50), f64::from(i / 50), 0.0)).collect();
    let twice: Vec<Vec3> = plate.iter().flat_map(|p| [*p, *p, *p]).collect();
    let far: Vec<Vec3> = plate.iter().copied().chain([Vec3::repeat(-1e9)]).collect();
    for points in [vec![], vec![Vec3::x()], vec![Vec3::x(); 5000], line, volume, plate, twice, far] {
        let count = points.len();
        let cloud = Cloud { attributes: Table::with_rows(count), points, ..Cloud::default() };
        for below in [None, Some(1e-9), Some(0.5), Some(1e9)] {
            let filled = fill(cloud.clone(), &Settings { below, ..Settings::default() });
            assert_eq!(filled.cloud.points[..count], cloud.points[..]);
        }
    }
    for too_far in [1e12, -1e15, 1e308] {
        let mut cloud = half_pipe(&[(0.7, 0.0, 0.1)], 8);
        cloud.points[7] = Vec3::repeat(too_far);
        let error = cloud::fill(cloud, &Settings::default()).expect_err("refused").to_string();
        assert!(error.contains("point 7") && error.contains("farther than 1e9 m"), "{error}");
    }
    let mut cloud = half_pipe(&[(0.7, 0.0, 0.1)], 8);
    cloud.points[7] = Vec3::repeat(f64::NAN);
    let filled = fill(cloud, &Settings::default());
    assert_eq!((filled.report.not_finite, filled.report.holes.len()), (1, 1));
}

#[test]
fn a_spacing_that_memory_cannot_hold_is_refused() {
    let settings = Settings { spacing: Some(1e-7), ..Settings::default() };
    let error = cloud::fill(half_pipe(&[(0.7, 0.0, 0.1)], 8), &settings).unwrap_err();
    assert!(matches!(error, FillError::TooMany { spacing: 1e-7, .. }), "{error}");
}
