//! The layout of checkpoints belongs to the version that they are written with: a state of one version is never read as another.
//!
//! `layouts/VERSION.txt` holds what the version writes. A change of it is a new version, so that `--resume` refuses older files by
//! their number instead of reading them wrongly: raise `VERSION` in `crates/base/stream/src/state.rs`, then
//! `GRAINPIPE_NEW_LAYOUT=1 cargo test -p grainpipe-tests --test tools layout` writes the file that goes with it.

use grainpipe_tests::layout::layout;
use grainpipe_tests::scenes::{Head, RUBS};
use std::path::Path;
use stream::mcap::{Compression, Provenance};
use stream::state::VERSION;

const HEAD: Head = Head {
    time: "until = 0.06",
    output: "every = 0.01\ncheckpoint = 0.02\nenergy = true\ncontacts = true",
    material: "stone",
    density: 2500.0,
    young: 2e6,
    contact: RUBS,
};

/// Grains that fall from a faucet, roll, cross a storage plane, could be taken out below the floor, are pressed by a wall that follows a force.
const FLOW: &str = r#"[domain]
periodic = ["y"]
low = [0, -0.1, 0]
high = [0, 0.1, 0]
[[fill]]
material = "stone"
shape = "box:-0.05,-0.05,0.012,0.05,0.05,0.06"
diameter = 0.01
count = 20
velocity = [0, 0, -1]
[[insert]]
material = "stone"
shape = "box:-0.05,-0.05,0.1,0.05,0.05,0.13"
diameter = 0.01
rate_count = 1000
velocity = [0, 0, -1]
[[outlet]]
plane = "0.045,0,0,1,0,0"
length = 0.02
[[remove]]
shape = "box:-1,-1,-1,1,1,-0.5"
[[wall]]
name = "press"
plane = "-0.06,0,0,1,0,0"
material = "stone"
servo = { direction = [1, 0, 0], force = 1, speed_limit = 0.1 }
[[wall]]
name = "plate"
plane = "0.06,0,0,-1,0,0"
material = "stone"
spring = { direction = [1, 0, 0], stiffness = 100, mass = 1, speed_limit = 1 }
"#;

/// Grains that adhere fall asleep.
const ASLEEP: &str = r#"[sleep]
speed = 1
time = 1e-4
wake = 0.5
[[fill]]
material = "stone"
shape = "box:-0.02,-0.02,0,0.02,0.02,0.03"
diameter = 0.01
count = 5
"#;

/// Rigid clumps, from the start and from a faucet.
const CLUMPS: &str = r#"[[clump]]
name = "pair"
material = "stone"
spheres = [[0, 0, 0, 0.01], [0.012, 0, 0, 0.008]]
[[body]]
clump = "pair"
position = [0, 0, 0.02]
spin = [0, 0, 3]
[[insert]]
clump = "pair"
shape = "cylinder:0,0,0.1,0,0,0.15,0.05"
velocity = [0, 0, -1]
rate_count = 50
"#;

/// Bonded grains.
const BONDED: &str = r#"[[bond]]
between = ["stone", "stone"]
gap = 0.02
young = 1e6
poisson = 0.25
[[fill]]
material = "stone"
shape = "box:-0.02,-0.02,0,0.02,0.02,0.03"
diameter = 0.01
count = 5
"#;

/// The layout of the last checkpoint of a run.
fn written(scene: &str) -> String {
    let scene =
        scene::Scene::new("s.toml", HEAD.toml() + &HEAD.floor() + scene, &[], Path::new("")).expect("sound");
    let mut plan = scene.plan(Vec::new()).expect("whole");
    // Beyond what a scene may say: they sleep as they fall.
    plan.setup.sleep.iter_mut().for_each(|sleep| sleep.wake *= 10.0);
    let (provenance, how) = (Provenance::default(), Compression::None.into());
    let settings = run::Settings {
        provenance,
        how,
        resume: None,
        earlier: None,
        watched: false,
        stop: || false,
        device: None,
    };
    let (_, run) = run::run(&scene, plan, Vec::new(), settings, &mut |_| ()).expect("it runs");
    layout(&run::Checkpoint::last("run", &run[..]).expect("there is one")).expect("it has a layout")
}

/// A field on each line.
fn lines(text: &str) -> String {
    text.replace(" { ", " {\n").replace(", ", ",\n").replace(" }", "\n}")
}

#[test]
fn the_layout_of_checkpoints_is_that_of_their_version() {
    let mut all = String::new();
    for (name, scene) in [("flow", FLOW), ("asleep", ASLEEP), ("clumps", CLUMPS), ("bonded", BONDED)] {
        all += &format!("# {name}\n{}\n", lines(&written(scene)));
    }
    for filled in [
        "zone_particles: [ZoneParticle",
        "servos: [ServoState",
        "mounts: [MountState",
        "history: [\nf64",
        "flights: [ClumpMotion",
        "pairs: [BondedPair",
        "?Sleepers",
        "regions: [Removed",
    ] {
        let flat = all.replace('\n', " ").replace("[ ", "[");
        assert!(flat.contains(&filled.replace('\n', "")), "the scenes have {filled}: {all}");
    }
    let file = format!("{}/tests/tools/layouts/{VERSION}.txt", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("GRAINPIPE_NEW_LAYOUT").is_some() && !Path::new(&file).exists() {
        std::fs::write(&file, &all).expect("written");
    }
    let known = std::fs::read_to_string(&file).unwrap_or_default();
    let first = all.lines().zip(known.lines()).find(|(a, b)| a != b);
    assert!(
        all == known,
        "a checkpoint is written otherwise than version {VERSION} says (now, then: {first:?}): raise VERSION in \
         crates/base/stream/src/state.rs, and run this test once with GRAINPIPE_NEW_LAYOUT=1"
    );
}
