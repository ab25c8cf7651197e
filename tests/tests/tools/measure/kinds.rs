//! Each measure on each kind of run, by brute force from the tables of the run: plain, periodic, of clumps, bonded, stopped, and with frames without grains.

use super::{column, failed, measure, sum};
use geom::Vec3;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{line, tool};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::fs;
use stream::Table;
use stream::mcap::{Event, Reader};
use tempfile::TempDir;

const HEAD: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.1
[output]
every = 0.01
contacts = true
energy = true
wall_forces = true
[[material]]
name = "a"
density = 2500
young = 1e7
poisson = 0.2
[[contact]]
between = ["*", "*"]
restitution = 0.5
sliding_friction = 0.3
"#;
const TRAY: &str = "[[wall]]\nbox = [0, 0, 0, 0.05, 0.05, 0.2]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\nmaterial = \"a\"\n";
const FLOOR: &str = "[[wall]]\nplane = \"0,0,0,0,0,1\"\nmaterial = \"a\"\n\
                     [domain]\nperiodic = [\"x\", \"y\"]\nlow = [0, 0, 0]\nhigh = [0.05, 0.05, 0.2]\n";
const GRAINS: &str = "[[fill]]\nmaterial = \"a\"\nshape = \"box:0,0,0,0.05,0.05,0.05\"\ndiameter = [0.006, 0.008]\ncount = 120\n";

/// A kind of run, its scene and its further options.
pub(super) fn kinds() -> Vec<(&'static str, String, &'static [&'static str])> {
    let clumps = "[[clump]]\nname = \"dumbbell\"\nmaterial = \"a\"\nspheres = [[-0.003, 0, 0, 0.004], [0.003, 0, 0, 0.004]]\n\
                  [[fill]]\nclump = \"dumbbell\"\nshape = \"box:0,0,0,0.05,0.05,0.08\"\ncount = 25\n";
    let bond = "[[material]]\nname = \"rock\"\ndensity = 2500\nyoung = 1e7\npoisson = 0.2\n\
                [[particles]]\nsource = \"rod.csv\"\nmaterial = \"rock\"\n\
                [[bond]]\nbetween = [\"rock\", \"rock\"]\ngap = 1e-4\nyoung = 1e7\npoisson = 0.2\ntensile_strength = 1e3\nshear_strength = 1e3\n";
    let late = "[[insert]]\nmaterial = \"a\"\ndiameter = [0.006, 0.008]\nshape = \"box:0.01,0.01,0.06,0.04,0.04,0.08\"\nvelocity = [0, 0, -1]\n\
                rate_count = 700\nfrom = 0.03\n";
    vec![
        ("plain", format!("{HEAD}{TRAY}{GRAINS}"), &[]),
        ("periodic", format!("{HEAD}{FLOOR}{GRAINS}"), &[]),
        ("clumps", format!("{HEAD}{TRAY}{clumps}"), &[]),
        ("bonded", format!("{HEAD}{TRAY}{GRAINS}{bond}"), &[]),
        ("stopped", format!("{HEAD}{TRAY}{GRAINS}"), &["--set", "guards.overlap=0.035"]),
        ("empty", format!("{HEAD}{TRAY}{late}"), &[]),
    ]
}

/// What a run holds, by channel and time.
pub(super) struct Held {
    pub folder: TempDir,
    tables: BTreeMap<String, Vec<(f64, Table)>>,
}

impl Held {
    pub fn new(scene: &str, options: &[&str]) -> Held {
        let folder = folder(&[("s.toml", scene)]);
        let rod: String =
            (0..5).map(|k| format!("{},0.025,0.062,0.004\n", 0.009 + 0.008 * f64::from(k))).collect();
        fs::write(folder.path().join("rod.csv"), format!("x,y,z,radius\n{rod}")).unwrap();
        let done = tool(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], options].concat());
        assert!(done.code == 0 || done.code == 3, "{}", done.stderr);
        let mut tables: BTreeMap<String, Vec<(f64, Table)>> = BTreeMap::new();
        for event in Reader::new(fs::File::open(folder.path().join("run.mcap")).unwrap()) {
            if let Event::Points { topic, time_ns, table } = event.unwrap() {
                tables.entry(topic).or_default().push((time_ns as f64 / 1e9, table));
            }
        }
        Held { folder, tables }
    }

    pub fn all(&self, topic: &str) -> &[(f64, Table)] {
        self.tables.get(topic).map_or(&[], Vec::as_slice)
    }

    pub fn times(&self) -> Vec<f64> {
        self.all("/particles").iter().map(|frame| frame.0).collect()
    }

    pub fn table(&self, topic: &str, time: f64) -> Option<&Table> {
        self.all(topic).iter().find(|t| (t.0 - time).abs() < 1e-9).map(|t| &t.1)
    }
}

pub(super) fn values(table: &Table, name: &str) -> Vec<f64> {
    table.get(name).unwrap_or_else(|| panic!("{name}")).to_f64()
}

pub(super) fn vectors(table: &Table, names: [&str; 3]) -> Vec<Vec3> {
    let [x, y, z] = names.map(|name| values(table, name));
    (0..x.len()).map(|k| Vec3::new(x[k], y[k], z[k])).collect()
}

/// Pairs of grains whose bond is whole at a time.
pub(super) fn whole_bonds(run: &Held, time: f64) -> Vec<[u64; 2]> {
    let Some(table) = run.table("/bonds", time) else { return Vec::new() };
    let [i, j, broken] = ["id_i", "id_j", "broken"].map(|name| values(table, name));
    (0..i.len()).filter(|k| broken[*k] == 0.0).map(|k| [i[k] as u64, j[k] as u64]).collect()
}

pub(super) fn near(on: &str, found: &[f64], wanted: &[f64], tolerance: f64) {
    assert_eq!(found.len(), wanted.len(), "{on}: {found:?} for {wanted:?}");
    for (a, b) in found.iter().zip(wanted) {
        assert!((a - b).abs() <= tolerance || a.is_nan() && b.is_nan(), "{on}: {found:?} for {wanted:?}");
    }
}

/// Measures with a row for each frame.
const SERIES: &[&[&str]] = &[
    &["--contacts"],
    &["--porosity", "box:0.005,0.005,0.002,0.045,0.045,0.1"],
    &["--wall-force", "all"],
    &["--plane-force", "0,0,0.01,0,0,1"],
    &["--stress", "box:0,0,0,0.05,0.05,0.05"],
    &["--energy"],
    &["--strain"],
    &["--segregation"],
    &["--bed-height", "--all"],
    &["--bed-slope", "x-"],
];

/// Measures of one frame, each with the column of its time.
const SINGLE: &[&[&str]] = &[
    &["--contacts"],
    &["--porosity", "box:0.005,0.005,0.002,0.045,0.045,0.1"],
    &["--profile", "--bins", "2"],
    &["--bed-height"],
    &["--radial", "0.025,0.025,0,0,0,1", "--bins", "2"],
];

/// A frame has a row, whether it holds grains or not; a time is that of the nearest frame; times without frames are refused. The same in all measures.
#[test]
fn all_measures_mean_the_same_frames() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let times = run.times();
        for words in SERIES {
            // All dumbbells are of one size.
            if kind == "clumps" && words[0] == "--segregation" {
                continue;
            }
            let on = format!("{kind} {}", words.join(" "));
            near(&on, &column(&measure(&run.folder, words), "time"), &times, 1e-9);
            let [from, until] = [times[times.len() / 3], times[2 * times.len() / 3]];
            let part: Vec<f64> = times.iter().copied().filter(|t| (from..=until).contains(t)).collect();
            let span =
                [&words.iter().copied().filter(|w| *w != "--all").collect::<Vec<_>>()[..], &["--from"]]
                    .concat();
            let (a, b) = (format!("{from}"), format!("{until}"));
            let span = [&span[..], &[&a, "--until", &b]].concat();
            if words[0] != "--bed-slope"
                && (kind != "empty" || !["--strain", "--segregation"].contains(&words[0]))
            {
                near(&on, &column(&measure(&run.folder, &span), "time"), &part, 1e-9);
            }
            let said = failed(&run.folder, &[&span[..span.len() - 3], &["5", "--until", "6"]].concat());
            assert!(said.contains("no frame from 5 to 6 s"), "{on}: {said}");
        }
        let grains = |t: f64| run.table("/particles", t).is_some_and(|table| table.rows() > 0);
        let last = times.iter().copied().rfind(|t| grains(*t)).unwrap();
        for words in SINGLE {
            let on = format!("{kind} {}", words.join(" "));
            let found = column(&measure(&run.folder, &[words, &["--last"][..]].concat()), "time");
            assert!(found.iter().all(|t| (t - last).abs() < 1e-9), "{on}: {found:?} for {last}");
            for share in [0.55, 0.66, 0.94] {
                let at = share * times.last().unwrap();
                let far = |t: &&f64| (**t - at).abs();
                let nearest = *times.iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
                if !grains(nearest) {
                    continue;
                }
                let found = column(
                    &measure(&run.folder, &[words, &["--time", &at.to_string()][..]].concat()),
                    "time",
                );
                assert!(
                    !found.is_empty() && found.iter().all(|t| (t - nearest).abs() < 1e-9),
                    "{on}: {found:?} for {nearest}"
                );
            }
        }
        let long = failed(&run.folder, &["--flow", "0,0,0.01,0,0,-1", "--span", "7"]);
        assert!(long.contains("one span of 7 s does not fit"), "{kind}: {long}");
        for words in [&["--flow", "0,0,0.01,0,0,-1"][..], &["--impact"]] {
            let said = failed(&run.folder, &[words, &["--from", "5", "--until", "6"]].concat());
            assert!(said.contains("no frame from 5 to 6 s"), "{kind}: {said}");
        }
    }
}

/// The picture of a time and the measure of it are of one frame.
#[test]
fn a_time_is_the_same_frame_in_pictures() {
    let run = Held::new(&kinds()[0].1, &[]);
    for at in ["0.014", "0.016"] {
        let pictured = line(
            run.folder.path(),
            &format!("dem-view run.mcap --time {at} -o at.vtp --report at.json && cat at.json"),
        );
        assert_eq!(pictured.code, 0, "{}", pictured.stderr);
        let report: serde_json::Value = serde_json::from_slice(&pictured.stdout).unwrap();
        let measured = column(&measure(&run.folder, &["--contacts", "--time", at]), "time");
        let shown = report["time_s"].as_f64().unwrap_or_else(|| panic!("{report}"));
        near(at, &measured, &[shown], 1e-9);
    }
}

/// Share of the points of a grid in a box that lie in balls, their images along periodic axes included.
fn filled(run: &Held, time: f64, (low, high): (Vec3, Vec3), period: Option<f64>) -> f64 {
    let table = run.table("/particles", time).unwrap();
    let (places, radii) = (vectors(table, ["x", "y", "z"]), values(table, "radius"));
    let n = 60;
    let point = |k: usize| {
        let share =
            Vec3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64).add_scalar(0.5) / n as f64;
        low + (high - low).component_mul(&share)
    };
    let nearest = |d: f64| period.map_or(d, |l| d - l * (d / l).round());
    let inside = |p: Vec3| {
        places.iter().zip(&radii).any(|(x, r)| {
            let d = p - x;
            Vec3::new(nearest(d.x), nearest(d.y), d.z).norm_squared() < r * r
        })
    };
    (0..n * n * n).filter(|k| inside(point(*k))).count() as f64 / (n * n * n) as f64
}

fn sorted([a, b]: [u64; 2]) -> [u64; 2] {
    [a.min(b), a.max(b)]
}

/// Sizes of the sets that pairs join, of all ids.
fn sets(ids: &[f64], pairs: &[[u64; 2]]) -> Vec<usize> {
    let mut of: BTreeMap<u64, u64> = ids.iter().map(|id| (*id as u64, *id as u64)).collect();
    loop {
        let before = of.clone();
        for [a, b] in pairs {
            let least = of[a].min(of[b]);
            of.insert(*a, least);
            of.insert(*b, least);
        }
        if of == before {
            break;
        }
    }
    let mut count: BTreeMap<u64, usize> = BTreeMap::new();
    of.values().for_each(|root| *count.entry(*root).or_default() += 1);
    count.into_values().collect()
}

/// Numbers of the measures are those of sums, pairs and voxels.
#[test]
fn measures_are_sums_over_the_tables() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let times = run.times();
        let clumps = kind == "clumps";
        let mut wanted: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        for t in &times {
            let (frame, contacts) = (run.table("/particles", *t).unwrap(), run.table("/contacts", *t));
            let mut add = |name: &'static str, value: f64| wanted.entry(name).or_default().push(value);
            let (radius, velocity) = (values(frame, "radius"), vectors(frame, ["vx", "vy", "vz"]));
            let mass = |r: &f64| 2500.0 * 4.0 / 3.0 * PI * r.powi(3);
            add(
                "translation",
                radius.iter().zip(&velocity).map(|(r, v)| 0.5 * mass(r) * v.norm_squared()).sum(),
            );
            let force = contacts.map_or(Vec::new(), |c| vectors(c, ["fx", "fy", "fz"]));
            let walls = contacts.map_or(Vec::new(), |c| values(c, "kind"));
            let on_walls = force.iter().zip(&walls).filter(|(_, kind)| **kind == 1.0);
            let sum: Vec3 = on_walls.map(|(f, _)| -*f).sum();
            add("fx", sum.x);
            add("fz", sum.z);
            let acting =
                |wall: f64| force.iter().zip(&walls).filter(|(f, k)| **k == wall && f.norm() > 0.0).count();
            // Of a pair that is bonded, the bond counts whether the two touch or not.
            let bonded: BTreeSet<[u64; 2]> = whole_bonds(&run, *t).into_iter().map(sorted).collect();
            let touching =
                contacts.map_or(Vec::new(), |c| ["id_i", "id_j"].map(|name| values(c, name)).to_vec());
            let touch = |k: &usize| sorted([touching[0][*k] as u64, touching[1][*k] as u64]);
            let besides = (0..force.len()).filter(|k| walls[*k] == 0.0 && force[*k].norm() > 0.0);
            let besides = besides.filter(|k| !bonded.contains(&touch(k))).count();
            add("pairs", (besides + bonded.len()) as f64);
            add("wall_contacts", acting(1.0) as f64);
        }
        let is = |words: &[&str], name: &str, tolerance: f64| {
            let (all, on) = (&wanted[name], format!("{kind} {} {name}", words.join(" ")));
            let largest = all.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            near(&on, &column(&measure(&run.folder, words), name), all, tolerance * largest);
        };
        // Of whole walls there are means over all steps; of a shape, forces of the frames.
        is(&["--wall-force", "box:-9,-9,-9,9,9,9"], "fx", 1e-9);
        is(&["--wall-force", "box:-9,-9,-9,9,9,9"], "fz", 1e-9);
        // Grains on their way in are not yet in the ledger.
        if !clumps && kind != "empty" {
            is(&["--energy"], "translation", 1e-9);
        }
        if !clumps {
            is(&["--contacts"], "pairs", 0.0);
            is(&["--contacts"], "wall_contacts", 0.0);
        }
        let period = (kind == "periodic").then_some(0.05);
        let low = if period.is_some() { -0.02 } else { 0.0 };
        let room = (Vec3::new(low, low, 0.0), Vec3::new(low + 0.05, low + 0.05, 0.03));
        let shape = format!("box:{low},{low},0,{},{},0.03", low + 0.05, low + 0.05);
        let end = *times.last().unwrap();
        let solid = sum(&run.folder, &["--porosity", &shape, "--last"], "solid_fraction");
        let voxels = filled(&run, end, room, period);
        // Overlaps of the members of a clump count as the clump's volume does.
        assert!((solid - voxels).abs() < 0.01 * voxels.max(0.05), "{kind}: solid {solid} for {voxels}");
        if kind == "bonded" {
            bonds(&run, &times);
        }
    }
}

/// Bonds and fragments, with grains that have none.
fn bonds(run: &Held, times: &[f64]) {
    let (mut count, mut largest) = (Vec::new(), Vec::new());
    for t in times {
        let (frame, pairs) = (run.table("/particles", *t).unwrap(), whole_bonds(run, *t));
        let all = sets(&values(frame, "id"), &pairs);
        count.push(all.len() as f64);
        largest.push(*all.iter().max().unwrap() as f64);
        let words = ["--fragments", "--time", &t.to_string()];
        let grains = column(&measure(&run.folder, &words), "grains");
        let [mut found, mut wanted] = [grains.iter().map(|n| *n as usize).collect(), all];
        found.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(found, wanted, "at {t} s");
    }
    near("fragments", &column(&measure(&run.folder, &["--bonds"]), "fragments"), &count, 0.0);
    near("largest", &column(&measure(&run.folder, &["--bonds"]), "largest_fragment"), &largest, 0.0);
    let kinds: BTreeSet<u64> = count.iter().map(|n| *n as u64).collect();
    assert!(count[0] > 100.0 && kinds.len() > 1, "some break: {count:?}");
}
