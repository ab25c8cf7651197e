//! The force on walls from what a run holds: contacts, or sums for whole walls.

use super::made::{Made, grain};
use super::{column, failed, measure, saved};
use grainpipe_tests::tools::succeed;
use std::fs;
use tempfile::{TempDir, tempdir};

/// Two walls at two times; no contacts.
fn whole_walls() -> TempDir {
    let mut made = Made::new("");
    made.json("/surfaces", 0.0, r#"[{"name": "floor"}, {"name": "lid"}]"#);
    for (time, push) in [(0.0, 2.0), (0.1, 4.0)] {
        made.frame(time, &[grain(0, [0.0, 0.0, 0.01], 0.01)]);
        let walls = format!(
            r#"{{"time": {time}, "walls": [{{"name": "floor", "force": [0.5, 0, -{push}], "shift": [0, 0, 0], "contacts": 3}},
                {{"name": "lid", "force": [0, 0, 1], "shift": [0, 0, 0.1], "contacts": 1}}]}}"#
        );
        made.json("/wall_forces", time, &walls);
    }
    saved(made)
}

#[test]
fn forces_on_whole_walls_serve_where_no_contacts_were_recorded() {
    let folder = whole_walls();
    let floor = measure(&folder, &["--wall-force", "all", "--wall", "floor", "--plot", "p.svg"]);
    assert_eq!((column(&floor, "fx"), column(&floor, "fz")), (vec![0.5, 0.5], vec![-2.0, -4.0]));
    assert_eq!((column(&floor, "time"), column(&floor, "contacts")), (vec![0.0, 0.1], vec![3.0, 3.0]));
    let lid = measure(&folder, &["--wall-force", "all", "--wall", "lid"]);
    assert_eq!((column(&floor, "shift_z"), column(&lid, "shift_z")), (vec![0.0; 2], vec![0.1; 2]));
    // What they do not tell is missing, not zero.
    for name in ["normal_sum", "sliding_work", "sliding_work_sum"] {
        assert!(column(&floor, name).iter().all(|v| v.is_nan()), "{name}");
    }
    for part in ["from forces on whole walls (/wall_forces)", "[output] contacts = true"] {
        assert!(floor.stderr.contains(part), "{part}: {}", floor.stderr);
    }
    let both = measure(&folder, &["--wall-force", "all", "--until", "0.05"]);
    assert_eq!((column(&both, "fz"), column(&both, "contacts")), (vec![-1.0], vec![4.0]));
    assert_eq!(column(&measure(&folder, &["--wall-force", "all", "--wall", "1"]), "fz"), [1.0, 1.0]);
}

#[test]
fn a_part_of_a_wall_needs_contacts() {
    let folder = whole_walls();
    let message = failed(&folder, &["--wall-force", "box:-1,-1,-1,1,1,1"]);
    for part in ["forces on whole walls only", "--wall-force all", "[output] contacts = true"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    let message = failed(&folder, &["--wall-force", "all", "--wall", "roof"]);
    assert!(message.contains("no material or wall 'roof'; there are floor, lid"), "{message}");
    let mut made = Made::new("");
    made.json("/wall_forces", 0.0, r#"{"time": 0, "walls": [{"name": "floor", "force": [0, 1]}]}"#);
    let message = failed(&saved(made), &["--wall-force", "all"]);
    assert!(message.contains("/wall_forces at 0 s: wall 0 has no force of three numbers"), "{message}");
}

/// A run that records both gives the same force either way.
#[test]
fn both_sources_agree_in_a_run() {
    let folder = tempdir().unwrap();
    let scene = |output: &str| {
        format!(
            "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.05\n[output]\nevery = 0.01\nprecision = \"f64\"\n{output}\
             [[material]]\nname = \"m\"\ndensity = 2500\nyoung = 1e6\npoisson = 0.3\n[[contact]]\n\
             between = [\"*\", \"*\"]\nrestitution = 0.5\nsliding_friction = 0.3\n[[fill]]\nmaterial = \"m\"\n\
             shape = \"box:0,0,0,0.05,0.05,0.06\"\ndiameter = 0.01\ncount = 60\n[[wall]]\nname = \"box\"\n\
             box = [0, 0, 0, 0.05, 0.05, 0.2]\nmaterial = \"m\"\n"
        )
    };
    let forces = |name: &str, output: &str| {
        fs::write(folder.path().join("scene.toml"), scene(output)).unwrap();
        succeed(folder.path(), "dem-run", &["scene.toml", "-o", "run.mcap"]);
        let done = measure(&folder, &["--wall-force", "all"]);
        assert!(done.stderr.contains(name), "{name}: {}", done.stderr);
        ["fx", "fy", "fz", "contacts"].map(|name| column(&done, name))
    };
    let of_contacts = forces("from recorded contacts", "contacts = true\nwall_forces = true\n");
    let of_walls = forces("from forces on whole walls", "wall_forces = true\n");
    let largest = of_walls[2].iter().copied().fold(0.0, |m: f64, f| m.max(f.abs()));
    assert!(largest > 0.0);
    for (a, b) in of_contacts.iter().flatten().zip(of_walls.iter().flatten()) {
        assert!((a - b).abs() <= 1e-9 * largest, "{a} {b}");
    }
}
