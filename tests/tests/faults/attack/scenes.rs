//! Every key of a scene, read from the tables of docs/reference/scene.md, with each of fourteen values.

use super::case::Case;
use super::{files, values};
use std::fs;
use std::path::Path;

/// A scene that has a table for every heading of docs/reference/scene.md that goes together.
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
    let docs = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = docs
        .ancestors()
        .map(|d| d.join("docs/reference/scene.md"))
        .find(|d| d.exists())
        .expect("docs/reference/scene.md");
    let text = fs::read_to_string(docs).expect("text");
    let (mut table, mut inner, mut keys) = (String::new(), String::new(), Vec::new());
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            inner.clear();
            table = match heading.trim_matches('`') {
                "Top level" => String::new(),
                "Contacts" => "contact.0.".to_owned(),
                "Bonds" => "bond.0.".to_owned(),
                h if h.starts_with("[[") => format!("{}.0.", h.trim_matches(['[', ']'])),
                h => format!("{}.", h.trim_matches(['[', ']'])),
            };
        } else if let Some(rest) = line.strip_prefix("| key of `") {
            inner = rest.split('`').next().map(|k| format!("{k}.")).unwrap_or_default();
        } else if line.starts_with("| key |") {
            inner.clear();
        } else if let Some(key) = line.strip_prefix("| `").and_then(|l| l.split('`').next()) {
            // The servo belongs to the second wall.
            let table = if inner == "servo." { "wall.1." } else { &table };
            keys.push(format!("{table}{}{key}", if inner.starts_with('[') { "" } else { &inner }));
        }
    }
    keys.retain(|k| k.chars().all(|c| c.is_ascii_alphanumeric() || "._".contains(c)));
    keys.sort();
    keys.dedup();
    keys
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
