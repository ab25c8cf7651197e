//! Contact numbers of a pile, whatever the output interval: a contact that has ended is none of that instant.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::succeed;
use serde_json::Value;
use std::path::Path;

/// Grains that fall onto a floor between walls; the 60 ms are the middle of the tumble, when contacts end all the time.
const PILE: &str = r#"
gravity = [0, 0, -9.81]
[time]
until = 0.06
dt = 2e-5
[[material]]
name = "s"
density = 2500
young = 5e6
poisson = 0.25
[[contact]]
between = ["s", "s"]
restitution = 0.5
sliding_friction = 0.4
[[fill]]
material = "s"
shape = "box:-0.03,-0.03,0,0.03,0.03,0.08"
diameter = [0.008, 0.01]
count = 150
velocity = [0.5, 0, -1]
[[wall]]
plane = "0,0,0,0,0,1"
material = "s"
[[wall]]
box = [-0.03,-0.03,-1,0.03,0.03,1]
faces = ["x-","x+","y-","y+"]
material = "s"
"#;

/// What a measure says of a run, its columns by name.
fn measured(folder: &Path, run: &str, arguments: &[&str]) -> Value {
    let done = succeed(folder, "dem-measure", &[&[run][..], arguments, &["--json"]].concat());
    serde_json::from_slice(&done.stdout).expect("JSON")
}

/// The last value of a column.
fn last(json: &Value, name: &str) -> f64 {
    let columns = json["columns"].as_array().expect("columns");
    let at = columns.iter().position(|c| c["name"] == name).expect("the column");
    json["rows"].as_array().and_then(|rows| rows.last()?[at].as_f64()).unwrap_or(f64::NAN)
}

#[test]
fn contacts_of_an_instant_do_not_depend_on_the_output_interval() {
    let folder = folder(&[("s.toml", PILE)]);
    let run = |name: &str, sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let arguments: Vec<&str> = ["s.toml", "-o", name].into_iter().chain(sets).collect();
        succeed(folder.path(), "dem-run", &arguments);
    };
    run("rare.mcap", &["output.every=0.03", "output.contacts=true"]);
    run("often.mcap", &["output.every=0.001", "output.contacts=true"]);
    run("without.mcap", &["output.every=0.03"]);
    let of = |run: &str, arguments: &[&str]| measured(folder.path(), run, arguments);
    let [rare, often, without] =
        ["rare.mcap", "often.mcap", "without.mcap"].map(|run| of(run, &["--contacts", "--last"]));
    assert!(last(&rare, "pairs") > 50.0, "{} pairs", last(&rare, "pairs"));
    for column in ["pairs", "coordination"] {
        let values = [&rare, &often, &without].map(|json| last(json, column));
        assert_eq!(values, [values[2]; 3], "{column}");
    }
    for column in ["wall_contacts", "mechanical_coordination", "rattlers"] {
        assert_eq!(last(&rare, column), last(&often, column), "{column}");
    }
    for arguments in [&["--forces"][..], &["--forces", "--on-walls"]] {
        let [rare, often] = ["rare.mcap", "often.mcap"].map(|run| of(run, arguments)["summary"].clone());
        assert_eq!(rare, often, "{arguments:?}");
    }
    let [rare, often] = ["rare.mcap", "often.mcap"].map(|run| of(run, &["--wall-force", "all"]));
    for column in ["contacts", "fx", "fy", "fz", "normal_sum"] {
        assert_eq!(last(&rare, column), last(&often, column), "{column}");
    }
    // What the lists have dropped between two frames is in a row, too.
    let work = [&rare, &often].map(|json| last(json, "sliding_work_sum"));
    assert!(work[0] > 0.0 && (work[0] / work[1] - 1.0).abs() < 1e-9, "{work:?} J");
    let [rare, often] = ["rare.mcap", "often.mcap"].map(|run| of(run, &["--plane-force", "0,0,0.01,0,0,1"]));
    for column in ["contacts", "fz", "normal", "shear"] {
        assert_eq!(last(&rare, column), last(&often, column), "{column}");
    }
}
