//! Plates, edges and noise: what is thin is sampled on both sides.

use super::*;

/// Both sides of a plate of the given thickness [m], 1 m wide, closed around its edges; noise of σ [m] along each axis.
fn plate(count: usize, thickness: f64, noise: f64) -> Vec<Vec3> {
    let mut next = uniform(11);
    let rim = thickness / (1.0 + thickness);
    (0..count)
        .map(|_| {
            let off = |n: &mut dyn FnMut() -> f64| noise * (n() + n() + n() + n() - 2.0) * 3f64.sqrt();
            let (x, y, side) = (next(), next(), next());
            let p = if side < rim {
                Vec3::new(if side < 0.5 * rim { 0.0 } else { 1.0 }, y, x * thickness)
            } else if side < 2.0 * rim {
                Vec3::new(y, if side < 1.5 * rim { 0.0 } else { 1.0 }, x * thickness)
            } else {
                Vec3::new(x, y, if next() < 0.5 { 0.0 } else { thickness })
            };
            p + Vec3::new(off(&mut next), off(&mut next), off(&mut next))
        })
        .collect()
}

/// Density of the sample on one side of the plate, away from its rim, times the spacing squared.
fn packing(points: &[Vec3], kept: &[u32], spacing: f64, thickness: f64, upper: bool) -> f64 {
    let inside = |p: &&Vec3| (0.1..0.9).contains(&p.x) && (0.1..0.9).contains(&p.y);
    let on = |p: &&Vec3| (p.z > 0.5 * thickness) == upper;
    pick(points, kept).iter().filter(inside).filter(on).count() as f64 * spacing * spacing / 0.64
}

#[test]
fn both_sides_of_a_thin_plate_are_sampled_as_if_each_were_alone() {
    let spacing = 0.06;
    for (thickness, noise) in [(0.025, 0.0), (0.04, 0.0015)] {
        let points = plate(40_000, thickness, noise);
        for method in [Method::Poisson, Method::Eliminate, Method::Relax, Method::Tile] {
            let made = sample(&points, None, &settings(Amount::Spacing(spacing), method)).unwrap();
            let sides = [true, false].map(|up| packing(&points, &made.kept, spacing, thickness, up));
            let on = format!("{method:?}, {thickness} m, noise {noise} m: {sides:?}, {} beside", made.beside);
            assert!(sides.iter().all(|p| (0.6..0.76).contains(p)) && made.beside > 50, "{on}");
            let flat: Vec<u32> =
                made.kept.iter().copied().filter(|&i| points[i as usize].z < 0.5 * thickness).collect();
            let nearest = sampling::nearest_distances(&pick(&points, &flat)).unwrap();
            let least = if method == Method::Eliminate { 0.6 } else { 0.97 };
            assert!(nearest.min > least * spacing && nearest.variation < 0.16, "{on}: {nearest:?}");
            let air =
                SampleSettings { distance: Distance::Space, ..settings(Amount::Spacing(spacing), method) };
            let through = sample(&points, None, &air).unwrap();
            assert!(
                through.kept.len() < made.kept.len() * 17 / 20 && through.beside == 0,
                "{on}: {}",
                through.kept.len()
            );
        }
    }
}

/// Two halves of a sheet that meet at an edge of `angle`, turned out of the axes.
fn edge(count: usize, angle: f64) -> Vec<Vec3> {
    let mut next = uniform(5);
    (0..count)
        .map(|_| {
            let (along, across) = (next(), 2.0 * next() - 1.0);
            let (sin, cos) = libm::sincos(if across < 0.0 { 0.0 } else { std::f64::consts::PI - angle });
            Vec3::new(across * cos + 0.3 * along, along, across * sin + 0.2 * along)
        })
        .collect()
}

#[test]
fn a_sharp_edge_thins_across_itself() {
    for degrees in [170.0, 135.0, 90.0f64] {
        let points = edge(150_000, degrees.to_radians());
        let on_surface = settings(Amount::Spacing(0.04), Method::Poisson);
        let made = sample(&points, None, &on_surface).unwrap();
        let space =
            sample(&points, None, &SampleSettings { distance: Distance::Space, ..on_surface }).unwrap();
        assert!(made.beside <= 2, "{degrees}°: {} beside of {}", made.beside, made.kept.len());
        assert!(made.kept.len() - space.kept.len() <= 2);
    }
}

/// Noise of a third of the scan's own spacing leaves one sheet one sheet: almost no point is kept as if on another one.
#[test]
fn a_noisy_sheet_is_one_sheet() {
    let (count, mut next) = (40_000, uniform(5));
    let scan = libm::sqrt(1.0 / f64::from(count));
    for share in [0.1, 1.0 / 3.0] {
        let mut off = || share * scan * (next() + next() + next() + next() - 2.0) * 3f64.sqrt();
        let noise: Vec<Vec3> = (0..count).map(|_| Vec3::new(off(), off(), off())).collect();
        let points: Vec<Vec3> = noise.iter().map(|n| Vec3::new(next(), next(), 0.0) + n).collect();
        let on_surface = settings(Amount::Spacing(0.06), Method::Poisson);
        let made = sample(&points, None, &on_surface).unwrap();
        let space =
            sample(&points, None, &SampleSettings { distance: Distance::Space, ..on_surface }).unwrap();
        let (kept, more) = (made.kept.len(), made.kept.len().abs_diff(space.kept.len()));
        assert!(space.kept.len() > 150, "{}", space.kept.len());
        assert!(
            made.beside * 50 <= kept && more * 50 <= kept,
            "{share}: {} beside, {more} more, of {kept}",
            made.beside
        );
    }
}

#[test]
fn rows_of_a_scanner_are_one_sheet() {
    // Points 1 mm apart in rows 8 mm apart, on a bent surface.
    let points: Vec<Vec3> = (0..1000)
        .flat_map(|x| (0..125).map(move |y| (0.001 * f64::from(x), 0.008 * f64::from(y))))
        .map(|(x, y)| Vec3::new(x, y, 0.2 * libm::sin(3.0 * y)))
        .collect();
    let made = sample(&points, None, &settings(Amount::Spacing(0.03), Method::Poisson)).unwrap();
    assert_eq!(made.beside, 0);
}

#[test]
fn counts_of_thin_plates_and_of_few_points_are_met() {
    let points = plate(10_000, 0.04, 0.0);
    for method in [Method::Poisson, Method::Eliminate, Method::Relax, Method::Tile, Method::Grid] {
        for count in [3, 150] {
            let made = sample(&points, None, &settings(Amount::Count(count), method)).unwrap();
            let off = made.kept.len().abs_diff(count);
            let exact = method == Method::Eliminate || (count < 200 && method != Method::Grid);
            let most = if exact { 0 } else { count / 100 };
            assert!(off <= most || method == Method::Grid, "{method:?}: {} for {count}", made.kept.len());
        }
    }
}

/// No spacing leaves seven tenths of a lattice; those that go are many, and go from everywhere.
#[test]
fn counts_between_the_samples_of_a_lattice_are_met_without_holes() {
    let (side, count) = (200, 28_000);
    let points: Vec<Vec3> =
        (0..side * side).map(|k| Vec3::new(f64::from(k % side), f64::from(k / side), 0.0)).collect();
    let kept = sample(&points, None, &settings(Amount::Count(count), Method::Poisson)).unwrap().kept;
    assert_eq!(kept.len(), count);
    let mut near = vec![false; points.len()];
    for p in pick(&points, &kept) {
        for (dx, dy) in [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)] {
            let (x, y) = (p.x as i32 + dx, p.y as i32 + dy);
            if (0..side).contains(&x) && (0..side).contains(&y) {
                near[(y * side + x) as usize] = true;
            }
        }
    }
    assert!(near.iter().all(|&near| near), "a hole");
}
