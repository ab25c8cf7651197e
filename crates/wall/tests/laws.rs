//! What every wall must hold, against closed answers.

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
    let settings = WallSettings { smallest_particle: Some(0.0022), ..settings };
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

#[test]
fn placed_on_the_surface_spheres_touch_the_points_from_behind() {
    let settings =
        WallSettings { placement: Placement::Surface, facing: Some(Vec3::z()), ..with(Radius::Uniform) };
    let (wall, _) = build(&lattice(9, 0.01), &everywhere(0.001), &settings).unwrap();
    assert!(wall.centres.iter().zip(&wall.radii).all(|(c, r)| (c.z + r).abs() < 1e-12));
    let error =
        build(&lattice(9, 0.01), &everywhere(0.001), &WallSettings { facing: None, ..settings }).unwrap_err();
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
fn regions_decide_roughness_material_and_velocity() {
    let text = "roughness = 0.0005\n[[region]]\nname = \"worn\"\nshape = \"box:-1,-1,-1,0.05,1,1\"\nroughness = 0.001\n\
                friction = 0.4\nvelocity = [1, 0, 0]\n";
    let none = |_: &str| Err("no files here".to_owned());
    let regions = Regions::parse(text, steel(), Vec3::zeros(), &none, &|_| Ok(String::new())).unwrap();
    let points = lattice(12, 0.01);
    let (wall, _) = build(&points, &regions, &with(Radius::Solve)).unwrap();
    let table = wall.table(&regions).unwrap();
    let names: Vec<&str> = table.columns().iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "radius", "material", "roughness", "region", "vx", "vy", "vz"]);
    let worn = |i: usize| points[i].x <= 0.05;
    for i in 0..points.len() {
        assert_eq!(table.get("region").unwrap().get(i), f64::from(worn(i)));
        assert_eq!(table.get("roughness").unwrap().get(i), if worn(i) { 0.001 } else { 0.0005 });
        assert_eq!(table.get("vx").unwrap().get(i), f64::from(worn(i)));
    }
    assert_eq!(regions.materials[1].name, "steel-worn");
    assert_eq!((regions.materials[1].friction, regions.materials[1].young), (Some(0.4), Some(2e8)));
    for (bad, says) in [
        ("roughness = 1e-3\nwear = 1", "wear"),
        ("rouhgness = 1e-3", "rouhgness"),
        ("[[region]]\nshape = \"cube:1\"", "region 1"),
        ("[[region]]\nshape = \"sphere:0,0,0,1\"\nfriction = -1", "friction"),
        ("roughness = -1", "roughness"),
    ] {
        let error = Regions::parse(bad, steel(), Vec3::zeros(), &none, &|_| Ok(String::new()))
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{bad}: {error}");
    }
}

/// A class of the scan, or a range of a colour, decides as a shape does; a range that no point has is refused.
#[test]
fn a_column_of_the_cloud_decides_as_a_shape_does() {
    let text = "roughness = 0.0005\n[[region]]\nname = \"red\"\ncolumn = \"r\"\nvalues = [200, 255]\nfriction = 0.8\n\
                [[region]]\nname = \"six\"\nshape = \"box:0,0,-1,0.055,1,1\"\ncolumn = \"class\"\nvalues = 6\nroughness = 0.001\n";
    let none = |_: &str| Err("no files here".to_owned());
    let points = lattice(12, 0.01);
    let red = |i: usize| i.is_multiple_of(5);
    let six = |i: usize| i.is_multiple_of(2);
    let property = |name: &str| match name {
        "r" => Some((0..points.len()).map(|i| if red(i) { 220.0 } else { 10.0 }).collect()),
        "class" => Some((0..points.len()).map(|i| if six(i) { 6.0 } else { 2.0 }).collect()),
        _ => None,
    };
    let parse = |text: &str| Regions::parse(text, steel(), Vec3::zeros(), &none, &|_| Ok(String::new()));
    let mut regions = parse(text).unwrap();
    assert!(regions.measure(&points, &property).unwrap().is_none());
    let (wall, _) = build(&points, &regions, &with(Radius::Solve)).unwrap();
    for (i, p) in points.iter().enumerate() {
        let wanted = if red(i) { 1 } else { 2 * u16::from(six(i) && p.x <= 0.055) };
        assert_eq!(wall.regions[i], wanted, "point {i}");
    }
    assert_eq!(regions.materials[1].friction, Some(0.8));
    for (bad, says) in [
        ("[[region]]\nname = \"a\"\nfriction = 1", "region 1 'a': give shape, or column and values"),
        ("[[region]]\ncolumn = \"r\"", "column without values"),
        ("[[region]]\nvalues = 3", "values without column"),
        ("[[region]]\ncolumn = \"r\"\nvalues = [3, 2]", "the smallest, then the largest"),
        ("[[region]]\ncolumn = \"g\"\nvalues = 3", "no property 'g'"),
        ("[[region]]\ncolumn = \"r\"\nvalues = [20, 30]", "its values are 10 to 220"),
    ] {
        let message = match parse(bad) {
            Err(e) => e.to_string(),
            Ok(mut regions) => regions.measure(&points, &property).unwrap_err().to_string(),
        };
        assert!(message.contains(says), "{bad}: {message}");
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

#[test]
fn the_stream_says_what_the_wall_is_made_of() {
    use stream::mcap::{Event, Provenance, Reader};
    let regions = everywhere(0.001);
    let (wall, _) = build(&lattice(4, 0.01), &regions, &with(Radius::Uniform)).unwrap();
    let provenance =
        Provenance { tool: "wallgen".into(), version: "0".into(), arguments: vec![], inputs: vec![] };
    let bytes = wall::write_mcap(Vec::new(), &wall.table(&regions).unwrap(), &regions, &provenance).unwrap();
    let (mut materials, mut rows) = (false, 0);
    for event in Reader::new(bytes.as_slice()) {
        match event.unwrap() {
            Event::Metadata { name, map, .. } if name == "materials" => {
                assert_eq!(map["0"], r#"{"name":"steel","young":200000000.0}"#);
                materials = true;
            }
            Event::Points { topic, time_ns, table, .. } => {
                assert!(materials && topic == "/walls" && time_ns == 0, "materials come first");
                rows = table.rows();
            }
            _ => {}
        }
    }
    assert_eq!(rows, 16);
}
