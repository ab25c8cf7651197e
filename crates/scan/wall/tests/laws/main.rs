//! What every wall must hold, against closed answers.

mod gaps;
mod radii;
mod regions;
mod sides;

use geom::Vec3;
use record::MaterialRecord;
use sampling::cells::Cells;
use wall::{Placement, Radius, Regions, Representative, WallError, WallSettings, build, equation};

fn steel() -> MaterialRecord {
    MaterialRecord { name: "steel".to_owned(), young: Some(2e8), ..MaterialRecord::default() }
}

fn everywhere(roughness: f64) -> Regions {
    Regions::one(Some(roughness), steel(), Vec3::zeros()).unwrap()
}

/// Points of a square lattice in z = 0, `n` by `n`, at distance `p` [m].
fn lattice(n: usize, p: f64) -> Vec<Vec3> {
    (0..n * n).map(|i| Vec3::new((i % n) as f64 * p, (i / n) as f64 * p, 0.0)).collect()
}

/// The same, each point moved randomly by up to `off` [m] along x and y.
fn shaken(n: usize, p: f64, off: f64) -> Vec<Vec3> {
    let mut state = 5u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        off * (2.0 * (state >> 11) as f64 / (1u64 << 53) as f64 - 1.0)
    };
    lattice(n, p).into_iter().map(|q| q + Vec3::new(next(), next(), 0.0)).collect()
}

/// Pairs by the points' numbers, lower one first, ascending.
fn pairs(points: &[Vec3], typical: f64) -> Vec<(u32, u32)> {
    let cells = Cells::new(points, wall::pairs::REACH * typical);
    let by_place = wall::pairs::pairs(&cells, typical).pairs;
    let number = |place: u32| cells.order()[place as usize];
    let by_number = by_place.iter().map(|&(a, b)| (number(a).min(number(b)), number(a).max(number(b))));
    let mut pairs: Vec<(u32, u32)> = by_number.collect();
    pairs.sort_unstable();
    pairs
}

fn with(radius: Radius) -> WallSettings {
    WallSettings { radius, ..WallSettings::default() }
}

#[test]
fn placed_on_the_surface_spheres_touch_the_points_from_behind() {
    let settings =
        WallSettings { placement: Placement::Surface, facing: Some(Vec3::z()), ..with(Radius::Uniform) };
    let (wall, _) = build(&lattice(9, 0.01), &everywhere(0.001), &settings).unwrap();
    assert!(wall.centres.iter().zip(&wall.radii).all(|(c, r)| (c.z + r).abs() < 1e-12));
    let error =
        build(&lattice(9, 0.01), &everywhere(0.001), &WallSettings { facing: None, ..settings.clone() })
            .unwrap_err();
    assert!(matches!(error, WallError::NoFacing));
}

#[test]
fn the_flow_side_of_a_half_pipe_is_its_inside_also_past_the_vertical() {
    let points: Vec<Vec3> = (0..60 * 30)
        .map(|i| {
            let angle = -1.9 + 3.8 * (i % 60) as f64 / 59.0;
            Vec3::new(0.03 * (i / 60) as f64, 0.45 * libm::sin(angle), -0.45 * libm::cos(angle))
        })
        .collect();
    let settings =
        WallSettings { placement: Placement::Surface, facing: Some(Vec3::z()), ..with(Radius::Given(0.03)) };
    let (wall, _) = build(&points, &everywhere(0.001), &settings).unwrap();
    for c in &wall.centres {
        let off = (c.y * c.y + c.z * c.z).sqrt();
        assert!((off - 0.48).abs() < 1e-3, "{off}");
    }
}

#[test]
fn the_same_wall_for_any_number_of_threads() {
    let points = shaken(60, 0.01, 0.002);
    let settings = WallSettings { smallest_particle: Some(0.003), ..with(Radius::Solve) };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| build(&points, &everywhere(0.0008), &settings).unwrap())
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn hard_clouds() {
    let by = |points: &[Vec3]| build(points, &everywhere(0.001), &with(Radius::Solve));
    assert!(matches!(by(&[]), Err(WallError::TooFew(0))));
    assert!(matches!(by(&[Vec3::zeros()]), Err(WallError::TooFew(1))));
    assert!(matches!(by(&[Vec3::zeros(); 9]), Err(WallError::OnePlace(9))));
    let mut twice = lattice(5, 0.01);
    twice.push(twice[7]);
    assert!(matches!(by(&twice), Err(WallError::Duplicate { first: 7, second: 25, .. })));
    let nan = [Vec3::zeros(), Vec3::new(0.0, 0.0, f64::NAN)];
    assert!(matches!(by(&nan), Err(WallError::NotFinite { index: 1, .. })));
    let line: Vec<Vec3> = (0..50).map(|i| Vec3::new(0.01 * i as f64, 0.0, 0.0)).collect();
    let (wall, report) = by(&line).unwrap();
    assert_eq!(report.changes.pairs, 49);
    assert!(wall.radii.iter().all(|r| (r / equation::radius(0.01, 0.001).unwrap() - 1.0).abs() < 1e-9));
    assert!(matches!(
        build(&line, &everywhere(0.001), &with(Radius::Given(-1.0))),
        Err(WallError::BadRadius(_))
    ));
}
