//! Checkpoints with a right hash that no program wrote.

use crate::runs::{last, made, tray};
use run::Checkpoint;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Changes of one checkpoint.
const CHANGES: usize = 400;
/// Length of the head in front of the body [B]: magic, version, length, hash.
const HEAD: usize = 52;

const CLUMPS: &str = r#"[[clump]]
name = "dumbbell"
material = "rock"
spheres = [[-0.0015, 0, 0, 0.002], [0.0015, 0, 0, 0.002]]
[[insert]]
clump = "dumbbell"
shape = "box:0.01,0.01,0.05,0.05,0.05,0.08"
velocity = [0, 0, -1]
rate_count = 300
[[outlet]]
plane = "0,0,0.045,0,0,-1"
"#;

const SERVO: &str = r#"[sleep]
speed = 0.01
[[fill]]
material = "rock"
shape = "box:0,0,0,0.06,0.06,0.05"
diameter = 0.009
count = 40
[[wall]]
name = "lid"
plane = "0,0,0.06,0,0,-1"
material = "rock"
servo = { direction = [0, 0, -1], force = 5, speed_limit = 0.2 }
"#;

const BONDS: &str = r#"[[fill]]
material = "rock"
shape = "box:0,0,0,0.06,0.06,0.05"
diameter = 0.009
count = 60
[[bond]]
between = ["rock", "rock"]
kind = "parallel"
gap = 0.002
modulus = 1e6
stiffness_ratio = 2
tensile_strength = 1e4
shear_strength = 1e4
"#;

/// The bytes of a checkpoint with the word at `at` changed, behind a head that is right.
fn changed(good: &[u8], at: usize, word: u32) -> Vec<u8> {
    let mut body = good[HEAD..].to_vec();
    body[at..at + 4].copy_from_slice(&word.to_le_bytes());
    let hash = stream::sha256(&body);
    let digits = (0..32).map(|k| u8::from_str_radix(&hash[2 * k..2 * k + 2], 16).unwrap());
    good[..20].iter().copied().chain(digits).chain(body).collect()
}

/// Numbers that look like chance: splitmix64 of Steele, Lea & Flood (2014), doi:10.1145/2660193.2660195.
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end as u64) as usize
    }
}

/// Where the body of a checkpoint may hold an index or a length: small numbers, and one that stands for none.
fn index_like(body: &[u8], from: usize) -> Vec<usize> {
    let word = |at: usize| u32::from_le_bytes([body[at], body[at + 1], body[at + 2], body[at + 3]]);
    (from..body.len() - 4).filter(|&at| matches!(word(at), 1..4096 | u32::MAX)).collect()
}

/// Resumes from changed checkpoints of a scene: none may end in a panic; returns how many were refused.
fn refused(scene: &str, seed: u64) -> usize {
    let until = |time: &str| [format!("time.until={time}")];
    let saved = last(&made(scene, &until("0.04"), None).unwrap().1);
    let good = stream::state::encode(&saved).unwrap();
    made(scene, &until("0.045"), Some(saved)).expect("the checkpoint as it was written resumes");
    let (body, mut random) = (&good[HEAD..], Chance(seed));
    let places = index_like(body, scene.len() + 100);
    let mut refused = 0;
    for _ in 0..CHANGES {
        let at = places[random.below(places.len())];
        let words =
            [u32::MAX, u32::MAX - 1, 0, 1, 63, 4095, 1 << 31, 0x7ff8_0000, random.below(1 << 32) as u32];
        let word = words[random.below(words.len())];
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            let Ok(saved) = stream::state::decode::<Checkpoint>(&changed(&good, at, word)) else {
                return true;
            };
            made(scene, &until("0.045"), Some(saved)).is_err()
        }));
        refused += usize::from(outcome.unwrap_or_else(|_| panic!("word {word:#x} at byte {at} panics")));
    }
    refused
}

#[test]
fn no_changed_checkpoint_ends_in_a_panic() {
    for (seed, further) in [CLUMPS, SERVO, BONDS].into_iter().enumerate() {
        let refused = refused(&(tray("0, 0, -9.81", 0.06) + further), seed as u64);
        assert!(refused > CHANGES / 10, "scene {seed}: only {refused} were refused");
    }
}
