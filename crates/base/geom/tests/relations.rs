//! Relations over random points: searches against brute force, empty circles, what a shift or a scale does not change.

use geom::motion::{Path, PathRow};
use geom::random::{generator, unit};
use geom::star::{StarScratch, stars, voids};
use geom::{Cells, Motion, Vec3, digits::Extent, least_axis};
use nalgebra::Matrix3;

/// Random points in a box of these sides [m], a corner of it at the origin.
fn points(count: usize, sides: [f64; 3], seed: u64) -> Vec<Vec3> {
    let mut random = generator(seed, 1, 2);
    (0..count).map(|_| Vec3::from(sides.map(|side| side * unit(&mut random)))).collect()
}

#[test]
fn searches_in_cells_find_what_brute_force_finds() {
    for (seed, reach) in [(1, 0.08), (2, 0.15), (3, 0.4), (4, 2.0)] {
        let cells = Cells::new(&points(600, [1.0, 0.7, 0.5], seed), reach);
        for slot in 0..cells.len() as u32 {
            let radius = reach * f64::from(slot % 7 + 1) / 7.0;
            let centre = cells.points[slot as usize];
            let near = |other: &u32| (cells.points[*other as usize] - centre).norm() < radius;
            let wanted: Vec<u32> = (0..cells.len() as u32).filter(near).collect();
            let mut found = Vec::new();
            cells.each_near(slot, radius, |other, square| {
                let way = cells.points[other as usize] - centre;
                assert!((square - way.norm_squared()).abs() < 1e-15, "{square}");
                found.push(other);
            });
            found.sort_unstable();
            assert_eq!(found, wanted, "seed {seed}, slot {slot}");
            assert_eq!(cells.count_near(slot, radius, u32::MAX) as usize, wanted.len());
        }
    }
}

#[test]
fn cubes_share_out_the_cells_of_the_grid() {
    let cells = Cells::new(&points(3000, [1.0, 0.7, 0.5], 5), 0.06);
    for wide in 1..5 {
        let (mut seen, side) = (vec![0; cells.len()], cells.grid.cell() * wide as f64);
        let cubes = cells.cubes(wide);
        assert!(cubes.windows(2).all(|pair| pair[0].0 != pair[1].0), "each cube once");
        let low = cells.points.iter().fold(Vec3::repeat(f64::MAX), |low, p| low.inf(p));
        for (at, runs) in cubes {
            for slot in runs.into_iter().flatten() {
                seen[slot] += 1;
                let off = cells.points[slot] - low;
                for axis in 0..3 {
                    // A cell may begin before the lowest point.
                    let cube = off[axis] / side;
                    assert!((cube - at[axis] as f64 - 0.5).abs() <= 1.5, "{cube} is not in {at:?}");
                }
            }
        }
        assert!(seen.iter().all(|times| *times == 1), "each point in one cube");
    }
}

/// On a plane in any position, a void is an empty circle through three points, and all points have voids with the same neighbours.
#[test]
fn voids_are_empty_circles_through_three_points() {
    for seed in 0..4 {
        let mut random = generator(seed, 3, 4);
        let turn = nalgebra::Rotation3::from_euler_angles(unit(&mut random), 6.0 * unit(&mut random), 0.3);
        let flat: Vec<Vec3> = points(300, [1.0, 1.0, 0.0], seed).iter().map(|p| turn * p).collect();
        // Cells narrower and wider than the voids.
        for width in [0.04, 0.3] {
            let (cells, mut work, mut found) = (Cells::new(&flat, width), StarScratch::default(), 0);
            for slot in 0..cells.len() as u32 {
                let (normal, voids) = voids(&cells, slot, 0.2, &mut work);
                assert!((normal.dot(&(turn * Vec3::z())).abs() - 1.0).abs() < 1e-9, "{normal}");
                found += voids.len();
                for void in voids {
                    assert!(void.corners.contains(&slot) && void.radius <= 0.2 * (1.0 + 1e-9), "{void:?}");
                    for (other, p) in cells.points.iter().enumerate() {
                        let off = (p - void.centre).norm() - void.radius;
                        let corner = void.corners.contains(&(other as u32));
                        assert!(if corner { off.abs() < 1e-9 } else { off > -1e-9 }, "{void:?}: {off}");
                    }
                }
            }
            let triangles = stars(&cells, 0.2).triangles.len();
            assert!(triangles > 400 && found == 3 * triangles, "{found} voids, {triangles} triangles");
        }
    }
}

#[test]
fn the_axis_of_least_spread_is_that_of_the_least_eigenvalue() {
    for seed in 0..200 {
        let spread: Matrix3<f64> = points(9, [1.0, 0.8, 0.6], seed)
            .iter()
            .map(|p| p - Vec3::repeat(0.4))
            .map(|d| d * d.transpose())
            .sum();
        let axis = least_axis(&spread).expect("points in space");
        let least = spread.symmetric_eigenvalues().min();
        assert!((axis.norm() - 1.0).abs() < 1e-12, "{axis}");
        assert!((spread * axis - axis * least).norm() < 1e-9 * spread.norm(), "seed {seed}: {axis}");
    }
}

#[test]
fn every_seed_kind_and_index_has_a_stream_of_its_own() {
    let number = |seed: u64, kind: u64, index: u64| unit(&mut generator(seed, kind, index)).to_bits();
    let streams = (0..512).map(|k| number(k % 8, k / 8 % 8, k / 64));
    assert_eq!(streams.collect::<std::collections::HashSet<_>>().len(), 512);
}

/// The spacing of points scales as they do, and is the distance of neighbours on a square lattice.
#[test]
fn the_spacing_of_a_lattice_is_its_distance_of_neighbours() {
    for step in [1e-3, 0.1, 7.0] {
        let lattice: Vec<Vec3> =
            (0..2500).map(|k| Vec3::new(f64::from(k % 50), f64::from(k / 50), 0.0) * step).collect();
        let spacing = Extent::of(&lattice).expect("many").spacing(2500.0);
        assert!((spacing / step - 1.0).abs() < 0.15, "{spacing} m instead of {step} m");
    }
}

#[test]
fn a_hull_moves_with_its_points() {
    for seed in 0..50 {
        let mut random = generator(seed, 5, 6);
        let all = points(4 + seed as usize % 20, [1.0, 1.0, 0.1], seed);
        let shift = Vec3::from([0; 3].map(|_| 1e3 * (unit(&mut random) - 0.5)));
        let moved: Vec<Vec3> = all.iter().map(|p| p + shift).collect();
        let [here, there] = [&all, &moved].map(|points| geom::hull::hull(points).expect("points in space"));
        let [a, b] = [here.volume(), there.volume()];
        assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-9, "seed {seed}: {a} and {b} m³");
    }
}

/// A table ends at its last row, unless the wall moves in another way as well.
#[test]
fn a_motion_runs_as_long_as_any_part_of_it() {
    let row = |time, x| PathRow { time, shift: Vec3::x() * x, angle: 0.0 };
    let still = Path::new(Vec3::z(), vec![row(0.1, 1.0), row(0.5, 1.0)]).expect("sound");
    let path = Path::new(Vec3::z(), vec![row(0.1, 1.0), row(0.5, 2.0)]).expect("sound");
    assert!(path.moves() && !still.moves());
    let alone = Motion { path: Some(path), ..Motion::still() };
    let besides = [
        Motion { velocity: Vec3::y(), ..alone.clone() },
        Motion { turn: Vec3::y(), ..alone.clone() },
        Motion { amplitude: Vec3::y(), frequency: 1.0, ..alone.clone() },
    ];
    assert!(alone.runs(0.3) && !alone.runs(0.6));
    assert!(besides.iter().all(|motion| motion.runs(0.3) && motion.runs(0.6)));
}

/// A number before a unit may be written in every way in which Rust reads it.
#[test]
fn all_ways_to_write_a_number_may_stand_before_a_unit() {
    for text in ["1", "-2.5", "+.5", "1.", "1.e5", "2.E-3", "+1.5e+2", "3e1"] {
        let number: f64 = text.parse().expect("a number");
        for given in [format!("{text} mm"), format!("{text}mm")] {
            let found = geom::units::parse(&given, "m").expect("a length");
            assert!((found - 1e-3 * number).abs() <= 1e-15 * number.abs(), "{given}: {found}");
        }
    }
}
