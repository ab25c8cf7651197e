//! The bench pile on a GPU and on this processor: how fast, and whether any bit differs.
//!
//! `pile SCENE.toml COPIES,… STEPS [--gpu|--cpu]` puts so many copies of the pile side by side, makes the steps on both, and prints a row of a table
//! for each number of copies.

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
    let (words, options): (Vec<_>, Vec<_>) = args.iter().partition(|word| !word.starts_with("--"));
    let [file, copies, steps] = words.as_slice() else {
        return Err("usage: pile SCENE.toml COPIES,… STEPS [--gpu|--cpu]".into());
    };
    let steps: u64 = steps.parse()?;
    let wants = |one: &str| options.is_empty() || options.iter().any(|option| *option == one);
    let (gpu, cpu) = (wants("--gpu"), wants("--cpu"));
    let one = setup(Path::new(file))?;
    println!(
        "| grains | steps | lists | GPU [M/s] | CPU [M/s] | ratio | stepping | sending | fetching | bits |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for copies in copies.split(',') {
        row(&one, copies.parse()?, steps, [gpu, cpu])?;
    }
    println!("\n{} threads", rayon::current_num_threads());
    Ok(())
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

/// Seconds of so many steps after the first ones.
fn time(sim: &mut Simulation, steps: u64) -> Result<f64, Halt> {
    let to = |sim: &mut Simulation, last: u64| -> Result<(), Halt> {
        while sim.steps() < last {
            sim.advance(last)?;
        }
        Ok(())
    };
    to(sim, WARM)?;
    let start = Instant::now();
    to(sim, WARM + steps)?;
    Ok(start.elapsed().as_secs_f64())
}

/// A number that any bit of any particle changes (FNV-1a).
fn mark(sim: &mut Simulation) -> Result<u64, Halt> {
    let of = |hash: u64, x: &f64| (hash ^ x.to_bits()).wrapping_mul(0x0100_0000_01b3);
    let all = sim.particles()?;
    let numbers =
        |p: &dem::setup::Particle| [p.position, p.velocity, p.spin].map(|v| [v.x, v.y, v.z]).concat();
    Ok(all.iter().flat_map(numbers).fold(0xcbf2_9ce4_8422_2325, |hash, x| of(hash, &x)))
}

fn row(one: &Setup, copies: u32, steps: u64, [gpu, cpu]: [bool; 2]) -> Result<(), Box<dyn Error>> {
    let setup = side_by_side(one, copies);
    let grains = setup.particles.len();
    let speed = |seconds: f64| grains as f64 * steps as f64 / seconds / 1e6;
    let (mut there, mut here) = (None, None);
    let (mut lists, mut parts) = (0, vec!["–".to_owned(); 3]);
    if gpu {
        let mut sim = Simulation::new(setup.clone())?;
        sim.use_device(Box::new(cuda::Gpu::new(0)?)).map_err(|refused| refused.join(", "))?;
        let seconds = time(&mut sim, steps)?;
        let DeviceTimes { stepping, sending, fetching } = sim.device_times().unwrap_or_default();
        let share = |part: f64| format!("{:.0} %", 100.0 * part / seconds);
        parts = [stepping, sending, fetching].map(share).to_vec();
        parts[0] += &format!(" ({:.0} M/s)", speed(stepping));
        lists = sim.rebuilds();
        there = Some((speed(seconds), mark(&mut sim)?));
    }
    if cpu {
        let mut sim = Simulation::new(setup)?;
        let seconds = time(&mut sim, steps)?;
        lists = sim.rebuilds();
        here = Some((speed(seconds), mark(&mut sim)?));
    }
    let number = |of: Option<(f64, u64)>| of.map_or("–".to_owned(), |(speed, _)| format!("{speed:.1}"));
    let both = there.zip(here);
    let ratio = both.map_or("–".to_owned(), |(a, b)| format!("{:.2}", a.0 / b.0));
    let bits = both.map_or("–", |(a, b)| if a.1 == b.1 { "the same" } else { "DIFFERENT" });
    let (there, here, parts) = (number(there), number(here), parts.join(" | "));
    println!("| {grains} | {steps} | {lists} | {there} | {here} | {ratio} | {parts} | {bits} |");
    Ok(())
}
