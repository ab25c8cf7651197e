//! A run is exact, resumes bit for bit, and what stops it leaves a file that can be read.

mod at_rest;
mod combined;
mod continued;
mod device;
mod fallen;
mod foretold;
mod new;
mod settled;
mod stopped;
mod together;
mod whole;

use grainpipe_tests::recorded::{events, json};
use grainpipe_tests::scenes::{Head, RUBS, folder};
use grainpipe_tests::tools::{line, program, succeed, tool};
use std::fs;
use std::path::Path;
use stream::Table;
use stream::mcap::Event;
use tempfile::TempDir;

const HEAD: Head = Head {
    time: "until = 0.12",
    output: "every = 0.01\ncheckpoint = 0.04",
    material: "sinter",
    density: 3300.0,
    young: 2e7,
    contact: RUBS,
};

fn poured() -> String {
    HEAD.poured(0.2)
}

fn with(scene: &str) -> TempDir {
    folder(&[("s.toml", scene)])
}

/// The tables of a topic, with their times.
fn tables(path: &Path, of: &str) -> Vec<(u64, Table)> {
    let pick = |event| match event {
        Event::Points { topic, time_ns, table } if topic == of => Some((time_ns, table)),
        _ => None,
    };
    events(path).0.into_iter().filter_map(pick).collect()
}

fn frames(path: &Path) -> Vec<(u64, Table)> {
    tables(path, "/particles")
}

fn checkpoints(path: &Path) -> Vec<Vec<u8>> {
    let pick = |event| match event {
        Event::Bytes { topic, data, .. } if topic == "/checkpoint" => Some(data),
        _ => None,
    };
    events(path).0.into_iter().filter_map(pick).collect()
}

#[test]
fn a_run_has_its_frames_scene_and_end() {
    let folder = with(&poured());
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    let (events, whole) = events(&folder.path().join("run.mcap"));
    assert!(whole);
    let frames = frames(&folder.path().join("run.mcap"));
    assert_eq!(frames.len(), 13);
    assert!(frames.iter().enumerate().all(|(k, f)| f.0.abs_diff(k as u64 * 10_000_000) < 100_000));
    let names: Vec<&str> = frames[0].1.columns().iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names.join(" "), "x y z radius vx vy vz wx wy wz id material");
    let scene = events.iter().find_map(|e| match e {
        Event::Metadata { name, map } if name == "scene" => map.get("toml"),
        _ => None,
    });
    assert_eq!(scene.map(String::as_str), Some(&*poured()));
}

#[test]
fn threads_change_no_byte() {
    let folder = with(&poured());
    for threads in ["1", "2", "3"] {
        succeed(folder.path(), "dem-run", &["s.toml", "-o", threads, "--threads", threads]);
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("1") == bytes("2") && bytes("1") == bytes("3"));
}

#[test]
fn a_resumed_run_goes_on_as_if_it_had_never_stopped() {
    let folder = with(&poured());
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "whole.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "--until", "0.055", "-o", "part.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "part.mcap", "-o", "rest.mcap"]);
    let (whole, rest) = (frames(&path("whole.mcap")), frames(&path("rest.mcap")));
    assert_eq!(rest.len(), 7, "0.06 to 0.12 s");
    assert!(whole[6..] == rest[..], "frames after the checkpoint differ");
    assert!(checkpoints(&path("whole.mcap")).last() == checkpoints(&path("rest.mcap")).last());
}

#[test]
fn walls_that_move_are_written_with_every_frame() {
    let scene = poured().replace("plane = \"0,0,0,0,0,1\"\nmaterial = \"sinter\"", "");
    let scene =
        format!("{scene}motion = {{ rotate = {{ about = [0,0,1], through = [0,0,0], rpm = 60 }} }}\n");
    let folder = with(&scene.replace("until = 0.12", "until = 0.05"));
    write_walls(&folder.path().join("walls.mcap"));
    succeed(folder.path(), "dem-run", &["s.toml", "walls.mcap", "-o", "run.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "walls.mcap", "-o", "again.mcap"]);
    let piped = line(folder.path(), "cat walls.mcap | dem-run s.toml - -o piped.mcap");
    assert_eq!(piped.code, 0, "{}", piped.stderr);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("run.mcap") == bytes("again.mcap") && bytes("run.mcap") == bytes("piped.mcap"));
    let walls = tables(&folder.path().join("run.mcap"), "/walls");
    assert_eq!(walls.len(), 6);
    let place = |t: &Table| (t.get("x").unwrap().get(0), t.get("y").unwrap().get(0));
    let (before, after) = (place(&walls[0].1), place(&walls[5].1));
    let turned = after.1.atan2(after.0) - before.1.atan2(before.0);
    assert!((turned - 0.05 * 60.0 / 60.0 * std::f64::consts::TAU).abs() < 1e-3, "{turned} rad in 0.05 s");
    let cut = &fs::read(folder.path().join("walls.mcap")).unwrap()[..2000];
    fs::write(folder.path().join("cut.mcap"), cut).unwrap();
    let done = tool(folder.path(), "dem-run", &["s.toml", "cut.mcap", "-o", "x.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("cut.mcap"), "{}", done.stderr);
}

/// A floor of wall spheres, of a material that the scene does not know.
fn write_walls(path: &Path) {
    let places: Vec<(f64, f64)> =
        (0..400).map(|i| (f64::from(i % 20) * 0.006 - 0.057, f64::from(i / 20) * 0.006 - 0.057)).collect();
    let mut table = Table::default();
    let column = |f: &dyn Fn(&(f64, f64)) -> f64| stream::Values::F64(places.iter().map(f).collect());
    table.push("x", column(&|p| p.0)).unwrap();
    table.push("y", column(&|p| p.1)).unwrap();
    table.push("z", column(&|_| -0.005)).unwrap();
    table.push("radius", column(&|_| 0.005)).unwrap();
    table.push("material", stream::Values::U16(vec![0; 400])).unwrap();
    let mut writer = stream::mcap::Writer::new(fs::File::create(path).unwrap(), &Default::default()).unwrap();
    let steel = r#"{"name":"steel","young":2e7,"poisson":0.3,"friction":0.4}"#;
    writer.metadata("materials", [("0".to_owned(), steel.to_owned())].into()).unwrap();
    writer.points("/walls", 0, "world", &table).unwrap();
    writer.finish().unwrap();
}

/// A faucet gives its rate into a box, and a run resumed in the middle of it gives the same.
#[test]
fn a_faucet_pours_at_its_rate_and_resumes() {
    let scene = poured()
        .replace("[[fill]]", "[[insert]]")
        .replace("mass = 0.2", "rate = 2\nvelocity = [0, 0, -1]\nuntil = 0.1");
    let scene = scene.replace("cylinder:0,0,0,0,0,0.1,0.04", "cylinder:0,0,0.1,0,0,0.12,0.04");
    let scene = scene.replace("plane = \"0,0,0,0,0,1\"", "box = [-0.06, -0.06, 0, 0.06, 0.06, 1]");
    let folder = with(&scene.replace("every = 0.01", "every = 0.02"));
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "whole.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "part.mcap", "--until", "0.05"]);
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "part.mcap", "-o", "rest.mcap"]);
    let (whole, rest) = (frames(&folder.path().join("whole.mcap")), frames(&folder.path().join("rest.mcap")));
    assert!(whole[3..] == rest[..] && rest.len() == 4, "{} frames", rest.len());
    let last = &whole.last().unwrap().1;
    let radius = last.get("radius").unwrap().to_f64();
    let mass: f64 = radius.iter().map(|r| 3300.0 * 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum();
    assert!((mass - 0.2).abs() < 0.01, "{mass} kg in 0.1 s at 2 kg/s");
}

/// Energy is written when it is asked for, and nothing of the motion changes by asking.
#[test]
fn the_ledger_is_written_and_changes_nothing() {
    let folder = with(&poured());
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "without.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "with.mcap", "--set", "output.energy=true"]);
    let path = |name: &str| folder.path().join(name);
    assert!(frames(&path("with.mcap")) == frames(&path("without.mcap")));
    let energies = json(&path("with.mcap"), "/energy");
    let balances: Vec<f64> = energies.iter().map(|energy| energy["balance"].as_f64().unwrap()).collect();
    assert_eq!(balances.len(), 13);
    let first = balances[0];
    assert!(balances.iter().all(|b| (b - first).abs() < 0.02 * first.abs()), "{balances:?}");
}

/// Exit code and words of a line that must be refused, and that it leaves no `x.mcap`.
fn refused(folder: &Path, words: &str, code: i32, parts: &[&str]) {
    let done = line(folder, words);
    let said = parts.iter().all(|part| done.stderr.contains(part));
    assert!(done.code == code && said, "{words}: {}: {}", done.code, done.stderr);
    assert!(!folder.join("x.mcap").exists(), "{words}");
}

#[test]
fn an_output_that_is_also_an_input_is_refused() {
    let folder = with(&poured());
    let also = ["-o s.toml is also an input: choose another name"];
    refused(folder.path(), "dem-run s.toml -o s.toml", 2, &also);
    refused(folder.path(), "dem-run ./s.toml --check -o s.toml", 2, &also);
    fs::write(folder.path().join("a.xyz"), "0 0 0\n1 0 0\n0 1 0\n").unwrap();
    std::os::unix::fs::symlink("a.xyz", folder.path().join("b.xyz")).unwrap();
    refused(folder.path(), "cloud-crop a.xyz -o b.xyz", 2, &["-o b.xyz is also an input"]);
    assert_eq!(fs::read_to_string(folder.path().join("s.toml")).unwrap(), poured());
}

#[test]
fn an_input_that_is_given_twice_or_that_nothing_waits_for_is_refused() {
    let scene = poured().replace("plane = \"0,0,0,0,0,1\"\nmaterial = \"sinter\"", "");
    let folder = with(&scene);
    write_walls(&folder.path().join("fl.mcap"));
    refused(folder.path(), "dem-run s.toml fl.mcap fl.mcap -o x.mcap", 1, &["fl.mcap: is given twice"]);
    refused(
        folder.path(),
        "cat fl.mcap | dem-run s.toml fl.mcap - -o x.mcap",
        1,
        &["stdin: holds the same spheres as fl.mcap"],
    );
    fs::copy(folder.path().join("fl.mcap"), folder.path().join("copy.mcap")).unwrap();
    refused(folder.path(), "dem-run s.toml fl.mcap copy.mcap -o x.mcap", 1, &["copy.mcap: is given twice"]);
    let outlet = "[[outlet]]\nplane = \"0,0,-0.05,0,0,-1\"\nlength = 0.03\n";
    let up = poured().replace("plane = \"0,0,0,0,0,1\"", "plane = \"0,0,-9,0,0,1\"") + outlet;
    let up = up.replace("until = 0.12", "until = 0.2");
    fs::write(folder.path().join("up.toml"), up).unwrap();
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "--until", "0.15", "-o", "in2.mcap"]);
    refused(folder.path(), "dem-run up.toml in.mcap -o x.mcap", 1, &["in.mcap: the scene has no [[inlet]]"]);
    let whole = poured();
    let down = &whole[..whole.find("[[fill]]").unwrap()];
    let down = format!("{down}[[inlet]]\nplane = \"0,0,-0.05,0,0,-1\"\n");
    fs::write(folder.path().join("down.toml"), down).unwrap();
    let both = ["in2.mcap: 2 inlets are given, and 1 [[inlet]]"];
    refused(folder.path(), "dem-run down.toml in.mcap in2.mcap -o x.mcap", 1, &both);
}

#[test]
fn a_grain_that_starts_in_a_wall_is_refused_before_the_run() {
    let folder = with(&(poured() + "[[particles]]\nsource = \"low.csv\"\nmaterial = \"sinter\"\n"));
    fs::write(folder.path().join("low.csv"), "x,y,z,radius\n0.3,0,0.003,0.005\n").unwrap();
    let inside = ["s.toml: particle ", " starts inside wall '", "(overlap ", "m): move it"];
    refused(folder.path(), "dem-run s.toml -o x.mcap", 1, &inside);
    refused(folder.path(), "dem-run s.toml --check", 1, &inside);
    refused(folder.path(), "dem-run s.toml --explain", 1, &inside);
}

#[test]
fn progress_is_one_json_line_with_each_frame() {
    let folder = with(&poured());
    let done = tool(folder.path(), "dem-run", &["s.toml", "--progress", "-q", "-o", "run.mcap"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let lines: Vec<serde_json::Value> =
        done.stderr.lines().map(|l| serde_json::from_str(l).unwrap_or_else(|e| panic!("{e}: {l}"))).collect();
    assert_eq!(lines.len(), 13, "one for each frame");
    for (k, line) in lines.iter().enumerate() {
        let number = |key: &str| line[key].as_f64().unwrap_or_else(|| panic!("{key} is missing in {line}"));
        assert!((number("time") - 0.01 * k as f64).abs() < 1e-4 && (number("until") - 0.12).abs() < 1e-4);
        assert!(number("kinetic") >= 0.0 && number("left") >= 0.0 && number("elapsed") >= 0.0);
        assert!(number("particles") > 50.0 && (number("share") - k as f64 / 12.0).abs() < 1e-2);
        assert!(k == 0 || number("particle_steps_per_second") > 1e3);
    }
    assert!(lines[12]["left"] == 0.0);
}

/// What contacts press on the floor is the weight of what lies on it, as dem-measure reads it from the run.
#[test]
fn recorded_contacts_carry_the_weight_of_the_bed() {
    let folder = with(&poured());
    let more = ["--set", "output.contacts=true", "--until", "1.2", "--set", "output.every=0.4"];
    succeed(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], &more[..]].concat());
    let out = succeed(folder.path(), "dem-measure", &["run.mcap", "--wall-force", "all", "-q"]);
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    let (head, last) = (text.lines().next().unwrap_or(""), text.lines().last().unwrap_or(""));
    let at =
        head.split(',').position(|c| c.starts_with("fz")).unwrap_or_else(|| panic!("no force in {head}"));
    let force: f64 = last.split(',').nth(at).and_then(|n| n.parse().ok()).unwrap_or_else(|| panic!("{text}"));
    let frame = frames(&folder.path().join("run.mcap")).pop().unwrap().1;
    let radii = frame.get("radius").unwrap().to_f64();
    let volume = radii.iter().map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum::<f64>();
    let weight = volume * 3300.0 * 9.81;
    assert!((force / weight + 1.0).abs() < 0.01, "{force} N on the floor, the bed weighs {weight} N");
}

/// A row of bonded grains over a floor, and what a scene says of its bonds.
fn bonded(bond: &str) -> TempDir {
    let head = HEAD.toml();
    let rows: String = (0..6).map(|k| format!("{k},{},0,0.05,0.01\n", 0.02 * f64::from(k))).collect();
    let scene = format!(
        "{head}{}[[particles]]\nsource = \"row.csv\"\nmaterial = \"sinter\"\n[[bond]]\nbetween = [\"sinter\", \"sinter\"]\n{bond}\n",
        HEAD.floor()
    );
    folder(&[("s.toml", &scene), ("row.csv", &format!("id,x,y,z,radius\n{rows}"))])
}

const BOND: &str = "gap = 1e-6\nyoung = 1e7\npoisson = 0.25";

#[test]
fn bonds_are_written_with_each_frame_broken_ones_as_well() {
    for (strength, breaks) in [("", false), ("\ntensile_strength = 2e3\nshear_strength = 2e3", true)] {
        let folder = bonded(&format!("{BOND}{strength}"));
        let more = ["--set", "output.energy=true", "--set", "gravity=[3, 0, -9.81]"];
        succeed(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], &more[..]].concat());
        let tables = tables(&folder.path().join("run.mcap"), "/bonds");
        assert_eq!(tables.len(), 13, "one for each frame");
        let (first, last) = (&tables[0].1, &tables[12].1);
        let column = |t: &Table, name: &str| t.get(name).unwrap_or_else(|| panic!("no {name}")).to_f64();
        assert_eq!(column(first, "id_i"), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(column(first, "id_j"), [1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!(column(first, "broken").iter().all(|&b| b == 0.0));
        let broken = column(last, "broken");
        assert_eq!(broken.contains(&1.0), breaks, "{broken:?}");
        for (k, at) in column(last, "broken_at").into_iter().enumerate() {
            assert_eq!(at > 0.0, broken[k] == 1.0);
            let force = column(last, "fx")[k].hypot(column(last, "fz")[k]);
            assert_eq!(force == 0.0, broken[k] == 1.0, "a broken bond bears nothing");
        }
    }
}

#[test]
fn bonds_that_no_grain_has_or_that_are_not_followed_are_refused() {
    let says = |bond: &str, more: &str, parts: &[&str]| {
        let folder = bonded(bond);
        let scene = fs::read_to_string(folder.path().join("s.toml")).unwrap() + more;
        fs::write(folder.path().join("s.toml"), scene).unwrap();
        let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
        let text = done.stderr;
        assert_eq!(done.code, 1, "{text}");
        parts.iter().for_each(|part| assert!(text.contains(part), "'{part}' is not in {text}"));
        assert!(!folder.path().join("run.mcap").exists());
    };
    let with = |from: &str, to: &str| BOND.replace(from, to);
    says(&with("1e-6", "-1"), "", &["bond.0.gap", "-1 m", "0 to 100 m"]);
    says(&with("young = 1e7", "young = 0"), "", &["bond.0.young", "0 Pa", "above 0"]);
    says(&with("0.25", "0.7"), "", &["bond.0.poisson", "0.7"]);
    says(&format!("{BOND}\ntensile_strength = -3"), "", &["bond.0.tensile_strength", "-3 Pa"]);
    says(&format!("{BOND}\nradius = 2"), "", &["unknown key 'radius'", "radius_ratio"]);
    let sleep = "[sleep]\nspeed = 0.01\n";
    says(BOND, sleep, &["bond: not available yet with [sleep]", "leave out one of them"]);
    let narrow = "[domain]\nperiodic = [\"y\"]\nlow = [0, -0.04, 0]\nhigh = [0, 0.04, 0]\n";
    says(
        &with("1e-6", "0.02"),
        narrow,
        &["period of 8.0000e-2 m along y is too small", "at least 9.0000e-2 m"],
    );
    let again = format!("[[bond]]\nbetween = [\"sinter\", \"sinter\"]\n{BOND}\n");
    says(BOND, &again, &["bond.1.between", "bond.0 is between these two materials already"]);
    let stone = "[[material]]\nname = \"stone\"\nyoung = 1e7\npoisson = 0.25\ndensity = 2000\n";
    let far = format!("{stone}[[bond]]\nbetween = [\"stone\", \"sinter\"]\n{BOND}\n");
    says(BOND, &far, &["bond sinter–stone", "no two particles", "gap of 1.0000e-6 m", "larger gap"]);
    let any = format!("[[bond]]\nbetween = [\"*\", \"sinter\"]\n{BOND}\n");
    says(BOND, &any, &["bond.1.between.0", "named materials"]);
    let folder = bonded(BOND);
    let done = succeed(folder.path(), "dem-run", &["s.toml", "--explain"]);
    let text = String::from_utf8_lossy(&done.stdout) + &*done.stderr;
    assert!(text.contains("bond.0 (sinter–sinter)") && text.contains("B per bond, 5 bonds"), "{text}");
    assert!(text.contains("the bonds of particle"), "{text}");
}
