//! Bonded lumps through a cut: the stage downstream gets them whole, and breaks them as the undivided plant does.

use super::{last_of, passages, plant_of};
use grainpipe_tests::scenes::{SINTER, write};
use grainpipe_tests::tools::{line, succeed, tool};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Three lumps of 27 spheres that fall onto a floor at different times, one of them beside the others' axis.
pub fn lumps(motion: &str) -> TempDir {
    let mut rows = "id,x,y,z,radius,cluster\n".to_owned();
    for (lump, (x, z)) in [(0.0, 0.02), (0.004, 0.07), (0.05, 0.05)].into_iter().enumerate() {
        for k in 0..27 {
            let at = |n: usize| 0.01 * (n % 3) as f64;
            rows += &format!(
                "{},{},{},{},0.005,{}\n",
                27 * lump + k,
                x + at(k),
                at(k / 3),
                z + at(k / 9),
                lump + 1
            );
        }
    }
    let bond = "[[bond]]\nbetween = [\"sinter\", \"sinter\"]\ngap = 1e-6\nyoung = 2e7\npoisson = 0.25\ndamping = 0.2\n\
                tensile_strength = 5e4\nshear_strength = 5e4\n";
    let floor = "[[wall]]\nname = \"floor\"\nplane = \"0,0,-0.1,0.1,0,1\"\nmaterial = \"sinter\"\n";
    let grains = "[[particles]]\nsource = \"lumps.csv\"\nmaterial = \"sinter\"\n";
    // Pieces that the floor throws back get up to the plane at the end.
    let guards = "[guards]\nzones = false\n";
    let plant = format!("{}{guards}{grains}{bond}{floor}", SINTER.toml());
    plant_of(&plant, &[("lumps.csv", &rows)], &["--motion", motion])
}

fn bonds(folder: &Path, report: &str) -> Vec<u64> {
    let report: Value = serde_json::from_str(&fs::read_to_string(folder.join(report)).unwrap()).unwrap();
    report["bonds"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect()
}

#[test]
fn lumps_break_downstream_as_in_the_undivided_plant() {
    let folder = lumps("ballistic");
    let run = |arguments: &str| {
        let done = line(folder.path(), arguments);
        assert_eq!(done.code, 0, "{}", done.stderr);
    };
    run("dem-run plant.toml -q --report plant.json -o plant.mcap");
    let [all, broken] = bonds(folder.path(), "plant.json")[..] else { panic!("two numbers") };
    assert!(all == 162 && broken > 20 && broken < all, "{broken} of {all}");
    run("dem-run up.toml -q --report up.json -o up.mcap");
    assert_eq!(bonds(folder.path(), "up.json"), [all, 0]);
    for (replay, down) in [("", ""), ("--first-id 5000", ""), ("--turn-deg 180 --shift 0.2,0,0", "plane")] {
        run(&format!("stage-replay up.mcap --keep-times {replay} -q -o in.mcap"));
        // Turned about the vertical with everything: so is the floor.
        let text = fs::read_to_string(folder.path().join("down.toml")).unwrap();
        let text = if down.is_empty() {
            text
        } else {
            text.replace("0,0,-0.1,0.1,0,1", "0.2,0,-0.1,-0.1,0,1")
                .replace("plane = \"0,0,0,0,0,-1\"", "plane = \"0.2,0,0,0,0,-1\"")
        };
        write(folder.path(), "turned.toml", text);
        run("dem-run turned.toml in.mcap -q --report down.json -o down.mcap");
        let found = bonds(folder.path(), "down.json");
        assert_eq!(found[0], all, "{replay}");
        assert!(found[1].abs_diff(broken) <= broken / 20, "{} of {broken} with {replay}", found[1]);
    }
}

/// A lump is the same cluster downstream, also as a column of the frames there; in a second replay it is another one.
#[test]
fn lumps_keep_their_clusters() {
    let folder = lumps("ballistic");
    let path = folder.path();
    succeed(path, "dem-run", &["up.toml", "-q", "-o", "up.mcap"]);
    let replayed = |options: &[&str]| {
        succeed(path, "stage-replay", &[&["up.mcap", "-q", "-o", "in.mcap"], options].concat());
        passages(&path.join("in.mcap"))
    };
    let once = replayed(&[]);
    assert_eq!(once.len(), 81);
    assert!(once.iter().all(|row| row.cluster == row.particle.id / 27 + 1));
    succeed(path, "dem-run", &["down.toml", "in.mcap", "-q", "-o", "down.mcap"]);
    let frame = last_of(&path.join("down.mcap"), "/particles").expect("a frame");
    let column = |name: &str| frame.get(name).expect("a column").to_f64();
    let (ids, clusters) = (column("id"), column("cluster"));
    assert!(ids.len() > 60, "{} grains", ids.len());
    assert!(ids.iter().zip(&clusters).all(|(id, cluster)| (id / 27.0).floor() + 1.0 == *cluster));
    let twice = replayed(&["--repeat", "2", "--period", "2"]);
    let mut counts = std::collections::BTreeMap::new();
    twice.iter().for_each(|row| *counts.entry(row.cluster).or_insert(0) += 1);
    assert_eq!(
        counts.into_iter().collect::<Vec<_>>(),
        (1..=6).map(|cluster| (cluster, 27)).collect::<Vec<_>>()
    );
}

/// At once, and after a stop: the same bytes.
#[test]
fn pipes_and_stops_change_nothing() {
    let folder = lumps("ballistic");
    let done = line(
        folder.path(),
        "dem-run up.toml -q -o up.mcap && stage-replay up.mcap --keep-times -q -o in.mcap && dem-run down.toml in.mcap -q -o after.mcap \
         && dem-run up.toml -q | stage-replay --keep-times -q | dem-run down.toml - -q -o piped.mcap \
         && dem-run down.toml in.mcap -q --until 0.14 -o part.mcap && dem-run down.toml in.mcap -q --resume part.mcap -o resumed.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("after.mcap") == bytes("piped.mcap"));
    for topic in ["/particles", "/bonds"] {
        let last = |name: &str| last_of(&folder.path().join(name), topic);
        assert!(last("after.mcap").is_some() && last("after.mcap") == last("resumed.mcap"), "{topic}");
    }
}

/// A stage that knows of no bonds does not take them for loose grains.
#[test]
fn bonds_that_no_scene_asked_for_are_refused() {
    let folder = lumps("ballistic");
    succeed(folder.path(), "dem-run", &["up.toml", "--until", "0.15", "-q", "-o", "up.mcap"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "-q", "-o", "in.mcap"]);
    let text = fs::read_to_string(folder.path().join("down.toml")).unwrap();
    let (before, rest) = text.split_once("[[bond]]").expect("it is there");
    let after = rest.find("[[").map_or("", |at| &rest[at..]);
    write(folder.path(), "down.toml", format!("{before}{after}"));
    let done = tool(folder.path(), "dem-run", &["down.toml", "in.mcap", "-o", "x.mcap"]);
    let wanted = "brings bonds, and the scene has no [[bond]]";
    assert!(done.code == 1 && done.stderr.contains(wanted), "{}", done.stderr);
}
