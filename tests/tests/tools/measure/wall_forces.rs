//! The force on walls from what a run holds: contacts, or sums for whole walls.

use super::made::{Made, grain};
use super::{column, failed, measure, saved, sum};
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
    assert!(message.contains("--wall: no wall 'roof' in this run; by number and name there are 0 floor, 1 lid: give one of these"), "{message}");
    let mut made = Made::new("");
    made.json("/wall_forces", 0.0, r#"{"time": 0, "walls": [{"name": "floor", "force": [0, 1]}]}"#);
    let message = failed(&saved(made), &["--wall-force", "all"]);
    assert!(message.contains("/wall_forces at 0 s: wall 0 has no force of three numbers"), "{message}");
}

/// Grains that tumble in a box: means over all steps of seldom frames are those of the contacts of every step, and the work is that of the contacts.
#[test]
fn means_of_seldom_frames_are_those_of_every_step() {
    let folder = tempdir().unwrap();
    let scene = "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.05\ndt = 5e-5\n[[material]]\nname = \"m\"\ndensity = 2500\n\
        young = 1e6\npoisson = 0.3\n[[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\nsliding_friction = 0.3\n\
        [[fill]]\nmaterial = \"m\"\nshape = \"box:0,0,0.004,0.05,0.05,0.07\"\ndiameter = 0.01\ncount = 60\n\
        [[wall]]\nname = \"box\"\nbox = [0, 0, 0, 0.05, 0.05, 0.2]\nmaterial = \"m\"\n\
        [[wall]]\nname = \"tile\"\nmesh = \"tile.ply\"\nmaterial = \"m\"\nmotion = { translate = [0.2, 0, 0] }\n";
    let tile = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0.001\n0.05 0 0.001\n0 0.05 0.001\n3 0 1 2\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    fs::write(folder.path().join("tile.ply"), tile).unwrap();
    let summary = |sets: &[&str], measure_of: &[&str], name: &str| {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let arguments: Vec<&str> = ["scene.toml", "-o", "run.mcap"].into_iter().chain(sets).collect();
        succeed(folder.path(), "dem-run", &arguments);
        let values: Vec<f64> = ["mean_fx", "mean_fz", "largest_force", "sliding_work"]
            .iter()
            .map(|value| sum(&folder, measure_of, value))
            .collect();
        let said = measure(&folder, measure_of).stderr;
        assert!(said.contains(name), "{name}: {said}");
        values
    };
    let all = ["--wall-force", "all", "--wall", "tile"];
    let every_step =
        summary(&["output.contacts=true", "output.every=step"], &all, "from recorded contacts: forces are");
    let seldom = summary(
        &["output.every=0.025", "output.energy=true", "output.wall_forces=true"],
        &all,
        "sums over every step",
    );
    let (push, pull) = (every_step[1], every_step[0]);
    // The first and the last instant count half, or whole.
    assert!(push < 0.0 && (seldom[1] / push - 1.0).abs() < 2e-3, "{seldom:?} {every_step:?}");
    assert!((seldom[0] - pull).abs() < 2e-3 * push.abs(), "{seldom:?} {every_step:?}");
    for k in [2, 3] {
        assert!((seldom[k] / every_step[k] - 1.0).abs() < 1e-9, "{seldom:?} {every_step:?}");
    }
    // Of a curve over the way of a wall, forces are those of frames, as recorded contacts tell them.
    let instants = |sets: &[&str], name: &str| {
        let curve = [&all[..], &["--instants"]].concat();
        let all = [sets, &["output.every=0.0125", "time.until=0.045"]].concat();
        let mean = summary(&all, &curve, name);
        (mean, column(&measure(&folder, &curve), "fz"))
    };
    let of_walls = instants(&["output.wall_forces=true"], "at the instants of frames");
    let of_contacts = instants(&["output.contacts=true"], "from recorded contacts: forces are");
    assert!(of_walls.1.len() > 3 && of_walls.1.iter().any(|fz| *fz < 0.0), "{of_walls:?}");
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * push.abs();
    assert!(of_walls.1.iter().zip(&of_contacts.1).all(near), "{of_walls:?} {of_contacts:?}");
    // The map of the tile is one of its triangle, where its file has it.
    summary(&["output.every=0.025", "output.wear=true"], &all, "sums over every step");
    let wear = measure(&folder, &["--wear", "all", "--wall", "tile"]);
    let place = ["x", "y", "z"].map(|axis| column(&wear, axis)[0]);
    assert!((place[0] - 0.05 / 3.0).abs() < 1e-12 && (place[2] - 0.001).abs() < 1e-12, "{place:?}");
    let (work, area) = (column(&wear, "sliding_work"), 0.5 * 0.05 * 0.05);
    assert!((work[0] / every_step[3] - 1.0).abs() < 1e-9 && work.len() == 1, "{work:?}");
    assert!((column(&wear, "work_per_area")[0] * area / work[0] - 1.0).abs() < 1e-9);
    assert!(column(&wear, "impacts")[0] > 0.0);
    // Of cubes, too, it is one of the body.
    let cells = summary(
        &["output.every=0.025", "output.contacts=true"],
        &["--wear", "all", "--wall", "tile", "--cell", "0.06"],
        "sliding_work",
    );
    assert!((cells[3] / every_step[3] - 1.0).abs() < 1e-9, "{cells:?}");
}
