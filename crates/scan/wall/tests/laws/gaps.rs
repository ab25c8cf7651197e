//! Pairs of neighbours and gaps between spheres, against brute force.

use super::*;

#[test]
fn gabriel_pairs_are_those_of_brute_force() {
    let points = shaken(16, 0.01, 0.002);
    let apart = |i: usize, k: usize| if i == k { f64::INFINITY } else { (points[i] - points[k]).norm() };
    let nearest = |i: usize| (0..points.len()).map(|k| apart(i, k)).fold(f64::INFINITY, f64::min);
    let mut brute = Vec::new();
    for j in 0..points.len() {
        for i in 0..j {
            let (middle, p) = ((points[i] + points[j]) / 2.0, (points[i] - points[j]).norm());
            let empty = (0..points.len()).all(|k| k == i || k == j || (points[k] - middle).norm() >= 0.5 * p);
            if empty && p <= 2.0 * nearest(i).max(nearest(j)) {
                brute.push((i as u32, j as u32));
            }
        }
    }
    brute.sort_unstable();
    assert_eq!(pairs(&points, 0.008), brute);
}

#[test]
fn the_widest_gap_of_a_square_lattice_is_its_diagonal_less_two_radii() {
    let points = lattice(12, 0.01);
    let settings = WallSettings { smallest_particle: Some(0.002), ..with(Radius::Given(0.006)) };
    let (_, report) = build(&points, &everywhere(0.001), &settings).unwrap();
    let gap = 0.01 * 2f64.sqrt() - 0.012;
    assert!((report.widest_gap.unwrap().diameter - gap).abs() < 1e-12);
    assert!(report.leaks > 0 && report.warnings[0].contains("leaks"), "{:?}", report.warnings);
    let settings = WallSettings { smallest_particle: Some(0.0022), ..settings.clone() };
    let (_, report) = build(&points, &everywhere(0.001), &settings).unwrap();
    assert_eq!((report.leaks, report.warnings.len()), (0, 0));
}

/// A point missing in the outermost row leaves a notch, one missing inside leaves a hole of the same width.
#[test]
fn a_notch_of_the_rim_is_no_leak_and_a_hole_of_its_width_is() {
    let leaks = |hole: Vec3| {
        let points: Vec<Vec3> = lattice(12, 0.01).into_iter().filter(|p| (p - hole).norm() > 0.005).collect();
        let settings = WallSettings { smallest_particle: Some(0.004), ..with(Radius::Given(0.0075)) };
        build(&points, &everywhere(0.001), &settings).unwrap().1.leaks
    };
    let corner = lattice(12, 0.01)[0];
    assert_eq!(leaks(corner + Vec3::new(0.05, 0.0, 0.0)), 0);
    assert!(leaks(corner + Vec3::new(0.05, 0.05, 0.0)) > 0);
}

/// Points that were eliminated leave a ragged rim, whose voids open outwards: no gap is reported there, and those inside are as
/// wide as brute force finds them.
#[test]
fn no_gap_lies_beyond_the_rim_and_the_widest_inside_is_that_of_brute_force() {
    let (side, big) = (0.15, 0.006);
    let scan = shaken(180, 2.0 * side / 180.0, 0.01);
    let amount = sampling::Amount::Count(900);
    let settings = sampling::SampleSettings {
        amount,
        method: sampling::Method::Eliminate,
        distance: sampling::Distance::Surface,
        seed: 1,
    };
    let kept = sampling::sample(&scan, None, &settings).unwrap().kept;
    let points: Vec<Vec3> = kept.iter().map(|&k| scan[k as usize]).collect();
    let cells = Cells::new(&points, wall::pairs::REACH * 0.008);
    let (stars, points) = (geom::star::stars(&cells, 3.0 * 0.008), &cells.points);
    let radii = vec![big; points.len()];
    let (low, high) = points.iter().fold((points[0], points[0]), |(a, b), p| (a.inf(p), b.sup(p)));
    let inside = |at: &[f64; 3]| (0..2).all(|k| at[k] > low[k] && at[k] < high[k]);
    let gaps: Vec<_> = stars.triangles.iter().filter_map(|t| wall::leak::gap(points, &radii, t)).collect();
    let (widest, _) = wall::leak::widest(points, &radii, &stars.triangles, &stars.outline, 0.002);
    assert!(inside(&widest.unwrap().at), "{widest:?}");
    let deep = |c: f64| (0.03..2.0 * side - 0.03).contains(&c);
    let found =
        gaps.iter().filter(|g| deep(g.at[0]) && deep(g.at[1])).map(|g| g.diameter).fold(0.0, f64::max);
    let clear = |x: f64, y: f64| {
        let nearest = points.iter().map(|p| (p.x - x).hypot(p.y - y)).fold(f64::INFINITY, f64::min);
        2.0 * (nearest - big)
    };
    let step = 0.001;
    let of = |k: u32| 0.03 + step * f64::from(k);
    let steps = ((2.0 * side - 0.06) / step) as u32;
    let brute = (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j)));
    let brute = brute.map(|(i, j)| clear(of(i), of(j))).fold(0.0, f64::max);
    // A place of the grid is within half its diagonal of the best one.
    assert!(brute <= found + 1e-12 && found - brute < 1.5 * step, "{found} m, by brute force {brute} m");
}

#[test]
fn a_missing_sphere_is_found_as_the_widest_gap() {
    let mut points = lattice(12, 0.01);
    let hole = points.remove(5 * 12 + 6);
    let settings = WallSettings { smallest_particle: Some(0.006), ..with(Radius::Given(0.007)) };
    let (_, report) = build(&points, &everywhere(0.001), &settings).unwrap();
    let gap = report.widest_gap.unwrap();
    assert!((Vec3::from(gap.at) - hole).norm() < 1e-9 && (gap.diameter - 0.006).abs() < 1e-9, "{gap:?}");
}

#[test]
fn spheres_much_smaller_than_the_particles_are_warned_of() {
    let settings = WallSettings { smallest_particle: Some(0.0151), ..with(Radius::Given(0.006)) };
    let (_, report) = build(&lattice(5, 0.005), &everywhere(0.001), &settings).unwrap();
    assert!(report.warnings[0].contains("80 %"), "{:?}", report.warnings);
}
