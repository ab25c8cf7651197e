//! What a scene does not ask for costs no instruction: counted by valgrind, on the path of AVX2.
//!
//! Callgrind adds instructions up by source line, inlined code included, so that a file tells whether anything of it ran. Instructions of the engine are the same in every run; those of the rest (reading, hashing) vary a little.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::{skip, tools};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// Grains along an edge of the lattice.
const EDGE: usize = 6;
/// What reads and resolves contact laws, once before any step.
const SET_UP: [&str; 6] = [
    "effects/registry.rs",
    "effects/law.rs",
    "effects/describe.rs",
    "effects/messages.rs",
    "effects/friction.rs",
    "effects/hooke_direct.rs",
];
/// The spring that sliding friction and rolling resistance share. Most of an effect is inlined down to `simd/`; this remains.
const SPRING: &str = "effects/capped_spring.rs";

const SCENE: &str = r#"
gravity = [0, 0, -9.81]
[time]
until = 5e-4
dt = 5e-6
[output]
every = 1.0
[[material]]
name = "grain"
density = 2500
young = 5e6
poisson = 0.3
[[particles]]
source = "lattice.csv"
material = "grain"
[[wall]]
material = "grain"
plane = "0,0,0,0,0,1"
[[contact]]
between = ["grain", "grain"]
law = "hooke"
stiffness = 1e4
restitution = 0.5
"#;

/// Grains that touch all their neighbours and are sheared.
fn lattice() -> String {
    let mut text = "id,x,y,z,radius,vx,vy,vz\n".to_owned();
    for id in 0..EDGE.pow(3) {
        let [x, y, z] = [id % EDGE, id / EDGE % EDGE, id / EDGE / EDGE].map(|k| 0.00199 + 0.00399 * k as f64);
        // Writing to a string does not fail.
        let _ = writeln!(text, "{id},{x},{y},{z},0.002,{},0,0", 2.0 * z);
    }
    text
}

/// Instructions of the engine: by file, its path below the sources of a crate in `crates/engine`, and of all its functions but [`SET_UP`], with what is inlined into them.
#[derive(Debug)]
struct Count {
    files: HashMap<String, u64>,
    engine: u64,
}

impl Count {
    /// Runs a scene of this name under callgrind.
    fn of(folder: &Path, name: &str, contact: &str) -> Count {
        let scene = format!("{name}.toml");
        std::fs::write(folder.join(&scene), format!("{SCENE}{contact}")).expect("the scene can be written");
        let mut command = Command::new("valgrind");
        command.current_dir(folder).args(["-q", "--tool=callgrind", "--callgrind-out-file=counted"]);
        command.arg(tools::program("dem-run")).args([
            scene.as_str(),
            "-q",
            "--threads",
            "1",
            "-o",
            "run.mcap",
        ]);
        let done = command.output().expect("valgrind starts");
        assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
        Count::read(&std::fs::read_to_string(folder.join("counted")).expect("callgrind has written"))
    }

    /// Callgrind's format: `fl=`, `fi=`, `fe=` name the file of the lines below, `(number) name` once and `(number)` from
    /// then on; a line is a place and its cost, and the one after `calls=` is the cost of what was called.
    fn read(text: &str) -> Count {
        let (mut names, mut cost) = (HashMap::new(), HashMap::new());
        let (mut file, mut home, mut called) = (String::new(), String::new(), false);
        let (own, mut engine) = ("crates/engine/", 0);
        for line in text.lines() {
            if let Some((key @ ("fl" | "fi" | "fe" | "cfi" | "cfl"), value)) = line.split_once('=') {
                let (number, name) = value.split_once(' ').unwrap_or((value, ""));
                if !name.is_empty() {
                    names.insert(number, name);
                }
                if !key.starts_with('c') {
                    file = names.get(number).copied().unwrap_or_default().to_owned();
                }
                if key == "fl" {
                    home = file.clone();
                }
            } else if line.starts_with("calls=") {
                called = true;
            } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c)) {
                let count: Option<u64> = line.split_whitespace().nth(1).and_then(|n| n.parse().ok());
                if let (false, Some(count)) = (called, count) {
                    let steps = home.contains(own) && !SET_UP.iter().any(|file| home.ends_with(file));
                    engine += if steps { count } else { 0 };
                    let within = |path: &str| Some(path.split_once(own)?.1.split_once("/src/")?.1.to_owned());
                    if let Some(path) = within(&file) {
                        *cost.entry(path).or_insert(0) += count;
                    }
                }
                called = false;
            }
        }
        Count { files: cost, engine }
    }

    fn engine(&self) -> u64 {
        self.engine
    }

    /// Instructions of a file.
    fn at(&self, file: &str) -> u64 {
        self.files.get(file).copied().unwrap_or(0)
    }
}

/// Whether valgrind is here; says so when it is not.
fn counts() -> bool {
    let here = Command::new("valgrind").arg("--version").output().is_ok();
    if !here {
        skip("valgrind");
    }
    here
}

/// An effect that a scene leaves out, or gives the value of nothing, leaves no instruction behind.
#[test]
fn absent_effects_cost_no_instruction() {
    if !counts() {
        return;
    }
    let folder = folder(&[("lattice.csv", lattice())]);
    let count = |name, contact| Count::of(folder.path(), name, contact);
    let without = count("frictionless", "");
    let friction = count("friction", "sliding_friction = 0.5");
    let rolling = count("rolling", "sliding_friction = 0.5\nrolling_resistance = 0.1");
    let nothing = count("nothing", "sliding_friction = 0\nrolling_resistance = 0");

    assert_eq!(without.at(SPRING), 0, "{without:?}");
    // Blocks in which nothing touches are passed over.
    assert!(friction.at(SPRING) > 5_000, "{friction:?}");
    // Its own lines alone: how many of its operations count as lines of the numbers' types depends on what the compiler inlines where.
    assert!(4 * rolling.at(SPRING) > 5 * friction.at(SPRING), "{friction:?} {rolling:?}");
    let (least, more, most) = (without.engine(), friction.engine(), rolling.engine());
    // A quarter more at least: slip, spring, cap, moments and rotation, beside lists and the move, which both have.
    assert!(
        (least as f64) < 0.8 * more as f64,
        "frictionless {least}, with friction {more}: {without:?} {friction:?}"
    );
    assert!(more < most, "with friction {more}, and with rolling resistance {most}");
    let apart = nothing.engine().abs_diff(least);
    assert!(apart <= 100, "friction of 0 costs {apart} instructions");
    println!(
        "instructions: frictionless {least}, friction {more}, rolling {most}; friction of 0: {apart} apart"
    );
}

/// A closure or a function that is not inlined into the loop of wide registers calls a function for each operation of its lanes, and takes
/// several times as long, with the same result.
#[cfg(target_arch = "x86_64")]
#[test]
fn nothing_that_computes_with_lanes_is_out_of_line() {
    let Ok(symbols) = Command::new("nm").arg(tools::program("dem-run")).output() else {
        skip("nm");
        return;
    };
    let symbols = String::from_utf8_lossy(&symbols.stdout);
    assert!(symbols.contains("compiled4wide"), "nm lists the symbols of dem-run");
    let called: Vec<&str> =
        symbols.lines().filter(|s| s.contains("core_arch") && s.contains("_mm")).collect();
    assert!(called.is_empty(), "out of line: {called:#?}");
}
