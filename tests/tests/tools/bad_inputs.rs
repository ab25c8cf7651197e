//! What users do wrong: the exit code, the words, and that nothing is left that looks whole.

use grainpipe_tests::tools::{Done, succeed, with_stdin};
use std::fs;
use std::path::Path;
use stream::mcap::Reader;
use tempfile::{TempDir, tempdir};

/// A command line (`<FILE` is its stdin), its exit code, and what stderr must say.
type Case = (&'static str, i32, &'static [&'static str]);

/// Runs every case twice, to a file and to stdout: whatever fails leaves neither a file nor a whole stream.
fn check(folder: &Path, cases: &[Case]) {
    let wrong: Vec<String> = cases.iter().filter_map(|case| outcome(folder, case).err()).collect();
    assert!(wrong.is_empty(), "{} of {} cases:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

/// Why a case is not refused as it should be.
fn outcome(folder: &Path, &(line, code, parts): &Case) -> Result<(), String> {
    let before = names(folder);
    let output = match line.split(['-', ' ']).next() {
        Some("cloud" | "bluenoise") => "out.ply",
        _ if line.starts_with("dem-view") => "out.png",
        _ => "out.mcap",
    };
    let (to_file, to_stdout) = (run(folder, line, &["-o", output]), run(folder, line, &[]));
    let said = to_file.stderr.trim_end();
    // Shown by --nocapture: the messages are to be read, too.
    println!("{line}\n    {said}");
    let wrong = |what: &str| Err(format!("{line}: {what}: {said}"));
    let begins = format!("{}: ", line.split(' ').next().unwrap_or_default());
    for done in [&to_file, &to_stdout] {
        if done.code != code {
            return wrong(&format!("exit code {} for {code}", done.code));
        }
        if !done.stderr.starts_with(&begins) {
            return wrong("the tool is not named");
        }
    }
    if let Some(part) = parts.iter().find(|part| !said.contains(**part)) {
        return wrong(&format!("does not say '{part}'"));
    }
    if code != 2 && !said.lines().all(|l| l.starts_with(&begins)) {
        return wrong("more than one line for a message");
    }
    if long_number(said) {
        return wrong("more digits than anybody reads");
    }
    // A run that fails on its way keeps what it had written, under a name that says so.
    if said.contains("is kept in out.mcap.part") {
        let _ = fs::remove_file(folder.join("out.mcap.part"));
    }
    if names(folder) != before {
        return wrong("leaves a file");
    }
    if whole(&to_stdout.stdout) { wrong("its output looks whole") } else { Ok(()) }
}

fn run(folder: &Path, line: &str, more: &[&str]) -> Done {
    let (mut words, mut stdin) = (Vec::new(), Vec::new());
    for word in line.split(' ') {
        match word.strip_prefix('<') {
            Some(file) => stdin = fs::read(folder.join(file)).unwrap(),
            None => words.push(word),
        }
    }
    with_stdin(folder, words[0], &[&words[1..], more].concat(), &stdin)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Whether a reader would take the bytes for a finished stream.
fn whole(bytes: &[u8]) -> bool {
    let mcap = bytes.starts_with(b"\x89MCAP");
    if mcap {
        Reader::new(bytes).all(|event| event.is_ok())
    } else {
        cloud::from_bytes(bytes.to_vec()).is_ok()
    }
}

/// Whether a number has more digits than anybody reads: a computed one that was not rounded.
fn long_number(text: &str) -> bool {
    let numbers = text.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    numbers.filter(|n| n.contains('.')).any(|n| {
        let digits = n.chars().filter(char::is_ascii_digit).skip_while(|&c| c == '0').count();
        digits > 9
    })
}

/// A surface of 20 x 20 points, 10 mm apart.
fn surface() -> String {
    (0..400).map(|k| format!("{} {} 0\n", 0.01 * f64::from(k % 20), 0.01 * f64::from(k / 20))).collect()
}

fn clouds() -> TempDir {
    let folder = tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let sample = |name: &str| {
        fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../sample-data").join(name)).unwrap()
    };
    write("good.xyz", surface().as_bytes());
    succeed(folder.path(), "cloud-crop", &["good.xyz", "-o", "good.ply"]);
    let ply = fs::read(folder.path().join("good.ply")).unwrap();
    write("cut.ply", &ply[..ply.len() - 100]);
    write("long.ply", &[&ply[..], b"more"].concat());
    let las = sample("autzen/autzen_400.las");
    write("cut.las", &las[..las.len() / 2]);
    write("head.las", &las[..100]);
    let laz = sample("autzen/autzen_400.laz");
    write("cut.laz", &laz[..laz.len() / 2]);
    write("cut.e57", b"ASTM-E57\x01\0\0\0\0\0\0\0");
    let header = |more: &str| {
        format!("ply\nformat ascii 1.0\nelement vertex 3\n{more}end_header\n0 0 0\n1 0 0\n0 1 0\n")
    };
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    write("text.ply", header(xyz).replace("1 0 0\n", "1 o 0\n").as_bytes());
    write("no-z.ply", header("property float x\nproperty float y\nproperty float w\n").as_bytes());
    write("format.ply", header(xyz).replace("ascii 1.0", "ascii 2.0").as_bytes());
    write("type.ply", header(&xyz.replace("float x", "floot x")).as_bytes());
    write("count.ply", header(xyz).replace("vertex 3", "vertex 99999999999999").as_bytes());
    write("minus.ply", header(xyz).replace("vertex 3", "vertex -3").as_bytes());
    write("header.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n");
    write("none.ply", header(xyz).split("0 0 0").next().unwrap().replace("vertex 3", "vertex 0").as_bytes());
    write("one.xyz", b"1 2 3\n");
    write("same.xyz", "1 2 3\n".repeat(50).as_bytes());
    let on_line: String = (0..50).map(|k| format!("{} 0 0\n", 0.01 * f64::from(k))).collect();
    write("line.xyz", on_line.as_bytes());
    write("nan.xyz", [surface(), "nan 0 0\n".to_owned()].concat().as_bytes());
    write("far.xyz", [surface(), "1e300 0 0\n".to_owned()].concat().as_bytes());
    write("comma.xyz", b"0,5 1,25 2,0\n");
    let wide: String = (0..400).map(|k| format!("{} {} 0\n", k % 20, k / 20)).collect();
    write("mm.xyz", wide.as_bytes());
    write("mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("word.xyz", b"1 2 3\n1 2 three\n");
    write("row.xyz", b"1 2 3\n4 5\n");
    write("empty.xyz", b"");
    write("cut.pcd", b"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n0 0 0\n1 1 1\n");
    write("photo.png", b"\x89PNG\r\n\x1a\n0000000000000000");
    write("regions.toml", b"[[region]]\nname = \"a\"\nshap = \"sphere:0,0,0,1\"\naction = \"remove\"\n");
    fs::create_dir(folder.path().join("folder")).unwrap();
    folder
}

/// The check itself: what succeeds is seen as whole, so that "not whole" means something.
#[test]
fn what_succeeds_is_seen_as_whole() {
    let folder = scenes();
    for line in [
        "cloud-crop good.ply",
        "wallgen good.ply --roughness 0.002",
        "dem-run s.toml",
        "stage-replay up.mcap",
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 0 && whole(&done.stdout), "{line}: {}", done.stderr);
        assert!(!whole(&done.stdout[..done.stdout.len() - 5]), "{line}");
    }
    assert!(long_number("0.010000000000000009 m") && !long_number("0.0433050 m, 1.2.3"));
}

#[test]
fn clouds_that_are_damaged_or_no_clouds() {
    let folder = clouds();
    check(
        folder.path(),
        &[
            ("cloud-crop cut.ply", 1, &["cut.ply", "promises 400 rows", "row 395", "byte 9620"]),
            ("cloud-crop <cut.ply", 1, &["stdin", "promises 400 rows"]),
            ("cloud-crop long.ply", 1, &["long.ply", "4 bytes follow"]),
            ("cloud-crop cut.las", 1, &["cut.las", "LAS", "cut off"]),
            ("cloud-crop head.las", 1, &["head.las", "LAS", "cut off"]),
            ("cloud-crop cut.laz", 1, &["cut.laz", "LAZ", "cut off"]),
            ("cloud-crop cut.e57", 1, &["cut.e57", "E57", "cut off"]),
            ("cloud-crop cut.pcd", 1, &["cut.pcd", "PCD", "point 2", "cut off"]),
            ("cloud-crop row.xyz", 1, &["row.xyz", "line 2"]),
            (
                "cloud-crop comma.xyz",
                1,
                &["comma.xyz", "line 1", "decimal commas: write numbers with a point", "0,5 1,25 2,0"],
            ),
            ("cloud-crop word.xyz", 1, &["word.xyz", "line 2", "three"]),
            ("cloud-crop text.ply", 1, &["text.ply", "line 9", "row 1", "'y'", "'o'"]),
            ("cloud-crop no-z.ply", 1, &["no-z.ply", "no 'z'"]),
            ("cloud-crop format.ply", 1, &["format.ply", "line 2", "2.0"]),
            ("cloud-crop type.ply", 1, &["type.ply", "line 4", "floot"]),
            ("cloud-crop count.ply", 1, &["count.ply", "99999999999999"]),
            ("cloud-crop minus.ply", 1, &["minus.ply", "line 3", "-3"]),
            ("cloud-crop header.ply", 1, &["header.ply", "end_header"]),
            ("cloud-crop empty.xyz", 1, &["empty.xyz", "nothing to read"]),
            ("cloud-crop photo.png", 1, &["photo.png", "give PLY, LAS"]),
            ("cloud-crop missing.ply", 1, &["missing.ply", "cannot open it", "check the path"]),
            ("cloud-crop folder", 1, &["folder", "is a folder", "name a file"]),
            ("dem-view cut.ply", 1, &["cut.ply", "promises 400 rows"]),
        ],
    );
}

#[test]
fn clouds_that_cannot_become_a_wall_or_a_sample() {
    let folder = clouds();
    check(
        folder.path(),
        &[
            ("bluenoise-sample none.ply --spacing 0.01", 1, &["none.ply", "no point"]),
            (
                "bluenoise-sample nan.xyz --spacing 0.01",
                1,
                &["nan.xyz", "point 400", "not finite", "cloud-crop"],
            ),
            ("bluenoise-sample good.ply --count 401", 1, &["good.ply", "401", "400 points"]),
            ("wallgen far.xyz --roughness 0.001", 1, &["far.xyz", "point 400", "1e300", "cloud-crop"]),
            ("bluenoise-sample far.xyz --spacing 0.01", 1, &["far.xyz", "point 400", "1e300", "cloud-crop"]),
            ("wallgen none.ply --roughness 0.001", 1, &["none.ply", "0 points", "at least 2"]),
            ("wallgen one.xyz --roughness 0.001", 1, &["one.xyz", "at least 2"]),
            (
                "wallgen same.xyz --roughness 0.001",
                1,
                &["same.xyz", "50 points", "same position", "bluenoise-sample"],
            ),
            (
                "wallgen mm.xyz --roughness 0.0001 --smallest-particle 0.01",
                1,
                &["mm.xyz", "the cloud is 19 m wide: is it in millimetres?"],
            ),
            ("wallgen nan.xyz --roughness 0.001", 1, &["nan.xyz", "point 400", "not finite"]),
            ("wallgen line.xyz --roughness 0.02", 1, &["roughness 0.02 m", "half", "0.01 m"]),
            ("wallgen good.ply --roughness 0.006", 1, &["good.ply", "roughness 0.006 m", "half", "0.01 m"]),
            ("cloud-crop good.ply --regions regions.toml", 1, &["regions.toml: line 3", "'shap'", "'shape'"]),
            ("cloud-crop good.ply --regions good.xyz", 1, &["good.xyz"]),
            ("wallgen good.ply --roughness nowhere.toml", 1, &["nowhere.toml: cannot read"]),
        ],
    );
}

#[test]
fn options_that_cannot_be_meant() {
    let folder = clouds();
    check(
        folder.path(),
        &[
            ("cloud-crop good.ply --keep ball:0,0,0,1", 2, &["--keep", "ball", "sphere:"]),
            ("cloud-crop good.ply --keep sphere:0,0,0", 2, &["--keep", "4 numbers wanted", "3 found"]),
            ("cloud-crop good.ply --remove halfspace:0,0,0,0,0,0", 2, &["--remove", "normal"]),
            ("cloud-crop good.ply --keep sphere:0,0,0,-1", 2, &["radius -1 m", "positive"]),
            ("cloud-crop good.ply --keep mesh:missing.ply", 2, &["missing.ply", "cannot read"]),
            ("cloud-crop good.ply --keep mesh:mesh.obj", 2, &["mesh.obj", "not closed"]),
            ("cloud-crop good.ply --keep mesh:word.xyz", 2, &["word.xyz", "give PLY, STL, OBJ"]),
            (
                "wallgen good.ply --roughness 0.002mm",
                2,
                &["--roughness 0.002mm: is neither a number of metres nor a file"],
            ),
            ("cloud-crop good.ply --kep sphere:0,0,0,1", 2, &["--kep", "--keep"]),
            ("cloud-crop good.ply --largest -1", 2, &["--largest"]),
            ("cloud-crop good.ply --threads 0", 2, &["--threads"]),
            ("cloud-crop good.ply good.xyz", 2, &["good.xyz"]),
            ("cloud-fill good.ply --spacing 0", 2, &["--spacing", "above 0"]),
            ("cloud-fill good.ply --spacing=-0.1", 2, &["--spacing", "above 0"]),
            ("cloud-fill good.ply --fill noise", 2, &["--fill", "noise", "blue-noise"]),
            ("bluenoise-sample good.ply", 2, &["--spacing", "--count", "--density"]),
            ("bluenoise-sample good.ply --spacing 0.01 --count 5", 2, &["--spacing", "--count"]),
            ("bluenoise-sample good.ply --spacing -0.01", 2, &["spacing -0.01 m", "positive"]),
            (
                "bluenoise-sample good.ply --spacing 12mm",
                2,
                &["--spacing", "12mm", "not a number", "SI units"],
            ),
            ("bluenoise-sample good.ply --count 0", 2, &["count 0"]),
            ("bluenoise-sample good.ply --density 500,20", 2, &["density 500,20", "lower one first"]),
            ("bluenoise-sample good.ply --density 500 --method tile", 2, &["--density", "LO,HI"]),
            (
                "bluenoise-sample good.ply --spacing 0.01 --method blue",
                2,
                &["--method", "poisson", "eliminate"],
            ),
            ("bluenoise-sample good.ply --spacing 0.01 --plot a.pdf", 2, &["--plot", "a.pdf", "svg"]),
            ("wallgen good.ply", 2, &["--roughness", "--radius M"]),
            ("wallgen good.ply --roughness 0", 2, &["--roughness 0 m", "positive"]),
            ("wallgen good.ply --roughness -0.001", 2, &["--roughness -0.001 m", "positive"]),
            ("wallgen good.ply --roughness 0.001 --facing 0,0,0", 2, &["--facing 0,0,0", "no direction"]),
            ("wallgen good.ply --roughness 0.001 --smallest-particle -1", 2, &["--smallest-particle -1 m"]),
            ("wallgen good.ply --roughness 0.001 --young 0", 2, &["--young 0 Pa", "positive"]),
            ("cloud-crop good.ply --threads 1000000", 2, &["--threads 1000000", "at most 4096"]),
            ("stage-replay up.mcap --from nan", 2, &["--from", "nan", "seconds"]),
            ("stage-replay up.mcap --from 2 --until 1", 2, &["--until 1 s", "--from 2 s"]),
            ("dem-view good.ply --time nan", 2, &["--time", "seconds"]),
            ("dem-view - -", 2, &["only one of the inputs"]),
            ("dem-run - -", 2, &["only one of the inputs", "give files"]),
            ("wallgen good.ply --roughness 0.001 --place surface", 2, &["--place surface", "--facing x,y,z"]),
            ("wallgen good.ply --roughness 0.001 --poisson 0.7", 2, &["--poisson", "0.7"]),
            (
                "wallgen good.ply --roughness 0.001 --radius 0.01 --from-mesh mesh.obj",
                2,
                &["--from-mesh", "leave one of them out"],
            ),
            ("wallgen --roughness 0.001 --from-mesh mesh.obj", 2, &["--from-mesh", "add --radius M"]),
            ("wallgen --radius 0.01 --from-mesh mesh.obj", 2, &["--from-mesh", "add --roughness M"]),
            (
                "wallgen --radius 0.01 --roughness 0.02 --from-mesh mesh.obj",
                1,
                &["0.02 m", "at most the radius"],
            ),
            ("wallgen --radius 1e-9 --roughness 1e-12 --from-mesh mesh.obj", 1, &["too many", "millimetres"]),
            (
                "wallgen --radius 0.01 --roughness 0.001 --from-mesh missing.stl",
                1,
                &["missing.stl", "cannot read"],
            ),
            ("wallgen good.ply --roughness 0.001 --ascii", 2, &["--ascii", "no text form"]),
            ("dem-view good.ply --colour speeed", 1, &["speeed"]),
            ("stage-split s.toml --at 0,0,0,0,0,0 --keep upstream", 2, &["--at", "normal"]),
            ("stage-split s.toml --at 0,0,0,0,0,-1", 2, &["--keep"]),
            ("stage-split s.toml --at 0,0,0,0,0,-1 --keep both", 2, &["both", "upstream"]),
            ("dem-run", 2, &["SCENE.toml"]),
            ("dem-run s.toml --until soon", 2, &["--until", "soon"]),
        ],
    );
    for (line, part) in [
        ("cloud-crop good.ply -o a.las", "-o a.las: only PLY"),
        ("cloud-fill good.ply -o a.csv", "-o a.csv: only PLY"),
        ("bluenoise-sample good.ply --spacing 0.02 -o a.xyz", "-o a.xyz: only PLY"),
        ("wallgen good.ply --roughness 0.002 -o a.las", "-o a.las: only MCAP and PLY"),
        ("dem-view good.ply -o a.png --every 0.1", "--every is for a film"),
        ("dem-view good.ply -o a.xyz", ".html"),
        ("dem-view good.ply -o a", ".html"),
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 2 && done.stderr.contains(part), "{line}: {}", done.stderr);
    }
    for line in [
        "cloud-crop good.ply -o no/such/a.ply",
        "cloud-crop good.ply -o folder",
        "cloud-crop good.ply -o b.ply --report no/r.json",
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 1 && done.stderr.contains("folder"), "{line}: {}", done.stderr);
        println!("{line}\n    {}", done.stderr);
    }
}

#[test]
fn lengths_of_another_unit_are_told() {
    let folder = clouds();
    for (line, part) in [
        ("wallgen mm.xyz --roughness 0.05 --smallest-particle 0.01", "far larger than the smallest particle"),
        ("bluenoise-sample mm.xyz --spacing 0.01", "all 400 points were kept"),
        ("bluenoise-sample good.ply --spacing 10", "1 of 400 points were kept"),
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 0 && done.stderr.contains(part), "{line}: {}", done.stderr);
    }
}

const SCENE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.06
[output]
every = 0.02
checkpoint = 0.04
[[material]]
name = "sinter"
density = 3300
young = 2e7
poisson = 0.25
[[contact]]
between = ["sinter", "sinter"]
restitution = 0.5
[[fill]]
material = "sinter"
shape = "box:-0.04,-0.04,0.02,0.04,0.04,0.06"
diameter = [0.008, 0.012]
count = 40
[[wall]]
plane = "0,0,0,0,0,1"
material = "sinter"
"#;

fn scenes() -> TempDir {
    let folder = clouds();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("s.toml", SCENE);
    write("key.toml", &SCENE.replace("young =", "yung ="));
    write("type.toml", &SCENE.replace("density = 3300", "density = \"3300\""));
    write("broken.toml", &SCENE.replace("[time]", "[time"));
    let steel = "[[material]]\nname = \"steel\"\nyoung = 2e8\npoisson = 0.3\n";
    write(
        "law.toml",
        &format!("{}{steel}", SCENE.replace("1\"\nmaterial = \"sinter\"", "1\"\nmaterial = \"steel\"")),
    );
    let plant = SCENE.replace("plane = \"0,0,0,", "plane = \"0,0,-0.1,");
    write("plant.toml", &plant);
    write("walls.toml", &SCENE.replace("plane = \"0,0,0,0,0,1\"\n", ""));
    let f = folder.path();
    succeed(f, "wallgen", &["good.ply", "--roughness", "0.002", "--material", "sinter", "-o", "walls.mcap"]);
    for (stage, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        succeed(f, "stage-split", &["plant.toml", "--at", "0,0,0,0,0,-1", "--keep", stage, "-o", file]);
    }
    succeed(f, "dem-run", &["s.toml", "-o", "run.mcap"]);
    succeed(f, "dem-run", &["up.toml", "--until", "0.1", "-o", "up.mcap"]);
    succeed(f, "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    for name in ["up", "walls", "in"] {
        let bytes = fs::read(f.join(format!("{name}.mcap"))).unwrap();
        let write =
            |kind: &str, bytes: &[u8]| fs::write(f.join(format!("{name}-{kind}.mcap")), bytes).unwrap();
        write("cut", &bytes[..bytes.len() * 2 / 3]);
        write("long", &[&bytes[..], b"more"].concat());
        write("twice", &[&bytes[..], &bytes[..]].concat());
        let mut flipped = bytes.clone();
        flipped[bytes.len() / 2] ^= 0x10;
        write("flipped", &flipped);
    }
    let bytes = fs::read(f.join("run.mcap")).unwrap();
    fs::write(f.join("start.mcap"), &bytes[..700]).unwrap();
    folder
}

#[test]
fn scenes_that_cannot_run() {
    let folder = scenes();
    check(
        folder.path(),
        &[
            ("dem-run missing.toml", 1, &["missing.toml", "cannot open"]),
            ("dem-run good.ply", 1, &["good.ply", "not UTF-8 text", "right file"]),
            ("dem-run key.toml", 1, &["key.toml:10:1", "'yung'", "did you mean 'young'?"]),
            ("dem-run type.toml", 1, &["type.toml:9:11", "expected a number"]),
            ("dem-run broken.toml", 1, &["broken.toml:2:"]),
            (
                "dem-run law.toml",
                1,
                &["law.toml: contact: no law between 'sinter' and 'steel'", "[[contact]]"],
            ),
            ("dem-run s.toml --set material.0.density=-1", 1, &["material.0.density = -1 kg/m³", "positive"]),
            (
                "dem-run s.toml --set contact.0.restitutio=1",
                1,
                &["restitutio", "did you mean 'restitution'?"],
            ),
            (
                "dem-run s.toml --set time.dt=0.01",
                1,
                &["s.toml: time.dt: 1.0000e-2 s", "critical step", "sinter (radius", "auto"],
            ),
            ("dem-run s.toml --set fill.0.count=0", 1, &["fill.0.count", "0"]),
            (
                "dem-run s.toml --set fill.0.count=4000000000",
                1,
                &["fill.0.count = 4000000000", "fifty million"],
            ),
            (
                "dem-run s.toml --set gravity=[0,0]",
                1,
                &["s.toml with --set gravity=[0,0]: ", "number of values: 2", "list of 3"],
            ),
            ("dem-run s.toml --set material.0.name=\"\"", 1, &["material.0.name = \"\"", "is not a name"]),
            ("dem-run s.toml --set guards.overlap=0", 1, &["guards.overlap = 0: must"]),
            ("dem-run s.toml --set fill.0.diameter.0=-0.1", 1, &["fill.0.diameter", "-0.1"]),
            ("dem-run s.toml --set fill.0.shape=box:0,0,0,1", 1, &["fill.0.shape", "6 numbers wanted"]),
            ("dem-run s.toml --until=-1", 1, &["time.until = -1", "s"]),
            ("dem-run s.toml --set wall.0.plane=0,0,0,0,0,0", 1, &["wall.0.plane", "normal"]),
            ("dem-run walls.toml", 1, &["waits for walls", "wallgen"]),
            ("dem-run walls.toml good.ply", 1, &["good.ply", "MCAP", "wallgen"]),
            ("dem-run walls.toml walls-cut.mcap", 1, &["walls-cut.mcap", "truncated"]),
            ("dem-run walls.toml walls-long.mcap", 1, &["walls-long.mcap", "bytes follow the end"]),
            ("dem-run walls.toml walls-twice.mcap", 1, &["walls-twice.mcap", "bytes follow the end"]),
            ("dem-run walls.toml walls-flipped.mcap", 1, &["walls-flipped.mcap", "damaged"]),
            ("dem-run s.toml missing.mcap", 1, &["missing.mcap", "cannot open"]),
            ("dem-run s.toml in.mcap", 1, &["in.mcap: the scene has no [[inlet]]"]),
        ],
    );
}

#[test]
fn stages_and_resumed_runs_that_do_not_fit() {
    let folder = scenes();
    check(
        folder.path(),
        &[
            ("stage-replay run.mcap", 1, &["run.mcap", "without [[outlet]]", "stage-split"]),
            ("stage-replay walls.mcap", 1, &["walls.mcap"]),
            ("stage-replay up-cut.mcap", 1, &["up-cut.mcap", "truncated"]),
            ("stage-replay <up-cut.mcap", 1, &["stdin", "truncated"]),
            ("stage-replay up-flipped.mcap", 1, &["up-flipped.mcap", "damaged"]),
            ("stage-replay up-long.mcap", 1, &["up-long.mcap", "bytes follow the end"]),
            ("stage-replay up-twice.mcap", 1, &["up-twice.mcap", "cat"]),
            ("stage-replay up.mcap --length 0.01", 1, &["0.01", "largest diameter", "at least"]),
            ("stage-replay up.mcap --move free", 2, &["--move", "'free'", "ballistic"]),
            ("stage-replay up.mcap --outlet 3", 1, &["outlet", "3"]),
            (
                "stage-split plant.toml --at 0,0,0,0,0,-1 --keep upstream --length 0.01",
                1,
                &["--length 0.01 m", "largest diameter", "at least 0.0144 m"],
            ),
            (
                "stage-split plant.toml --at 0,0,0.1,0,0,-1 --keep upstream",
                1,
                &["no grains start upstream of the plane: its normal is to point with the flow"],
            ),
            ("stage-split plant.toml --at 0,0,0.04,0,0,-1 --keep upstream", 1, &["fill.0", "both sides"]),
            (
                "stage-split plant.toml --at 0,0,0,0,0,-1 --keep upstream --motion free",
                2,
                &["--motion", "'free'", "ballistic"],
            ),
            ("dem-run down.toml", 1, &["waits for an inlet", "stage-replay"]),
            ("dem-run down.toml up.mcap", 1, &["up.mcap", "stage-replay"]),
            ("dem-run down.toml in-cut.mcap", 1, &["in-cut.mcap", "truncated"]),
            (
                "dem-run s.toml --set outlet=[{plane=\"0,0,-1,0,0,-1\",length=0.01}]",
                1,
                &["outlet.0.length = 0.01 m", "largest diameter"],
            ),
            ("dem-run plant.toml --resume run.mcap", 1, &["--resume", "wall.0.plane", "was"]),
            ("dem-run s.toml --resume start.mcap", 1, &["start.mcap", "checkpoint"]),
            ("dem-run s.toml --resume walls.mcap", 1, &["walls.mcap"]),
            ("dem-run s.toml --resume good.ply", 1, &["good.ply", "MCAP"]),
            ("dem-run s.toml --resume run.mcap", 1, &["until"]),
            ("dem-view in.mcap", 1, &["in.mcap", "/particles"]),
            ("dem-view up-cut.mcap", 1, &["up-cut.mcap", "truncated"]),
        ],
    );
}
