//! What users do wrong: the exit code, the words, and that nothing is left that looks whole.

mod options;
mod scenes;

use grainpipe_tests::tools::{Done, succeed, with_stdin};
use grainpipe_tests::tree::root;
use std::fs;
use std::path::Path;
use stream::mcap::Reader;
use tempfile::{TempDir, tempdir};

struct Case {
    /// The command; `<FILE` is its stdin.
    line: &'static str,
    code: i32,
    /// What stderr must say.
    parts: &'static [&'static str],
}

const fn failed(line: &'static str, parts: &'static [&'static str]) -> Case {
    Case { line, code: 1, parts }
}

const fn misused(line: &'static str, parts: &'static [&'static str]) -> Case {
    Case { line, code: 2, parts }
}

/// Runs every case twice, to a file and to stdout: whatever fails leaves neither a file nor a whole stream.
fn check(folder: &Path, cases: &[Case]) {
    let wrong: Vec<String> = cases.iter().filter_map(|case| outcome(folder, case).err()).collect();
    assert!(wrong.is_empty(), "{} of {} cases:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

/// Why a case is not refused as it should be.
fn outcome(folder: &Path, &Case { line, code, parts }: &Case) -> Result<(), String> {
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
    let sample = |name: &str| fs::read(root().join("sample-data").join(name)).unwrap();
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
    let folder = scenes::scenes();
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
            failed("cloud-crop cut.ply", &["cut.ply", "promises 400 rows", "row 395", "byte 9620"]),
            failed("cloud-crop <cut.ply", &["stdin", "promises 400 rows"]),
            failed("cloud-crop long.ply", &["long.ply", "4 bytes follow"]),
            failed("cloud-crop cut.las", &["cut.las", "LAS", "cut off"]),
            failed("cloud-crop head.las", &["head.las", "LAS", "cut off"]),
            failed("cloud-crop cut.laz", &["cut.laz", "LAZ", "cut off"]),
            failed("cloud-crop cut.e57", &["cut.e57", "E57", "cut off"]),
            failed("cloud-crop cut.pcd", &["cut.pcd", "PCD", "point 2", "cut off"]),
            failed("cloud-crop row.xyz", &["row.xyz", "line 2"]),
            failed(
                "cloud-crop comma.xyz",
                &["comma.xyz", "line 1", "decimal commas: write numbers with a point", "0,5 1,25 2,0"],
            ),
            failed("cloud-crop word.xyz", &["word.xyz", "line 2", "three"]),
            failed("cloud-crop text.ply", &["text.ply", "line 9", "row 1", "'y'", "'o'"]),
            failed("cloud-crop no-z.ply", &["no-z.ply", "no 'z'"]),
            failed("cloud-crop format.ply", &["format.ply", "line 2", "2.0"]),
            failed("cloud-crop type.ply", &["type.ply", "line 4", "floot"]),
            failed("cloud-crop count.ply", &["count.ply", "99999999999999"]),
            failed("cloud-crop minus.ply", &["minus.ply", "line 3", "-3"]),
            failed("cloud-crop header.ply", &["header.ply", "end_header"]),
            failed("cloud-crop empty.xyz", &["empty.xyz", "nothing to read"]),
            failed("cloud-crop photo.png", &["photo.png", "give PLY, LAS"]),
            failed("cloud-crop missing.ply", &["missing.ply", "cannot open it", "check the path"]),
            failed("cloud-crop folder", &["folder", "is a folder", "name a file"]),
            failed("dem-view cut.ply", &["cut.ply", "promises 400 rows"]),
            // Devices have no end.
            failed("cloud-crop /dev/zero", &["/dev/zero", "is a device, and a file is needed"]),
            failed("dem-view /dev/zero", &["/dev/zero", "is a device"]),
            failed("dem-run /dev/zero --check", &["/dev/zero", "is a device"]),
            failed("stage-split /dev/zero --at 0,0,1,0,0,-1 --keep upstream", &["/dev/zero", "is a device"]),
            failed("lab-test heap /dev/zero", &["/dev/zero", "is a device"]),
            failed("calibrate /dev/zero", &["/dev/zero", "is a device"]),
            failed(
                "wallgen --radius 0.01 --roughness 0.001 --from-mesh /dev/zero",
                &["/dev/zero", "is a device, and a file is needed"],
            ),
            failed("cloud-crop good.ply --regions /dev/zero", &["/dev/zero", "is a device"]),
            misused("cloud-crop good.ply --keep mesh:/dev/zero", &["/dev/zero", "is a device"]),
            misused("cloud-crop good.ply --keep prism:/dev/zero", &["/dev/zero", "not a prism"]),
        ],
    );
}

#[test]
fn clouds_that_cannot_become_a_wall_or_a_sample() {
    let folder = clouds();
    check(
        folder.path(),
        &[
            failed("bluenoise-sample none.ply --spacing 0.01", &["none.ply", "no point"]),
            failed(
                "bluenoise-sample nan.xyz --spacing 0.01",
                &["nan.xyz", "point 400", "not finite", "cloud-crop"],
            ),
            failed("bluenoise-sample good.ply --count 401", &["good.ply", "401", "400 points"]),
            failed("wallgen far.xyz --roughness 0.001", &["far.xyz", "point 400", "1e300", "cloud-crop"]),
            failed(
                "bluenoise-sample far.xyz --spacing 0.01",
                &["far.xyz", "point 400", "1e300", "cloud-crop"],
            ),
            failed("cloud-fill far.xyz", &["far.xyz", "point 400", "1e300", "cloud-crop"]),
            misused("cloud-fill good.ply --scale 1e308", &["--scale", "1e308 is beyond 1e100"]),
            failed("wallgen none.ply --roughness 0.001", &["none.ply", "0 points", "at least 2"]),
            failed("wallgen one.xyz --roughness 0.001", &["one.xyz", "at least 2"]),
            failed(
                "wallgen same.xyz --roughness 0.001",
                &["same.xyz", "50 points", "same position", "bluenoise-sample"],
            ),
            failed(
                "wallgen mm.xyz --roughness 0.0001 --smallest-particle 0.01",
                &["mm.xyz", "the cloud is 19 m wide: is it in millimetres?"],
            ),
            failed("wallgen nan.xyz --roughness 0.001", &["nan.xyz", "point 400", "not finite"]),
            failed("wallgen line.xyz --roughness 0.02", &["roughness 0.02 m", "half", "0.01 m"]),
            failed(
                "wallgen good.ply --roughness 0.006",
                &["good.ply", "roughness 0.006 m", "half", "0.01 m"],
            ),
            failed(
                "cloud-crop good.ply --regions regions.toml",
                &["regions.toml: line 3", "'shap'", "'shape'"],
            ),
            failed("cloud-crop good.ply --regions good.xyz", &["good.xyz"]),
            failed("wallgen good.ply --roughness nowhere.toml", &["nowhere.toml: cannot read"]),
        ],
    );
}
