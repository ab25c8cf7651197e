//! What every sample must hold, against brute force and closed answers.

mod thin;

use geom::Vec3;
use sampling::{Amount, Distance, Method, SampleError, SampleSettings, sample};

/// Uniform numbers in [0, 1) of a small generator (splitmix64).
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = state;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Points of a wavy sheet 1 m wide.
fn sheet(count: usize, seed: u64) -> Vec<Vec3> {
    let mut next = uniform(seed);
    (0..count)
        .map(|_| {
            let (x, y) = (next(), next());
            Vec3::new(x, y, 0.1 * libm::sin(6.0 * x) + 0.001 * next())
        })
        .collect()
}

/// A half pipe scanned from one end: density falls as 1/distance², 0.8 mm noise, a blind patch.
fn chute(count: usize) -> Vec<Vec3> {
    let mut next = uniform(7);
    let mut points = Vec::new();
    while points.len() < count {
        let (x, angle) = (3.0 * next(), (2.0 * next() - 1.0) * (std::f64::consts::FRAC_PI_2 + 0.3));
        let (radius, chance) = (0.45 - 0.05 * x / 3.0, 0.36 / ((x + 0.6) * (x + 0.6)));
        if next() < chance && (x - 1.7).hypot(radius * (angle - 0.2)) > 0.12 {
            let noise = |a: f64, b: f64| {
                0.0008 * (-2.0 * libm::log(1.0 - a)).sqrt() * libm::cos(std::f64::consts::TAU * b)
            };
            let off = Vec3::new(noise(next(), next()), noise(next(), next()), noise(next(), next()));
            points.push(Vec3::new(x, radius * libm::sin(angle), -radius * libm::cos(angle)) + off);
        }
    }
    points
}

fn settings(amount: Amount, method: Method) -> SampleSettings {
    SampleSettings { amount, method, distance: Distance::Surface, seed: 0 }
}

fn pick(points: &[Vec3], kept: &[u32]) -> Vec<Vec3> {
    kept.iter().map(|&i| points[i as usize]).collect()
}

#[test]
fn no_two_kept_points_are_nearer_and_no_point_is_farther_than_the_spacing() {
    for (seed, spacing) in [(1, 0.02), (2, 0.05), (3, 0.3), (4, 5.0), (5, 1e-4)] {
        let points = sheet(3000, seed);
        for seed in [0, 9] {
            let settings = SampleSettings { seed, ..settings(Amount::Spacing(spacing), Method::Poisson) };
            let kept = pick(&points, &sample(&points, None, &settings).unwrap().kept);
            for (i, p) in kept.iter().enumerate() {
                assert!(kept[..i].iter().all(|q| (p - q).norm() >= spacing));
            }
            for p in &points {
                assert!(kept.iter().any(|q| (p - q).norm() < spacing), "{p} is not covered");
            }
        }
    }
}

#[test]
fn the_same_points_for_any_number_of_threads() {
    let points = sheet(20_000, 6);
    for method in [Method::Poisson, Method::Eliminate, Method::Relax, Method::Tile, Method::Grid] {
        let amounts = [Amount::Spacing(0.01), Amount::Count(5000), Amount::Density(6000.0, 7000.0)];
        for amount in amounts {
            let run = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| {
                    let sample = sample(&points, None, &settings(amount, method)).unwrap();
                    let kept = pick(&points, &sample.kept);
                    let measures =
                        (sampling::nearest_distances(&kept), sampling::spectrum(&kept, sample.spacing));
                    (sample, measures)
                })
            };
            let one = run(1);
            for threads in [2, 3, 7] {
                assert!(run(threads) == one, "{method:?} {amount:?} with {threads} threads");
            }
        }
    }
}

#[test]
fn golden_samples_stay_what_they_are() {
    let points = sheet(20_000, 6);
    let hash = |method, amount| {
        let kept = sample(&points, None, &settings(amount, method)).unwrap().kept;
        let mix = |h: u64, &i: &u32| (h ^ u64::from(i)).wrapping_mul(0x0000_0100_0000_01b3);
        (kept.len(), kept.iter().fold(0xcbf2_9ce4_8422_2325, mix))
    };
    let made = [
        hash(Method::Poisson, Amount::Spacing(0.01)),
        hash(Method::Eliminate, Amount::Count(5000)),
        hash(Method::Relax, Amount::Spacing(0.01)),
        hash(Method::Grid, Amount::Spacing(0.01)),
    ];
    assert_eq!(made, GOLDEN);
}

/// Number of points, and FNV-1a of their indices.
const GOLDEN: [(usize, u64); 4] = [
    (5864, 7108701606534372638),
    (5000, 11880176359934542335),
    (5864, 7631349653192467468),
    (9709, 15234346403559292376),
];

#[test]
fn counts_are_met() {
    let points = sheet(20_000, 8);
    for count in [1, 2, 10, 100, 1000, 5000, 15_000, 20_000] {
        let kept =
            sample(&points, None, &settings(Amount::Count(count), Method::Poisson)).unwrap().kept.len();
        assert!(kept.abs_diff(count) <= (count / 100).max(1), "{kept} for {count}");
        let exact =
            sample(&points, None, &settings(Amount::Count(count), Method::Eliminate)).unwrap().kept.len();
        assert_eq!(exact, count);
    }
}

#[test]
fn densities_are_met() {
    let points = sheet(40_000, 8);
    let made = sample(&points, None, &settings(Amount::Density(3000.0, 4000.0), Method::Poisson)).unwrap();
    let density = sampling::median_density(&pick(&points, &made.kept), made.spacing);
    assert!((3000.0..4000.0).contains(&density), "{density}");
    // More than the cloud has: all points, at their own density, is the best there is, and what is reported.
    let own = sampling::median_density(&points, sampling::nearest_distances(&points).unwrap().median);
    for factor in [1.5, 5.0, 50.0] {
        let amount = Amount::Density(factor * own, 1.3 * factor * own);
        let made = sample(&points, None, &settings(amount, Method::Poisson)).unwrap();
        let found = sampling::median_density(&pick(&points, &made.kept), made.spacing);
        assert!(found < 1.2 * own && found > 0.7 * own, "{factor}: {found} of {own}");
    }
}

/// Another program's thinning of a scan like this one to as many points leaves a variation of 0.191.
#[test]
fn thinning_a_chute_scan_leaves_even_distances() {
    let points = chute(277_647);
    let made = sample(&points, None, &settings(Amount::Count(79_159), Method::Poisson)).unwrap();
    let kept = pick(&points, &made.kept);
    let before = sampling::nearest_distances(&points).unwrap();
    let after = sampling::nearest_distances(&kept).unwrap();
    assert!(made.kept.len().abs_diff(79_159) < 791);
    assert!(after.variation < 0.188 && before.variation > 0.6, "{} {}", after.variation, before.variation);
    let spectrum = sampling::spectrum(&kept, after.median).unwrap();
    assert!(spectrum.peak().1 < 1.6 && spectrum.low() < 0.4, "{:?} {}", spectrum.peak(), spectrum.low());
    assert!(spectrum.mean_anisotropy() < 1.4, "{}", spectrum.mean_anisotropy());
}

/// Below half a wave per mean spacing less than a tenth of the power of random points is left, and above it no peak of more than two and a half times that power.
#[test]
fn no_method_that_chooses_by_distance_leaves_unevenness_of_large_extent() {
    let dense = sheet(200_000, 5);
    for method in [Method::Poisson, Method::Eliminate, Method::Relax] {
        let kept = pick(&dense, &sample(&dense, None, &settings(Amount::Count(6000), method)).unwrap().kept);
        let spectrum = sampling::spectrum(&kept, sampling::nearest_distances(&kept).unwrap().median).unwrap();
        let seen = format!("{method:?}: {} {:?}", spectrum.low(), spectrum.peak());
        assert!(
            spectrum.low() < 0.10 && spectrum.peak().1 < 2.5 && spectrum.mean_anisotropy() < 1.3,
            "{seen}"
        );
    }
}

#[test]
fn the_spectrum_tells_chance_blue_noise_and_rows_apart() {
    let chance = sampling::spectrum(&sheet(20_000, 1), 0.005).unwrap();
    assert!(
        (chance.low() - 1.0).abs() < 0.15 && chance.peak().1 < 1.3,
        "{} {:?}",
        chance.low(),
        chance.peak()
    );
    let dense = sheet(300_000, 2);
    let made = sample(&dense, None, &settings(Amount::Spacing(0.008), Method::Poisson)).unwrap();
    let blue = sampling::spectrum(&pick(&dense, &made.kept), 0.01).unwrap();
    let seen = format!("{} {:?} {}", blue.low(), blue.peak(), blue.mean_anisotropy());
    // A sample as even as this has a wider first peak, as one by elimination has.
    assert!(blue.low() < 0.10 && blue.peak().1 < 2.5 && blue.mean_anisotropy() < 1.3, "{seen}");
    let rows: Vec<Vec3> =
        (0..20_000).map(|i| Vec3::new((i % 200) as f64, (i / 200) as f64, 0.0) * 0.005).collect();
    let rows = sampling::spectrum(&rows, 0.005).unwrap();
    assert!(
        rows.peak().1 > 5.0 && rows.mean_anisotropy() > 10.0,
        "{:?} {}",
        rows.peak(),
        rows.mean_anisotropy()
    );
}

#[test]
fn filled_points_are_kept_as_they_are() {
    let points = sheet(5000, 3);
    let forced: Vec<bool> = (0..5000).map(|i| i % 10 == 0).collect();
    for method in [Method::Poisson, Method::Eliminate, Method::Relax, Method::Tile, Method::Grid] {
        let made = sample(&points, Some(&forced), &settings(Amount::Spacing(0.03), method)).unwrap();
        assert!((0..5000).step_by(10).all(|i| made.kept.binary_search(&i).is_ok()), "{method:?}");
        assert!(made.kept.windows(2).all(|w| w[0] < w[1]));
        if method == Method::Poisson {
            let free = made.kept.iter().filter(|&&i| i % 10 != 0);
            let mut others = made.kept.iter().map(|&i| points[i as usize]);
            for &i in free {
                let p = points[i as usize];
                assert!(others.all(|q| q == p || (p - q).norm() >= 0.03));
            }
        }
    }
}

#[test]
fn the_grid_keeps_the_point_nearest_to_each_node() {
    let points = sheet(2000, 4);
    let kept = sample(&points, None, &settings(Amount::Spacing(0.1), Method::Grid)).unwrap().kept;
    let node = |p: &Vec3| (p / 0.1).map(f64::round);
    for (i, p) in points.iter().enumerate() {
        let off = |q: &Vec3| (q - node(p) * 0.1).norm();
        let best = points.iter().filter(|q| node(q) == node(p)).map(off).fold(f64::INFINITY, f64::min);
        assert_eq!(kept.contains(&(i as u32)), off(p) <= best, "point {i}");
    }
}

#[test]
fn hard_clouds() {
    let by = |points: &[Vec3], amount| sample(points, None, &settings(amount, Method::Poisson));
    let one = Vec3::new(1e6, 0.0, 0.0);
    assert_eq!(by(&[], Amount::Spacing(1.0)), Err(SampleError::Empty));
    assert_eq!(by(&[one], Amount::Spacing(1.0)).unwrap().kept, [0]);
    assert_eq!(by(&[one], Amount::Count(1)).unwrap().kept, [0]);
    assert_eq!(by(&[one; 50], Amount::Spacing(1e-3)).unwrap().kept.len(), 1, "duplicates");
    assert!(matches!(
        by(&[one; 50], Amount::Count(20)),
        Err(SampleError::Duplicates { asked: 20, distinct: 1 })
    ));
    let line: Vec<Vec3> = (0..1000).map(|i| Vec3::new(0.001 * i as f64, 0.0, 0.0)).collect();
    assert_eq!(by(&line, Amount::Count(100)).unwrap().kept.len(), 100, "points of a line come in steps");
    let far: Vec<Vec3> = sheet(1000, 5).into_iter().chain([Vec3::new(1e7, 0.0, 0.0)]).collect();
    assert!(by(&far, Amount::Spacing(0.1)).unwrap().kept.contains(&1000), "an outlier far away");
    let nan = [one, Vec3::new(0.0, f64::NAN, 0.0)];
    assert!(matches!(by(&nan, Amount::Spacing(1.0)), Err(SampleError::NotFinite { index: 1, .. })));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(by(&[one], Amount::Spacing(bad)), Err(SampleError::Spacing(_))));
    }
    assert!(matches!(by(&[one], Amount::Count(2)), Err(SampleError::Count { asked: 2, there: 1 })));
    assert!(matches!(by(&[one], Amount::Density(2.0, 1.0)), Err(SampleError::Density { .. })));
}
