//! The tool as a user meets it.

use std::io::Write;
use std::process::{Command, Output, Stdio};

const CHUTE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../sample-data/chute/chute.ply");

fn crop(args: &[&str], stdin: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_cloud-crop"))
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut to = child.stdin.take().unwrap();
    let bytes = stdin.to_vec();
    let writer = std::thread::spawn(move || {
        // A tool that refuses its arguments does not read.
        let _ = to.write_all(&bytes);
    });
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    output
}

#[test]
fn the_mounting_end_goes_and_a_pipe_gives_the_same_bytes() {
    let remove = ["--remove", "halfspace:0,0,0,-0.766,0,0.643"];
    let from_file = crop(&[&[CHUTE][..], &remove[..]].concat(), b"");
    assert_eq!(from_file.status.code(), Some(0));
    let from_pipe = crop(&[&["-"][..], &remove[..]].concat(), &std::fs::read(CHUTE).unwrap());
    assert!(from_file.stdout == from_pipe.stdout);
    let cloud = cloud::from_bytes(from_file.stdout).unwrap();
    assert!(cloud.points.iter().all(|p| 0.766 * p.x > 0.643 * p.z) && cloud.points.len() > 64_000);
    assert!(cloud.attributes.get("intensity").is_some());
    let kept = crop(&[CHUTE, "--keep", "!halfspace:0,0,0,-0.766,0,0.643", "-q"], b"");
    assert!(kept.stdout == from_pipe.stdout && kept.stderr.is_empty());
}

#[test]
fn regions_largest_part_and_outliers() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plant.toml");
    std::fs::write(
        &file,
        "[[region]]\nname = \"mounting\"\nshape = \"halfspace:0,0,0,-0.766,0,0.643\"\naction = \"remove\"\n",
    )
    .unwrap();
    let regions = crop(&[CHUTE, "--regions", file.to_str().unwrap()], b"");
    let count = |output: &Output| cloud::from_bytes(output.stdout.clone()).unwrap().points.len();
    let all = count(&regions);
    assert!((64_000..68_000).contains(&all));
    let parts = "0 0 0\n0 0 1\n0 1 0\n9 9 9\n9 9 8\n";
    assert_eq!(count(&crop(&["-", "--largest", "1.2"], parts.as_bytes())), 3);
    let lone = crop(&[CHUTE, "--outliers", "8,20"], b"");
    assert!((74_900..=75_000).contains(&count(&lone)));
}

#[test]
fn wrong_use_and_wrong_input_say_what_and_where() {
    for (args, stdin, code, part) in [
        (vec!["-", "--keep", "ball:1,2,3,4"], "1 2 3\n", 2, "is no shape"),
        (vec!["-", "--keep", "sphere:0,0,x,4"], "1 2 3\n", 2, "'x' at character 12"),
        (vec!["-", "--largest", "0"], "1 2 3\n", 2, "largest"),
        (vec!["-", "--outliers", "3"], "1 2 3\n", 2, "K,SIGMA"),
        (vec!["-", "--regions", "/nowhere.toml"], "1 2 3\n", 1, "/nowhere.toml"),
        (vec!["/nowhere.ply"], "", 1, "/nowhere.ply"),
        (vec!["-"], "", 1, "nothing to read"),
        (vec!["-"], "1 2 3\n1 2\n", 1, "line 2"),
    ] {
        let output = crop(&args, stdin.as_bytes());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {said}");
        assert!(said.contains(part) && output.stdout.is_empty(), "{args:?}: {said}");
    }
}
