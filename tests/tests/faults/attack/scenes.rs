//! Every key of a scene, with each of fourteen values.

use super::case::Case;
use super::{files, values};
use scene::keys::{Section, sections};

/// A scene that has every table that goes together.
const SCENE: &str = r#"
gravity = [0, 0, -9.81]
[time]
until = 0.002
[output]
every = 0.001
energy = true
[domain]
periodic = ["x", "y"]
low = [0, 0, 0]
high = [0.03, 0.03, 0.1]
[neighbours]
[guards]
[[material]]
name = "sinter"
density = 3300
young = 2e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.5
sliding_friction = 0.5
[[fill]]
material = "sinter"
shape = "box:0,0,0.0205,0.03,0.03,0.06"
diameter = 0.005
count = 20
[[insert]]
material = "sinter"
shape = "box:0.005,0.005,0.08,0.025,0.025,0.095"
diameter = 0.005
velocity = [0, 0, -1]
rate_count = 1000
[[bond]]
between = ["sinter", "sinter"]
gap = 0.002
young = 1e6
poisson = 0.25
[[wall]]
plane = "0,0,0,0,0,1"
material = "sinter"
motion = { vibrate = { amplitude = [0, 0, 1e-4], frequency = 50 } }
[[wall]]
plane = "0,0,0.099,0,0,-1"
material = "sinter"
servo = { direction = [0, 0, -1], force = 1, speed_limit = 0.1 }
"#;

/// Keys as `--set` names them.
pub fn keys() -> Vec<String> {
    let of = |section: Section| {
        let table = match section.path.split_once('.') {
            // The servo belongs to the second wall.
            Some(("wall", inner)) => format!("wall.{}.{inner}.", usize::from(inner == "servo")),
            _ if section.path.is_empty() => String::new(),
            _ if section.many => format!("{}.0.", section.path),
            _ => format!("{}.", section.path),
        };
        section.rows.into_iter().map(move |row| format!("{table}{}", row.name))
    };
    sections().into_iter().flat_map(of).collect()
}

/// All cases: keys × values.
pub fn cases() -> Vec<Case> {
    let mut shared = files::others();
    shared.push(("all.toml".into(), SCENE.as_bytes().to_vec()));
    let one = |key: &str, value: &str| {
        let args =
            ["all.toml".to_owned(), "--set".into(), format!("{key}={value}"), "-o".into(), "out.mcap".into()];
        Case {
            group: "keys of scenes",
            tool: "dem-run",
            args: args.into(),
            files: shared.clone(),
            change: String::new(),
            memory: None,
        }
    };
    keys().iter().flat_map(|key| values::KEY.map(|value| one(key, value))).collect()
}

/// The scene whose keys are changed, and its name.
pub fn file() -> (String, Vec<u8>) {
    ("all.toml".to_owned(), SCENE.as_bytes().to_vec())
}
