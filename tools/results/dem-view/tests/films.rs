//! Films and series of files from outside: how many pictures, of which times, and the same bytes every time.

use assert_cmd::Command;
use std::{fs, os::unix::process::ExitStatusExt, path::Path, process::Stdio, time::Duration};
use stream::{
    Table, Values,
    mcap::{Provenance, Writer},
};

fn dem_view(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_dem-view")).current_dir(folder).args(args).assert()
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

/// 11 frames, 0.1 s apart, of two grains that fall; the first is empty. A wall of spheres turns, a plane rests.
fn folder() -> tempfile::TempDir {
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    let still = r#""velocity":[0,0,0],"turn":[0,0,0],"through":[0,0,0],"amplitude":[0,0,0],"frequency":0"#;
    let turns = still.replace("\"turn\":[0,0,0]", "\"turn\":[0,0,1]");
    let surfaces = format!(
        r#"[{{"name":"drum","motion":{{{turns}}},"shape":{{"spheres":1}}}},
            {{"name":"floor","motion":{{{still}}},"shape":{{"plane":{{"point":[0,0,-1],"normal":[0,0,1]}}}}}}]"#
    );
    let table = |count: usize, z: f64, wall: bool| {
        let mut table = Table::default();
        for (name, value) in
            [("x", 0.5), ("y", 0.0), ("z", z), ("radius", 0.1), ("vz", -z), ("vx", 0.0), ("vy", 0.0)]
        {
            let column = (0..count).map(|i| value + if name == "x" { i as f64 } else { 0.0 });
            table.push(name, Values::F64(column.collect())).expect("fits");
        }
        if wall {
            table.push("wall", Values::U16(vec![0; count])).expect("fits");
        }
        table
    };
    writer.points("/walls", 0, "world", table(1, -0.8, true)).expect("written");
    writer.bytes("/surfaces", "json", 0, surfaces.as_bytes()).expect("written");
    for k in 0..=10u32 {
        let frame = table(if k == 0 { 0 } else { 2 }, -0.05 * f64::from(k), false);
        writer.points("/particles", u64::from(k) * 100_000_000, "world", &frame).expect("written");
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("run.mcap"), writer.finish().expect("finished")).expect("written");
    folder
}

/// Pictures in a GIF: each has a block that says how long it is shown.
fn pictures(gif: &[u8]) -> usize {
    gif.windows(4).filter(|w| w == b"\x21\xf9\x04\x05" || *w == b"\x21\xf9\x04\x04").count()
}

const SMALL: [&str; 4] = ["--size", "160x120", "--fps", "10"];

#[test]
fn a_gif_shows_every_frame_for_ever_and_is_the_same_for_any_number_of_threads() {
    let folder = folder();
    let film = |threads: &str, name: &str| {
        let args = [&["run.mcap", "-o", name, "--threads", threads], &SMALL[..]].concat();
        let assert = dem_view(folder.path(), &args).success();
        assert!(
            said(&assert).contains("11 pictures, t = 0.000 to 1.000 s, shown in 1.10 s"),
            "{}",
            said(&assert)
        );
        fs::read(folder.path().join(name)).expect("there")
    };
    let one = film("1", "a.gif");
    assert!(one.starts_with(b"GIF89a") && one.windows(11).any(|w| w == b"NETSCAPE2.0"), "it loops");
    assert_eq!(pictures(&one), 11);
    assert!(one == film("3", "b.gif"), "other bytes with three threads");
}

#[test]
fn a_part_of_a_run_with_fewer_pictures() {
    let folder = folder();
    let part = ["run.mcap", "-o", "a.gif", "--from", "0.2", "--to", "0.8", "--every", "0.2"];
    let assert = dem_view(folder.path(), &[&part, &SMALL[..]].concat()).success();
    assert!(said(&assert).contains("4 pictures, t = 0.200 to 0.800 s"), "{}", said(&assert));
    let none = ["run.mcap", "-o", "b.gif", "--from", "7"];
    let assert = dem_view(folder.path(), &[&none, &SMALL[..]].concat()).code(1);
    assert!(said(&assert).contains("nothing to show"), "{}", said(&assert));
}

#[test]
fn a_series_for_paraview_lists_files_that_are_there() {
    let folder = folder();
    for _ in 0..2 {
        // The second time, the first series is replaced.
        dem_view(folder.path(), &["run.mcap", "-o", "run.pvd"]).success();
    }
    let list = fs::read_to_string(folder.path().join("run.pvd")).expect("there");
    let of =
        |line: &str, name: &str| line.split(name).nth(1).and_then(|r| r.split('"').next()).map(str::to_owned);
    let sets: Vec<_> = list.lines().filter(|l| l.starts_with("<DataSet")).collect();
    assert_eq!(sets.len(), 3 * 11, "grains, drum and floor at 11 times");
    for set in &sets {
        let file = of(set, "file=\"").expect("named");
        let head = fs::read(folder.path().join(&file)).expect(&file);
        assert!(head.starts_with(b"<?xml"), "{file}");
    }
    let files = fs::read_dir(folder.path().join("run")).expect("a folder").count();
    assert_eq!(files, 11 + 11 + 1, "the floor rests");
    let left: Vec<_> =
        fs::read_dir(folder.path()).expect("a folder").flatten().map(|e| e.file_name()).collect();
    assert_eq!(left.len(), 3, "nothing else is left: {left:?}");
}

#[test]
fn a_folder_with_other_things_in_it_is_not_replaced() {
    let folder = folder();
    fs::create_dir(folder.path().join("run")).expect("made");
    fs::write(folder.path().join("run/thesis.tex"), "years of work").expect("written");
    let assert = dem_view(folder.path(), &["run.mcap", "-o", "run.pvd"]).code(1);
    assert!(said(&assert).contains("holds 'thesis.tex', which run.pvd does not list"), "{}", said(&assert));
    assert!(folder.path().join("run/thesis.tex").exists() && !folder.path().join("run.pvd").exists());
}

#[test]
fn one_moment_for_paraview_is_that_asked_for() {
    let folder = folder();
    let assert = dem_view(folder.path(), &["run.mcap", "-o", "a.vtp", "--time", "0.5"]).success();
    assert!(said(&assert).contains("7 points, 2 triangles"), "{}", said(&assert));
    let bytes = fs::read(folder.path().join("a.vtp")).expect("there");
    assert!(bytes.windows(5).any(|w| w == b">0.5<"));
}

#[test]
fn a_mesh_is_drawn_alone_and_with_a_run() {
    let folder = folder();
    let mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    fs::write(folder.path().join("tri.ply"), mesh).expect("written");
    for inputs in [&["tri.ply"][..], &["run.mcap", "tri.ply"]] {
        dem_view(folder.path(), &[inputs, &["-o", "a.png"], &SMALL[..2]].concat()).success();
    }
    let assert = dem_view(folder.path(), &["tri.ply", "-o", "a.vtp"]).success();
    assert!(said(&assert).contains("3 points, 1 triangles"), "{}", said(&assert));
}

#[test]
fn without_ffmpeg_the_cure_is_named() {
    let folder = folder();
    let mut command = Command::new(env!("CARGO_BIN_EXE_dem-view"));
    command.current_dir(folder.path()).env("PATH", "").args(["run.mcap", "-o", "run.mp4"]);
    let assert = command.assert().code(1);
    assert!(said(&assert).contains("install it") && said(&assert).contains(".gif"), "{}", said(&assert));
    assert!(!folder.path().join("run.mp4").exists());
}

/// A film that ffmpeg packs and a folder of files are removed by a signal, as every other output.
#[test]
fn a_signal_leaves_no_film_and_no_series() {
    let folder = folder();
    let names = || {
        let all = fs::read_dir(folder.path()).expect("a folder").map(|e| e.expect("an entry").file_name());
        all.collect::<std::collections::BTreeSet<_>>()
    };
    let before = names();
    let long = ["run.mcap", "--size", "160x120", "--every", "1e-4", "-o", "a.mp4"];
    // This one waits for its input.
    for words in [&long[..], &["-", "-o", "a.pvd"]] {
        if words.contains(&"a.mp4") && Command::new("ffmpeg").arg("-version").ok().is_err() {
            continue;
        }
        let mut tool = std::process::Command::new(env!("CARGO_BIN_EXE_dem-view"));
        tool.current_dir(folder.path()).args(words).stdin(Stdio::piped()).stderr(Stdio::null());
        let mut child = tool.spawn().expect("it starts");
        let stdin = child.stdin.take();
        while names() == before {
            assert!(child.try_wait().expect("a child").is_none(), "it has ended");
            std::thread::sleep(Duration::from_millis(5));
        }
        let sent = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
        assert!(sent.expect("kill").success());
        assert_eq!(child.wait().expect("a child").signal(), Some(15), "{words:?}");
        assert_eq!(names(), before, "{words:?}");
        drop(stdin);
    }
}

#[test]
fn options_of_another_kind_of_output_are_refused() {
    let folder = folder();
    for (args, word) in [
        (["-o", "a.png", "--every", "0.1"], "use --time"),
        (["-o", "a.gif", "--time", "0.1"], "--from and --to"),
        (["-o", "a.gif", "--every", "0"], "above 0"),
        (["-o", "a.gif", "--fps", "0"], "1..=100"),
    ] {
        let assert = dem_view(folder.path(), &[&["run.mcap"], &args[..]].concat()).code(2);
        assert!(said(&assert).contains(word), "{args:?}: {}", said(&assert));
    }
}

#[test]
fn bad_input_leaves_no_file_for_paraview() {
    let folder = folder();
    let whole = fs::read(folder.path().join("run.mcap")).expect("there");
    fs::write(folder.path().join("cut.mcap"), &whole[..whole.len() / 2]).expect("written");
    for name in ["out.vtp", "out.pvd", "out.gif"] {
        let assert = dem_view(folder.path(), &["cut.mcap", "-o", name]).code(1);
        assert!(said(&assert).contains("truncated"), "{}", said(&assert));
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2, "the two runs");
}
