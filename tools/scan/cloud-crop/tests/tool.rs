//! The tool as a user meets it.

use std::io::Write;
use std::process::{Command, Output, Stdio};

const CHUTE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../sample-data/chute/chute.ply");

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
        (vec!["-", "--keep", "ball:1,2,3,4"], "1 2 3\n", 2, "is not a shape"),
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

/// The scan of the chute, and its hull as a tube with a cone at its end; what is beyond it is the mounting.
#[test]
fn a_part_beyond_the_outer_shape_is_found_and_removed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plant.toml");
    let region = |name: &str, shape: &str, action: &str| {
        format!("[[region]]\nname = \"{name}\"\nshape = \"{shape}\"\naction = \"{action}\"\n")
    };
    let hull = region("hull", "halfspace:0,0,0,0.766,0,-0.643", "outer");
    let bolt = region("bolt", "sphere:9,9,9,0.1", "remove");
    std::fs::write(&file, format!("tolerance = 0.01\n{hull}{bolt}")).unwrap();
    let regions = ["--regions", file.to_str().unwrap()];
    let check = crop(&[&[CHUTE, "--check"][..], &regions[..]].concat(), b"");
    let said = String::from_utf8_lossy(&check.stderr).into_owned();
    assert_eq!(check.status.code(), Some(3), "{said}");
    assert!(said.contains("beyond the outer shape") && said.contains("'bolt' contains no point"), "{said}");
    let table = String::from_utf8(check.stdout).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert!(rows[0] == "part,points,x0,y0,z0,x1,y1,z1,beyond" && rows.len() >= 2, "{table}");
    let points: usize = rows[1].split(',').nth(1).unwrap().parse().unwrap();
    assert!(points > 5000, "{table}");
    let done = crop(&[&[CHUTE][..], &regions[..]].concat(), b"");
    assert_eq!(done.status.code(), Some(0));
    let kept = cloud::from_bytes(done.stdout).unwrap();
    assert!(kept.points.len() <= 75_000 - points);
    assert!(kept.points.iter().all(|p| 0.766 * p.x - 0.643 * p.z > -0.0101));
    // What is left passes.
    std::fs::write(folder.path().join("kept.ply"), {
        let mut bytes = Vec::new();
        cloud::write_ply(&mut bytes, &kept, Default::default()).unwrap();
        bytes
    })
    .unwrap();
    let again = folder.path().join("kept.ply");
    let check = crop(&[&[again.to_str().unwrap(), "--check"][..], &regions[..]].concat(), b"");
    assert_eq!(check.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&check.stdout).lines().count(), 1);
    for words in [&["--check"][..], &["--tolerance", "0.1"], &["--outer", "!sphere:0,0,0,1"]] {
        assert_eq!(crop(&[&[CHUTE][..], words].concat(), b"").status.code(), Some(2), "{words:?}");
    }
}

#[test]
fn a_scan_in_millimetres_is_told_and_scaled() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mm.xyz");
    let row = |k: u32| format!("{}.125 {} {}\n", 4 * (k % 50), 4 * (k / 50), k % 3);
    std::fs::write(&file, (0..2500).map(row).collect::<String>()).unwrap();
    let file = file.to_str().unwrap();
    let plain = crop(&[file], b"");
    let said = String::from_utf8_lossy(&plain.stderr).into_owned();
    assert!(plain.status.code() == Some(0) && said.contains("--scale 0.001"), "{said}");
    for (factor, x) in [("0.001", 4.125 * 0.001), ("1", 4.125)] {
        let scaled = crop(&[file, "--scale", factor], b"");
        assert!(!String::from_utf8_lossy(&scaled.stderr).contains("warning"));
        assert_eq!(cloud::from_bytes(scaled.stdout).unwrap().points[1].x, x);
    }
    assert_eq!(crop(&[file, "--scale", "-1"], b"").status.code(), Some(2));
}

/// A mesh is read before the threads start: the points inside it stay, for any number of threads.
#[test]
fn a_closed_mesh_is_a_region() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("tetrahedron.ply");
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    let corners = "-9 -9 -0.2\n9 -9 -0.2\n0 9 -0.2\n0 0 0.3\n";
    let faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    std::fs::write(&mesh, [header, corners, faces].concat()).unwrap();
    let keep = format!("mesh:{}", mesh.display());
    let kept = crop(&[CHUTE, "--keep", &keep], b"");
    assert_eq!(kept.status.code(), Some(0), "{}", String::from_utf8_lossy(&kept.stderr));
    let removed = crop(&[CHUTE, "--remove", &keep, "--threads", "2"], b"");
    let count = |output: Output| cloud::from_bytes(output.stdout).unwrap().points.len();
    let all = cloud::from_bytes(std::fs::read(CHUTE).unwrap()).unwrap().points.len();
    let (kept, removed) = (count(kept), count(removed));
    assert!(kept > 0 && removed > 0 && kept + removed == all, "{kept} + {removed} of {all}");
}

/// Of several clouds only those of text get the names of `--columns`; names that none of them takes are refused.
#[test]
fn names_of_columns_are_for_those_clouds_that_are_text() {
    let folder = tempfile::tempdir().unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
    let files = [("a.ply", ply), ("b.xyz", "P1 4 5 6\n"), ("c.ply", ply)].map(|(name, text)| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    });
    let [a, b, c] = files.each_ref().map(String::as_str);
    for clouds in [[a, b], [b, a]] {
        let done = crop(&[&clouds[..], &["--columns", "-,x,y,z"]].concat(), b"");
        let told = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(0), "{told}");
        let mut x: Vec<f64> = cloud::from_bytes(done.stdout).unwrap().points.iter().map(|p| p.x).collect();
        x.sort_by(f64::total_cmp);
        assert_eq!(x, [1.0, 4.0]);
    }
    let none = crop(&[a, c, "--columns", "-,x,y,z"], b"");
    let told = String::from_utf8_lossy(&none.stderr).into_owned();
    assert!(none.status.code() == Some(2) && told.contains("no cloud is text: leave it out"), "{told}");
}
