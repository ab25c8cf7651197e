//! The tool from outside: what it writes, and what it says when it cannot.

use assert_cmd::Command;
use std::{collections::BTreeMap, fs, path::Path};
use stream::{
    Table, Values,
    mcap::{Provenance, Writer},
};

fn dem_view(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_dem-view")).current_dir(folder).args(args).assert()
}

fn spheres(z: f64, vz: f64) -> Table {
    let mut table = Table::default();
    for (name, value) in [("x", [0.0, 0.1]), ("y", [0.0, 0.1]), ("z", [z, z]), ("radius", [0.05, 0.04])] {
        table.push(name, Values::F64(value.to_vec())).expect("fits");
    }
    for (name, value) in [("vx", 0.0), ("vy", 0.0), ("vz", vz)] {
        table.push(name, Values::F64(vec![value, 2.0 * value])).expect("fits");
    }
    table.push("material", Values::U16(vec![0, 1])).expect("fits");
    table
}

/// A run of 5 frames, 0.1 s apart, with walls.
fn run() -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    let materials = BTreeMap::from([("1".to_owned(), "{\"name\":\"coke\"}".to_owned())]);
    writer.metadata("materials", materials).expect("written");
    writer.points("/walls", 0, "world", spheres(-1.0, 0.0)).expect("written");
    for k in 0..5u32 {
        let frame = spheres(-0.1 * f64::from(k), f64::from(k));
        writer.points("/particles", u64::from(k) * 100_000_000, "world", &frame).expect("written");
    }
    writer.finish().expect("finished")
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("run.mcap"), run()).expect("written");
    folder
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

#[test]
fn a_run_becomes_a_page_from_a_file_and_from_a_pipe() {
    let folder = folder();
    dem_view(folder.path(), &["run.mcap", "-o", "run.html", "--title", "T"]).success();
    let page = fs::read_to_string(folder.path().join("run.html")).expect("there");
    assert!(page.contains("\"coke\"") && page.contains("\"walls\"") && page.contains("<title>T</title>"));
    let piped =
        Command::new(env!("CARGO_BIN_EXE_dem-view")).args(["--title", "T"]).write_stdin(run()).assert();
    let piped = String::from_utf8_lossy(&piped.success().get_output().stdout).into_owned();
    // The page tells its size, in which the longer name counts.
    let sized = |page: &str| {
        let (before, after) = page.split_once("\"bytes\":").expect("its size");
        format!("{before}{}", after.trim_start_matches(|c: char| c.is_ascii_digit()))
    };
    assert_eq!(
        sized(&piped.replace("(stdin)", "(run.mcap)")),
        sized(&page),
        "{} and {}",
        piped.len(),
        page.len()
    );
}

#[test]
fn a_picture_is_of_the_time_asked_for() {
    let folder = folder();
    let picture = |args: &[&str], name: &str| {
        let all = [&["run.mcap", "-o", name, "--size", "320x200"], args].concat();
        let assert = dem_view(folder.path(), &all).success();
        (fs::read(folder.path().join(name)).expect("there"), said(&assert))
    };
    let (early, note) = picture(&["--time", "0.1"], "a.png");
    assert!(early.starts_with(b"\x89PNG") && note.contains("t = 0.100000 s"), "{note}");
    let (late, note) = picture(&["--camera", "-3,-1,0,0,0,0", "--colour", "vz", "--range", "-1,9"], "b.png");
    assert!(late != early && note.contains("t = 0.400000 s"), "{note}");
    assert_eq!(picture(&["--time", "0.1"], "c.png").0, early);
}

#[test]
fn a_cloud_and_a_run_are_shown_together() {
    let folder = folder();
    fs::write(folder.path().join("scan.xyz"), "0 0 0\n1 0 0\n0 1 0\n").expect("written");
    dem_view(folder.path(), &["run.mcap", "scan.xyz", "-o", "both.html"]).success();
    let page = fs::read_to_string(folder.path().join("both.html")).expect("there");
    assert!(page.contains("\"role\":\"cloud\"") && page.contains("\"role\":\"grains\""));
}

/// A run of 40 frames whose one wall of 2000 spheres turns; a floor and a mesh rest.
fn turning(frames: u32) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    let still = r#""velocity":[0,0,0],"turn":[0,0,0],"through":[0,0,0],"amplitude":[0,0,0],"frequency":0"#;
    let turns = still.replace("\"turn\":[0,0,0]", "\"turn\":[0,0,1]");
    let surfaces = format!(
        r#"[{{"name":"drum","motion":{{{turns}}},"shape":{{"spheres":2000}}}},
            {{"name":"ground","motion":{{{still}}},"shape":{{"plane":{{"point":[0,0,-2],"normal":[0,0,1]}}}}}},
            {{"name":"bin","motion":{{{still}}},"shape":{{"mesh":{{"vertices":[[0,0,0],[1,0,0],[0,1,0]],"faces":[[0,1,2]]}}}}}}]"#
    );
    for k in 0..frames {
        let (time, angle) = (u64::from(k) * 100_000_000, 0.1 * f64::from(k));
        let mut walls = Table::default();
        let column = |of: &dyn Fn(f64) -> f64| {
            Values::F64((0..2000).map(|i| of(f64::from(i) * 0.003 + angle)).collect())
        };
        for (name, values) in [("x", column(&f64::cos)), ("y", column(&f64::sin)), ("z", column(&|_| 0.0))] {
            walls.push(name, values).expect("fits");
        }
        walls.push("radius", Values::F64(vec![0.01; 2000])).expect("fits");
        walls.push("wall", Values::U16(vec![0; 2000])).expect("fits");
        writer.points("/walls", time, "world", &walls).expect("written");
        if k == 0 {
            writer.bytes("/surfaces", "json", time, surfaces.as_bytes()).expect("written");
        }
        writer.points("/particles", time, "world", spheres(0.0, 0.0)).expect("written");
    }
    writer.finish().expect("finished")
}

#[test]
fn walls_that_move_are_stored_once_with_their_motion() {
    let folder = folder();
    let page = |frames: u32| {
        fs::write(folder.path().join("drum.mcap"), turning(frames)).expect("written");
        dem_view(folder.path(), &["drum.mcap", "-o", "drum.html"]).success();
        fs::read_to_string(folder.path().join("drum.html")).expect("there")
    };
    let (short, long) = (page(2), page(40));
    assert!(long.len() < short.len() + 38 * 400, "{} {}", long.len(), short.len());
    for word in ["\"drum (drum.mcap)\"", "\"ground\"", "\"bin\"", "\"turn\":[0.0,0.0,1.0]"] {
        assert!(long.contains(word), "{word}");
    }
    let picture = |time: &str, name: &str| {
        dem_view(folder.path(), &["drum.mcap", "-o", name, "--size", "320x200", "--time", time]).success();
        fs::read(folder.path().join(name)).expect("there")
    };
    assert_ne!(picture("0", "a.png"), picture("3", "b.png"));
}

#[test]
fn surfaces_that_cannot_be_read_are_named() {
    let folder = folder();
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    writer.bytes("/surfaces", "json", 0, br#"[{"name":"bin","motion":{}}]"#).expect("written");
    fs::write(folder.path().join("bad.mcap"), writer.finish().expect("finished")).expect("written");
    let assert = dem_view(folder.path(), &["bad.mcap", "-o", "bad.html"]).code(1);
    assert!(said(&assert).contains("bin: motion"), "{}", said(&assert));
}

#[test]
fn what_it_cannot_write_is_refused_by_name() {
    let folder = folder();
    for name in ["run.jpeg", "run"] {
        let assert = dem_view(folder.path(), &["run.mcap", "-o", name]).code(2);
        assert!(said(&assert).contains(".gif, .mp4, .vtp or .pvd"), "{}", said(&assert));
    }
    let assert = dem_view(folder.path(), &["run.mcap", "--pick", "-o", "x.html"]).code(1);
    assert!(said(&assert).contains("--pick needs a cloud that cloud-crop can read"));
}

#[test]
fn bad_input_is_named_and_leaves_no_file() {
    let folder = folder();
    let whole = run();
    fs::write(folder.path().join("cut.mcap"), &whole[..whole.len() / 2]).expect("written");
    fs::write(folder.path().join("empty.ply"), "").expect("written");
    let cases: [(&[&str], i32, &str); 7] = [
        (&["cut.mcap"], 1, "truncated"),
        (&["empty.ply"], 1, "empty.ply"),
        (&["none.mcap"], 1, "none.mcap"),
        (&["run.mcap", "--colour", "warmth"], 1, "'warmth'"),
        (&["run.mcap", "--camera", "above"], 2, "iso"),
        (&["run.mcap", "--range", "2,1"], 2, "the lower first"),
        (&["run.mcap", "--max-mb", "0"], 2, "above 0"),
    ];
    for (args, code, word) in cases {
        for name in ["out.html", "out.png", "out.gif"] {
            let assert = dem_view(folder.path(), &[args, &["-o", name]].concat()).code(code);
            assert!(said(&assert).contains(word), "{args:?}: {}", said(&assert));
            assert!(!folder.path().join(name).exists(), "{args:?}");
        }
    }
}

/// A run of two grains with a bond that breaks, or without; with contacts, or without.
fn bonded(bonds: bool, contacts: bool) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    for k in 0..3u32 {
        let time = u64::from(k) * 100_000_000;
        let mut frame = spheres(0.0, f64::from(k));
        frame.push("id", Values::U32(vec![3, 4])).expect("fits");
        writer.points("/particles", time, "world", frame).expect("written");
        let one = |columns: &[(&str, f64)]| {
            let mut table = Table::default();
            for (name, value) in columns {
                table.push(name, Values::F64(vec![*value])).expect("fits");
            }
            table
        };
        let place = [("x", 0.05), ("y", 0.05), ("z", 0.0), ("id_i", 3.0), ("id_j", 4.0)];
        if bonds {
            let broken = [
                ("broken", f64::from(u8::from(k == 2))),
                ("broken_at", 0.15),
                ("tension", 1.0),
                ("shear", 0.0),
            ];
            writer.points("/bonds", time, "world", one(&[&place[..], &broken].concat())).expect("written");
        }
        if contacts {
            let force = [("fx", 1.0), ("fy", 0.0), ("fz", 2.0)];
            let normal = [("nx", 1.0), ("ny", 0.0), ("nz", 0.0), ("overlap", 0.0), ("kind", 0.0)];
            let all = one(&[&place[..], &force, &normal].concat());
            writer.points("/contacts", time, "world", all).expect("written");
        }
    }
    writer.finish().expect("finished")
}

#[test]
fn bonds_cracks_and_arrows_are_in_pages_pictures_and_films() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("b.mcap"), bonded(true, true)).expect("written");
    dem_view(folder.path(), &["b.mcap", "--bonds", "--vectors", "force", "-o", "b.html"]).success();
    let page = fs::read_to_string(folder.path().join("b.html")).expect("there");
    for part in ["\"role\":\"bonds\"", "\"role\":\"arrows\"", "\"word\":\"force\"", "\"name\":\"broken\""] {
        assert!(page.contains(part), "{part}");
    }
    let picture = |args: &[&str]| {
        let all = [&["b.mcap", "-o", "b.png", "--size", "320x200"], args].concat();
        dem_view(folder.path(), &all).success();
        fs::read(folder.path().join("b.png")).expect("there")
    };
    let [plain, whole, broken] = [&[][..], &["--bonds", "--time", "0"], &["--bonds"]].map(picture);
    assert!(plain != whole && whole != broken);
    assert!(picture(&["--colour", "broken"]) != picture(&["--colour", "broken", "--time", "0"]));
    assert!(picture(&["--vectors", "velocity"]) != plain && picture(&["--vectors", "force"]) != plain);
    assert!(picture(&["--colour", "size"]) != plain);
    dem_view(
        folder.path(),
        &["b.mcap", "--bonds", "--vectors", "velocity", "--size", "160x90", "-o", "b.gif"],
    )
    .success();
}

/// Force chains are in pictures, films and pages; their scale is that of `--range`.
#[test]
fn force_chains_are_in_pages_pictures_and_films() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("b.mcap"), bonded(false, true)).expect("written");
    let picture = |args: &[&str]| {
        let all = [&["b.mcap", "-o", "b.png", "--size", "320x200"], args].concat();
        dem_view(folder.path(), &all).success();
        fs::read(folder.path().join("b.png")).expect("there")
    };
    let [plain, chains, wide] =
        [&[][..], &["--force-chains"], &["--force-chains", "--range", "0,3"]].map(picture);
    assert!(plain != chains && chains != wide);
    assert!(picture(&["--force-chains", "--hide", "force-chains"]) != chains);
    let film = &["b.mcap", "--force-chains", "--size", "160x90", "-o", "b.gif"];
    dem_view(folder.path(), film).success();
    dem_view(folder.path(), &["b.mcap", "--force-chains", "--range", "0,3", "-o", "b.html"]).success();
    let page = fs::read_to_string(folder.path().join("b.html")).expect("there");
    for part in ["\"role\":\"force-chains\"", "\"name\":\"normal force\"", "\"shown\":[0.0,3.0]"] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn what_a_run_does_not_hold_cannot_be_drawn() {
    let folder = folder();
    fs::write(folder.path().join("b.mcap"), bonded(false, false)).expect("written");
    fs::write(folder.path().join("c.xyz"), "0 0 0\n1 0 0\n0 1 0\n").expect("written");
    for (args, parts) in [
        (&["b.mcap", "--bonds", "-o", "x.png"][..], &["--bonds: run holds no bonds", "[[bond]]"][..]),
        (&["b.mcap", "--colour", "broken", "-o", "x.html"], &["--colour broken: run holds no bonds"]),
        (
            &["b.mcap", "--vectors", "force", "-o", "x.png"],
            &["--vectors force: run holds no contacts", "[output] contacts"],
        ),
        (
            &["b.mcap", "--force-chains", "-o", "x.png"],
            &["--force-chains: run holds no contacts", "--set output.contacts=true"],
        ),
        (&["b.mcap", "--force-chains", "--bonds", "-o", "x.png"], &["--bonds: --force-chains draws"]),
        (&["b.mcap", "--force-chains", "--colour", "z", "-o", "x.png"], &["--colour: --force-chains draws"]),
        (&["c.xyz", "--force-chains", "-o", "x.png"], &["--force-chains: no input is a run"]),
        (&["b.mcap", "--vectors", "spin", "-o", "x.png"], &["give velocity or force"]),
        (&["b.mcap", "--bonds", "-o", "x.vtp"], &["--bonds changes nothing in .vtp", "leave it out"]),
        (&["b.mcap", "--colour", "size", "--range", "0,1", "-o", "x.png"], &["--range: size has classes"]),
        (&["b.mcap", "--dark", "-o", "x.vtp"], &["--dark changes nothing in .vtp"]),
        (&["c.xyz", "--vectors", "velocity", "-o", "x.png"], &["--vectors: no input is a run"]),
        (&["c.xyz", "--colour", "size", "-o", "x.png"], &["no field 'size'"]),
    ] {
        let said = said(&dem_view(folder.path(), args).failure());
        for part in parts {
            assert!(said.contains(part), "{args:?}: {part} in {said}");
        }
    }
}

/// The curves of what the run holds are in the page, with the values of the run.
#[test]
fn a_page_has_diagrams_of_what_the_run_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    let material = "{\"name\":\"coke\", \"density\": 1000}";
    let materials = [0, 1].map(|k| (k.to_string(), material.to_owned()));
    writer.metadata("materials", BTreeMap::from(materials)).expect("written");
    for k in 0..3u32 {
        let time = u64::from(k) * 100_000_000;
        let mut frame = spheres(0.0, f64::from(k));
        frame.push("id", Values::U32(vec![3, 4])).expect("fits");
        writer.points("/particles", time, "world", frame).expect("written");
        let force = format!(
            "{{\"time\": {}, \"walls\": [{{\"name\": \"lid\", \"force\": [0, 0, {k}], \"contacts\": 1}}]}}",
            0.1 * f64::from(k)
        );
        writer.bytes("/wall_forces", "json", time, force.as_bytes()).expect("written");
    }
    fs::write(folder.path().join("run.mcap"), writer.finish().expect("finished")).expect("written");
    dem_view(folder.path(), &["run.mcap", "-o", "run.html"]).success();
    let page = fs::read_to_string(folder.path().join("run.html")).expect("there");
    assert!(
        page.contains("\"label\":\"force on walls [N]\"") && page.contains("[[0.0,0.0],[0.1,1.0],[0.2,2.0]]")
    );
    assert!(page.contains("\"label\":\"kinetic energy [J]\"") && !page.contains("mass of the grains"));
}

/// A page is written all the same, and a warning says why a curve is missing.
#[test]
fn what_cannot_be_measured_for_a_diagram_is_reported() {
    let folder = folder();
    let said = said(&dem_view(folder.path(), &["run.mcap", "-o", "run.html"]).success());
    for part in ["5 messages of run.mcap are not in the diagrams", "the column 'id' is missing"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}
