//! What a message names is done, and the run goes on: each remedy with a key, an option or a command.

use super::zones::{bounce, bounced};
use super::{COLLISION, HEAD, scene};
use ::scene::advice::Remedy;
use grainpipe_tests::tools::{Done, line, tool};
use std::fs;
use tempfile::TempDir;

/// How a remedy is tried.
enum How {
    /// It has no key: what is to be done depends on the plant.
    Words,
    /// A run of stages or on another machine shows it.
    Elsewhere,
    /// A scene that is stopped, its call, and what the message says.
    Runs(TempDir, &'static [&'static str], Change),
}

/// What is done.
enum Change {
    /// Keys are set again, from the start.
    Keys(&'static [&'static str]),
    /// The command that is printed.
    Command,
    /// The modulus that is named: the first one, or the one for what is near.
    Modulus,
}

use Change::*;
use How::*;

/// Grains in a box, with more keys.
fn boxed(more: &str) -> TempDir {
    let folder = scene("", "");
    let head = HEAD.split("[[particles]]").next().expect("a head").replace("dt = 1e-5\n", "");
    let head = head.replace("until = 0.02", "until = 0.3").replace("every = 0.002", "every = 0.02");
    fs::write(folder.path().join("s.toml"), format!("gravity = [0, 0, -9.81]\n{head}{more}"))
        .expect("written");
    folder
}

/// Three balls that fall on one wall, with more keys of it.
fn drop_on(wall: &str) -> TempDir {
    let folder = boxed(&format!("[[particles]]\nmaterial = \"glass\"\nsource = \"p.csv\"\n{wall}"));
    let balls = "x,y,z,radius,vz\n0,0,0.02,0.01,-1\n0.021,0,0.02,0.01,-1\n-0.021,0,0.02,0.01,-1\n";
    fs::write(folder.path().join("p.csv"), balls).expect("written");
    folder
}

/// Grains that pile up to where they come in.
fn pile() -> TempDir {
    boxed(
        "[[wall]]\nbox = [-0.02, -0.02, 0, 0.02, 0.02, 0.3]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\nmaterial = \"glass\"\n\
         [[insert]]\nmaterial = \"glass\"\ndiameter = 0.006\nshape = \"box:-0.02,-0.02,0.02,0.02,0.02,0.03\"\n\
         velocity = [0, 0, -1]\nrate_count = 1500\n",
    )
}

/// Grains that come in beside a plate that shakes, and into it.
fn beside_a_plate() -> TempDir {
    boxed(
        "[[wall]]\nname = \"plate\"\nsolid = \"box:-0.03,0.015,-0.1,0.03,0.03,0.1\"\nmaterial = \"glass\"\n\
         motion = { vibrate = { amplitude = [0, 0, 1e-4], frequency = 10 } }\n\
         [[insert]]\nmaterial = \"glass\"\ndiameter = 0.006\nshape = \"box:-0.02,-0.02,0.02,0.02,0.018,0.03\"\n\
         velocity = [0, 0, -1]\nrate_count = 500\n",
    )
}

/// Grains that bounce without loss in steps that are too long.
fn gains() -> TempDir {
    let folder = boxed(
        "[[wall]]\nbox = [-0.03, -0.03, 0, 0.03, 0.03, 0.3]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\nmaterial = \"glass\"\n\
         [[fill]]\nmaterial = \"glass\"\nshape = \"box:-0.03,-0.03,0.01,0.03,0.03,0.2\"\ndiameter = 0.01\ncount = 100\n",
    );
    let file = folder.path().join("s.toml");
    let text = fs::read_to_string(&file).expect("read").replace("until = 0.3", "until = 0.5");
    let text = text.replace(
        "restitution = 0.9\nsliding_friction = 0.3",
        "law = \"hooke\"\nstiffness = 1e4\nrestitution = 1",
    );
    fs::write(file, text).expect("written");
    folder
}

const COARSE: &[&str] =
    &["--set", "time.safety=1", "--set", "time.contacts=sampled", "--set", "output.energy=true"];
/// Grains that do not bounce back to where others come in, which stop the run where they find no room.
const SOFT: &[&str] = &["--set", "contact.0.restitution=0.3", "--set", "insert.0.when_blocked=stop"];
const SPRING: &str = "[[wall]]\nname = \"plate\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\n\
                      spring = { direction = [0, 0, 1], stiffness = 100, mass = 0.05, speed_limit = 0.2 }\n";

/// A lid that is to press down, and is drawn pushing up.
fn lid() -> TempDir {
    let folder = drop_on(
        "[[wall]]\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\n\
         [[wall]]\nname = \"lid\"\nmesh = \"lid.obj\"\nmaterial = \"glass\"\n\
         servo = { direction = [0, 0, 1], force = 1, speed_limit = 0.5 }\n",
    );
    let lid = "v -0.1 -0.1 0.05\nv 0.1 -0.1 0.05\nv 0.1 0.1 0.05\nv -0.1 0.1 0.05\nf 1 3 2\nf 1 4 3\n";
    fs::write(folder.path().join("lid.obj"), lid).expect("written");
    folder
}

/// A domain that is squeezed until a grain would meet itself.
fn squeezed() -> TempDir {
    let folder = boxed(
        "[[fill]]\nmaterial = \"glass\"\nshape = \"box:0,0,0,0.04,0.04,0.04\"\ndiameter = 0.008\ncount = 40\n\
         [domain]\nperiodic = [\"x\", \"y\", \"z\"]\nlow = [0, 0, 0]\nhigh = [0.04, 0.04, 0.04]\n\
         [domain.strain]\nx = { rate = 5 }\n",
    );
    let file = folder.path().join("s.toml");
    let text = fs::read_to_string(&file).expect("read").replace("gravity = [0, 0, -9.81]\n", "");
    fs::write(file, text).expect("written");
    folder
}

/// The downstream stage of such a plant as the scene.
fn downstream(folder: TempDir) -> TempDir {
    fs::copy(folder.path().join("down.toml"), folder.path().join("s.toml")).expect("copied");
    folder
}

/// How each remedy is tried: a remedy that is added must be tried, too.
fn how(remedy: Remedy) -> How {
    let falls = || {
        let folder = scene("7,0,0,0,0.01,0,0,0,0,0,0\n", "");
        let text = format!("gravity = [0, 0, -9810]\n{HEAD}");
        fs::write(folder.path().join("s.toml"), text).expect("written");
        folder
    };
    match remedy {
        Remedy::ShortenStep => Runs(falls(), &["--set", "guards.motion=0.1"], Keys(&["time.dt=1e-6"])),
        Remedy::RaiseMotion => Runs(falls(), &["--set", "guards.motion=0.1"], Command),
        Remedy::SmallerShare => Runs(gains(), COARSE, Keys(&["time.safety=0.1"])),
        Remedy::RaiseEnergy => Runs(gains(), COARSE, Command),
        Remedy::RaiseOverlap => Runs(scene(COLLISION, ""), &["--set", "guards.overlap=0.11"], Command),
        Remedy::Stiffen => Runs(scene(COLLISION, ""), &["--set", "guards.overlap=0.05"], Modulus),
        Remedy::InsertShape => {
            let higher = Keys(&["insert.0.shape=\"box:-0.02,-0.02,0.2,0.02,0.02,0.21\"", "time.until=0.15"]);
            Runs(pile(), SOFT, higher)
        }
        Remedy::InsertUntil => Runs(pile(), SOFT, Keys(&["insert.0.until=0.05"])),
        Remedy::InsertRate => Runs(pile(), SOFT, Keys(&["insert.0.rate_count=100"])),
        Remedy::WaitOrSkip => Runs(pile(), SOFT, Keys(&["insert.0.when_blocked=wait"])),
        Remedy::SmallerShape => {
            Runs(beside_a_plate(), &[], Keys(&["insert.0.shape=\"box:-0.02,-0.02,0.02,0.02,0.014,0.03\""]))
        }
        Remedy::SpringLimit => Runs(drop_on(SPRING), &[], Keys(&["wall.0.spring.speed_limit=2"])),
        Remedy::SpringMass => Runs(drop_on(SPRING), &[], Keys(&["wall.0.spring.mass=5"])),
        Remedy::ServoDirection => Runs(lid(), &[], Keys(&["wall.1.servo.direction=[0, 0, -1]"])),
        Remedy::EndBefore => Runs(squeezed(), &[], Keys(&["time.until=0.1"])),
        Remedy::RemoveReturned => {
            // Two grains: the first is in the way of the second.
            let grains = "1,0,0,0.03,0.01,0,0,-1,0,0,0\n2,0.001,0,0.15,0.01,0,0,-1,0,0,0\n";
            Runs(
                downstream(bounced(grains)),
                &["in.mcap"],
                Keys(&["guards.zones=\"remove\"", "time.until=0.15"]),
            )
        }
        Remedy::AllowReturned => Runs(downstream(bounce()), &["in.mcap"], Command),
        Remedy::RecordedPaths | Remedy::Ahead | Remedy::WithoutDevice => Elsewhere,
        Remedy::MeetSlower
        | Remedy::FreeZone
        | Remedy::CutBelow
        | Remedy::CutUpstream
        | Remedy::LongerZone
        | Remedy::LookAtStart
        | Remedy::LookAtStiffness
        | Remedy::ServoStart
        | Remedy::LargerDomain
        | Remedy::RecordWrenches
        | Remedy::SofterBonds
        | Remedy::MoveOne => Words,
    }
}

/// Does what a message says.
fn changed(folder: &TempDir, call: &[&str], change: &Change, said: &str) -> Done {
    let again = |sets: &[String]| {
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        tool(folder.path(), "dem-run", &[&["s.toml", "-o", "again.mcap"], call, &sets[..]].concat())
    };
    match change {
        Keys(keys) => again(&keys.iter().map(|key| (*key).to_owned()).collect::<Vec<_>>()),
        Command => {
            let (_, command) = said.split_once("continue with: ").expect("a command");
            assert!(command.contains("--whole"), "{command}");
            line(folder.path(), command.lines().next().expect("a line"))
        }
        Modulus => {
            let (_, value) = said.split_once("young of glass ≥ ").expect("a modulus");
            again(&[format!("material.0.young={}", value.split_whitespace().next().expect("a number"))])
        }
    }
}

/// Whether a sentence names a key or an option.
fn names_a_key(text: &str) -> bool {
    let key = |word: &str| {
        let word = word.trim_matches(|c: char| !c.is_alphanumeric());
        word.split_once('.')
            .is_some_and(|(table, key)| !table.is_empty() && key.starts_with(|c: char| c.is_alphanumeric()))
    };
    text.contains("--") || text.contains(" = ") || text.split_whitespace().any(key)
}

#[test]
fn what_a_message_names_lets_the_run_go_on() {
    let mut tried = 0;
    for remedy in Remedy::ALL {
        let text = remedy.text(0, "");
        match how(*remedy) {
            Words => assert!(!names_a_key(&text), "'{text}' names a key and is not tried"),
            Elsewhere => {}
            Runs(folder, call, change) => {
                let first = tool(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], call].concat());
                assert_eq!(first.code, 3, "{remedy:?}: {}", first.stderr);
                assert!(first.stderr.contains(&text), "'{text}' is not in {}", first.stderr);
                let done = changed(&folder, call, &change, &first.stderr);
                assert_eq!(done.code, 0, "{remedy:?}: {}\nafter {}", done.stderr, first.stderr);
                tried += 1;
            }
        }
    }
    assert_eq!(tried, Remedy::ALL.len() - 15, "those with words only, and of stages and devices");
}

/// Of soft and hard materials the softer one is made stiffer, or both where that is not enough; of many grains the hardest impact is named.
#[test]
fn a_modulus_that_is_named_is_enough_for_two_materials() {
    let steel = "[[material]]\nname = \"rubber\"\ndensity = 1000\nyoung = 4e6\npoisson = 0.45\n";
    let wall = "[[wall]]\nplane = \"0,0,-0.05,0,0,1\"\nmaterial = \"rubber\"\n";
    let folder = scene("1,0,0,0,0.01,0,0,-3,0,0,0\n", wall);
    let file = folder.path().join("s.toml");
    let text =
        fs::read_to_string(&file).expect("read").replace("[[contact]]", &format!("{steel}[[contact]]"));
    fs::write(&file, text.replace("dt = 1e-5", "dt = 1e-6").replace("until = 0.02", "until = 0.03"))
        .expect("written");
    let guard = ["--set", "guards.overlap=0.1"];
    let first = tool(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], &guard[..]].concat());
    assert_eq!(first.code, 3, "{}", first.stderr);
    let (_, said) = first.stderr.split_once("young of ").expect("a modulus");
    let (of, value) = said.split_once(" ≥ ").expect("a modulus");
    let value = value.split_whitespace().next().expect("a number");
    assert_eq!(of, "glass and rubber", "{}", first.stderr);
    let sets = [format!("material.0.young={value}"), format!("material.1.young={value}")];
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set.as_str()]).collect();
    let done = tool(folder.path(), "dem-run", &[&["s.toml", "-o", "again.mcap"], &guard[..], &sets].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
}
