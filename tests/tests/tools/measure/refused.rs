//! What dem-measure cannot measure, and what it says.

use super::flow::uniform_stream;
use super::made::{Made, grain};
use super::{column, failed, one_frame, saved, with_contacts};
use grainpipe_tests::tools::tool;
use tempfile::{TempDir, tempdir};

struct Case {
    arguments: &'static [&'static str],
    /// What stderr must say.
    parts: &'static [&'static str],
}

/// Of one particle at time 0, without contacts.
const OF_ONE_FRAME: &[Case] = &[
    Case {
        arguments: &["--energy"],
        parts: &["run.mcap: --energy: run holds no energy ledger", "[output] energy = true"],
    },
    Case { arguments: &["--bonds"], parts: &["run holds no bonds", "[[bond]]"] },
    Case { arguments: &["--forces"], parts: &["run holds no contacts: set [output] contacts = true"] },
    Case {
        arguments: &["--wall-force", "all"],
        parts: &["run holds no forces on walls: set [output] wall_forces = true"],
    },
    Case {
        arguments: &["--wear", "all"],
        parts: &["run holds no wear of walls: set [output] wear = true, or contacts = true and give --cell"],
    },
    Case { arguments: &["--flow", "0,0,0,0,0,1"], parts: &["run has 1 frame:", "set [output] every"] },
    Case { arguments: &["--residence", "all"], parts: &["run has 1 frame:"] },
    Case { arguments: &["--porosity", "box:0,0,0,1,1,0"], parts: &["volume of 0 m³", "larger shape"] },
    Case { arguments: &["--porosity", "halfspace:0,0,0,0,0,1"], parts: &["shape is infinite"] },
    Case {
        arguments: &["--porosity", "box:5,5,5,6,6,6"],
        parts: &["no grain in the shape", "box:-0.01,-0.01,0,0.01,0.01,0.02"],
    },
    Case {
        arguments: &["--profile", "--field", "heat"],
        parts: &["no field 'heat' in /particles", "vx, vy, vz"],
    },
    Case {
        arguments: &["--repose", "--within", "box:5,5,5,6,6,6"],
        parts: &["no grain in the shape", "move the shape"],
    },
    Case { arguments: &["--repose"], parts: &["heap at 0 s", "profile bins", "smaller --bin"] },
    Case {
        arguments: &["--repose", "--bin", "0.001"],
        parts: &["bin = 0.001 m: give at least a quarter of a mean diameter"],
    },
    Case {
        arguments: &["--profile", "--bins", "4294967296,4294967296,1"],
        parts: &["cells are more than", "fewer bins"],
    },
    Case { arguments: &["--repose", "--sectors", "1"], parts: &["sectors = 1: give 2 to 1000"] },
    Case { arguments: &["--segregation"], parts: &["frames hold at most 1 grains, and mixing needs 2"] },
    Case {
        arguments: &["--time", "-1", "--porosity", "sphere:0,0,0,1"],
        parts: &["no frame at -1 s", "from 0 to 0 s"],
    },
    Case { arguments: &["--profile", "--turn-deg", "y,0"], parts: &["--turn-deg", "such as y,30"] },
    Case {
        arguments: &["--contacts", "--turn-deg", "y,3"],
        parts: &["--turn-deg: is an option of --profile"],
    },
    Case { arguments: &["--profile", "--sectors", "3"], parts: &["--sectors: is an option of --repose"] },
    Case {
        arguments: &["--energy", "--time", "1"],
        parts: &["--time: --energy is measured over time", "--from and --until"],
    },
    Case { arguments: &["--contacts", "--plot", "x.pdf"], parts: &["must end in .svg or .png"] },
    Case { arguments: &[], parts: &["--repose", "--porosity <SHAPE>"] },
];

/// Of a run that ended before its first frame.
const OF_NO_FRAME: &[Case] = &[
    Case { arguments: &["--repose"], parts: &["run holds no frames"] },
    Case { arguments: &["--flow", "0,0,0,0,0,1"], parts: &["run holds no frames"] },
];

/// Of a uniform stream.
const OF_A_STREAM: &[Case] = &[
    Case { arguments: &["--residence", "sphere:9,9,9,1"], parts: &["no grain in the shape"] },
    Case {
        arguments: &["--flow", "0,0,0,0,0,-1", "--span", "1e-9"],
        parts: &["spans of 1e-9 s", "give a --span of at least"],
    },
];

/// Of particles in contact with each other and with walls.
const OF_CONTACTS: &[Case] = &[
    Case {
        arguments: &["--wall-force", "box:5,5,5,6,6,6"],
        parts: &["no contact with a wall in the shape", "move the shape"],
    },
    Case {
        arguments: &["--wall-force", "all", "--wall", "roof"],
        parts: &["--wall: no wall 'roof' in this run", "0 floor, 1 side: give one of these"],
    },
    Case {
        arguments: &["--segregation", "--kind", "a", "--cell", "1e-300"],
        parts: &["cell = 1e-300 m", "give a longer side"],
    },
    Case {
        arguments: &["--segregation", "--kind", "z"],
        parts: &["no material 'z'; there are a, b: give one of these names"],
    },
];

fn refuses(folder: &TempDir, cases: &[Case]) {
    for Case { arguments, parts } in cases {
        let message = failed(folder, arguments);
        assert!(message.starts_with("dem-measure: "), "{message}");
        for part in *parts {
            assert!(message.contains(part), "{arguments:?}: {part} in {message}");
        }
    }
}

#[test]
fn what_cannot_be_measured_is_refused_with_a_cure() {
    refuses(&one_frame("", &[grain(0, [0.0, 0.0, 0.01], 0.01)]), OF_ONE_FRAME);
    refuses(&saved(Made::new("")), OF_NO_FRAME);
    let stream = tempdir().unwrap();
    uniform_stream(&stream);
    refuses(&stream, OF_A_STREAM);
    refuses(&with_contacts(), OF_CONTACTS);
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
