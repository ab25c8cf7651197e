//! `dem-run --new`.

use super::*;
use grainpipe_tests::tree::root;

/// The scene to begin with runs and is drawn, and nothing is overwritten.
#[test]
fn a_new_plant_runs_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let done = succeed(folder.path(), "dem-run", &["--new", "plant"]);
    assert!(done.stderr.contains("plant/scene.toml"), "{}", done.stderr);
    let plant = folder.path().join("plant");
    let text = fs::read_to_string(plant.join("scene.toml")).unwrap();
    assert_eq!(text, fs::read_to_string(root().join("examples/first-plant.toml")).unwrap());
    // The commands at its head, with a run that is shorter.
    let commands: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("#     dem-")).collect();
    assert_eq!(commands.len(), 3);
    for command in commands {
        let command = command.split('#').next().unwrap().replace("scene.toml", "scene.toml --until 0.3");
        let done = line(&plant, &format!("dem-{command}"));
        // The second kind of stones comes later than this run ends.
        let warned = done.stderr.lines().filter(|line| line.contains("warning"));
        let warned: Vec<&str> = warned.filter(|line| !line.contains("insert.1.from")).collect();
        assert!(done.code == 0 && warned.is_empty(), "{command}: {}", done.stderr);
    }
    let again = tool(folder.path(), "dem-run", &["--new", "plant"]);
    assert!(again.code != 0 && again.stderr.contains("is there already"), "{}", again.stderr);
    let nowhere = tool(folder.path(), "dem-run", &["--new", "no/plant"]);
    assert!(nowhere.code != 0 && nowhere.stderr.contains("make it first"), "{}", nowhere.stderr);
}
