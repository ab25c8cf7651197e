//! Errors of a sample name places in its file, though the scene that is checked is another one: it has shape and amount of the grains, too.

use lab::Sample;
use std::path::Path;

const SAND: &str = r#"[[fill]]
material = "sand"
diameter = 0.002
[[material]]
name = "sand"
density = 2600
young = 1e7
poisson = 0.25
[[contact]]
between = ["sand", "sand"]
restitution = 0.5
[time]
dt = "auto"
"#;

fn message(from: &str, to: &str, set: &[&str]) -> String {
    assert!(SAND.contains(from), "{from}");
    let set: Vec<String> = set.iter().map(|set| (*set).to_owned()).collect();
    let sample = Sample::new("sand.toml", SAND.replace(from, to), &set, Path::new(""));
    sample.map_or_else(|error| error.to_string(), |_| String::new())
}

#[test]
fn errors_stand_where_the_reader_finds_them() {
    for (from, to, begins) in [
        ("dt = \"auto\"", "dt = 1", "sand.toml:13:6: time.dt: 1"),
        ("restitution = 0.5", "restitution = 7", "sand.toml:11:15: contact.0.restitution = 7: "),
        ("restitution = 0.5", "restitution = \"a\"", "sand.toml:11:15: \"a\" has no number"),
        ("restitution = 0.5", "restitution = 0.5\nslide = 1", "sand.toml:12:9: unknown key 'slide'"),
        ("dt = \"auto\"", "dt = \"auto\"\n[tim]\n", "sand.toml:14:1: unknown key 'tim'"),
    ] {
        let message = message(from, to, &[]);
        assert!(message.starts_with(begins), "{to}: {message}");
    }
    for set in ["contact.0.restitution=7", "contact.0.restution=0.5", "time.dt=1"] {
        let message = message("[time]\ndt = \"auto\"\n", "", &[set]);
        assert!(message.starts_with(&format!("sand.toml with --set {set}: ")), "{message}");
    }
    assert_eq!(message("[time]\ndt = \"auto\"\n", "", &[]), "");
}
