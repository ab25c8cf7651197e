//! No output replaces what the same call reads, another output, or a run; and none is another for options that only tell.

use grainpipe_tests::scenes::{SINTER, folder};
use grainpipe_tests::tools::{line, succeed};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const PLATE: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                     element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
                     3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// A grain over a floor, its files in a folder beside the scene.
fn scene() -> TempDir {
    let grain = "[[particles]]\nsource = \"in/one.csv\"\nmaterial = \"sinter\"\n";
    let plate = "[[wall]]\nmesh = \"in/plate.ply\"\nmaterial = \"sinter\"\n";
    let text =
        format!("{}{grain}{plate}{}", SINTER.toml(), SINTER.floor()).replace("until = 0.3", "until = 0.01");
    let folder = folder(&[("s.toml", text.as_str())]);
    fs::create_dir(folder.path().join("in")).unwrap();
    fs::write(folder.path().join("in/one.csv"), "x,y,z,radius\n-0.5,0,0.02,0.01\n").unwrap();
    fs::write(folder.path().join("in/plate.ply"), PLATE).unwrap();
    folder
}

/// Every file of a folder, and what it holds.
fn all(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(all(&path));
        } else {
            found.push((path.display().to_string(), fs::read(&path).unwrap()));
        }
    }
    found.sort();
    found
}

/// Wrong usage, with these words; no file comes, goes or changes.
fn refused(folder: &Path, words: &str, parts: &[&str]) {
    let before = all(folder);
    let done = line(folder, words);
    let said = parts.iter().all(|part| done.stderr.contains(part));
    assert!(done.code == 2 && said, "{words}: {}: {}", done.code, done.stderr);
    assert!(all(folder) == before, "{words} changes a file");
}

#[test]
fn files_that_the_scene_names_are_not_replaced() {
    let folder = scene();
    let f = folder.path();
    std::os::unix::fs::symlink("in/plate.ply", f.join("link.ply")).unwrap();
    refused(f, "dem-run s.toml -o in/one.csv", &["-o in/one.csv is also an input: choose another name"]);
    refused(f, "dem-run s.toml -o in/plate.ply", &["-o in/plate.ply is also an input"]);
    refused(
        f,
        "cloud-crop in/one.csv --remove mesh:in/plate.ply,units=mm -o in/plate.ply",
        &["-o in/plate.ply is also an input"],
    );
    refused(f, "dem-run s.toml -o link.ply", &["-o link.ply is also an input (in/plate.ply)"]);
    refused(f, "dem-run s.toml -o x.mcap --report ./in/one.csv", &["--report ./in/one.csv", "also an input"]);
    refused(f, "dem-run s.toml --explain -o in/one.csv", &["-o in/one.csv is also an input"]);
    refused(f, "stage-split s.toml --at 0,0,0.01,0,0,-1 --keep upstream -o in/one.csv", &["also an input"]);
    refused(
        f,
        "cost-curve s.toml --vary safety=0.1,0.2 --measure overlap --words in/one.csv",
        &["also an input"],
    );
    succeed(f, "dem-run", &["s.toml", "-o", "run.mcap"]);
    fs::write(
        f.join("on.toml"),
        fs::read_to_string(f.join("s.toml")).unwrap().replace("in/one.csv", "run.mcap"),
    )
    .unwrap();
    refused(f, "dem-run on.toml -o run.mcap", &["-o run.mcap is also an input"]);
}

#[test]
fn two_outputs_have_two_names() {
    let folder = scene();
    let f = folder.path();
    refused(
        f,
        "dem-run s.toml -o x.mcap --report ./x.mcap",
        &["--report ./x.mcap is also -o: choose another name"],
    );
    succeed(f, "dem-run", &["s.toml", "-o", "run.mcap"]);
    refused(f, "dem-run s.toml -o run.mcap --report run.mcap", &["--report run.mcap is also -o"]);
    refused(f, "dem-measure run.mcap --energy -o e.svg --plot e.svg", &["--plot e.svg is also -o"]);
    refused(f, "dem-measure run.mcap --energy --plot run.mcap", &["--plot run.mcap is also an input"]);
    let done = line(f, "dem-run s.toml -o /dev/null --report /dev/null");
    assert_eq!(done.code, 0, "a device may have both: {}", done.stderr);
}

/// /dev/stdout is written to as it is: a pipe, or a file to which a shell sends several programs.
#[test]
fn an_open_file_is_written_to_and_not_replaced() {
    let folder = scene();
    let f = folder.path();
    let done = line(f, "dem-run s.toml -q -o run.mcap --report /dev/stdout");
    assert!(done.code == 0 && done.stdout.starts_with(b"{"), "{}", done.stderr);
    let both = "{ echo before; dem-run s.toml -q -o run.mcap --report /dev/stdout; echo after; } > all.txt";
    assert_eq!(line(f, both).code, 0);
    let all = fs::read_to_string(f.join("all.txt")).unwrap();
    for (target, said) in
        [("/dev/fd/7", "is not open"), ("/dev/fd/3", "is an open file"), ("/dev/stdin", "is read")]
    {
        let words = format!("dem-run s.toml -q -o run.mcap --report {target} 3> three.txt");
        let done = line(f, &words);
        assert!(done.code != 0 && done.stderr.contains(said), "{words}: {}", done.stderr);
    }
    assert!(all.starts_with("before\n{") && all.ends_with("}\nafter\n"), "{all}");
}

#[test]
fn files_of_shapes_and_other_options_are_inputs() {
    let folder = scene();
    let f = folder.path();
    fs::write(f.join("a.xyz"), "0 0 0\n1 0 0\n0 1 0\n").unwrap();
    fs::write(f.join("r.toml"), "[[region]]\nname = \"a\"\nkeep = \"box:0,0,0,1,1,1\"\n").unwrap();
    refused(
        f,
        "cloud-crop a.xyz --keep '!mesh:in/plate.ply' -o in/plate.ply",
        &["-o in/plate.ply is also an input"],
    );
    refused(
        f,
        "cloud-crop a.xyz --regions r.toml -o x.ply --report r.toml",
        &["--report r.toml is also an input"],
    );
}

#[test]
fn words_do_not_replace_a_run() {
    let folder = scene();
    let f = folder.path();
    succeed(f, "dem-run", &["s.toml", "-o", "run.mcap"]);
    fs::copy(f.join("run.mcap"), f.join("keep")).unwrap();
    refused(
        f,
        "dem-run s.toml --explain -o run.mcap",
        &["-o run.mcap holds a run, and --explain writes text"],
    );
    refused(f, "dem-run s.toml --explain -o keep", &["-o keep holds a run"]);
    refused(f, "dem-run s.toml --explain -o new.mcap", &["is the name of a run", "FILE.txt"]);
    succeed(f, "dem-run", &["s.toml", "--explain", "-o", "words.txt"]);
}

/// What an option only tells, or writes beside, is no part of the result.
#[test]
fn options_that_only_tell_change_no_byte() {
    let folder = scene();
    let f = folder.path();
    let run = |more: &[&str]| {
        succeed(f, "dem-run", &[&["s.toml", "-o", "run.mcap"], more].concat());
        fs::read(f.join("run.mcap")).unwrap()
    };
    let plain = run(&[]);
    for more in [&["--progress"][..], &["-q"], &["--threads", "2"], &["--report", "r.json"]] {
        assert!(run(more) == plain, "{more:?}");
    }
    let points = (0..400).map(|n| format!("{} {} 0\n", 0.01 * f64::from(n % 20), 0.01 * f64::from(n / 20)));
    fs::write(f.join("scan.xyz"), points.collect::<String>()).unwrap();
    let walls = |more: &[&str]| {
        succeed(f, "wallgen", &[&["scan.xyz", "--roughness", "0.002", "-o", "walls.mcap"], more].concat());
        fs::read(f.join("walls.mcap")).unwrap()
    };
    assert!(walls(&["--changes", "c.csv"]) == walls(&[]), "--changes");
}
