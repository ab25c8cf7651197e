//! A plant of a user's own: the Makefile of docs/how-to/plants.md, its files, and each of its stages swapped for another program.

use grainpipe_tests::tree::root;
use grainpipe_tests::{skip, tools::program};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::SystemTime;
use tempfile::{TempDir, tempdir};

const FILES: [&str; 7] =
    ["cropped.ply", "filled.ply", "sampled.ply", "walls.mcap", "run.mcap", "page.html", "picture.png"];

/// The folder of a user: a scan, a scene, and the documented Makefile, with fewer points and a short run.
fn plant() -> TempDir {
    let folder = tempdir().unwrap();
    let text = fs::read_to_string(root().join("docs/how-to/plants.md")).unwrap();
    let makefile = text.split("```make\n").nth(1).unwrap().split("```").next().unwrap();
    assert!(makefile.lines().count() <= 10, "{makefile}");
    let rules = root().join("pipelines/plant.mk").display().to_string();
    let tools = program("dem-run").parent().unwrap().display().to_string();
    let mut text = makefile.to_owned();
    for (old, new) in [
        ("../grainpipe/pipelines/plant.mk", &*rules),
        ("--spacing 0.012", "--spacing 0.03"),
        ("--time 1.9", "--size 320x180"),
        ("PLANTS", &format!("DEM := dem-run --until 0.004\nBIN := {tools}\nPLANTS")),
    ] {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    fs::write(folder.path().join("Makefile"), text).unwrap();
    for (from, to) in
        [("sample-data/chute/chute.ply", "chute.ply"), ("pipelines/scenes/chute.toml", "chute.toml")]
    {
        fs::copy(root().join(from), folder.path().join(to)).unwrap();
    }
    folder
}

fn call(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new("make");
    // The make that runs the tests must not set variables of this one.
    command.current_dir(folder).args(words).env_remove("MAKEFLAGS").env_remove("MAKELEVEL");
    command.output().expect("make starts")
}

fn make(folder: &Path, words: &[&str]) -> String {
    let done = call(folder, words);
    assert!(done.status.success(), "make {words:?}: {}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// When each file was made.
fn times(folder: &Path) -> BTreeMap<&'static str, SystemTime> {
    let time = |name: &&str| fs::metadata(folder.join("out/chute").join(name)).ok()?.modified().ok();
    FILES.iter().filter_map(|name| Some((*name, time(name)?))).collect()
}

/// The files that a call of make makes again.
fn made(folder: &Path, words: &[&str]) -> Vec<&'static str> {
    let before = times(folder);
    make(folder, words);
    let after = times(folder);
    FILES.into_iter().filter(|name| before.get(name) != after.get(name)).collect()
}

#[test]
fn every_file_is_made_once_and_the_pipe_has_the_same_bytes() {
    let folder = plant();
    let folder = folder.path();
    let bytes = |name: &str| fs::read(folder.join("out/chute").join(name)).unwrap();
    assert!(make(folder, &["-n"]).contains("dem-run --until 0.004 chute.toml out/chute/walls.mcap"));
    assert!(!folder.join("out").exists(), "make -n writes nothing");
    assert_eq!(made(folder, &["-j2"]), FILES);
    assert_eq!((made(folder, &[]), made(folder, &["chute"])), (vec![], vec![]));
    assert!(!make(folder, &["-n"]).contains("dem-"));
    make(folder, &["chute-pipe"]);
    assert!(bytes("run.mcap").len() > 10_000 && bytes("run.mcap") == bytes("piped.mcap"));
    make(folder, &["clean-run"]);
    assert_eq!(
        times(folder).into_keys().collect::<Vec<_>>(),
        ["cropped.ply", "filled.ply", "sampled.ply", "walls.mcap"]
    );
    assert_eq!(made(folder, &["out/chute/run.mcap"]), ["run.mcap"]);
}

#[test]
fn only_what_changed_is_made_again() {
    let folder = plant();
    let folder = folder.path();
    make(folder, &[]);
    let other = "SAMPLE=bluenoise-sample --spacing 0.04";
    let said = make(folder, &["-n", other]);
    assert!(said.contains("--spacing 0.04") && !said.contains("cloud-fill"), "{said}");
    assert_eq!(made(folder, &[]), [""; 0], "make -n remembers nothing");
    assert_eq!(made(folder, &[other]), FILES[2..]);
    assert_eq!(made(folder, &[other]), [""; 0]);
    assert_eq!(made(folder, &["PICTURE=--size 160x90", other]), ["picture.png"]);
    assert_eq!(
        made(folder, &["WALLS=wallgen --roughness 0.002 --material steel"])[0],
        "sampled.ply",
        "its command is the old one"
    );
    // Files that a command or a scene names.
    let regions = "[[region]]\nname = \"all\"\nshape = \"box:-9,-9,-9,9,9,9\"\naction = \"keep\"\n";
    fs::write(folder.join("regions.toml"), regions).unwrap();
    let crop = "CROP=cloud-crop --regions regions.toml";
    assert_eq!(made(folder, &[crop]), FILES);
    fs::write(folder.join("regions.toml"), regions.replace("all", "same")).unwrap();
    assert_eq!(made(folder, &[crop]), FILES);
    let scene = fs::read_to_string(folder.join("chute.toml")).unwrap();
    fs::write(folder.join("chute.toml"), scene.replace("rpm = 8", "rpm = 9")).unwrap();
    assert_eq!(made(folder, &[crop]), FILES[4..]);
}

#[test]
fn a_stage_that_fails_or_is_missing_leaves_nothing_that_looks_whole() {
    let folder = plant();
    let folder = folder.path();
    let done = call(folder, &["SAMPLE=head -c 1000 | false"]);
    assert!(!done.status.success());
    assert_eq!(times(folder).into_keys().collect::<Vec<_>>(), ["cropped.ply", "filled.ply"]);
    // The environment does not count.
    let mut command = Command::new("make");
    command.current_dir(folder).env("SAMPLE", "nothing").env("VIEW", "nothing").args(["-n"]);
    let said = String::from_utf8(command.output().unwrap().stdout).unwrap();
    assert!(said.contains("bluenoise-sample") && !said.contains("nothing"), "{said}");
    let text = fs::read_to_string(folder.join("Makefile")).unwrap();
    let without: Vec<&str> = text.lines().filter(|line| !line.starts_with("SAMPLE")).collect();
    fs::write(folder.join("Makefile"), without.join("\n")).unwrap();
    let said = call(folder, &[]);
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.contains("plant chute: SAMPLE is not set") && said.contains("such as"), "{said}");
}

/// Keeps every fourth row of a PLY.
const SAMPLE: &str = r#"import sys; head, body = sys.stdin.buffer.read().split(b"end_header\n", 1)
n = int(head.split(b"element vertex ")[1].split()[0]); size = len(body) // n; rows = range(0, n, 4)
sys.stdout.buffer.write(head.replace(b"vertex %d" % n, b"vertex %d" % len(rows)) + b"end_header\n" + b"".join(body[k * size:(k + 1) * size] for k in rows))
"#;
/// Gives walls that were made before.
const WALLS: &str = r#"import sys
sys.stdin.buffer.read()
sys.stdout.buffer.write(open("given-walls.mcap", "rb").read())
"#;
/// Is called as `dem.py SCENE WALLS -o RUN`.
const DEM: &str = r#"import sys
assert sys.argv[1].endswith(".toml") and open(sys.argv[2], "rb").read(5) == b"\x89MCAP"
open(sys.argv[sys.argv.index("-o") + 1], "wb").write(open("given-run.mcap", "rb").read())
"#;
/// Is called as `view.py RUN -o PAGE`.
const VIEW: &str = r#"import sys
size = len(open(sys.argv[1], "rb").read())
open(sys.argv[sys.argv.index("-o") + 1], "w").write(f"{size} bytes")
"#;

#[test]
fn each_stage_is_swapped_for_three_lines_of_python() {
    if Command::new("python3").arg("--version").output().is_err() {
        return skip("python3");
    }
    let folder = plant();
    let folder = folder.path();
    make(folder, &[]);
    let read = |name: &str| fs::read(folder.join("out/chute").join(name)).unwrap();
    fs::write(folder.join("given-walls.mcap"), read("walls.mcap")).unwrap();
    fs::write(folder.join("given-run.mcap"), read("run.mcap")).unwrap();
    for (stage, script, first) in [
        ("CROP", SAMPLE, 0),
        ("FILL", SAMPLE, 1),
        ("SAMPLE", SAMPLE, 2),
        ("WALLS", WALLS, 3),
        ("DEM", DEM, 4),
        ("VIEW", VIEW, 5),
    ] {
        let program = format!("{}.py", stage.to_lowercase());
        assert_eq!(script.lines().count(), 3);
        fs::write(folder.join(&program), script).unwrap();
        make(folder, &[]);
        let swapped = format!("{stage}=python3 {program}");
        assert_eq!(made(folder, &[&swapped]), FILES[first..], "{stage}");
        assert_eq!(made(folder, &[&swapped]), [""; 0], "{stage}");
        // The program is an input of its stage.
        fs::write(folder.join(&program), script).unwrap();
        assert_eq!(made(folder, &[&swapped]), FILES[first..], "{stage}");
    }
    let points = |name: &str| {
        let text = String::from_utf8_lossy(&read(name)[..300]).into_owned();
        let count = text.split("element vertex ").nth(1).unwrap().split_whitespace().next().unwrap();
        count.parse::<usize>().unwrap()
    };
    make(folder, &["SAMPLE=python3 sample.py", "out/chute/sampled.ply"]);
    assert_eq!(points("sampled.ply"), points("filled.ply").div_ceil(4));
    make(folder, &["VIEW=python3 view.py"]);
    assert_eq!(read("page.html"), format!("{} bytes", read("run.mcap").len()).into_bytes());
}

#[test]
fn the_repositorys_makefiles_take_swapped_stages_from_either_folder() {
    let swapped = ["-n", "chute", "SAMPLE=my-sampler --spacing 0.01", "DEM=dem-lammps", "OUT=/tmp/never"];
    for folder in [root(), root().join("pipelines")] {
        let said = make(&folder, &swapped);
        assert!(said.contains("< /tmp/never/chute/filled.ply my-sampler --spacing 0.01 >"), "{said}");
        assert!(said.contains("dem-lammps scenes/chute.toml /tmp/never/chute/walls.mcap -o"), "{said}");
        assert!(said.contains("cargo build --release --locked") && !said.contains("--quiet"), "{said}");
    }
    assert!(make(&root(), &[]).contains("demo "), "the list of targets");
}

/// Notes each start and takes a while.
const SLOW: &str = r#"import sys, time
open("starts", "a").write("one\n"); time.sleep(0.7)
open(sys.argv[sys.argv.index("-o") + 1], "wb").write(b"a run")
"#;

/// One of two makes that share a folder makes each file, the other waits and finds it; a make that is to make all again does.
#[test]
fn two_makes_on_one_folder_make_each_file_once() {
    let tools = ["python3", "flock"].map(|tool| Command::new(tool).arg("--version").output().is_ok());
    if tools.contains(&false) {
        return skip("python3, flock");
    }
    let folder = plant();
    let folder = folder.path();
    fs::write(folder.join("dem.py"), SLOW).unwrap();
    let words = ["DEM=python3 dem.py", "out/chute/run.mcap"];
    std::thread::scope(|threads| {
        let both = [0, 1].map(|_| threads.spawn(|| make(folder, &words)));
        let said = both.map(|one| one.join().unwrap());
        assert!(said.iter().any(|words| words.contains("python3 dem.py chute.toml")), "{said:?}");
    });
    let starts = || fs::read_to_string(folder.join("starts")).unwrap().lines().count();
    assert_eq!(starts(), 1);
    assert_eq!(fs::read(folder.join("out/chute/run.mcap")).unwrap(), b"a run");
    make(folder, &words);
    assert_eq!(starts(), 1);
    make(folder, &["-B", words[0], words[1]]);
    assert_eq!(starts(), 2);
}
