//! Which side of the surface the spheres are on, and whether they stay there.

use super::*;
use geom::Vec3;
use std::f64::consts::PI;

/// A cylinder along a direction: points about `p` [m] apart on an arc from its lowest line, of this half angle.
fn arc(radius: f64, half: f64, p: f64, turn: &dyn Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    let (rows, around) = (16, (2.0 * half * radius / p).round().max(3.0) as usize);
    let closed = half >= PI;
    let place = |i: usize, k: usize| {
        let steps = if closed { around } else { around - 1 };
        let angle = half * (2.0 * (k as f64 + 0.3 * (i % 2) as f64) / steps as f64 - 1.0);
        let (sin, cos) = angle.sin_cos();
        turn(Vec3::new(i as f64 * p, radius * sin, -radius * cos))
    };
    (0..rows).flat_map(|i| (0..around).map(move |k| (i, k))).map(|(i, k)| place(i, k)).collect()
}

/// About z by one angle, then about x by another [rad].
fn turned(z: f64, x: f64) -> impl Fn(Vec3) -> Vec3 {
    move |q| {
        let q = Vec3::new(q.x * z.cos() - q.y * z.sin(), q.x * z.sin() + q.y * z.cos(), q.z);
        Vec3::new(q.x, q.y * x.cos() - q.z * x.sin(), q.y * x.sin() + q.z * x.cos())
    }
}

fn surface(radius: f64) -> WallSettings {
    WallSettings { placement: Placement::Surface, ..with(Radius::Given(radius)) }
}

/// Share of the centres that are farther from the axis than their points.
fn outside(points: &[Vec3], centres: &[Vec3], axis: &Vec3) -> f64 {
    let off = |q: &Vec3| (q - axis * q.dot(axis)).norm();
    points.iter().zip(centres).filter(|(p, c)| off(c) > off(p)).count() as f64 / points.len() as f64
}

#[test]
fn a_direction_tells_the_side_of_an_open_trough_and_of_no_pipe() {
    for (z, x) in [(0.0, 0.0), (0.7, 0.4), (2.1, -1.3), (1.0, 3.0)] {
        let turn = turned(z, x);
        let (up, axis) = (turn(Vec3::z()), turn(Vec3::x()));
        for (degrees, told) in [(60.0, true), (90.0, true), (130.0, true), (180.0, false)] {
            let points = arc(0.1, f64::to_radians(degrees), 0.008, &turn);
            let towards = WallSettings { facing: Some(up), ..surface(0.01) };
            let made = build(&points, &everywhere(0.001), &towards);
            match (told, made) {
                (true, Ok((wall, _))) => {
                    assert_eq!(outside(&points, &wall.centres, &axis), 1.0, "{degrees}° turned by {z}, {x}");
                }
                (false, Err(WallError::FacesBothWays { share, .. })) => {
                    assert!((share - 50.0).abs() < 5.0, "{share}");
                    // What the message advises.
                    let inside = WallSettings { flow_at: Some(axis * 0.05), ..surface(0.01) };
                    let (wall, _) = build(&points, &everywhere(0.001), &inside).unwrap();
                    assert_eq!(outside(&points, &wall.centres, &axis), 1.0, "{degrees}° turned by {z}, {x}");
                }
                (told, made) => panic!("{degrees}° turned by {z}, {x}: {told}, {made:?}"),
            }
            let along = WallSettings { facing: Some(axis), ..surface(0.01) };
            let made = build(&points, &everywhere(0.001), &along);
            assert!(matches!(made, Err(WallError::FacesAside { .. } | WallError::FacesBothWays { .. })));
        }
    }
}

#[test]
fn spheres_stick_out_where_the_surface_bends_outwards_more_tightly_than_they_do() {
    let still = |q: Vec3| q;
    for (bend, radius) in [(0.05, 0.03), (0.05, 0.045), (0.05, 0.08), (0.02, 0.05), (0.2, 0.05)] {
        let points = arc(bend, 0.5 * PI, bend / 12.0, &still);
        // From below the trough is a ridge.
        for (flow, convex) in [(Vec3::z(), false), (-Vec3::z(), true)] {
            let settings = WallSettings { facing: Some(flow), ..surface(radius) };
            let (_, report) = build(&points, &everywhere(0.001), &settings).unwrap();
            let case = format!("bend {bend}, radius {radius}, convex {convex}: {:?}", report.bulges);
            assert_eq!(report.bulges.is_some(), convex && radius > bend, "{case}");
            assert_eq!(report.warnings.iter().any(|w| w.contains("stick out")), report.bulges.is_some());
            if let Some(found) = report.bulges {
                // A sphere behind one point of a half circle covers that across by √((r − R)² + R²) − r at most: the rims lie at a right angle to its middle.
                let (apart, r) = (radius - bend, radius);
                let across = r - (apart * apart + bend * bend).sqrt();
                assert!(found.depth >= 0.9 * across && found.depth <= 2.0 * apart + 1e-3, "{case}, {across}");
            }
        }
    }
    let settings = WallSettings { facing: Some(Vec3::z()), ..surface(0.5) };
    let (_, report) = build(&shaken(20, 0.01, 0.002), &everywhere(0.001), &settings).unwrap();
    assert_eq!(report.bulges, None, "a plate");
}

/// The lips of a channel lie as squarely to the flow as its floor does, and face away; whichever point comes first, the floor decides.
#[test]
fn a_channel_whose_lips_bend_inwards_is_open_upwards() {
    let p = 0.01;
    // Half of the section, from the lip over the wall to the middle of the floor.
    let half = (4..6).map(|k| (p * f64::from(k), 0.1)).chain((0..10).map(|k| (0.05, p * f64::from(k))));
    let half: Vec<(f64, f64)> = half.chain((1..5).map(|k| (p * f64::from(k), 0.0))).collect();
    let middle = [(0.0, 0.0)];
    let section: Vec<(f64, f64)> =
        half.iter().map(|(x, z)| (-x, *z)).chain(half.iter().copied()).chain(middle).collect();
    let mut points: Vec<Vec3> = (0..14)
        .flat_map(|row| section.iter().map(move |(x, z)| Vec3::new(*x, p * f64::from(row), *z)))
        .collect();
    for lips_first in [true, false] {
        points.sort_by(|a, b| if lips_first { b.z.total_cmp(&a.z) } else { a.z.total_cmp(&b.z) });
        let settings = WallSettings { facing: Some(Vec3::z()), ..surface(0.004) };
        let (wall, _) = build(&points, &everywhere(0.001), &settings).unwrap();
        let of_floor = points.iter().zip(&wall.centres).filter(|(q, _)| q.z == 0.0 && q.x.abs() < 0.03);
        assert!(of_floor.clone().count() > 50);
        assert!(of_floor.clone().all(|(q, c)| c.z < q.z), "lips first: {lips_first}");
    }
}
