//! What this machine could do at most, for `make -C pipelines bench`: `limits THREADS TOUCHING LISTED [MEASURED]`, pairs a particle
//! that touch and that are listed, and a file with what it printed before, in place of measuring.
//!
//! Measured: memory bandwidth by the triad a ← b + s c (McCalpin, 1995), far beyond all caches; adds and multiplies, divisions and
//! square roots of f64 in the widest lanes, on registers. From these the particle-steps a second that memory alone and
//! arithmetic alone allow, with the counts of [`KERNELS`], and what the arithmetic of bonds allows.
#![cfg_attr(target_arch = "x86_64", expect(unsafe_code, reason = "the processor's own vector instructions"))]

mod kernels;

use kernels::{BOND, KERNELS, Kernel};
use std::hint::black_box;
use std::sync::Barrier;
use std::thread;
use std::time::Instant;

/// Numbers of one array of the triad: 128 MiB.
const ARRAY: usize = 16 << 20;
/// Registers in each chain of operations.
const CHAINS: usize = 6;
/// Rounds of a measurement; the best counts.
const ROUNDS: usize = 5;

/// Adds and multiplies of a listed contact that does not touch.
const APART: f64 = 11.0;
/// Adds and multiplies of a move, four at a time.
const MOVE: f64 = 60.0;

/// Numbers a second.
struct Limits {
    bytes: f64,
    operations: f64,
    divisions: f64,
    roots: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Vec<f64> = args.iter().take(3).map(|a| a.parse()).collect::<Result<_, _>>()?;
    let [threads, touching, listed] = numbers[..] else {
        return Err("usage: limits THREADS TOUCHING LISTED [MEASURED]".into());
    };
    let lanes = Lanes::best();
    let most = match args.get(3) {
        Some(file) => Limits::read(&std::fs::read_to_string(file)?)?,
        None => Limits::measure(threads as usize, lanes),
    };
    println!("lanes {}", lanes.width());
    println!("bandwidth {:.2} GB/s", most.bytes / 1e9);
    println!("add_multiply {:.2} G/s", most.operations / 1e9);
    println!("divide {:.2} G/s", most.divisions / 1e9);
    println!("root {:.2} G/s", most.roots / 1e9);
    for kernel in &KERNELS {
        let memory = kernel.particle + listed * kernel.listed;
        let (near, apart) = (touching, (listed - touching).max(0.0));
        let four = 2.0 * (MOVE + listed * kernel.gather) * lanes.width() as f64 / 8.0;
        let arithmetic = near * most.seconds(kernel) + (apart * APART + four) / most.operations;
        println!(
            "{} bytes {:.0} memory {:.2} arithmetic {:.2}",
            kernel.name,
            memory,
            most.bytes / memory / 1e6,
            1.0 / arithmetic / 1e6
        );
    }
    let Kernel { name, operations, divisions, roots, .. } = BOND;
    let arithmetic = 1e-6 / most.seconds(&BOND);
    println!("{name} operations {operations} divisions {divisions} roots {roots} arithmetic {arithmetic:.2}");
    Ok(())
}

impl Limits {
    /// What the arithmetic of a contact or a bond takes at least [s].
    fn seconds(&self, kernel: &Kernel) -> f64 {
        kernel.operations / self.operations + kernel.divisions / self.divisions + kernel.roots / self.roots
    }

    fn measure(threads: usize, lanes: Lanes) -> Limits {
        let rate = |what| together(threads, move || lanes.rate(what));
        Limits {
            bytes: together(threads, triad),
            operations: rate(What::AddMultiply),
            divisions: rate(What::Divide),
            roots: rate(What::Root),
        }
    }

    /// From what this program printed.
    fn read(text: &str) -> Result<Limits, Box<dyn std::error::Error>> {
        let number = |name: &str| -> Result<f64, Box<dyn std::error::Error>> {
            let line = text.lines().find(|l| l.split(' ').next() == Some(name));
            let value = line.and_then(|l| l.split(' ').nth(1));
            Ok(1e9 * value.ok_or_else(|| format!("{name} is missing"))?.parse::<f64>()?)
        };
        Ok(Limits {
            bytes: number("bandwidth")?,
            operations: number("add_multiply")?,
            divisions: number("divide")?,
            roots: number("root")?,
        })
    }
}

/// Sum of what all threads reach at once.
fn together(threads: usize, measure: impl Fn() -> f64 + Copy + Send + Sync) -> f64 {
    let start = Barrier::new(threads);
    thread::scope(|scope| {
        let all: Vec<_> = (0..threads)
            .map(|_| {
                let start = &start;
                scope.spawn(move || {
                    start.wait();
                    measure()
                })
            })
            .collect();
        all.into_iter().map(|t| t.join().unwrap_or(0.0)).sum()
    })
}

/// Bytes a second, as STREAM counts them: two arrays read, one written.
fn triad() -> f64 {
    let (mut a, b, c) = (vec![0.0; ARRAY], vec![1.0; ARRAY], vec![2.0; ARRAY]);
    let best = (0..ROUNDS).map(|_| {
        let start = Instant::now();
        let s = black_box(3.0);
        for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
            *a = b + s * c;
        }
        black_box(&mut a);
        (3 * ARRAY * size_of::<f64>()) as f64 / start.elapsed().as_secs_f64()
    });
    best.fold(0.0, f64::max)
}

#[derive(Clone, Copy)]
enum What {
    AddMultiply,
    Divide,
    Root,
}

/// The widest registers here.
#[derive(Clone, Copy)]
enum Lanes {
    Two,
    #[cfg(target_arch = "x86_64")]
    Four,
    #[cfg(target_arch = "x86_64")]
    Eight,
}

impl Lanes {
    fn best() -> Lanes {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") {
                return Lanes::Eight;
            }
            if is_x86_feature_detected!("avx2") {
                return Lanes::Four;
            }
        }
        Lanes::Two
    }

    fn width(self) -> usize {
        match self {
            Lanes::Two => 2,
            #[cfg(target_arch = "x86_64")]
            Lanes::Four => 4,
            #[cfg(target_arch = "x86_64")]
            Lanes::Eight => 8,
        }
    }

    /// Operations a second.
    fn rate(self, what: What) -> f64 {
        let steps = match what {
            What::AddMultiply => 20_000_000,
            _ => 1_000_000,
        };
        let best = (0..ROUNDS).map(|_| {
            let start = Instant::now();
            let done = self.run(what, steps);
            done as f64 / start.elapsed().as_secs_f64()
        });
        best.fold(0.0, f64::max)
    }

    fn run(self, what: What, steps: usize) -> usize {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx512f")]
            fn eight(what: What, steps: usize) -> usize {
                chains::<{ 8 * CHAINS }>(what, steps)
            }
            #[target_feature(enable = "avx2")]
            fn four(what: What, steps: usize) -> usize {
                chains::<{ 4 * CHAINS }>(what, steps)
            }
            match self {
                // SAFETY: this width is only made where the processor has AVX-512.
                Lanes::Eight => return unsafe { eight(what, steps) },
                // SAFETY: this width is only made where the processor has AVX2.
                Lanes::Four => return unsafe { four(what, steps) },
                Lanes::Two => {}
            }
        }
        chains::<{ 2 * CHAINS }>(what, steps)
    }
}

/// Independent chains of `N` numbers each, in registers; operations done.
#[inline(always)]
fn chains<const N: usize>(what: What, steps: usize) -> usize {
    let (mut a, mut b) = ([black_box(1.5f64); N], [black_box(1.5f64); N]);
    let (factor, term) = (black_box(1.0 - 1e-9), black_box(1e-9));
    match what {
        What::AddMultiply => {
            for _ in 0..steps {
                a.iter_mut().for_each(|x| *x *= factor);
                b.iter_mut().for_each(|x| *x += term);
            }
        }
        What::Divide => (0..steps).for_each(|_| a.iter_mut().for_each(|x| *x = factor / *x)),
        What::Root => (0..steps).for_each(|_| a.iter_mut().for_each(|x| *x = x.sqrt())),
    }
    black_box((a, b));
    if matches!(what, What::AddMultiply) { 2 * N * steps } else { N * steps }
}
