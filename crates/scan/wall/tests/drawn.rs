//! Spheres of drawn equipment, against bodies whose inside is known.

use geom::mesh::{TriMesh, cuboid};
use geom::{Shape, Vec3};
use record::MaterialRecord;
use std::f64::consts::TAU;
use wall::drawn::{Drawing, Drawn, place};
use wall::{Radius, Regions, WallError, WallSettings, build, equation};

const RADIUS: f64 = 0.02;
const ZETA: f64 = 0.004;

fn drawing() -> Drawing {
    Drawing { radius: RADIUS, roughness: ZETA, flow_at: None, centred: false }
}

/// A closed cylinder around z of radius 0.4 m and height 0.8 m, of `n` sides.
fn cylinder(n: u32) -> TriMesh {
    const WIDE: f64 = 0.4;
    let ring = |z: f64| {
        (0..n).map(move |i| {
            let turn = TAU * f64::from(i) / f64::from(n);
            Vec3::new(turn.cos(), turn.sin(), z) * WIDE
        })
    };
    let mut vertices: Vec<Vec3> = ring(-1.0).chain(ring(1.0)).collect();
    vertices.extend([Vec3::z() * -WIDE, Vec3::z() * WIDE]);
    let faces = (0..n).flat_map(|i| {
        let (a, b) = (i, (i + 1) % n);
        [[a, b, b + n], [a, b + n, a + n], [b, a, 2 * n], [a + n, b + n, 2 * n + 1]]
    });
    TriMesh::new(vertices.clone(), faces.collect()).unwrap()
}

/// Every sphere is inside of `mesh`, and touches it.
fn check_inside(mesh: &TriMesh, drawn: &Drawn) {
    for c in &drawn.centres {
        let (q, _) = mesh.closest(*c).unwrap();
        assert!(
            ((c - q).norm() / RADIUS - 1.0).abs() < 2e-6,
            "{} m from the surface at {c:?}",
            (c - q).norm()
        );
        assert!(mesh.contains(c), "{c:?} is outside");
    }
}

#[test]
fn spheres_of_a_box_are_inside_and_touch_it_at_both_ends_of_every_edge_and_between() {
    let (lo, hi) = (Vec3::zeros(), Vec3::new(0.3, 0.4, 0.25));
    let mesh = cuboid(lo, hi);
    let drawn = place(&mesh, &drawing()).unwrap();
    check_inside(&mesh, &drawn);
    let report = &drawn.report;
    assert_eq!((report.stretches, report.corners, report.closed_parts), (12, 8, 1));
    let spacing = equation::spacing(RADIUS, ZETA).unwrap();
    assert_eq!(report.spacing_asked, spacing);
    // A sphere in each corner touches its three faces; along an edge they stand at most the spacing apart.
    let inset = |x: f64, lo: f64, hi: f64| (x - lo - RADIUS).abs().min((hi - RADIUS - x).abs()) < 1e-6;
    let sides = |c: &Vec3| (0..3).filter(|&a| inset(c[a], lo[a], hi[a])).count();
    assert_eq!(drawn.centres.iter().filter(|c| sides(c) == 3).count(), 8);
    let mut along: Vec<f64> = drawn
        .centres
        .iter()
        .filter(|c| inset(c.x, 0.0, 0.3) && c.x < 0.15 && inset(c.y, 0.0, 0.4) && c.y < 0.2)
        .map(|c| c.z)
        .collect();
    along.sort_by(f64::total_cmp);
    assert!((along[0] - RADIUS).abs() < 1e-6 && (along[along.len() - 1] - 0.25 + RADIUS).abs() < 1e-6);
    assert!(along.windows(2).all(|w| w[1] - w[0] <= spacing * 1.001), "{along:?}");
    // No place of the surface lies deeper than a sphere's radius, and few nearly so.
    assert!(report.deepest < RADIUS, "{report:?}");
    assert_eq!(report.too_thin, 0.0);
}

#[test]
fn the_mean_distance_is_the_one_that_roughness_and_radius_ask_for_and_nothing_leaks() {
    let drawn = place(&cylinder(48), &drawing()).unwrap();
    check_inside(&cylinder(48), &drawn);
    let regions = Regions::one(
        Some(ZETA),
        MaterialRecord { name: "s".into(), ..MaterialRecord::default() },
        Vec3::zeros(),
    )
    .unwrap();
    let settings = WallSettings {
        radius: Radius::Given(RADIUS),
        smallest_particle: Some(RADIUS),
        ..WallSettings::default()
    };
    let (_, report) = build(&drawn.centres, &regions, &settings).unwrap();
    assert!((report.spacing / drawn.report.spacing_asked - 1.0).abs() < 0.02, "{} m", report.spacing);
    assert_eq!(report.leaks, 0, "{:?}", report.widest_gap);
    // Two rims without corners, and nothing else is a stretch: 48 sides turn by 7.5°.
    assert_eq!((drawn.report.stretches, drawn.report.corners), (2, 0));
}

#[test]
fn a_place_in_the_flow_puts_the_spheres_on_its_other_side_however_the_faces_are_drawn() {
    let mut mesh = cylinder(24);
    (0..mesh.faces.len()).step_by(3).for_each(|f| mesh.faces[f].swap(0, 1));
    let outside = place(&mesh, &Drawing { flow_at: Some(Vec3::zeros()), ..drawing() }).unwrap();
    assert!(outside.centres.iter().all(|c| !cylinder(24).contains(c)));
    assert_eq!(outside.report.one_sided_edges, 0);
    let inside = place(&mesh, &drawing()).unwrap();
    check_inside(&cylinder(24), &inside);
    let again = place(&mesh, &Drawing { flow_at: Some(Vec3::new(3.0, 0.0, 0.0)), ..drawing() }).unwrap();
    assert_eq!(again.centres.len(), inside.centres.len());
}

/// A cone upside down with a lid, whose rim is a wedge of 45° of many short edges: no sphere stands beside it.
#[test]
fn spheres_at_a_sharp_rim_are_inside() {
    let n = 28u32;
    let rim = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(n)).sin_cos();
        Vec3::new(cos, sin, 1.0)
    };
    let vertices: Vec<Vec3> = (0..n).map(rim).chain([Vec3::zeros(), Vec3::z()]).collect();
    let sides = (0..n).flat_map(|k| [[(k + 1) % n, k, n], [k, (k + 1) % n, n + 1]]).collect();
    let mesh = TriMesh::new(vertices, sides).unwrap();
    let drawing = Drawing { radius: 0.05, roughness: 0.05 / 6.0, flow_at: None, centred: false };
    let drawn = place(&mesh, &drawing).unwrap();
    let beside = drawn.centres.iter().filter(|c| c.xy().norm() > c.z || c.z > 1.0).count();
    assert_eq!(beside, 0, "of {} spheres", drawn.centres.len());
}

#[test]
fn an_open_sheet_and_a_thin_plate_touch_from_behind() {
    let corner = [Vec3::zeros(), Vec3::x(), Vec3::new(1.0, 1.0, 0.0), Vec3::y()];
    let sheet = TriMesh::new(corner.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let drawn = place(&sheet, &drawing()).unwrap();
    assert!(
        drawn.centres.iter().all(|c| (c.z + RADIUS).abs() < 1e-9),
        "the front is where corners run anticlockwise"
    );
    assert_eq!((drawn.report.stretches, drawn.report.corners), (4, 4));
    let turned = place(&sheet, &Drawing { flow_at: Some(-Vec3::z()), ..drawing() }).unwrap();
    assert!(turned.centres.iter().all(|c| (c.z - RADIUS).abs() < 1e-9));
    let plate = place(&cuboid(Vec3::zeros(), Vec3::new(1.0, 1.0, RADIUS)), &drawing()).unwrap();
    assert!(plate.report.too_thin > 0.9 && plate.report.too_thin_at.is_some(), "{:?}", plate.report);
    let up = plate.centres.iter().filter(|c| c.z.abs() < 1e-9).count();
    let down = plate.centres.iter().filter(|c| (c.z - RADIUS).abs() < 1e-9).count();
    assert!(up.min(down) > 500, "both faces have spheres of their own: {up} {down}");
    let on = place(&sheet, &Drawing { centred: true, ..drawing() }).unwrap();
    assert!(on.centres.iter().all(|c| c.z == 0.0));
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| place(&cylinder(30), &drawing()).unwrap())
    };
    let one = run(1);
    assert!([2, 5].iter().all(|&threads| run(threads) == one));
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
    let with = |radius, roughness| place(&mesh, &Drawing { radius, roughness, ..drawing() }).unwrap_err();
    assert!(matches!(with(0.0, 0.1), WallError::BadRadius(_)));
    assert!(matches!(with(0.1, 0.2), WallError::DeeperThanRadius { .. }));
    assert!(matches!(with(1e-6, 1e-7), WallError::TooManySpheres { .. }));
    let flat = TriMesh::new(vec![Vec3::zeros(); 3], vec![[0, 1, 2]]).unwrap();
    assert!(matches!(place(&flat, &drawing()), Err(WallError::NoArea)));
}

#[test]
fn a_region_by_wear_and_position_sets_the_roughness_of_every_sphere() {
    let text = "roughness = 1e-4\n[wear]\ntable = \"w.csv\"\nvalue = 5\nalong = [1, 0, 0]\n\
                [[region]]\nshape = \"box:-1,-1,-1,0.2,2,1\"\nroughness = 7e-4\n";
    let table = |_: &str| Ok("wear, 0, 1\n0, 1e-4, 2e-4\n10, 3e-4, 4e-4\n".to_owned());
    let none = |_: &str| Err("no meshes here".to_owned());
    let material = MaterialRecord { name: "s".into(), ..MaterialRecord::default() };
    let mut regions = Regions::parse(text, material, Vec3::zeros(), &none, &table).unwrap();
    let points: Vec<Vec3> =
        (0..400).map(|i| Vec3::new((i % 20) as f64, (i / 20) as f64, 0.0) * 0.05).collect();
    let report = regions.measure(&points, &|_| None).unwrap().unwrap();
    assert_eq!((report.not_measured, report.beyond), (0, 0));
    let (wall, _) = build(&points, &regions, &WallSettings::default()).unwrap();
    let table = wall.table(&regions).unwrap();
    let inside: Shape = "box:-1,-1,-1,0.2,2,1".parse().unwrap();
    for (i, p) in points.iter().enumerate() {
        let wanted = if inside.contains(p) { 7e-4 } else { 2e-4 + 1e-4 * p.x };
        let found = table.get("roughness").unwrap().get(i);
        assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    }
}
