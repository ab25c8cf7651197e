//! Rates and forces through a plane.

use super::*;

/// Layers of four grains, 10 mm apart, that fall at 2 m/s: 800 grains a second, 8 in every 10 ms.
pub fn uniform_stream(folder: &TempDir) {
    let mut made = Made::new("");
    for frame in 0..11 {
        let time = f64::from(frame) * 0.013;
        let at = |id: u32| {
            let (layer, corner) = (f64::from(id / 4), id % 4);
            let place = [
                f64::from(corner / 2) * 0.01,
                f64::from(corner % 2) * 0.01,
                0.002 + layer * 0.01 - 2.0 * time,
            ];
            Grain { velocity: Vec3::new(0.0, 0.0, -2.0), ..grain(id, place, 0.004) }
        };
        let grains: Vec<Grain> = (0..160).map(at).collect();
        made.frame(time, &grains);
    }
    made.save(&folder.path().join("run.mcap"));
}

#[test]
fn a_uniform_stream_flows_evenly_between_frames_too() {
    let folder = tempdir().unwrap();
    uniform_stream(&folder);
    let done = measure(&folder, &["--flow", "0,0,0,0,0,-1", "--span", "0.01"]);
    assert_eq!(column(&done, "forward"), vec![8.0; 13]);
    let mass = 4.0 / 3.0 * PI * 0.004f64.powi(3) * 2500.0;
    for flow in column(&done, "mass_flow") {
        assert!((flow / (800.0 * mass) - 1.0).abs() < 1e-9, "{flow}");
    }
    // Against the normal, and in half of the stream only.
    let back = measure(&folder, &["--flow", "0,0,0,0,0,1", "--within", "box:-1,-1,-1,0.005,1,1"]);
    assert_eq!(column(&back, "forward").iter().sum::<f64>(), 0.0);
    assert_eq!(column(&back, "backward").iter().sum::<f64>(), 52.0);
}

/// What nothing has reached yet lets nothing through: that is an answer, and the notes say how far away the grains are.
#[test]
fn a_plane_that_no_grain_has_reached_has_no_flow() {
    let folder = tempdir().unwrap();
    uniform_stream(&folder);
    let done = measure(&folder, &["--flow", "0,0,5,0,0,1"]);
    assert!(column(&done, "mass_flow").iter().all(|flow| *flow == 0.0));
    assert!(
        done.stderr.contains("no grain comes to the plane: they are from -5.258 to -4.608 m"),
        "{}",
        done.stderr
    );
}

/// A grain that goes from x = 0.95 m through the face at 1 m to 0.05 m passes what lies between, on both sides of the face.
#[test]
fn a_periodic_face_is_no_way_back() {
    let at = |x: f64| Grain { velocity: Vec3::x(), ..grain(0, [x, 0.5, 0.5], 0.01) };
    // Corners of the domain may have units.
    for corners in
        ["low = [0, 0, 0]\nhigh = [1, 1, 1]", "low = [0, \"0 mm\", 0]\nhigh = [\"1000 mm\", \"100 cm\", 1]"]
    {
        let mut made = Made::new(&format!("[domain]\nperiodic = [\"x\"]\n{corners}\n"));
        made.frame(0.0, &[at(0.95)]).frame(0.1, &[at(0.05)]);
        let folder = saved(made);
        for (x, passes) in [("0.98", 1.0), ("0", 1.0), ("0.03", 1.0), ("0.5", 0.0), ("0.07", 0.0)] {
            let done = measure(&folder, &["--flow", &format!("{x},0,0,1,0,0")]);
            assert_eq!((column(&done, "forward")[0], column(&done, "backward")[0]), (passes, 0.0), "x = {x}");
        }
    }
}

/// A grain that falls through a plane and drifts through a periodic face meanwhile passes once, wherever the face is passed.
#[test]
fn a_grain_passes_once_also_while_it_drifts_through_a_periodic_face() {
    for start in [0.99, 0.97, 0.93] {
        let at =
            |x: f64, z: f64| Grain { velocity: Vec3::new(1.0, 0.0, -1.0), ..grain(0, [x, 0.5, z], 0.01) };
        let mut made = Made::new("[domain]\nperiodic = [\"x\"]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\n");
        made.frame(0.0, &[at(start, 0.55)]).frame(0.1, &[at(start - 0.9, 0.45)]);
        let done = measure(&saved(made), &["--flow", "0,0,0.5,0,0,-1"]);
        assert_eq!(
            (column(&done, "forward")[0], column(&done, "backward")[0]),
            (1.0, 0.0),
            "from x = {start}"
        );
    }
}

/// Three grains on a floor: what goes through a plane is the weight above it, whichever of a pair the run calls i.
#[test]
fn the_force_through_a_plane_is_what_stands_before_it() {
    let grains = at_rest([[0.0, 0.0, 0.01], [0.0, 0.0, 0.03], [0.0, 0.0, 0.05]], 0.01);
    let touch = |i, j, wall, z, f: [f64; 3]| (i, j, wall, [0.0, 0.0, z], [0.0, 0.0, f[2].signum()], f, 0.0);
    let mut made = Made::new("");
    made.frame(0.0, &grains).contacts(
        0.0,
        &[
            touch(0, 0, true, 0.0, [0.0, 0.0, 3.0]),
            touch(0, 1, false, 0.02, [0.5, 0.0, -2.0]),
            touch(2, 1, false, 0.04, [0.0, 0.0, 1.0]),
        ],
    );
    let folder = saved(made);
    for (z, normal, shear) in [("0.02", 2.0, 0.5), ("0.04", 1.0, 0.0), ("0.005", 0.0, 0.0)] {
        let done = measure(&folder, &["--plane-force", &format!("0,0,{z},0,0,-1")]);
        assert_eq!((column(&done, "normal")[0], column(&done, "shear")[0]), (normal, shear), "z = {z}");
        let back = measure(&folder, &["--plane-force", &format!("0,0,{z},0,0,1")]);
        assert_eq!(column(&back, "normal")[0], normal, "the other side presses as much, z = {z}");
    }
}

/// Grains that are taken out, or come in, within the interval in which they pass cannot be seen to pass.
#[test]
fn grains_that_vanish_at_the_plane_are_told() {
    let falling = |id, z| Grain { velocity: Vec3::new(0.0, 0.0, -1.0), ..grain(id, [0.0, 0.0, z], 0.001) };
    let mut made = Made::new("");
    made.frame(0.0, &[falling(0, 0.01), falling(1, 0.05), falling(2, 0.015)]);
    made.frame(0.02, &[falling(2, -0.005), falling(3, -0.01), falling(4, -0.05)]);
    let folder = saved(made);
    let done = measure(&folder, &["--flow", "0,0,0,0,0,-1"]);
    assert_eq!(column(&done, "forward"), [1.0]);
    assert!(done.stderr.contains("2 grains near the plane vanished or appeared"), "{}", done.stderr);
}

#[test]
fn recorded_crossings_are_counted_where_an_outlet_lies_in_the_plane() {
    let mut made = Made::new("");
    let outlet = r#"{"plane": {"point": [0, 0, 0], "normal": [0, 0, -1]}, "length": 0.1}"#;
    made.record("outlets", &[("0", outlet)]);
    made.frame(0.0, &[grain(9, [0.0, 0.0, 0.01], 0.01)]);
    made.passages(0.1, &[(0.02, 1), (0.06, 2), (0.09, 3)]).frame(0.1, &[]);
    made.passages(0.2, &[(0.15, 4)]).frame(0.2, &[]);
    let folder = saved(made);
    let done = measure(&folder, &["--flow", "5,5,0,0,0,-2"]);
    assert_eq!(column(&done, "forward"), [3.0, 1.0]);
    assert!(done.stderr.contains("from recorded crossings"), "{}", done.stderr);
    let done = measure(&folder, &["--flow", "0,0,0,0,0,1", "--span", "0.05"]);
    assert_eq!(column(&done, "backward"), [1.0, 2.0, 1.0, 0.0]);
}
