//! Bonds that break on both engines: at the same instant under the loads that LAMMPS has exactly, and what the grains do after that.

use crate::bonds::{bpm, difference, off_by, scene, two_grains};
use grainpipe_tests::recorded::{column, frames, tables};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use std::path::Path;
use std::process::Command;
use stream::Table;

/// The frames of the scene `s.toml` on both engines; LAMMPS with these options.
fn both(path: &Path, lmp: &str, options: &[&str]) -> [Vec<Table>; 2] {
    let given = ["s.toml", "-q", "--set", "time.contacts=sampled"];
    succeed(path, "dem-run", &[&given[..], &["-o", "ours.mcap"]].concat());
    succeed(path, "dem-lammps", &[&given[..], &["--lmp", lmp, "-o", "theirs.mcap"], options].concat());
    ["ours.mcap", "theirs.mcap"].map(|name| frames(&path.join(name)))
}

/// What broke bonds here (1: tension, 2: shear), in the order of time.
fn cracks(path: &Path) -> Vec<(f64, f64)> {
    let of = |table: &Table| -> Vec<(f64, f64)> {
        let [time, mode] = ["time", "mode"].map(|name| table.get(name).unwrap().to_f64());
        time.into_iter().zip(mode).collect()
    };
    tables(&path.join("ours.mcap"), "/cracks").iter().flat_map(of).collect()
}

/// How much velocities change between the last two frames.
fn last_change(frames: &[Table]) -> f64 {
    let [.., a, b] = frames else { panic!("two frames") };
    let of = |name: &&str| -> f64 {
        column(a, name).into_iter().zip(column(b, name)).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max)
    };
    ["vx", "vy", "vz"].iter().map(of).fold(0.0, f64::max)
}

const ALONG: [f64; 3] = [0.02, 0.01, 0.02];
const ACROSS: [f64; 3] = [0.01, -0.02, 0.0];
const AXIS: [f64; 3] = [2.0, 1.0, 2.0];
const SIDE: [f64; 3] = [1.0, -2.0, 0.0];
const STILL: [f64; 3] = [0.0; 3];

/// Shear strength alone, with friction and without, is the same criterion: no option is needed. Tension alone is the same where the moments
/// of bending and shear are parallel; with both strengths, a load that is alone.
#[test]
fn bonds_break_at_the_same_instant() {
    let Some(lmp) = bpm() else { return };
    let nearest = &["--nearest"][..];
    for (what, v, w, bond, options, mode) in [
        ("twist", STILL, AXIS, "shear_strength = 1e3", &[][..], 2.0),
        ("shear", ACROSS, STILL, "shear_strength = 1e3", &[], 2.0),
        ("pulled and twisted", ALONG, AXIS, "shear_strength = 2e3\nfriction_angle = 0.2", &[], 2.0),
        ("stretching", ALONG, STILL, "tensile_strength = 6e3", nearest, 1.0),
        ("bending", STILL, SIDE, "tensile_strength = 1e3", nearest, 1.0),
        ("shear and bending", ACROSS, STILL, "tensile_strength = 3e3", nearest, 1.0),
        ("both, stretching", ALONG, STILL, "tensile_strength = 6e3\nshear_strength = 1e3", nearest, 1.0),
        ("both, shear", ACROSS, STILL, "tensile_strength = 1e9\nshear_strength = 1e3", nearest, 2.0),
    ] {
        let folder = two_grains(v, w, &format!("replaces_contact = true\n{bond}"));
        let runs = both(folder.path(), &lmp, options);
        let (off, broke) = (difference(&runs), cracks(folder.path()));
        println!("{what}: {off:.1e}, broken at {broke:?}");
        assert!(broke.len() == 1 && broke[0].1 == mode, "{what}: {broke:?}");
        assert!(runs.iter().all(|run| last_change(run) < 1e-12), "{what}: they fly freely");
        assert!(off < 3e-4, "{what}: {off:e}");
    }
}

/// Two grains whose bond breaks while they approach each other touch after that, and only then.
#[test]
fn contacts_begin_where_a_bond_broke() {
    let Some(lmp) = bpm() else { return };
    let folder = two_grains([-0.8, -0.4, -0.8], AXIS, "replaces_contact = true\nshear_strength = 100");
    let runs = both(folder.path(), &lmp, &[]);
    let off = difference(&runs);
    let turned_back = |run: &[Table]| column(run.last().unwrap(), "vx")[0] > column(&run[0], "vx")[0];
    println!("a contact after a break: {off:.1e}");
    assert!(cracks(folder.path()).len() == 1 && runs.iter().all(|run| turned_back(run)));
    assert!(off < 3e-4, "{off:e}");
}

/// A bar that is pulled apart, whose bonds are not equally strong: a type for each. It breaks into the same pieces, also when it goes on from a state.
#[test]
fn a_bar_of_uneven_bonds_breaks_into_the_same_pieces() {
    let Some(lmp) = bpm() else { return };
    let rows: String = (0..12)
        .map(|k| format!("{:?},0,0,0.003,{:?},0,0\n", 0.006 * f64::from(k), 0.02 * f64::from(k * k) / 12.0))
        .collect();
    let bond = "tensile_strength = 2e4\ndeviation = 0.4\nseed = 3\ndamping = 0.02";
    let bar = scene(2e-3, 2e5, bond).replace("[output]", "[output]\ncheckpoint = 9e-4");
    let folder = folder(&[("s.toml", bar), ("grains.csv", "x,y,z,radius,vx,vy,vz\n".to_owned() + &rows)]);
    let path = folder.path();
    let runs = both(path, &lmp, &["--nearest"]);
    let (off, broke) = (difference(&runs), cracks(path));
    println!("a bar in {} pieces: {off:.1e}", broke.len() + 1);
    assert!((2..11).contains(&broke.len()), "{broke:?}");
    assert!(broke[0].0 < 1.8e-3 && off < 1e-4, "{off:e} {broke:?}");
    let bonds = ["ours.mcap", "theirs.mcap"].map(|run| tables(&path.join(run), "/bonds"));
    for name in ["id_i", "id_j", "broken", "mode", "tensile_strength", "shear_strength"] {
        assert!(off_by(&bonds, &[name]) < 1e-12, "{name}");
    }
    // The time of a break is that of the next frame.
    let every = 2e-3 / 50.0;
    let theirs: Vec<f64> = tables(&path.join("theirs.mcap"), "/cracks")
        .iter()
        .flat_map(|table| table.get("time").unwrap().to_f64())
        .collect();
    assert_eq!(theirs.len(), broke.len());
    for ((time, _), found) in broke.iter().zip(theirs) {
        assert!((-1e-9..every + 1e-9).contains(&(found - time)), "{time} {found}");
    }
    let deck = ["s.toml", "--write-deck", "deck", "--lmp", &lmp, "--nearest", "-q"];
    succeed(path, "dem-lammps", &deck);
    let kinds = std::fs::read_to_string(path.join("deck/bonds.in")).unwrap();
    assert_eq!(kinds.lines().filter(|line| line.starts_with("bond_coeff")).count(), 11);
    // The second start is the one that a comment of the deck tells.
    let input = std::fs::read_to_string(path.join("deck/run.in")).unwrap();
    let told = input.lines().find_map(|l| l.strip_prefix("# states, in turn: lmp -in run.in ")).unwrap();
    let second: Vec<&str> = told.strip_suffix(" goes on from one").unwrap().split(' ').collect();
    assert_eq!(second.iter().filter(|word| **word == "-var").count(), 3, "{told}");
    for options in [&[][..], &second] {
        let mut lammps = Command::new(&lmp);
        lammps.args(["-in", "run.in", "-log", "none"]).args(options).current_dir(path.join("deck"));
        assert!(lammps.output().unwrap().status.success());
    }
    let read =
        ["s.toml", "--read-dump", "deck/frames.dump", "--set", "time.contacts=sampled", "--nearest", "-q"];
    succeed(path, "dem-lammps", &[&read[..], &["-o", "again.mcap"]].concat());
    let [_, theirs] = runs;
    let off = difference(&[theirs, frames(&path.join("again.mcap"))]);
    assert!(off < 1e-9, "{off:e}");
}

/// Each strength that is taken nearly is named.
#[test]
fn strengths_that_are_taken_nearly_are_named() {
    let Some(lmp) = bpm() else { return };
    let folder = two_grains(STILL, STILL, "tensile_strength = 1e6");
    let check = |options: &[&str]| {
        tool(folder.path(), "dem-lammps", &[&["s.toml", "--check", "--lmp", &lmp], options].concat())
    };
    let (refused, taken) = (check(&[]), check(&["--nearest"]));
    assert!(refused.code == 1 && refused.stderr.contains("tensile strength of bond.0"), "{}", refused.stderr);
    let words = "tensile strength of bond.0: LAMMPS adds the moments of bending and of shear by their sizes: where they are not in one plane, a bond breaks earlier, from 71 % of the load: the nearest is taken";
    assert!(taken.code == 0 && taken.stderr.contains(words), "{}", taken.stderr);
    let exact = two_grains(STILL, STILL, "shear_strength = 1e6\ndeviation = 0.1\nfriction_angle = 0.3");
    let exact = tool(exact.path(), "dem-lammps", &["s.toml", "--check", "--nearest", "--lmp", &lmp]);
    assert!(exact.code == 0 && exact.stderr.contains("--nearest changes nothing"), "{}", exact.stderr);
}
