//! Hulls of rendered silhouettes against the stone.

mod support;

use photos::hull;
use stones::Stone;
use support::{ring, stone, views};

/// 36 perfect masks at two tilts: the hull encloses the stone, and is an eighth larger at most.
#[test]
fn the_hull_of_two_rings_is_a_little_larger_than_the_stone() {
    let mesh = stone();
    let cameras = [ring(18, 0.0), ring(18, 35.0)].concat();
    let start = std::time::Instant::now();
    let views = views(&mesh, &cameras);
    println!("rendered {:?}", start.elapsed());
    let (found, _) = hull(&views, 60).unwrap();
    println!("carved {:?}", start.elapsed());
    let checked = Stone::new(&found, false).unwrap();
    let times = checked.moments.volume / mesh.volume();
    println!("{times}");
    assert!((1.0..1.125).contains(&times), "{times}");
    let outside = |v: &geom::Vec3| if checked.inside.contains(v) { 0.0 } else { checked.inside.distance(v) };
    let most = mesh.vertices.iter().map(outside).fold(0.0, f64::max);
    println!("{most}");
    assert!(most < 0.0025, "a vertex of the stone is {most} m outside");
}

/// The stone lies on another side for the second pair of rings: the move is found from the silhouettes, and the hull of all is smaller.
#[test]
fn a_stone_that_was_turned_over_is_laid_back() {
    let mesh = stone();
    let cameras = [ring(12, 0.0), ring(12, 35.0)].concat();
    let first = views(&mesh, &cameras);
    let turn = nalgebra::UnitQuaternion::from_scaled_axis(geom::Vec3::new(2.6, 1.1, 0.4));
    let shift = geom::Vec3::new(0.004, -0.006, 0.008);
    let vertices = mesh.vertices.iter().map(|v| turn * v + shift).collect();
    let turned = geom::mesh::TriMesh { vertices, ..mesh.clone() };
    let second = views(&turned, &cameras);
    let start = std::time::Instant::now();
    let found = photos::align(&first, &second).unwrap();
    println!("aligned {:?} {found:?}", start.elapsed());
    let angle = (found.place.turn * turn).angle().to_degrees();
    let off = found.place.turn * shift + found.place.shift;
    println!("{angle}° {} m", off.norm());
    let one = hull(&first, 60).unwrap().0.volume() / mesh.volume();
    let both = hull(&[first, found.place.views(&second)].concat(), 60).unwrap().0.volume() / mesh.volume();
    println!("{one} {both}");
    assert!(angle < 0.5 && off.norm() < 0.0005, "{angle}° {off}");
    assert!(both < one - 0.01 && both > 0.99, "{one} {both}");
}
