//! Rigid clumps, and what contacts remember, from the cut to the stage downstream.

use super::passages;
use grainpipe_tests::recorded::tables;
use grainpipe_tests::scenes::{ABOVE, AT, SINTER, folder};
use grainpipe_tests::tools::{line, succeed, tool};
use record::topic::CROSSING_CONTACTS;
use stages::outlet::contact::{ContactRow, from_table};
use std::fs;
use std::path::Path;
use tempfile::{TempDir, tempdir};

/// Clumps and spheres fall through the plane z = 0 onto a floor.
const CLUMPS: &str = r#"[guards]
overlap = 1
zones = false
[[clump]]
name = "pair"
material = "sinter"
spheres = [[0, 0, 0, 0.005], [0.006, 0, 0, 0.004]]
[[fill]]
clump = "pair"
scale = [0.8, 1.2]
shape = "cylinder:0,0,0.13,0,0,0.2,0.04"
count = 20
velocity = [0, 0, -1]
[[body]]
clump = "pair"
position = [0, 0, 0.25]
velocity = [0, 0, -1.5]
spin = [40, 20, 10]
[[body]]
clump = "pair"
position = [0, 0, -0.05]
[[wall]]
plane = "0,0,-0.1,0,0,1"
material = "sinter"
"#;

/// Grains that rest on a plate pass the plane with it, between walls.
const PLATE: &str = r#"[guards]
overlap = 1
zones = false
[[fill]]
material = "sinter"
shape = "box:-0.028,-0.028,0.02,0.028,0.028,0.12"
diameter = [0.008, 0.012]
mass = 0.25
[[wall]]
plane = "0,0,0.015,0,0,1"
material = "sinter"
motion = { translate = [0, 0, -0.3] }
[[wall]]
box = [-0.03, -0.03, -1, 0.03, 0.03, 1]
faces = ["x-", "x+", "y-", "y+"]
material = "sinter"
"#;

pub fn clumped(options: &str) -> TempDir {
    let folder = folder(&[("plant.toml", SINTER.toml() + ABOVE + CLUMPS)]);
    let cut =
        |keep: &str| format!("stage-split plant.toml --at {AT} {options} --keep {keep}stream -o {keep}.toml");
    let done = line(folder.path(), &format!("{} && {}", cut("up"), cut("down")));
    assert_eq!(done.code, 0, "{}", done.stderr);
    folder
}

fn touches(path: &Path) -> Vec<ContactRow> {
    tables(path, CROSSING_CONTACTS).iter().flat_map(|table| from_table("test", table).unwrap()).collect()
}

/// Live and one after the other, the same bytes; all that comes is there, and is what fell.
#[test]
fn clumps_pass_the_cut_whole() {
    for motion in ["constant", "ballistic", "recorded"] {
        let folder = clumped(&format!("--motion {motion}"));
        let path = |name: &str| folder.path().join(name);
        let done = line(
            folder.path(),
            "dem-run up.toml -o up.mcap && stage-replay up.mcap --keep-times -o in.mcap && dem-run down.toml in.mcap -o after.mcap \
             && dem-run up.toml | stage-replay --keep-times | dem-run down.toml - -o piped.mcap",
        );
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert!(
            fs::read(path("after.mcap")).unwrap() == fs::read(path("piped.mcap")).unwrap(),
            "live: the same bytes"
        );
        let (recorded, replayed) = (passages(&path("up.mcap")), passages(&path("in.mcap")));
        let clumps: Vec<_> = recorded.iter().filter(|p| p.clump.is_some()).collect();
        assert_eq!((clumps.len(), replayed.len()), (21, recorded.len()));
        for (a, b) in recorded.iter().zip(&replayed).filter(|(a, _)| a.clump.is_some()) {
            let ((was, mass), (now, same)) = (a.clump.unwrap(), b.clump.unwrap());
            assert_eq!((a.particle.id, mass, was.scale), (b.particle.id, same, now.scale));
            // It is turned back by what it turns on its way to the calculation plane.
            let (p, q) = (&a.particle, &b.particle);
            let ahead = match motion {
                "constant" => (p.position.z - q.position.z) / p.velocity.z,
                // The state in which it becomes free.
                "recorded" => 0.0,
                _ => (q.velocity.z - p.velocity.z) / 9.81,
            };
            let there = nalgebra::UnitQuaternion::from_scaled_axis(p.spin * ahead) * now.orientation;
            assert!(
                (ahead > 0.0 || motion == "recorded") && there.angle_to(&was.orientation) < 1e-6,
                "{ahead} s, {}",
                p.spin
            );
        }
        let flow =
            succeed(folder.path(), "dem-measure", &["up.mcap", &format!("--flow={AT}"), "--json", "-q"]);
        let flow: serde_json::Value = serde_json::from_slice(&flow.stdout).unwrap();
        let passed = flow["summary"]["mass"]["value"].as_f64().unwrap();
        let of_clumps: f64 = clumps.iter().map(|p| p.clump.unwrap().1).sum();
        let of_spheres: f64 =
            recorded.iter().filter(|p| p.clump.is_none()).map(|p| dem::mass(p.particle.radius, 3300.0)).sum();
        assert!(
            (passed - of_clumps - of_spheres).abs() < 1e-9 * passed,
            "{passed} kg of {} kg",
            of_clumps + of_spheres
        );
    }
}

/// Records turn, repeat and get new ids with all members of their clumps.
#[test]
fn replays_of_clumps_keep_them_whole() {
    let folder = clumped("--motion constant");
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap --repeat 2 --period 0.3 -o twice.mcap \
         && stage-replay up.mcap --turn-deg 90 -o turned.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let twice = passages(&folder.path().join("twice.mcap"));
    let mut next = 0;
    for p in &twice {
        assert_eq!(p.particle.id, next);
        next += if p.clump.is_some() { 2 } else { 1 };
    }
    let once = passages(&folder.path().join("up.mcap"));
    assert_eq!(twice.len(), 2 * once.len());
    let turned = passages(&folder.path().join("turned.mcap"));
    let plain = passages(&folder.path().join("twice.mcap"));
    let quarter = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    for (a, b) in plain.iter().zip(&turned).filter_map(|(a, b)| Some((a.clump?.0, b.clump?.0))) {
        assert!((quarter * a.orientation).angle_to(&b.orientation) < 1e-7);
    }
}

#[test]
fn what_planes_cannot_do_with_clumps_is_refused() {
    let folder = clumped("");
    let lowest = ["plant.toml", "--at", AT, "--keep", "upstream", "--test", "lowest", "-o", "x.toml"];
    let done = tool(folder.path(), "stage-split", &lowest);
    assert!(done.code == 1 && done.stderr.contains("has clumps ('pair')"), "{}", done.stderr);
    let short = ["plant.toml", "--at", AT, "--keep", "upstream", "--length", "0.014", "-o", "x.toml"];
    let done = tool(folder.path(), "stage-split", &short);
    assert!(done.code == 1 && done.stderr.contains("is not above the largest diameter"), "{}", done.stderr);
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && sed 's/0.006, 0, 0/0.005, 0, 0/' down.toml > other.toml \
         && dem-run other.toml in.mcap -o x.mcap",
    );
    assert!(
        done.code == 1 && done.stderr.contains("its clump 'pair' has other spheres than the scene's"),
        "{}",
        done.stderr
    );
}

/// Contacts at a cut whose stages have run.
struct CutContacts {
    recorded: Vec<ContactRow>,
    replayed: Vec<ContactRow>,
    /// Replayed with a quarter turn.
    turned: Vec<ContactRow>,
}

/// Runs both stages of a plant, one after the other and live.
fn run_stages(folder: &Path, plant: &str, motion: &str) -> CutContacts {
    fs::write(folder.join("plant.toml"), plant).unwrap();
    let cut = |keep: &str| {
        format!("stage-split plant.toml --at {AT} --motion {motion} --keep {keep}stream -o {keep}.toml")
    };
    let done = line(
        folder,
        &format!(
            "{} && {} && dem-run up.toml -o up.mcap && stage-replay up.mcap --keep-times -o in.mcap \
             && stage-replay up.mcap --keep-times --turn-deg 90 -o turned.mcap \
             && dem-run down.toml in.mcap -o after.mcap \
             && dem-run up.toml | stage-replay --keep-times | dem-run down.toml - -o piped.mcap",
            cut("up"),
            cut("down")
        ),
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(bytes("after.mcap") == bytes("piped.mcap"), "live: the same bytes");
    let [recorded, replayed, turned] =
        ["up.mcap", "in.mcap", "turned.mcap"].map(|name| touches(&folder.join(name)));
    CutContacts { recorded, replayed, turned }
}

fn assert_history_is_kept(CutContacts { recorded, replayed, turned }: &CutContacts, motion: &str) {
    let (count, of) = (replayed.len(), recorded.len());
    assert!(count > 1 && count <= of, "{motion}: {count} of {of}");
    let is_recorded = |row: &ContactRow| recorded.iter().any(|r| r.pair == row.pair);
    assert!(replayed.iter().all(is_recorded), "{motion}: in full precision");
    assert_eq!(count, turned.len());
    for (a, b) in replayed.iter().zip(turned) {
        let [a, b] = [a, b].map(|row| geom::Vec3::from_column_slice(row.pair.history.get("sliding")));
        assert!((b.x + a.y).abs() + (b.y - a.x).abs() + (b.z - a.z).abs() < 1e-15, "{a} {b}");
    }
}

/// Of the record `up.mcap`: its contacts come twice, between particles that come too.
fn assert_repeats_have_their_contacts(folder: &Path) {
    let repeat = ["up.mcap", "--repeat", "2", "--move", "constant", "-o", "twice.mcap"];
    succeed(folder, "stage-replay", &repeat);
    let path = folder.join("twice.mcap");
    let twice = touches(&path);
    let ids: Vec<u32> = passages(&path).iter().map(|p| p.particle.id).collect();
    assert!(twice.len() > 3 && twice.len().is_multiple_of(2));
    assert!(twice.iter().all(|t| ids.contains(&t.pair.id) && ids.contains(&t.pair.partner)));
}

/// Contacts of the record keep their history, and those of two incoming grains get it, rotated as the record is.
#[test]
fn what_contacts_remember_is_recorded_and_replayed() {
    let folder = tempdir().unwrap();
    // Grains pile up at the plane here, and overlap by nearly all that the guard bears.
    let lowered = (SINTER.toml() + PLATE).replace("[time]\n", "[time]\ncontacts = \"sampled\"\n");
    // Grains that fall behind the plane leave the plate that they rest on: these are pushed.
    let pushed = lowered.replace("gravity = [0, 0, -9.81]", "gravity = [0, -9.81, 0]");
    let pushed = pushed.replace("plane = \"0,0,0.015,0,0,1\"", "plane = \"0,0,0.125,0,0,-1\"");
    for (motion, plant) in [("constant", lowered), ("recorded", pushed)] {
        assert_history_is_kept(&run_stages(folder.path(), &plant, motion), motion);
    }
    assert_repeats_have_their_contacts(folder.path());
}
