//! What contacts bear, read back from LAMMPS: contacts and forces on walls at each frame are those of dem-run.

use crate::lmp;
use grainpipe_tests::engines::{R, S, SLOW, both, linear_time, reduced};
use grainpipe_tests::recorded::tables;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use std::fs;
use std::path::Path;
use std::process::Command;
use stream::Table;

/// Oblique impacts of two grains across a periodic face, of a grain on a plane, and of a grain on a wall sphere, all of them slow; dashpots pull nowhere.
fn scene(law: &str) -> String {
    let time = 0.9 * linear_time(reduced(), 1e8);
    let (step, every) = (time / 1e5, time / 20.0);
    format!(
        "[time]\nuntil = {time:?}\ndt = {step:?}\n[output]\nevery = {every:?}\ncontacts = true\nwall_forces = true\n\
         [domain]\nperiodic = [\"x\"]\nlow = [-0.1, 0, 0]\nhigh = [0.1, 0, 0]\n\
         [[material]]\nname = \"glass\"\ndensity = 2500\nyoung = 1e7\npoisson = 0.25\n\
         [[contact]]\nbetween = [\"*\", \"*\"]\nlaw = \"hooke\"\nstiffness = 1e8\n{law}\n\
         [[particles]]\nsource = \"grains.csv\"\nmaterial = \"glass\"\n\
         [[wall]]\nname = \"floor\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\nmotion = {{ translate = [0, 0, 1e-4] }}\n\
         [[wall]]\nname = \"ball\"\nsolid = \"sphere:0.05,0,0.05,0.004\"\nmaterial = \"glass\"\n\
         [[wall]]\nname = \"far\"\nplane = \"0,0,1,0,0,-1\"\nmaterial = \"glass\"\n"
    )
}

fn grains() -> String {
    let rows = [
        // From the second, they touch behind the face.
        [0.1 - 0.5 * (R + S), 0.0, 0.1, S, 0.5 * SLOW, 0.4 * SLOW, 0.0],
        [-0.1 + 0.5 * (R + S), 0.0, 0.1, R, -0.5 * SLOW, 0.0, 0.0],
        [0.0, 0.0, R, R, 0.3 * SLOW, 0.1 * SLOW, -SLOW],
        [0.05, 0.0, 0.054 + R, R, 0.0, 0.2 * SLOW, -SLOW],
    ];
    let line = |row: &[f64; 7]| row.map(|v| format!("{v:?}")).join(",") + "\n";
    "x,y,z,radius,vx,vy,vz\n".to_owned() + &rows.iter().map(line).collect::<String>()
}

/// The contacts of a frame by their ends: i < j of grains; force on i.
fn contacts(table: &Table) -> Vec<([u64; 3], [f64; 10])> {
    let get = |name: &str| table.get(name).expect(name).to_f64();
    let columns: Vec<Vec<f64>> =
        ["x", "y", "z", "nx", "ny", "nz", "fx", "fy", "fz", "overlap"].iter().map(|n| get(n)).collect();
    let (first, second, kind) = (get("id_i"), get("id_j"), get("kind"));
    let mut all: Vec<_> = (0..first.len())
        .map(|k| {
            let turned = kind[k] == 0.0 && first[k] > second[k];
            let mut values: [f64; 10] = std::array::from_fn(|c| columns[c][k]);
            if turned {
                values[3..9].iter_mut().for_each(|v| *v = -*v);
            }
            let [a, b] = if turned { [second[k], first[k]] } else { [first[k], second[k]] };
            ([kind[k] as u64, a as u64, b as u64], values)
        })
        .collect();
    all.sort_by_key(|c| c.0);
    all
}

/// Largest difference of contacts over their largest force and overlap; the frames without any are the same.
fn agree(path: &Path, to: f64) {
    both(path, &[]);
    let [ours, theirs] = ["ours.mcap", "theirs.mcap"]
        .map(|name| tables(&path.join(name), "/contacts").iter().map(contacts).collect::<Vec<_>>());
    assert!(ours.len() == 21 && ours[10].len() == 3, "{}: {:?}", ours.len(), ours[10]);
    let largest = |c: usize| ours.iter().flatten().map(|r| r.1[c].abs()).fold(0.0, f64::max);
    let force = largest(6).max(largest(7)).max(largest(8));
    let size = [0.1, 0.1, 0.1, 1.0, 1.0, 1.0, force, force, force, largest(9)];
    for (k, (a, b)) in ours.iter().zip(&theirs).enumerate().skip(1) {
        assert_eq!(
            a.iter().map(|c| c.0).collect::<Vec<_>>(),
            b.iter().map(|c| c.0).collect::<Vec<_>>(),
            "{k}"
        );
        for ((ends, a), (_, b)) in a.iter().zip(b) {
            for c in 0..10 {
                let off = (a[c] - b[c]).abs() / size[c];
                assert!(off < to, "frame {k}, {ends:?}, column {c}: {} {} ({off:.1e})", a[c], b[c]);
            }
        }
    }
}

#[test]
fn contacts_and_forces_on_walls_are_those_of_dem_run() {
    if !lmp() {
        return;
    }
    let folder =
        folder(&[("s.toml", scene("restitution = 1\nsliding_friction = 0.3")), ("grains.csv", grains())]);
    let path = folder.path();
    agree(path, 2e-5);
    let forces = |run: &str| {
        succeed(path, "dem-measure", &[run, "--wall-force", "all", "--instants", "-q", "-o", "forces.csv"]);
        fs::read_to_string(path.join("forces.csv")).unwrap()
    };
    let numbers = |text: String| -> Vec<f64> {
        text.lines().skip(1).flat_map(|l| l.split(',')).filter_map(|cell| cell.parse().ok()).collect()
    };
    let [ours, theirs] = ["ours.mcap", "theirs.mcap"].map(|run| numbers(forces(run)));
    let largest = ours.iter().copied().fold(0.0, |a: f64, v| a.max(v.abs()));
    assert!(ours.len() > 100 && ours.len() == theirs.len() && largest > 1e-3);
    for (a, b) in ours.iter().zip(&theirs) {
        assert!((a - b).abs() < 2e-5 * largest, "{a} {b}");
    }
    // The dumps of a deck that ran elsewhere: the same bytes, or an error that names the missing one.
    succeed(path, "dem-lammps", &["s.toml", "--write-deck", "deck", "-q"]);
    let mut lammps = Command::new("lmp");
    lammps.args(["-in", "run.in", "-log", "none"]).current_dir(path.join("deck"));
    assert!(lammps.output().unwrap().status.success());
    succeed(path, "dem-lammps", &["s.toml", "--read-dump", "deck/frames.dump", "-o", "read.mcap", "-q"]);
    let of = |run: &str| tables(&path.join(run), "/contacts");
    assert!(of("read.mcap") == of("theirs.mcap"));
    fs::remove_file(path.join("deck/pairs.dump")).unwrap();
    let done = tool(path, "dem-lammps", &["s.toml", "--read-dump", "deck/frames.dump", "-o", "x.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("pairs.dump: cannot open it"), "{}", done.stderr);
}

/// A dashpot has the speed half a step later than the force that moves the grains. Nothing slides, since both cut springs differently beside a dashpot.
#[test]
fn forces_of_dashpots_agree_to_a_step() {
    if !lmp() {
        return;
    }
    let law = "restitution = 0.8\nsliding_friction = 5";
    let folder = folder(&[("s.toml", scene(law)), ("grains.csv", grains())]);
    agree(folder.path(), 1e-4);
}
