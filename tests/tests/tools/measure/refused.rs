//! What dem-measure cannot measure, and what it says.

use super::made::{Made, grain};
use super::{column, failed, one_frame, uniform_stream, with_contacts};
use grainpipe_tests::tools::tool;
use tempfile::{TempDir, tempdir};

#[test]
fn what_cannot_be_measured_is_refused_with_a_cure() {
    let folder = with_contacts();
    let some = one_frame("", &[grain(0, [0.0, 0.0, 0.01], 0.01)]);
    let none = tempdir().unwrap();
    Made::new("").save(&none.path().join("run.mcap"));
    let stream = tempdir().unwrap();
    uniform_stream(&stream);
    let cases: [(&TempDir, &[&str], &[&str]); 26] = [
        (&some, &["--energy"], &["run.mcap: --energy: run holds no energy ledger", "[output] energy = true"]),
        (&some, &["--forces"], &["run holds no contacts: set [output] contacts = true"]),
        (&some, &["--wall-force", "all"], &["run holds no contacts: set [output] contacts = true"]),
        (&some, &["--wear", "all"], &["run holds no contacts: set [output] contacts = true"]),
        (&none, &["--repose"], &["run holds no frames"]),
        (&none, &["--flow", "0,0,0,0,0,1"], &["run holds no frames"]),
        (&some, &["--flow", "0,0,0,0,0,1"], &["run has 1 frame:", "set [output] every"]),
        (&some, &["--residence", "all"], &["run has 1 frame:"]),
        (
            &stream,
            &["--flow", "0,0,5,0,0,1"],
            &["plane lies outside of the grains", "from -5.258 to -4.608 m", "move it"],
        ),
        (&some, &["--porosity", "box:0,0,0,1,1,0"], &["volume of 0 m³", "room inside"]),
        (&some, &["--porosity", "halfspace:0,0,0,0,0,1"], &["shape is infinite"]),
        (
            &some,
            &["--porosity", "box:5,5,5,6,6,6"],
            &["no grain in the shape", "box:-0.01,-0.01,0,0.01,0.01,0.02"],
        ),
        (&stream, &["--residence", "sphere:9,9,9,1"], &["no grain in the shape"]),
        (
            &folder,
            &["--wall-force", "box:5,5,5,6,6,6"],
            &["no contact with a wall in the shape", "move the shape"],
        ),
        (&folder, &["--wall-force", "all", "--wall", "roof"], &["no material or wall 'roof'", "floor, side"]),
        (&some, &["--profile", "--field", "heat"], &["no field 'heat' in /particles", "vx, vy, vz"]),
        (&some, &["--repose"], &["heap at 0 s", "profile bins", "smaller --bin"]),
        (
            &some,
            &["--repose", "--bin", "0.001"],
            &["bin = 0.001 m: give at least a quarter of a mean diameter"],
        ),
        (&some, &["--repose", "--sectors", "1"], &["sectors = 1: give 2 to 1000"]),
        (&some, &["--segregation"], &["frames hold at most 1 grains, and mixing needs 2"]),
        (&folder, &["--segregation", "--kind", "z"], &["no material or wall 'z'; there are a, b"]),
        (
            &some,
            &["--time", "-1", "--porosity", "sphere:0,0,0,1"],
            &["no frame at or before -1 s", "from 0 to 0 s"],
        ),
        (&some, &["--profile", "--sectors", "3"], &["--sectors: is an option of --repose"]),
        (
            &some,
            &["--energy", "--time", "1"],
            &["--time: --energy is measured over time", "--from and --until"],
        ),
        (&some, &["--contacts", "--plot", "x.pdf"], &["must end in .svg or .png"]),
        (&some, &[], &["--repose", "--porosity <SHAPE>"]),
    ];
    for (folder, arguments, parts) in cases {
        let message = failed(folder, arguments);
        assert!(message.starts_with("dem-measure: "), "{message}");
        for part in parts {
            assert!(message.contains(part), "{arguments:?}: {part} in {message}");
        }
    }
}

/// What was measured before the break is written, and the break is reported.
#[test]
fn a_broken_run_is_measured_as_far_as_it_goes() {
    let folder = tempdir().unwrap();
    uniform_stream(&folder);
    let path = folder.path().join("run.mcap");
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 40]).unwrap();
    let done = tool(folder.path(), "dem-measure", &["run.mcap", "--flow", "0,0,0,0,0,-1"]);
    assert_eq!(done.code, 1);
    assert!(done.stderr.contains("truncated") && column(&done, "forward").len() == 10, "{}", done.stderr);
}
