//! Sliding work of walls in runs of random scenes, written seldom and often: all of it is in the file, and none depends on the interval of output.

use grainpipe_tests::metamorphic::draw;
use grainpipe_tests::recorded::{json, tables};
use grainpipe_tests::tools::{program, tool};
use record::column::{KIND, SECOND, WALL, WORK};
use record::topic::{CONTACTS, ENERGY, WALL_FORCES, WALL_WEAR};
use std::collections::BTreeMap;
use std::path::Path;
use stream::Table;

/// Sliding work of a run [J].
#[derive(Debug, Default)]
struct Worked {
    /// By the ledger, at the end.
    ledger: f64,
    /// By rows of contacts: between grains, and by wall.
    grains: f64,
    contacts: BTreeMap<usize, f64>,
    /// By the sums of walls, and of their parts.
    walls: BTreeMap<usize, f64>,
    parts: BTreeMap<usize, f64>,
    /// Momentum that walls were given [N·s].
    impulse: BTreeMap<usize, [f64; 3]>,
}

fn add(sums: &mut BTreeMap<usize, f64>, wall: f64, work: f64) {
    *sums.entry(wall as usize).or_default() += work;
}

fn read(path: &Path) -> Worked {
    let mut worked = Worked::default();
    for json in json(path, ENERGY) {
        worked.ledger = json["sliding"].as_f64().expect("a number");
    }
    for json in json(path, WALL_FORCES) {
        let length = json["interval"].as_f64().expect("a number");
        for (index, wall) in json["walls"].as_array().expect("walls").iter().enumerate() {
            let Some(work) = wall["sliding_work"].as_f64() else { continue };
            add(&mut worked.walls, index as f64, work);
            let impulse = worked.impulse.entry(index).or_default();
            (0..3).for_each(|a| impulse[a] += length * wall["mean_force"][a].as_f64().expect("a number"));
        }
    }
    let column = |table: &Table, name: &str| table.get(name).expect("the column").to_f64();
    for table in tables(path, WALL_WEAR) {
        let rows = column(&table, WALL).into_iter().zip(column(&table, WORK));
        rows.for_each(|(wall, work)| add(&mut worked.parts, wall, work));
    }
    for table in tables(path, CONTACTS) {
        let [walls, kinds, works] = [SECOND, KIND, WORK].map(|name| column(&table, name));
        for ((wall, kind), work) in walls.into_iter().zip(kinds).zip(works) {
            if kind == 1.0 { add(&mut worked.contacts, wall, work) } else { worked.grains += work }
        }
    }
    worked
}

/// Whether two sums of numbers up to `scale` are the same to rounding.
fn near(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= 1e-12 * scale
}

#[test]
fn all_sliding_work_is_in_the_file_however_seldom_it_is_written() {
    let (mut with_walls, mut with_parts, mut lost_before) = (0, 0, 0);
    assert!(program("dem-run").exists());
    for seed in 4_200_000..4_200_060 {
        let mut scene = draw::scene(seed);
        for key in ["energy", "contacts", "wear"] {
            scene.set("output", key, true);
        }
        scene.set("output", "precision", "f64");
        // Short lists, that drop what has ended.
        scene.set("neighbours", "skin", 2e-4);
        let folder = tempfile::tempdir().expect("a folder");
        let mut all: Vec<Worked> = Vec::new();
        for every in [0.0001, 0.0007, 0.002, 1.0] {
            scene.set("output", "every", every);
            scene.write(folder.path(), "scene.toml").expect("written");
            let done = tool(folder.path(), "dem-run", &["scene.toml", "-q", "-o", "run.mcap"]);
            if done.code != 0 {
                // What a guard stops has no last frame.
                break;
            }
            all.push(read(&folder.path().join("run.mcap")));
        }
        let Some(often) = all.first() else { continue };
        for run in &all {
            let Worked { ledger, grains, contacts, walls, parts, .. } = run;
            let of_walls: f64 = walls.values().sum();
            assert!(near(grains + of_walls, *ledger, *ledger), "seed {seed}: {run:?}");
            for (wall, work) in walls {
                let of = |sums: &BTreeMap<usize, f64>| sums.get(wall).copied().unwrap_or(0.0);
                assert!(near(of(contacts), *work, *ledger), "seed {seed}, wall {wall}: {run:?}");
                // A plane has no parts.
                let part = of(parts);
                assert!(part == 0.0 || near(part, *work, *ledger), "seed {seed}, wall {wall}: {run:?}");
                with_parts += usize::from(part > 0.0);
            }
            assert!(near(often.ledger, *ledger, *ledger), "seed {seed}: {often:?} {run:?}");
            with_walls += usize::from(of_walls > 0.0);
        }
        lost_before += usize::from(all.len() == 4);
    }
    assert!(
        with_walls > 60 && with_parts > 20 && lost_before > 30,
        "{with_walls} {with_parts} {lost_before}"
    );
}

/// A grain that adheres rolls from one mesh to another that is one surface with it: the contact that ends there books what it held.
#[test]
fn the_ledger_of_a_grain_that_adheres_is_sound_across_two_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    let half = |name: &str, from: f64| {
        let to = from + 1.0;
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
             element face 2\nproperty list uchar int vertex_indices\nend_header\n\
             {from} -1 0\n{to} -1 0\n{to} 1 0\n{from} 1 0\n3 0 1 2\n3 0 2 3\n"
        );
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    half("left.ply", -1.0);
    half("right.ply", 0.0);
    let scene = "[time]\nuntil = 0.02\n[output]\nenergy = true\n[[material]]\nname = \"m\"\ndensity = 2500\nyoung = 1e7\n\
        poisson = 0.25\n[[contact]]\nbetween = [\"*\", \"*\"]\nlaw = \"jkr\"\nwork_of_adhesion = 5\nrestitution = 0.3\n\
        sliding_friction = 0.4\n[[particles]]\nsource = \"ball.csv\"\nmaterial = \"m\"\n\
        [[wall]]\nmesh = \"left.ply\"\nmaterial = \"m\"\n[[wall]]\nmesh = \"right.ply\"\nmaterial = \"m\"\n";
    std::fs::write(folder.path().join("s.toml"), scene).expect("written");
    let ball = "id,x,y,z,radius,vx\n0,-0.003,0.003,0.0199,0.02,1\n";
    std::fs::write(folder.path().join("ball.csv"), ball).expect("written");
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let last = json(&folder.path().join("run.mcap"), ENERGY).pop().expect("an energy");
    for (name, value) in last.as_object().expect("terms") {
        // The ball has 0.042 J, and adhesion holds less.
        assert!(value.as_f64().is_none_or(|joules| joules.abs() < 0.1), "{name}: {value}");
    }
}
