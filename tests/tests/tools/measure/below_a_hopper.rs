//! The heap on a floor while the hopper above it still holds grains.

use super::made::{Chance, Grain, Made, grain};
use super::{column, failed, heap, measure, one_frame, saved, sum};
use geom::Vec3;
use tempfile::TempDir;

const SCENE: &str = "gravity = [0, 0, -9.81]";
const ALL: [&str; 3] = ["--repose", "--within", "all"];
const BELOW: [&str; 3] = ["--repose", "--within", "box:-1,-1,-1,1,1,0.4"];

/// A cone of 28° on a floor, grains that fall onto its top, and a block of grains 0.2 m above that.
fn heap_and_hopper() -> Vec<Grain> {
    let slope = 28f64.to_radians().tan();
    let mut grains = heap(|x, y| (0.28 - (x * x + y * y).sqrt()) * slope, 1);
    let mut chance = Chance(3);
    for id in 0..40 {
        let place = [0.02 * (chance.next() - 0.5), 0.02 * (chance.next() - 0.5), 0.16 + 0.3 * chance.next()];
        grains.push(Grain { velocity: Vec3::new(0.1, 0.0, -1.5), ..grain(100_000 + id, place, 0.005) });
    }
    for k in 0..24 * 24 * 8 {
        let place = [k % 24 - 12, k / 24 % 24 - 12, k / 576].map(|i| 0.01 * f64::from(i));
        grains.push(grain(200_000 + k as u32, [place[0], place[1], 0.5 + place[2]], 0.005));
    }
    grains
}

/// One frame without the hopper's grains, one with them.
fn alone_and_below() -> [TempDir; 2] {
    let all = heap_and_hopper();
    let alone: Vec<Grain> = all.iter().copied().filter(|g| g.place.z < 0.4).collect();
    [one_frame(SCENE, &alone), one_frame(SCENE, &all)]
}

#[test]
fn within_measures_the_heap_below_a_hopper_as_if_it_were_alone() {
    let [alone, below] = alone_and_below();
    for name in ["angle", "angle_interval", "height", "time"] {
        assert_eq!(sum(&below, &BELOW, name), sum(&alone, &ALL, name), "{name}");
    }
    let (angle, interval) = (sum(&below, &BELOW, "angle"), sum(&below, &BELOW, "angle_interval"));
    assert!((angle - 28.0).abs() <= interval && interval < 0.6, "{angle} ± {interval}");
    let [one, other] = [measure(&alone, &ALL), measure(&below, &BELOW)];
    for name in ["angle_low", "angle_high", "fitted_from", "fitted_to"] {
        assert_eq!(column(&one, name), column(&other, name), "{name}");
    }
}

/// Without it the grains of the hopper are the surface; the message gives the cure.
#[test]
fn grains_above_the_heap_are_reported() {
    let [alone, below] = alone_and_below();
    let message = failed(&below, &["--repose"]);
    for part in ["grains stand above a gap of more than 4 diameters", "--within SHAPE"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    // Where an angle is found all the same, a note says it.
    let done = measure(&below, &["--repose", "--fractions", "0.01,0.99", "--bin", "0.003"]);
    assert!(done.stderr.contains("above a gap of more than 4 diameters"), "{}", done.stderr);
    for (folder, options) in [(&alone, &["--repose"][..]), (&below, &BELOW)] {
        let done = measure(folder, options);
        assert!(!done.stderr.contains("gap"), "{}", done.stderr);
    }
}

/// The stream that feeds a heap is no part of it: its grains fall.
#[test]
fn falling_grains_do_not_count() {
    let mut grains = heap_and_hopper();
    grains.retain(|g| g.place.z < 0.4);
    let with = one_frame(SCENE, &grains);
    grains.retain(|g| g.id < 100_000);
    let without = one_frame(SCENE, &grains);
    for name in ["angle", "angle_interval", "height"] {
        assert_eq!(sum(&with, &ALL, name), sum(&without, &["--repose"], name), "{name}");
    }
}

/// The last frame that has grains in the shape counts, not the last one of the run.
#[test]
fn a_part_that_has_run_empty_is_measured_in_its_last_frame() {
    let all = heap_and_hopper();
    let above: Vec<Grain> = all.iter().copied().filter(|g| g.place.z > 0.4).collect();
    let mut made = Made::new(SCENE);
    made.frame(0.0, &above).frame(1.0, &all).frame(2.0, &above);
    let folder = saved(made);
    assert_eq!(sum(&folder, &BELOW, "time"), 1.0);
    let done = measure(&folder, &[&BELOW[..], &["--all"]].concat());
    assert!(done.stderr.contains("2 frames left out"), "{}", done.stderr);
}
