//! Filling bent surfaces scanned with noise of a third of the spacing: the hole is closed, within the noise, and nothing is added outside.

mod random;

use cloud::fill::{Filled, Settings};
use cloud::{Cloud, Mesher};
use geom::Vec3;
use random::Random;
use stream::Table;

/// A surface with a hole.
struct Scan {
    name: &'static str,
    /// An even place of the surface from chance.
    place: fn(&mut Random) -> Vec3,
    /// Distance from the surface [m].
    off: fn(&Vec3) -> f64,
    area: f64,
    /// Middle and radius of the hole [m].
    hole: (Vec3, f64),
}

const COUNT: usize = 30_000;
const TAU: f64 = std::f64::consts::TAU;

fn torus(random: &mut Random) -> Vec3 {
    loop {
        let (phi, theta) = (TAU * random.next(), TAU * random.next());
        let r = 1.0 + 0.5 * theta.cos();
        if 1.5 * random.next() <= r {
            return Vec3::new(r * phi.cos(), r * phi.sin(), 0.5 * theta.sin());
        }
    }
}

fn saddle(random: &mut Random) -> Vec3 {
    loop {
        let (x, y) = (2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0);
        let z = 0.5 * (x * x - y * y);
        if 3f64.sqrt() * random.next() <= (1.0 + x * x + y * y).sqrt() {
            return Vec3::new(x, y, z);
        }
    }
}

fn sphere(random: &mut Random) -> Vec3 {
    let (z, phi) = (2.0 * random.next() - 1.0, TAU * random.next());
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// Holes of 30 % of the least radius of curvature.
fn scans() -> [Scan; 4] {
    [
        Scan {
            name: "sphere",
            place: sphere,
            off: |p| p.norm() - 1.0,
            area: 2.0 * TAU,
            hole: (Vec3::new(0.6, 0.0, 0.8), 0.3),
        },
        Scan {
            name: "torus",
            place: torus,
            off: |p| (p.xy().norm() - 1.0).hypot(p.z) - 0.5,
            area: 0.5 * TAU * TAU,
            hole: (Vec3::new(0.0, 1.5, 0.0), 0.15),
        },
        Scan {
            name: "torus, inside",
            place: torus,
            off: |p| (p.xy().norm() - 1.0).hypot(p.z) - 0.5,
            area: 0.5 * TAU * TAU,
            hole: (Vec3::new(0.0, 0.5, 0.0), 0.15),
        },
        Scan {
            name: "saddle",
            place: saddle,
            // To first order, from the slope.
            off: |p| (p.z - 0.5 * (p.x * p.x - p.y * p.y)) / (1.0 + p.x * p.x + p.y * p.y).sqrt(),
            area: 5.123,
            hole: (Vec3::zeros(), 0.3),
        },
    ]
}

fn scanned(scan: &Scan, noise: f64) -> Cloud {
    let mut random = Random(11);
    let mut points = Vec::new();
    while points.len() < COUNT {
        let p = (scan.place)(&mut random);
        if (p - scan.hole.0).norm() > scan.hole.1 {
            points.push(p + Vec3::new(random.normal(), random.normal(), random.normal()) * noise);
        }
    }
    Cloud { attributes: Table::with_rows(COUNT), points, ..Cloud::default() }
}

/// Root mean square of the distances of what was added [m], in units of the noise; closed whole, and nothing outside.
fn check(scan: &Scan, filled: &Filled, noise: f64) -> f64 {
    let name = scan.name;
    assert_eq!(filled.report.holes.len(), 1, "{name}: {:?}", filled.report.holes);
    assert!(!filled.report.holes[0].open, "{name}");
    let spacing = (scan.area / COUNT as f64).sqrt();
    let added = &filled.cloud.points[COUNT..];
    for p in added {
        let from = (p - scan.hole.0).norm() - scan.hole.1;
        assert!(from < 3.0 * spacing, "{name}: a point {from} m outside the hole");
    }
    // Every place of the hole has a point near it.
    let mut random = Random(5);
    let holes =
        (0..60_000).map(|_| (scan.place)(&mut random)).filter(|p| (p - scan.hole.0).norm() < scan.hole.1);
    for place in holes {
        let near = filled.cloud.points.iter().any(|p| (p - place).norm() < 3.5 * spacing);
        assert!(near, "{name}: nothing near {place:?}");
    }
    let squares: f64 = added.iter().map(|p| (scan.off)(p).powi(2)).sum();
    (squares / added.len() as f64).sqrt() / noise
}

#[test]
fn added_points_are_within_the_noise_of_a_third_of_the_spacing_on_bent_surfaces() {
    for scan in scans() {
        let noise = (scan.area / COUNT as f64).sqrt() / 3.0;
        let settings = Settings { max_hole: Some(0.8), ..Settings::default() };
        let filled = cloud::fill(scanned(&scan, noise), &settings).unwrap();
        let off = check(&scan, &filled, noise);
        assert!(off < 1.0, "{}: {off} of the noise", scan.name);
        println!("{}: {off:.2}", scan.name);
    }
}

#[test]
fn the_volumetric_method_closes_the_same_holes_within_the_noise() {
    for scan in scans() {
        let noise = (scan.area / COUNT as f64).sqrt() / 3.0;
        let settings = Settings { mesher: Mesher::Volumetric, max_hole: Some(0.8), ..Settings::default() };
        let filled = cloud::fill(scanned(&scan, noise), &settings).unwrap();
        let off = check(&scan, &filled, noise);
        assert!(off < 1.0, "{}: {off} of the noise", scan.name);
        println!("{}: {off:.2}", scan.name);
        assert!(filled.mesh.faces.len() > 100);
    }
}

#[test]
fn a_strait_to_the_rim_does_not_keep_a_hole_open() {
    let mut random = Random(3);
    let is_open = |p: &Vec3| p.xy().norm() < 0.15 || (p.x > 0.0 && p.y.abs() < 0.008);
    let mut points = Vec::new();
    while points.len() < COUNT {
        let p = Vec3::new(2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0, 0.0);
        if !is_open(&p) {
            points.push(p + Vec3::z() * (0.002 * random.normal()));
        }
    }
    let cloud = Cloud { attributes: Table::with_rows(COUNT), points, ..Cloud::default() };
    let filled = cloud::fill(cloud, &Settings { below: Some(2500.0), ..Settings::default() }).unwrap();
    let added = &filled.cloud.points[COUNT..];
    let inside = added.iter().filter(|p| p.xy().norm() < 0.15).count() as f64;
    let wanted = COUNT as f64 / 4.0 * std::f64::consts::PI * 0.15 * 0.15;
    assert!((0.75..1.25).contains(&(inside / wanted)), "{inside} for {wanted}");
}
