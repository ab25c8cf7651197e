//! The bench pile on a GPU and on this processor: how fast, and whether any bit differs.
//!
//! `pile SCENE.toml COPIES,… STEPS [ROUNDS] [--gpu|--cpu]` puts so many copies of the pile side by side, makes the steps on both in turn, and prints a row
//! of a table for each number of copies: medians of the rounds, 1 unless given.

use dem::device::DeviceTimes;
use dem::setup::Setup;
use dem::{Halt, Simulation};
use geom::Vec3;
use scene::Scene;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// Steps before a timing begins: first lists, and the first sending.
const WARM: u64 = 20;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (words, options): (Vec<&str>, Vec<&str>) =
        args.iter().map(String::as_str).partition(|w| !w.starts_with("--"));
    let (file, copies, steps, rounds) = match words[..] {
        [file, copies, steps] => (file, copies, steps, "1"),
        [file, copies, steps, rounds] => (file, copies, steps, rounds),
        _ => return Err("usage: pile SCENE.toml COPIES,… STEPS [ROUNDS] [--gpu|--cpu]".into()),
    };
    let wants = |one: &str| options.is_empty() || options.contains(&one);
    let asked =
        Asked { steps: steps.parse()?, rounds: rounds.parse()?, gpu: wants("--gpu"), cpu: wants("--cpu") };
    let one = setup(Path::new(file))?;
    println!(
        "| grains | steps | lists | GPU [M/s] | {} threads [M/s] | ratio | steps alone [M/s] | listing | sending | fetching | bits |",
        rayon::current_num_threads()
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for copies in copies.split(',') {
        println!("{}", row(&one, copies.parse()?, asked)?);
    }
    Ok(())
}

/// What is to be measured.
#[derive(Debug, Clone, Copy)]
struct Asked {
    steps: u64,
    rounds: usize,
    gpu: bool,
    cpu: bool,
}

fn setup(file: &Path) -> Result<Setup, Box<dyn Error>> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let text = std::fs::read_to_string(file)?;
    let scene = Scene::new(&file.display().to_string(), text, &[], folder)?;
    let mut setup = scene.plan(Vec::new())?.setup;
    setup.record_wrenches = false;
    Ok(setup)
}

/// So many copies side by side, as square as whole copies allow.
fn side_by_side(one: &Setup, copies: u32) -> Setup {
    let across = (1..=copies).filter(|n| copies.is_multiple_of(*n) && n * n <= copies).max().unwrap_or(1);
    let along = copies / across;
    let mut all = one.clone();
    let side = |axis: usize| one.periodic[axis].map_or(0.0, |(lo, hi)| hi - lo);
    for (axis, count) in [along, across].into_iter().enumerate() {
        all.periodic[axis] = one.periodic[axis].map(|(lo, _)| (lo, lo + f64::from(count) * side(axis)));
    }
    all.particles = Vec::with_capacity(one.particles.len() * copies as usize);
    let next = one.particles.iter().map(|p| p.id).max().unwrap_or(0) + 1;
    for copy in 0..copies {
        let shift = Vec3::new(f64::from(copy % along) * side(0), f64::from(copy / along) * side(1), 0.0);
        let moved = one.particles.iter().map(|p| {
            let mut p = *p;
            (p.id, p.position) = (p.id + copy * next, p.position + shift);
            p
        });
        all.particles.extend(moved);
    }
    all
}

/// Seconds of so many steps after the first ones, and how a device spent them.
fn time(sim: &mut Simulation, steps: u64) -> Result<(f64, DeviceTimes), Halt> {
    let to = |sim: &mut Simulation, last: u64| -> Result<(), Halt> {
        while sim.steps() < last {
            sim.advance(last, &mut |_| true)?;
        }
        Ok(())
    };
    to(sim, WARM)?;
    let (start, before) = (Instant::now(), sim.device_times().unwrap_or_default());
    to(sim, WARM + steps)?;
    let (seconds, after) = (start.elapsed().as_secs_f64(), sim.device_times().unwrap_or_default());
    let spent = DeviceTimes {
        sending: after.sending - before.sending,
        listing: after.listing - before.listing,
        stepping: after.stepping - before.stepping,
        fetching: after.fetching - before.fetching,
    };
    Ok((seconds, spent))
}

/// A number that any bit of any particle changes (FNV-1a).
fn mark(sim: &mut Simulation) -> Result<u64, Halt> {
    let of = |hash: u64, x: &f64| (hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3);
    let all = sim.particles()?;
    let numbers =
        |p: &dem::setup::Particle| [p.position, p.velocity, p.spin].map(|v| [v.x, v.y, v.z]).concat();
    Ok(all.iter().flat_map(numbers).fold(0xcbf2_9ce4_8422_2325, |hash, x| of(hash, &x)))
}

/// The median; NaN of nothing.
fn median(of: &[f64]) -> f64 {
    let mut sorted = of.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = |k: usize| sorted.get(k).copied().unwrap_or(f64::NAN);
    0.5 * (middle(sorted.len().saturating_sub(1) / 2) + middle(sorted.len() / 2))
}

fn row(one: &Setup, copies: u32, asked: Asked) -> Result<String, Box<dyn Error>> {
    let setup = side_by_side(one, copies);
    let (grains, steps) = (setup.particles.len(), asked.steps);
    let speed = |seconds: f64| grains as f64 * steps as f64 / seconds / 1e6;
    let (mut there, mut here, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let (mut alone, mut listing, mut sending, mut fetching) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut marks, mut lists) = (Vec::new(), 0);
    for _ in 0..asked.rounds {
        if asked.gpu {
            let mut sim = Simulation::new(setup.clone())?;
            sim.use_device(Box::new(cuda::Gpu::new(0)?)).map_err(|refused| refused.join(", "))?;
            let (seconds, spent) = time(&mut sim, steps)?;
            there.push(speed(seconds));
            alone.push(speed(spent.stepping));
            listing.push(100.0 * spent.listing / seconds);
            sending.push(100.0 * spent.sending / seconds);
            fetching.push(100.0 * spent.fetching / seconds);
            (lists, _) = (sim.rebuilds(), marks.push(mark(&mut sim)?));
        }
        if asked.cpu {
            let mut sim = Simulation::new(setup.clone())?;
            here.push(speed(time(&mut sim, steps)?.0));
            (lists, _) = (sim.rebuilds(), marks.push(mark(&mut sim)?));
        }
        ratios.extend(there.last().zip(here.last()).map(|(a, b)| a / b));
    }
    let shown = |of: &[f64], unit: &str, digits: usize| match median(of) {
        x if x.is_nan() => "–".to_owned(),
        x => format!("{x:.digits$}{unit}"),
    };
    let same = marks.windows(2).all(|two| two[0] == two[1]);
    Ok(format!(
        "| {grains} | {steps} | {lists} | {} | {} | {} | {} | {} | {} | {} | {} |",
        shown(&there, "", 0),
        shown(&here, "", 1),
        shown(&ratios, "", 2),
        shown(&alone, "", 0),
        shown(&listing, " %", 0),
        shown(&sending, " %", 0),
        shown(&fetching, " %", 0),
        match (asked.gpu && asked.cpu, same) {
            (false, _) => "–",
            (true, true) => "the same",
            (true, false) => "DIFFERENT",
        }
    ))
}
