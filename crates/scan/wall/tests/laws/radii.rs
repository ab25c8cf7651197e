//! Radii of wall spheres: equation (1), solved and uniform.

use super::*;

#[test]
fn on_an_even_lattice_solved_and_uniform_radii_are_those_of_equation_1() {
    let points = lattice(20, 0.01);
    for zeta in [1e-5, 0.001, 0.005] {
        let even = equation::radius(0.01, zeta).unwrap();
        for radius in [Radius::Solve, Radius::Uniform] {
            for representative in [Representative::Mean, Representative::Median] {
                let settings = WallSettings { representative, ..with(radius) };
                let (wall, report) = build(&points, &everywhere(zeta), &settings).unwrap();
                assert!(wall.radii.iter().all(|r| (r / even - 1.0).abs() < 1e-9), "ζ = {zeta}, {radius:?}");
                assert_eq!(report.changes.pairs, 2 * 20 * 19, "the lattice's edges and no diagonals");
                assert!(report.changes.largest_change < 1e-6 * zeta);
            }
        }
    }
}

#[test]
fn roughness_above_half_the_spacing_is_refused_with_place_value_and_cure() {
    let points = lattice(5, 0.01);
    for radius in [Radius::Solve, Radius::Uniform] {
        let error = build(&points, &everywhere(0.0051), &with(radius)).unwrap_err();
        assert!(matches!(error, WallError::TooRough { .. }));
        let text = error.to_string();
        assert!(text.contains("0.0051 m") && text.contains("at most 0.005 m"), "{text}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Regions::one(Some(bad), steel(), Vec3::zeros()).is_err());
    }
}

#[test]
fn solving_changes_fewer_pairs_and_by_less_than_one_radius_for_all() {
    let (points, zeta) = (shaken(30, 0.01, 0.002), 0.0008);
    let (wall, solved) = build(&points, &everywhere(zeta), &with(Radius::Solve)).unwrap();
    let (_, uniform) = build(&points, &everywhere(zeta), &with(Radius::Uniform)).unwrap();
    assert!(solved.changes.pairs_changed * 10 < uniform.changes.pairs_changed * 9);
    assert!(solved.changes.mean_change < 0.8 * uniform.changes.mean_change, "{solved:?} {uniform:?}");
    let [least, _, largest] = solved.radius_range;
    assert!(largest / least < 4.1);
    // A pair that is not counted as changed meets equation (1).
    let mut met = 0;
    for (i, j) in pairs(&points, 0.008) {
        let (r_i, r_j) = (wall.radii[i as usize], wall.radii[j as usize]);
        let p = (points[i as usize] - points[j as usize]).norm();
        assert!((r_i - r_j).abs() < p, "one sphere inside the other");
        met += (equation::residual(r_i, r_j, zeta, p).abs() < 1e-7 * p) as usize;
    }
    assert!(met >= solved.changes.pairs - solved.changes.pairs_changed && met > 100, "{met}");
}
