//! Bonds of beams on both engines, where LAMMPS has the package BPM: two grains that stretch, shear, bend and twist their bond, and a beam of grains.

use crate::refusal;
use grainpipe_tests::engines::{R, S, both_with};
use grainpipe_tests::recorded::{column, frames, tables};
use grainpipe_tests::scenes::{folder, write};
use grainpipe_tests::tools::succeed;
use std::process::Command;
use stream::Table;
use tempfile::TempDir;

/// A LAMMPS that has bonds: `GRAINPIPE_LMP_BPM`, or `lmp`; where it has none, the test is counted as skipped.
pub fn bpm() -> Option<String> {
    let named = std::env::var("GRAINPIPE_LMP_BPM").unwrap_or_else(|_| "lmp".into());
    let done = Command::new(&named).arg("-h").output();
    let found = done.is_ok_and(|done| String::from_utf8_lossy(&done.stdout).contains("bpm/rotational"));
    if !found {
        grainpipe_tests::skip("lmp with BPM (GRAINPIPE_LMP_BPM)");
    }
    found.then_some(named)
}

pub fn scene(time: f64, steps: f64, bond: &str) -> String {
    let (dt, every) = (time / steps, time / 50.0);
    format!(
        "gravity = [0, 0, 0]\n[time]\nuntil = {time:?}\ndt = {dt:?}\n[output]\nevery = {every:?}\n[[material]]\nname = \"glass\"\n\
         density = 2500\nyoung = 1e7\npoisson = 0.25\n[[contact]]\nbetween = [\"*\", \"*\"]\nlaw = \"hooke\"\nstiffness = 1e4\nrestitution = 1\n\
         [[bond]]\nbetween = [\"glass\", \"glass\"]\ngap = 1e-3\nyoung = 1e8\npoisson = 0.25\n{bond}\n\
         [[particles]]\nsource = \"grains.csv\"\nmaterial = \"glass\"\n"
    )
}

/// A folder with two grains of two sizes along a skew line, with these velocities and spins of the first one.
pub fn two_grains(v: [f64; 3], w: [f64; 3], bond: &str) -> TempDir {
    let reach = R + S + 5e-4;
    let [x, y, z] = [2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0].map(|part| part * reach);
    let rows = [
        [x, y, z, R, v[0], v[1], v[2], w[0], w[1], w[2]],
        [0.0, 0.0, 0.0, S, 0.0, 0.0, 0.0, -0.5 * w[0], 0.2 * w[1], 0.0],
    ];
    let lines: String = rows.iter().map(|r| r.map(|v| format!("{v:?}")).join(",") + "\n").collect();
    let head = "x,y,z,radius,vx,vy,vz,wx,wy,wz\n".to_owned();
    folder(&[("s.toml", scene(2e-3, 2e5, bond)), ("grains.csv", head + &lines)])
}

/// Largest difference of velocities over the largest velocity.
pub fn difference([ours, theirs]: &[Vec<Table>; 2]) -> f64 {
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for (a, b) in ours.iter().zip(theirs) {
        for (name, arm) in [("vx", 1.0), ("vy", 1.0), ("vz", 1.0), ("wx", R), ("wy", R), ("wz", R)] {
            for (p, q) in column(a, name).into_iter().zip(column(b, name)) {
                worst = worst.max((p - q).abs() * arm);
                largest = largest.max(p.abs() * arm);
            }
        }
    }
    worst / largest
}

/// Largest difference of columns of a topic over the largest value of any of them.
pub fn off_by([ours, theirs]: &[Vec<Table>; 2], names: &[&str]) -> f64 {
    assert_eq!(ours.len(), theirs.len());
    let (mut worst, mut largest) = (0.0f64, f64::MIN_POSITIVE);
    for (name, (a, b)) in names.iter().flat_map(|name| ours.iter().zip(theirs).map(move |of| (name, of))) {
        let [a, b] = [a, b].map(|t| t.get(name).unwrap_or_else(|| panic!("no column {name}")).to_f64());
        assert_eq!(a.len(), b.len(), "{name}");
        for (p, q) in a.into_iter().zip(b).filter(|(p, _)| p.is_finite()) {
            (worst, largest) = (worst.max((p - q).abs()), largest.max(p.abs()));
        }
    }
    worst / largest
}

/// Small motions: stretching, shear with bending, bending, and twisting, each alone; all at once with dashpots; beside a contact.
#[test]
fn small_motions_of_a_bond_agree() {
    let Some(lmp) = bpm() else { return };
    let along = [0.02, 0.01, 0.02];
    let across = [0.01, -0.02, 0.0];
    let (axis, side) = ([2.0, 1.0, 2.0], [1.0, -2.0, 0.0]);
    let still = [0.0; 3];
    let alone = "replaces_contact = true";
    let damped = "replaces_contact = true\ndamping = 0.1";
    for (what, v, w, bond) in [
        ("stretching", along, still, alone),
        ("shear", across, still, alone),
        ("bending", still, side, alone),
        ("twisting", still, axis, alone),
        ("stretching, damped", along, still, damped),
        ("shear, damped", across, still, damped),
        ("bending, damped", still, side, damped),
        ("twisting, damped", still, axis, damped),
        ("beside a contact", across, axis, ""),
    ] {
        let off = difference(&both_with(two_grains(v, w, bond).path(), &lmp, &[]));
        println!("{what}: {off:.1e}");
        assert!(off < 3e-4, "{what}: {off:e}");
    }
}

/// A bar of twelve grains that swings free, with a contact law beside its bonds, and the same run from a state in its midst.
#[test]
fn a_bar_swings_as_in_dem_run_and_goes_on_from_a_state() {
    let Some(lmp) = bpm() else { return };
    let rows: String = (0..12)
        .map(|k| {
            let along = f64::from(k) / 11.0 - 0.5;
            let (x, v) = (0.006 * f64::from(k), 0.4 * along * along - 0.03);
            format!("{x:?},0,0,0.003,0,{v:?},{:?},{:?},0,0\n", 0.3 * v, 10.0 * along)
        })
        .collect();
    let bar = scene(0.02, 1e5, "damping = 0.05").replace("[output]", "[output]\ncheckpoint = 3e-3");
    let grains = "x,y,z,radius,vx,vy,vz,wx,wy,wz\n".to_owned() + &rows;
    let folder = folder(&[("s.toml", bar), ("grains.csv", grains)]);
    let path = folder.path();
    let [ours, theirs] = both_with(path, &lmp, &[]);
    let worst = |a: &[Table], b: &[Table], name: &str| {
        let of = |(a, b): (&Table, &Table)| {
            let pairs = column(a, name).into_iter().zip(column(b, name));
            pairs.map(|(p, q)| (p - q).abs()).fold(0.0, f64::max)
        };
        a.iter().zip(b).map(of).fold(0.0, f64::max)
    };
    let swing = ours.iter().flat_map(|frame| column(frame, "y")).fold(0.0, |a: f64, y| a.max(y.abs()));
    let off = worst(&ours, &theirs, "y") / swing;
    println!("a bar swings by {swing:.1e} m: {off:.1e} of it");
    assert!(swing > 1e-5 && off < 1e-4, "{off:e}");
    let bonds = ["ours.mcap", "theirs.mcap"].map(|run| tables(&path.join(run), "/bonds"));
    // Both dashpots differ in the fast motions of the first frames.
    for (names, most) in [
        (&["fx", "fy", "fz"][..], 2e-2),
        (&["mx_i", "my_i", "mz_i", "mx_j", "my_j", "mz_j"], 3e-3),
        (&["tension", "shear"], 3e-3),
        (&["x", "y", "z"], 1e-8),
    ] {
        let off = off_by(&bonds, names);
        println!("bonds, {}: {off:.1e} of the largest", names[0]);
        assert!(off < most, "{names:?}: {off:e}");
    }
    for name in ["id_i", "id_j", "broken", "mode"] {
        assert!(off_by(&bonds, &[name]) == 0.0, "{name}");
    }
    succeed(path, "dem-lammps", &["s.toml", "--write-deck", "deck", "--lmp", &lmp, "-q"]);
    let lammps = |options: &[&str]| {
        let mut lammps = Command::new(&lmp);
        lammps.args(["-in", "run.in", "-log", "none"]).args(options).current_dir(path.join("deck"));
        let done = lammps.output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout));
    };
    lammps(&[]);
    lammps(&["-var", "state", "state_1", "-var", "frames", "frames-2.dump", "-var", "bonds", "bonds-2.dump"]);
    let read = [
        "s.toml",
        "--read-dump",
        "deck/frames.dump",
        "--set",
        "time.contacts=sampled",
        "-q",
        "-o",
        "again.mcap",
    ];
    succeed(path, "dem-lammps", &read);
    let again = frames(&path.join("again.mcap"));
    assert_eq!(again.len(), theirs.len());
    for name in ["x", "y", "z", "vx", "vy", "vz"] {
        let off = worst(&again, &theirs, name);
        assert!(off < 1e-6, "{name}: {off:e}");
    }
}

/// What cannot be done is refused by name.
#[test]
fn other_bonds_are_refused_by_name() {
    let rows = "x,y,z,radius\n0,0,0,0.003\n0.0065,0,0,0.003\n";
    let folder = folder(&[("s.toml", scene(1e-3, 1e3, "")), ("grains.csv", rows.to_owned())]);
    // Decks are written for a LAMMPS of 2021 unless a program is named.
    let said = refusal(folder.path(), &[]);
    assert!(said.contains("bond: LAMMPS of 29 Sep 2021") && said.contains("BPM"), "{said}");
    for (bond, words) in [
        ("tensile_strength = 1e6", "tensile strength of bond.0: LAMMPS adds"),
        ("tensile_strength = 1e6\nshear_strength = 1e6", "under pressure later"),
        ("at = 1e-4", "bond.0.at"),
        ("[[outlet]]\nplane = \"0,0,1,0,0,1\"", "bonds through a cut"),
    ] {
        write(folder.path(), "s.toml", scene(1e-3, 1e3, bond));
        let said = refusal(folder.path(), &[]);
        assert!(said.contains(words), "{said}");
    }
}
