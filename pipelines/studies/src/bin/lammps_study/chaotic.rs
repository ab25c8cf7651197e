//! Five scenes of many grains: a number of each by both engines, over seeds, with its scatter.

use grainpipe_tests::engines::both;
use grainpipe_tests::recorded::column;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::succeed;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use stream::Table;

const HEAD: &str = "gravity = [0, 0, -9.81]
[output]
every = 0.05
[[material]]
name = \"glass\"
density = 2500
young = 1e6
poisson = 0.25
[[contact]]
between = [\"*\", \"*\"]
";
const HOOKE: &str = "law = \"hooke\"\nstiffness = 4e3\nrestitution = 0.5\nsliding_friction = 0.5\n";
const ROLLS: &str =
    "law = \"hooke\"\nstiffness = 4e3\nrestitution = 0.3\nsliding_friction = 0.7\nrolling_resistance = 0.3\n";
const HERTZ: &str = "law = \"hertz\"\nrestitution = 0.5\nsliding_friction = 0.5\n";
const PILE: &str = "[domain]
periodic = [\"x\", \"y\"]
low = [0, 0, 0]
high = [0.04, 0.04, 1]
[[fill]]
material = \"glass\"
shape = \"box:0,0,0,0.04,0.04,0.12\"
diameter = [0.004, 0.006]
count = 600
seed = SEED
[[wall]]
plane = \"0,0,0,0,0,1\"
material = \"glass\"
";
const HEAP: &str = "[[insert]]
material = \"glass\"
shape = \"cylinder:0,0,0.07,0,0,0.08,0.018\"
sizes = [[\"5 mm\", 0.4], [\"6 mm\", 0.6]]
velocity = [0, 0, -0.3]
rate_count = 400
until = 1.2
seed = SEED
[[wall]]
plane = \"0,0,0,0,0,1\"
material = \"glass\"
";
const HOPPER: &str = "[[particles]]
source = \"plate.csv\"
material = \"glass\"
fixed = true
[[fill]]
material = \"glass\"
shape = \"box:-0.028,-0.028,0.005,0.028,0.028,0.15\"
diameter = [0.004, 0.005]
count = 1400
seed = SEED
[[wall]]
box = [-0.028, -0.028, -1, 0.028, 0.028, 1]
faces = [\"x-\", \"x+\", \"y-\", \"y+\"]
material = \"glass\"
";
const SHEAR: &str = "[domain]
periodic = [\"x\", \"y\"]
low = [0, 0, 0]
high = [0.04, 0.04, 1]
[[fill]]
material = \"glass\"
shape = \"box:0,0,0,0.04,0.04,0.08\"
diameter = [0.004, 0.006]
count = 400
seed = SEED
[[wall]]
plane = \"0,0,0,0,0,1\"
material = \"glass\"
surface_velocity = [0.2, 0, 0]
";

/// A scene, and the number that is compared.
struct Case {
    name: &'static str,
    law: &'static str,
    more: &'static str,
    until: f64,
    number: fn(&Path, &str, &[Table]) -> f64,
}

const CASES: [Case; 5] = [
    Case {
        name: "settled pile, Hertz: mean height [mm]",
        law: HERTZ,
        more: PILE,
        until: 0.4,
        number: height,
    },
    Case {
        name: "settled pile, Hooke: spread of contact forces over their mean [–]",
        law: HOOKE,
        more: PILE,
        until: 0.4,
        number: forces,
    },
    Case { name: "heap of poured grains: angle [°]", law: ROLLS, more: HEAP, until: 1.6, number: angle },
    Case {
        name: "hopper with a hole of 32 mm: discharge [1/s]",
        law: HOOKE,
        more: HOPPER,
        until: 0.4,
        number: discharge,
    },
    Case {
        name: "belt under grains: mean speed after 0.4 s [mm/s]",
        law: HOOKE,
        more: SHEAR,
        until: 0.4,
        number: speed,
    },
];

/// A plate of fixed grains with a hole.
fn plate() -> String {
    let rows = (-7..=7).flat_map(|i| (-7..=7).map(move |j| (0.004 * f64::from(i), 0.004 * f64::from(j))));
    let plate = rows.filter(|(x, y)| x.hypot(*y) > 0.016);
    ["x,y,z,radius\n".to_owned()]
        .into_iter()
        .chain(plate.map(|(x, y)| format!("{x},{y},0,0.003\n")))
        .collect()
}

fn mean(all: &[f64]) -> f64 {
    all.iter().sum::<f64>() / all.len() as f64
}

/// Standard deviation of a sample.
fn deviation(all: &[f64]) -> f64 {
    let middle = mean(all);
    (all.iter().map(|x| (x - middle).powi(2)).sum::<f64>() / (all.len() - 1) as f64).sqrt()
}

fn height(_: &Path, _: &str, frames: &[Table]) -> f64 {
    1e3 * mean(&column(&frames[frames.len() - 1], "z"))
}

fn speed(_: &Path, _: &str, frames: &[Table]) -> f64 {
    1e3 * mean(&column(&frames[frames.len() - 1], "vx"))
}

/// Grains that pass the hole between the middle and the end of the run, per second.
fn discharge(_: &Path, _: &str, frames: &[Table]) -> f64 {
    let below = |frame: &Table| column(frame, "z").iter().filter(|z| **z < 0.0).count() as f64;
    let (middle, end) = (frames.len() / 2, frames.len() - 1);
    (below(&frames[end]) - below(&frames[middle])) / (0.05 * (end - middle) as f64)
}

fn angle(folder: &Path, run: &str, _: &[Table]) -> f64 {
    let done = succeed(folder, "dem-measure", &[run, "--repose", "--last", "--sectors", "4", "-q"]);
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    let mut lines = text.lines();
    let head = lines.next().unwrap_or_default().split(',');
    let at = head.into_iter().position(|name| name == "angle [deg]").expect("an angle");
    let angles: Vec<f64> = lines
        .map(|line| line.split(',').nth(at).and_then(|cell| cell.parse().ok()).expect("a number"))
        .collect();
    mean(&angles)
}

/// Overlaps of all pairs, across the periodic sides of 40 mm: of Hooke's law they are forces.
fn forces(_: &Path, _: &str, frames: &[Table]) -> f64 {
    let frame = &frames[frames.len() - 1];
    let [x, y, z, r] = ["x", "y", "z", "radius"].map(|name| column(frame, name));
    let near = |d: f64| d - 0.04 * (d / 0.04).round();
    let mut all = Vec::new();
    for i in 0..x.len() {
        for j in 0..i {
            let gap = near(x[i] - x[j]).hypot(near(y[i] - y[j])).hypot(z[i] - z[j]);
            let overlap = r[i] + r[j] - gap;
            if overlap > 0.0 {
                all.push(overlap);
            }
        }
    }
    deviation(&all) / mean(&all)
}

/// The table, and whether all agree within their scatter.
pub fn table(out: &Path, seeds: u32) -> (String, bool) {
    let mut text = format!(
        "| many grains, {seeds} seeds | dem-run | LAMMPS | difference over its standard error |\n|---|---|---|---|\n"
    );
    let mut agree = true;
    for case in &CASES {
        let (mut ours, mut theirs) = (Vec::new(), Vec::new());
        for seed in 1..=seeds {
            let time = format!("[time]\nuntil = {:?}\n", case.until);
            let scene = [HEAD, case.law, &time, &case.more.replace("SEED", &seed.to_string())].concat();
            let folder = folder(&[("s.toml", scene), ("plate.csv", plate())]);
            let [a, b] = both(folder.path(), &[]);
            ours.push((case.number)(folder.path(), "ours.mcap", &a));
            theirs.push((case.number)(folder.path(), "theirs.mcap", &b));
        }
        let n = f64::from(seeds).sqrt();
        let error = deviation(&ours).hypot(deviation(&theirs)) / n;
        let off = (mean(&ours) - mean(&theirs)) / error;
        // Of five numbers one is beyond 2.6 standard errors once in twenty times.
        agree &= off.abs() < 3.0;
        let one = |all: &[f64]| format!("{:.3} ± {:.3}", mean(all), deviation(all) / n);
        let line = format!("| {} | {} | {} | {off:+.1} |", case.name, one(&ours), one(&theirs));
        println!("{line}");
        let _ = writeln!(text, "{line}");
    }
    let _ = fs::write(out.join("agree.md"), &text);
    (text, agree)
}
