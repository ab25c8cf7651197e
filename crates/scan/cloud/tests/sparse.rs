//! Surface that is scanned too sparsely for a spacing is filled; holes, slots and the outside are not.

mod random;

use cloud::Cloud;
use cloud::fill::{FillError, Filled, Settings};
use geom::{Grid, Vec3};
use random::Random;
use stream::Table;

const RADIUS: f64 = 0.4;
const LENGTH: f64 = 1.5;
const NOISE: f64 = 0.0008;
const SPACING: f64 = 0.012;
/// x, θ and radius of a hole that stays open.
const HOLE: (f64, f64, f64) = (0.7, 0.3, 0.12);

fn cloud(points: Vec<Vec3>) -> Cloud {
    let attributes = Table::with_rows(points.len());
    Cloud { points, attributes, ..Cloud::default() }
}

fn fill(points: &[Vec3], settings: &Settings) -> Filled {
    cloud::fill(cloud(points.to_vec()), settings).unwrap()
}

fn wanted() -> Settings {
    Settings { for_spacing: Some(SPACING), max_hole: Some(0.05), ..Settings::default() }
}

fn in_hole(x: f64, theta: f64, grown: f64) -> bool {
    (x - HOLE.0).hypot(RADIUS * (theta - HOLE.1)) < HOLE.2 + grown
}

/// A half pipe along x, scanned from one end: the distance of neighbours grows from 7 mm to 22 mm.
fn half_pipe() -> Vec<Vec3> {
    let mut random = Random(3);
    let mut points = Vec::new();
    while points.len() < 14_000 {
        let (x, theta) = (LENGTH * random.next(), 3.0 * random.next() - 1.5);
        let keeps = random.next() < (1.0 + 2.0 * x / LENGTH).powi(-2);
        if keeps && !in_hole(x, theta, 0.0) {
            let noise = Vec3::new(random.normal(), random.normal(), random.normal()) * NOISE;
            points.push(Vec3::new(x, RADIUS * theta.sin(), -RADIUS * theta.cos()) + noise);
        }
    }
    points
}

/// Places on the half pipe, away from its rim and the hole, and the share that have no point within `reach` [m].
fn bare(points: &[Vec3], reach: f64) -> f64 {
    let grid = Grid::new(points, reach);
    let mut random = Random(5);
    let (mut bare, mut all) = (0.0, 0.0);
    while all < 20_000.0 {
        let (x, theta) = (0.03 + (LENGTH - 0.06) * random.next(), 2.8 * random.next() - 1.4);
        if !in_hole(x, theta, 0.04) {
            let at = Vec3::new(x, RADIUS * theta.sin(), -RADIUS * theta.cos());
            bare += f64::from(u8::from(grid.within(points, at, reach).next().is_none()));
            all += 1.0;
        }
    }
    bare / all
}

#[test]
fn sparse_surface_gets_points_on_it_and_its_hole_and_its_outside_get_none() {
    let scan = half_pipe();
    let filled = fill(&scan, &wanted());
    let report = filled.report.sparse.clone().unwrap();
    let (before, after) = (bare(&scan, 0.65 * SPACING), bare(&filled.cloud.points, 0.65 * SPACING));
    println!("without a point within 0.65 spacings: {before} of the scan, {after} after; {report:?}");
    assert!(before > 0.2 && after < 0.002, "{before} {after}");
    assert_eq!(filled.cloud.points[..scan.len()], scan[..], "what was scanned stays");
    let added = &filled.cloud.points[scan.len()..];
    assert!(report.added == added.len() && report.places > 0 && report.added < 20_000, "{report:?}");
    let mut squares = 0.0;
    for p in added {
        let (theta, off) = (p.y.atan2(-p.z), p.y.hypot(p.z) - RADIUS);
        assert!(off.abs() < 3.0 * NOISE, "{p}: {off} m off the surface");
        assert!((-0.002..LENGTH + 0.002).contains(&p.x) && theta.abs() < 1.51, "{p} is outside");
        assert!(!in_hole(p.x, theta, -0.012), "{p} is in the hole");
        squares += off * off;
    }
    assert!((squares / added.len() as f64).sqrt() < 0.5 * NOISE, "{squares}");
    assert!((0..scan.len()).all(|i| filled.cloud.attributes.get("filled").unwrap().get(i) == 0.0));
    assert!(
        (scan.len()..scan.len() + added.len())
            .all(|i| filled.cloud.attributes.get("filled").unwrap().get(i) == 1.0)
    );
}

#[test]
fn threads_change_nothing_and_a_dense_scan_gets_nothing() {
    let scan = half_pipe();
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fill(&scan, &wanted()).cloud.points)
    };
    assert!(by(1) == by(3));
    let sparse = fill(&scan, &Settings { for_spacing: Some(0.09), ..wanted() }).report.sparse.unwrap();
    assert_eq!((sparse.added, sparse.left), (0, 0));
    let inside = "box:0.9,-1,-1,1.1,1,1".parse().unwrap();
    let some = fill(&scan, &Settings { regions: vec![inside], ..wanted() });
    assert!(some.report.sparse.is_some_and(|s| s.added > 100));
    assert!(some.cloud.points[scan.len()..].iter().all(|p| (0.89..1.11).contains(&p.x)));
}

/// Between two plates, a slot eight times as wide as the distance of neighbours stays open, and so does the outside of a ragged rim.
#[test]
fn a_slot_stays_open() {
    let mut random = Random(9);
    let place = |_| Vec3::new(random.next(), random.next(), NOISE * random.normal());
    let plates: Vec<Vec3> = (0..8000).map(place).filter(|p| (p.x - 0.5).abs() > 0.05).collect();
    let filled =
        fill(&plates, &Settings { for_spacing: Some(0.008), max_hole: Some(0.05), ..Settings::default() });
    let added = &filled.cloud.points[plates.len()..];
    assert!(added.len() > 1000, "{:?}", filled.report);
    for p in added {
        assert!((p.x - 0.5).abs() > 0.046, "{p} is in the slot");
        assert!((-1e-3..1.0 + 1e-3).contains(&p.x) && (-1e-3..1.0 + 1e-3).contains(&p.y), "{p} is outside");
    }
}

/// A hole wider than --max-hole stays open, and is reported with its place.
#[test]
fn what_stays_sparse_is_reported_and_what_does_not_fit_into_memory_is_refused() {
    let scan = half_pipe();
    let few: Vec<Vec3> =
        scan.iter().copied().filter(|p| (p - Vec3::new(1.2, 0.0, -RADIUS)).norm() > 0.06).collect();
    let report = fill(&few, &wanted()).report.sparse.unwrap();
    let at = report.widest_at.unwrap();
    assert!(report.left > 0 && report.widest_left > 0.1, "{report:?}");
    assert!((Vec3::from(at) - Vec3::new(1.2, 0.0, -RADIUS)).norm() < 0.02, "{at:?}");
    let error = cloud::fill(cloud(scan), &Settings { for_spacing: Some(1e-5), ..wanted() }).unwrap_err();
    assert!(
        matches!(error, FillError::TooManySparse { .. }) && error.to_string().contains("millimetres"),
        "{error}"
    );
}

/// A plate scanned from both sides, 10 mm between neighbours. Three times as thick, each side is filled alone; as thick as that, it is refused and
/// reported. Around the rim the sides may be joined by a round edge; nothing grows beyond it.
#[test]
fn the_sides_of_a_plate_are_filled_alone_or_not_at_all() {
    let settings = Settings { for_spacing: Some(0.008), max_hole: Some(0.05), ..Settings::default() };
    for (thickness, most_off) in [(0.03, 0.02), (0.012, 1.0)] {
        let mut random = Random(11);
        let place = |k: i32| {
            let z = if k % 2 == 0 { 0.0 } else { thickness };
            Vec3::new(0.5 * random.next(), 0.5 * random.next(), z + 0.0003 * random.normal())
        };
        let plate: Vec<Vec3> = (0..5000).map(place).collect();
        let filled = fill(&plate, &settings);
        let (added, report) = (&filled.cloud.points[plate.len()..], filled.report.sparse.unwrap());
        println!("{thickness} m thick: {report:?}");
        assert!(
            if thickness > 0.02 { added.len() > 7000 } else { added.len() < 50 && report.left > 1000 },
            "{report:?}"
        );
        let off = |p: &Vec3| p.z.abs().min((p.z - thickness).abs());
        let off = added.iter().filter(|p| off(p) > 0.001).count();
        assert!(
            off as f64 <= most_off * added.len() as f64,
            "{off} of {} are between the sides",
            added.len()
        );
        let beyond = |p: &Vec3| {
            (p - Vec3::new(0.25, 0.25, 0.5 * thickness)).abs() - Vec3::new(0.25, 0.25, 0.5 * thickness)
        };
        assert!(added.iter().all(|p| beyond(p).max() < 0.5 * thickness), "beyond the rim");
    }
}
