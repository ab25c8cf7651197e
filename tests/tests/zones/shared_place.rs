//! Several insertions through one place: each waits, or leaves out, what has no room, and none stops the run.

use super::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use scene::Scene;
use scene::plan::{Insertion, Plan};
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.3\n[output]\nenergy = true\n[[material]]\nname = \"a\"\ndensity = 2500\nyoung = 2e6\n\
    poisson = 0.3\n[[contact]]\nbetween = [\"a\", \"a\"]\nrestitution = 0.5\nsliding_friction = 0.4\n";

/// Two or three insertions through narrow shapes that overlap wholly or in part, together or in turn; `when` of all of them.
fn scene(seed: u64, when: &str) -> String {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut draw = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let (size, speed) = (draw(0.008, 0.02), draw(0.3, 2.0));
    let (width, boxes, in_turn) = (size * draw(1.2, 2.2), draw(0.0, 1.0) < 0.5, draw(0.0, 1.0) < 0.2);
    let count = if draw(0.0, 1.0) < 0.6 { 2 } else { 3 };
    let mut text = HEAD.to_owned();
    for k in 0..count {
        let high = size * draw(0.7, 1.0);
        let low = high * draw(0.6, 1.0);
        let aside = if draw(0.0, 1.0) < 0.6 { 0.0 } else { draw(-0.7, 0.7) * width };
        let above = if draw(0.0, 1.0) < 0.6 { 0.0 } else { draw(-0.5, 0.5) * size };
        let (half, top) = (0.5 * width, above + 1.3 * size);
        let shape = match boxes {
            true => format!("box:{},{},{above},{},{half},{top}", aside - half, -half, aside + half),
            false => format!("cylinder:{aside},0,{above},{aside},0,{top},{half}"),
        };
        // Up to 27 % of what its centres can be in, each for itself.
        let area = (width - high).powi(2) * if boxes { 1.0 } else { 0.785 };
        let rate = draw(0.15, 0.27) * area * speed / geom::sphere::volume(0.25 * (low + high));
        let of = f64::from(count);
        let (from, until) =
            if in_turn { (0.25 * f64::from(k) / of, 0.25 * f64::from(k + 1) / of) } else { (0.0, 0.25) };
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "[[insert]]\nmaterial = \"a\"\ndiameter = [{low}, {high}]\nshape = \"{shape}\"\nvelocity = [0, 0, {}]\n\
             rate_count = {rate}\nfrom = {from}\nuntil = {until}\nwhen_blocked = \"{when}\"\nseed = {seed}\n",
            -speed
        );
    }
    text
}

/// The next that is due by a time, of all insertions.
fn due(insertions: &mut [Insertion], by: f64) -> Option<(Entry, bool)> {
    let times = insertions.iter().enumerate().filter_map(|(k, i)| Some((i.next_time()?, k)));
    let (_, first) = times.filter(|(time, _)| *time <= by).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let planned = insertions[first].next_entry().expect("it fits").expect("it is due");
    Some((planned.entry, planned.blocked))
}

/// How many came in, waited, still wait, were left out; and how many the plan had no room for.
fn run(seed: u64, when: &str) -> Result<[u64; 5], dem::Halt> {
    let scene = Scene::new("drawn", scene(seed, when), &[], Path::new("")).expect("sound");
    let Plan { setup, mut insertions, .. } = scene.plan(Vec::new()).expect("sound");
    let mut sim = Simulation::new(setup).expect("sound");
    let (mut given, mut blocked) = (0, 0);
    while sim.time() < 0.3 {
        while let Some((entry, has_no_room)) = due(&mut insertions, sim.time() + sim.look_ahead()) {
            sim.enter(entry).expect("in time");
            (given, blocked) = (given + 1, blocked + u64::from(has_no_room));
        }
        sim.step()?;
    }
    let sum = |of: fn(&dem::NoRoom) -> u64| sim.returned().inserts.iter().map(of).sum::<u64>();
    let [waited, waiting, skipped] = [sum(|i| i.waited), sum(|i| i.waiting), sum(|i| i.skipped)];
    let there = sim.particle_count() as u64;
    assert_eq!(there + waiting + skipped, given, "seed {seed}, {when}");
    let energy = sim.energy().expect("ready");
    let made = energy.integration;
    assert!(made.abs() < 5e-3 * energy.entered, "seed {seed}, {when}: {made} J of {} J", energy.entered);
    Ok([there, waited, waiting, skipped, blocked])
}

#[test]
fn insertions_that_share_a_narrow_place_wait_or_leave_out() {
    let (mut late, mut left_out, mut stopped, mut blocked) = (0, 0, 0, 0);
    for seed in 0..30 {
        let found = |when| run(seed, when).unwrap_or_else(|halt| panic!("seed {seed}, {when}: {halt}"));
        let [there, waited, waiting, none, planned] = found("wait");
        assert!(
            there > 0 && waiting <= waited && none == 0,
            "seed {seed}: {there} {waited} {waiting} {none}"
        );
        let [_, none, _, skipped, _] = found("skip");
        assert_eq!(none, 0, "seed {seed}");
        let stops = matches!(run(seed, "stop"), Err(dem::Halt::NoRoom { .. }));
        // All three are one run until a grain has no room for the first time.
        assert_eq!((waited > 0, skipped > 0), (stops, stops), "seed {seed}: {waited} {skipped}");
        (late, left_out) = (late + waited, left_out + skipped);
        (stopped, blocked) = (stopped + u64::from(stops), blocked + planned);
    }
    assert!(late > 20 && left_out > 10 && blocked > 10, "{late} {left_out} {blocked}");
    assert!((5..=25).contains(&stopped), "{stopped} of 30");
}
