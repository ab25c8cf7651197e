//! Features of dependencies: what tests need must not make the engine another one, which `cargo test` would compile again after `cargo build`.

use grainpipe_tests::tree::root;
use std::collections::BTreeSet;
use std::process::Command;

/// Packages with their features, as cargo chooses them for some kinds of dependencies.
fn chosen(words: &[&str]) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(root()).args(["tree", "--offline", "--locked", "--prefix", "none", "-f", "{p} [{f}]"]);
    let done = cargo.args(words).output().expect("cargo starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect()
}

#[test]
fn the_engine_is_compiled_once_for_building_and_for_testing() {
    let name = |line: &String| line.split(" [").next().unwrap_or_default().to_owned();
    let of_engine: BTreeSet<String> =
        chosen(&["-p", "grainpipe-dem", "-e", "normal"]).iter().map(name).collect();
    let built = chosen(&["--workspace", "-e", "normal,build"]);
    let tested = chosen(&["--workspace", "-e", "normal,build,dev"]);
    let other: Vec<_> =
        built.difference(&tested).filter(|package| of_engine.contains(&name(package))).collect();
    assert!(
        of_engine.len() > 10 && other.is_empty(),
        "tests ask for more features of {other:?}: ask for the same in [workspace.dependencies]"
    );
}
