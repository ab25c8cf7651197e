//! lab-test: small specimens of soft grains, prepared and tested in seconds.

use grainpipe_tests::lab::{ROCK, SAND, cube};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn lab() -> TempDir {
    folder(&[("sand.toml", SAND.to_owned()), ("rock.toml", ROCK.to_owned()), ("stone.csv", cube())])
}

fn json(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
}

/// Columns by name of a CSV file, without units.
fn columns(folder: &Path, name: &str) -> BTreeMap<String, Vec<f64>> {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    let names: Vec<&str> =
        text.lines().next().unwrap().split(',').map(|n| n.split(" [").next().unwrap()).collect();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for line in text.lines().skip(1) {
        for (name, cell) in names.iter().zip(line.split(',')) {
            columns.entry((*name).to_owned()).or_default().push(cell.parse().unwrap_or(f64::NAN));
        }
    }
    columns
}

fn figure(report: &Value, level: usize, name: &str) -> f64 {
    let figures = report["levels"][level]["figures"].as_array().unwrap();
    let found = figures.iter().find(|f| f["name"] == name).unwrap_or_else(|| panic!("no {name}"));
    found["mean"].as_f64().unwrap_or_else(|| panic!("{name} has no mean"))
}

const SHEAR: &[&str] = &[
    "direct-shear",
    "sand.toml",
    "--grains",
    "200",
    "--stress",
    "1000",
    "--rows",
    "40",
    "--strain",
    "6%",
    "--dir",
    "d",
];

/// The stress that the lid gives acts on the shear plane, and what the upper half takes the lower one bears.
#[test]
fn a_shear_box_is_in_equilibrium_and_continues_where_it_was() {
    let lab = lab();
    let path = lab.path();
    let run = |threads: &str, out: &str, seeds: &str| {
        let more = ["--seeds", seeds, "--threads", threads, "--report", "r.json", "-q", "-o", out];
        succeed(path, "lab-test", &[SHEAR, &more].concat());
    };
    run("2", "a.csv", "2");
    let curve = columns(path, "a.csv");
    let mean = |name: &str| curve[name].iter().sum::<f64>() / curve[name].len() as f64;
    // The plane carries the lid and the weight of the upper half.
    let report = json(path, "r.json");
    let weight = 0.5 * report["mass"].as_f64().unwrap() * 9.81;
    let area = report["size"][0].as_f64().unwrap() * report["size"][1].as_f64().unwrap();
    let stress = 1000.0 + weight / area;
    assert!((mean("normal_stress") / stress - 1.0).abs() < 0.02, "{} {stress}", mean("normal_stress"));
    assert!(curve["lid_stress"].iter().all(|s| (s / 1000.0 - 1.0).abs() < 0.02));
    // The halves: forces on the upper one and the lid against those on the lower one and the floor.
    let specimen = path.join("d/stress=1000,seed=0");
    let force = |wall: &str| columns(&specimen, &format!("{wall}.csv"))["fx"].clone();
    let [floor, lower, lid, upper] = ["floor", "lower", "lid", "upper"].map(force);
    let largest = lower.iter().copied().fold(0.0, f64::max);
    for row in 20..floor.len() {
        let off = floor[row] + lower[row] + lid[row] + upper[row];
        assert!(off.abs() < 0.1 * largest, "row {row}: {off} N of {largest} N");
    }
    let angle = figure(&report, 0, "residual_angle");
    assert!((15.0..40.0).contains(&angle), "{angle}");
    assert!(report["levels"][0]["figures"][0]["interval"].as_f64().unwrap() > 0.0);
    // What is finished is used again; what is missing is made again, with the same bytes.
    let run_file = specimen.join("test.mcap");
    let before = fs::metadata(&run_file).unwrap().modified().unwrap();
    fs::remove_file(path.join("d/stress=1000,seed=1/test.mcap")).unwrap();
    fs::remove_file(path.join("d/stress=1000,seed=1/upper.csv")).unwrap();
    run("1", "b.csv", "2");
    assert_eq!(fs::metadata(&run_file).unwrap().modified().unwrap(), before);
    assert!(fs::read(path.join("a.csv")).unwrap() == fs::read(path.join("b.csv")).unwrap());
    // Another sample is another specimen.
    fs::write(path.join("sand.toml"), SAND.replace("rolling_resistance = 0.1\n", "")).unwrap();
    run("2", "c.csv", "1");
    let other = columns(path, "c.csv")["shear_stress"].clone();
    assert!(other[..] != curve["shear_stress"][..other.len()]);
}

/// The sides hold their stress while the lid comes down; a specimen under a stress path follows it.
#[test]
fn boxes_hold_and_follow_their_stresses() {
    let lab = lab();
    let path = lab.path();
    let common = ["sand.toml", "--grains", "250", "--rows", "40", "-q", "--report", "r.json", "-o", "c.csv"];
    succeed(path, "lab-test", &[&["triaxial", "--stress", "1 kPa", "--strain", "5%"], &common[..]].concat());
    let curve = columns(path, "c.csv");
    assert!(
        curve["lateral_stress"].iter().skip(2).all(|s| (s / 1000.0 - 1.0).abs() < 0.02),
        "{:?}",
        curve["lateral_stress"]
    );
    assert!((curve["axial_strain"].last().unwrap() - 0.05).abs() < 1e-3);
    assert!(curve["deviator_stress"][0].abs() < 50.0 && *curve["deviator_stress"].last().unwrap() > 200.0);
    succeed(path, "lab-test", &[&["oedometer", "--stress", "500,1000,500"], &common[..]].concat());
    let (curve, report) = (columns(path, "c.csv"), json(path, "r.json"));
    let most = curve["stress"].iter().copied().fold(0.0, f64::max);
    assert!((most / 1000.0 - 1.0).abs() < 0.03, "{most}");
    let ratio = figure(&report, 0, "unloading_modulus") / figure(&report, 0, "constrained_modulus");
    assert!(ratio > 1.0, "unloading is stiffer: {ratio}");
    assert!((0.2..0.8).contains(&figure(&report, 0, "K0")));
}

/// Four columns of five grains are as stiff as their contacts: the force on the plates is 4 k δ/6 for six contacts in a row.
#[test]
fn columns_of_grains_are_springs_in_a_row() {
    let lab = lab();
    let path = lab.path();
    let at = |k: usize| 0.001 * k as f64;
    let row = |k: usize| format!("{},{},{},0.0005\n", at(k % 2), at(k / 2 % 2), at(k / 4));
    let rows: String = (0..20).map(row).collect();
    fs::write(path.join("stone.csv"), format!("x,y,z,radius\n{rows}")).unwrap();
    // Of the bonds only threads are left.
    let weak = ["bond.0.tensile_strength=1e12", "bond.0.shear_strength=1e12", "bond.0.modulus=1"];
    let weak = weak.into_iter().flat_map(|set| ["--set", set]);
    let words =
        ["uniaxial", "rock.toml", "--strain", "0.01", "--speed", "0.001", "-q", "-o", "c.csv", "--dir", "d"];
    succeed(path, "lab-test", &words.into_iter().chain(weak).collect::<Vec<_>>());
    let upper = columns(&path.join("d/seed=0"), "upper.csv");
    let stiffness = upper["fz"].last().unwrap() / -upper["shift_z"].last().unwrap();
    assert!((stiffness / (4.0 * 1e5 / 6.0) - 1.0).abs() < 0.01, "{stiffness}");
    // The outline: a square of 1 mm with round corners of 0.5 mm.
    let curve = columns(path, "c.csv");
    let area = upper["fz"].last().unwrap() / curve["stress"].last().unwrap();
    let exact = 1e-6 * (1.0 + 2.0 + std::f64::consts::PI / 4.0);
    assert!((area / exact - 1.0).abs() < 1e-3, "{area}");
}

/// Two of these cubes stand on an edge and turn: they have no strength.
#[test]
fn a_stone_is_crushed_in_another_orientation_for_each_seed() {
    let lab = lab();
    let path = lab.path();
    let words =
        ["crush", "rock.toml", "--seeds", "7", "--report", "r.json", "-o", "c.csv", "--words", "w.md"];
    let done = succeed(path, "lab-test", &words);
    let report = json(path, "r.json");
    let values = report["levels"][0]["figures"][0]["values"].as_array().unwrap();
    let strengths: Vec<f64> = values.iter().filter_map(|v| v.as_f64()).collect();
    assert_eq!((values.len(), strengths.len()), (7, 5));
    assert!(strengths.windows(2).all(|pair| pair[0] != pair[1]), "{strengths:?}");
    let turned = "so the stone has no strength: it turned between the plates";
    assert_eq!(done.stderr.matches(turned).count(), 2, "{}", done.stderr);
    assert!(done.stderr.contains("seed=4: no bond has broken"), "{}", done.stderr);
    assert!(!done.stderr.contains("too fast"), "{}", done.stderr);
    assert!(report["weibull"][0]["mean"].as_f64().unwrap() > 1.0);
    assert!(fs::read_to_string(path.join("w.md")).unwrap().contains("| weibull modulus of all |"));
    assert!(columns(path, "c.csv")["cracks"].iter().any(|cracks| *cracks > 0.0));
    let fast = ["crush", "rock.toml", "--speed", "0.6", "-o", "fast.csv"];
    let done = succeed(path, "lab-test", &fast);
    assert!(done.stderr.contains("the test is too fast"), "{}", done.stderr);
}

#[test]
fn printed_scenes_can_run() {
    let lab = lab();
    let path = lab.path();
    let shear = ["direct-shear", "sand.toml", "--stress", "1000", "-q"];
    let preparation = ["--grains", "200", "--print-preparation", "-o", "p.toml"];
    succeed(path, "lab-test", &[&shear[..], &preparation].concat());
    succeed(path, "dem-run", &["p.toml", "--check", "-q"]);
    succeed(path, "lab-test", &[&shear[..], &["--print-scene", "-o", "t.toml"]].concat());
    let scene = fs::read_to_string(path.join("t.toml")).unwrap();
    assert!(scene.contains("source = \"prepare.mcap\"") && scene.contains("name = \"upper\""), "{scene}");
}

/// Rigid stones lie among packed grains in the preparation; the test has them from its run.
#[test]
fn rigid_stones_are_prepared_with_the_grains_around_them() {
    let lab = lab();
    let path = lab.path();
    let at = |k: usize| 0.0025 + 0.005 * k as f64;
    let row = |k: usize| format!("{},{},{},0.0025\n", at(k % 6), at(k / 6 % 6), at(k / 36));
    let rows: String = (0..144).map(row).collect();
    fs::write(path.join("grains.csv"), format!("x,y,z,radius\n{rows}")).unwrap();
    let (head, _) = SAND.split_once("[[fill]]").unwrap();
    let stone = "[[clump]]\nname = \"stone\"\nmaterial = \"sand\"\nspheres = [[0, 0, 0, 0.003], [0.003, 0, 0, 0.003]]\n\
        [[body]]\nclump = \"stone\"\nposition = [0.012, 0.012, 0.024]\n\
        [[particles]]\nsource = \"grains.csv\"\nmaterial = \"sand\"\n";
    fs::write(path.join("rigid.toml"), format!("{head}{stone}")).unwrap();
    let print = |option: &str, file: &str| {
        succeed(path, "lab-test", &["triaxial", "rigid.toml", "--stress", "1000", option, "-q", "-o", file]);
        fs::read_to_string(path.join(file)).unwrap()
    };
    assert!(print("--print-preparation", "p.toml").contains("[[body]]"));
    succeed(path, "dem-run", &["p.toml", "--check", "-q"]);
    let test = print("--print-scene", "t.toml");
    assert!(
        !test.contains("[[body]]") && test.contains("[[clump]]") && test.contains("prepare.mcap"),
        "{test}"
    );
}

/// Frossard's rule (Frossard et al. 2012, doi:10.1680/geot.10.P.079): of stones whose strength falls with their size D as D^(−3/m), a fill with τ ∝ σ^b is
/// weaker by (D_B/D_A)^(−3 (1 − b)/m). It follows from similarity alone: with all stiffnesses and strengths as much smaller, lengths do not matter. Here
/// m = 3, and stones four times as large.
#[test]
fn larger_stones_make_a_weaker_fill_as_frossard_says() {
    let rows = |stone: usize| {
        // In bricks, so that any plane cuts some of them.
        let [i, j, k] = [stone % 4, stone / 4 % 4, stone / 16];
        let corner = [2 * i, 2 * j, 2 * k + (i + j) % 2];
        let at = move |grain: usize, k: usize| 0.001 * (corner[k] + (grain >> k & 1)) as f64;
        (0..8).map(move |g| format!("{},{},{},0.0005,{}\n", at(g, 0), at(g, 1), at(g, 2), stone + 1))
    };
    let grains: String = (0..48).flat_map(rows).collect();
    let sample = |size: f64| {
        let strength = 1.0 / size;
        let text =
            ROCK.replace("law = \"hooke\"\nstiffness = 1e5", "law = \"hertz\"").replace("cluster = 1", "");
        text.replace("young = 1e7", &format!("young = {}", 2e7 * strength))
            .replace("modulus = 1e8", &format!("modulus = {}", 2e7 * strength))
            .replace("2e5", &format!("{}", 1e4 * strength))
            .replace("gap = 1e-6", &format!("gap = {}", 1e-6 * size))
            .replace("source = \"stone.csv\"", &format!("source = \"stones.csv\"\nscale = {size}"))
    };
    let folder = folder(&[
        ("stones.csv", format!("x,y,z,radius,cluster\n{grains}")),
        ("small.toml", sample(1.0)),
        ("large.toml", sample(4.0)),
    ]);
    let path = folder.path();
    let test = |sample: &str, stresses: &str| {
        let words =
            ["direct-shear", sample, "--stress", stresses, "--inertial", "0.02", "--rest", "1e-2", "-q"];
        succeed(path, "lab-test", &[&words[..], &["--report", "r.json", "-o", "c.csv"]].concat());
        (json(path, "r.json"), columns(path, "c.csv"))
    };
    let (small, curves) = test("small.toml", "3000,12000");
    let (large, _) = test("large.toml", "3000");
    let strength = |report: &Value, level: usize| figure(report, level, "peak_shear_stress");
    let [weak, strong] = [0, 1].map(|level| strength(&small, level));
    let b = (strong / weak).ln() / 4f64.ln();
    let rule = 4f64.powf(-3.0 * (1.0 - b) / 3.0);
    let found = strength(&large, 0) / weak;
    assert!((found / rule - 1.0).abs() < 1e-6, "{found} {rule}");
    // Stones break, so the envelope bends.
    let cracks = curves["cracks"].last().unwrap();
    assert!(*cracks > 10.0 && b < 0.9, "{cracks} {b}");
}

/// Rough grains stand steeper than smooth ones, poured or turned; both ways make an angle between those of water and of a wall.
#[test]
fn a_poured_heap_and_a_drum_tell_rough_grains_from_smooth_ones() {
    let lab = lab();
    let path = lab.path();
    let angle = |test: &str, friction: &str| {
        let friction = format!("contact.0.sliding_friction={friction}");
        let words = ["sand.toml", "--grains", "300", "--set", &friction, "--seed", "2", "--rows", "60"];
        succeed(
            path,
            "lab-test",
            &[&[test][..], &words, &["--report", "r.json", "-q", "-o", "c.csv"]].concat(),
        );
        figure(&json(path, "r.json"), 0, "angle")
    };
    for test in ["heap", "drum"] {
        let [smooth, rough] = ["0.05", "0.8"].map(|friction| angle(test, friction));
        assert!(smooth > 0.0 && rough < 60.0 && rough > smooth + 5.0, "{test}: {smooth} {rough}");
    }
    let drum = columns(path, "c.csv");
    assert!(
        drum["angle"][0].abs() < 8.0 && drum["turn"].last().is_some_and(|turn| (turn - 0.3).abs() < 0.01)
    );
}

#[test]
fn what_a_test_cannot_use_is_refused() {
    let lab = lab();
    let path = lab.path();
    fs::write(
        path.join("wall.toml"),
        format!("{SAND}[[wall]]\nplane = \"0,0,0,0,0,1\"\nmaterial = \"sand\"\n"),
    )
    .unwrap();
    fs::write(path.join("count.toml"), format!("{SAND}count = 5\n")).unwrap();
    fs::write(path.join("two.csv"), "x,y,z,radius\n0,0,0,0.0005\n").unwrap();
    for (words, said) in [
        (&["direct-shear", "wall.toml"][..], "[wall] is not part of a sample"),
        (&["direct-shear", "count.toml"], "fill.0.count is not part of a sample"),
        (&["uniaxial", "sand.toml"], "has no [[bond]]"),
        (&["crush", "sand.toml"], "has no [[bond]]"),
        (&["repose", "rock.toml"], "has [[particles]]"),
        (&["repose", "sand.toml", "--stress", "1"], "--stress has no effect on repose"),
        (&["heap", "rock.toml"], "has [[particles]]"),
        (&["heap", "sand.toml", "--rest", "0.1"], "--rest has no effect on heap"),
        (&["heap", "sand.toml", "--print-preparation"], "heap prepares nothing"),
        (&["drum", "sand.toml", "--set", "gravity=[0,0,0]"], "has no gravity"),
        (&["heap", "sand.toml", "--set", "gravity=[0,0,9.81]"], "has no gravity along"),
        (&["heap", "sand.toml", "--set", "fill.0.cluster=3"], "has fill.0.cluster"),
        (&["heap", "sand.toml", "--size", "0.1,0.2"], "takes one, the diameter"),
        (&["drum", "sand.toml", "--set", "local_damping.factor=0.5"], "has [local_damping]"),
        (&["drum", "sand.toml", "--strain", "0.05"], "at least 0.2 turns"),
        (&["drum", "sand.toml", "--inertial", "0.1"], "--inertial has no effect on drum"),
        (&["oedometer", "sand.toml", "--stress", "1"], "at least two stresses"),
        (&["oedometer", "sand.toml", "--strain", "0.1"], "--strain has no effect"),
        (&["direct-shear", "sand.toml", "--grains", "60"], "give a larger --size or more --grains"),
        (&["direct-shear", "sand.toml", "--stress", "5 mm"], "Pa"),
        (&["direct-shear", "rock.toml", "--grains", "60"], "--grains has no effect"),
        (&["crush", "rock.toml", "--set", "particles.0.cluster=0"], "not one cluster"),
        (&["direct-shear", "sand.toml", "--set", "material.0.yung=1"], "yung"),
        (&["uniaxial", "rock.toml", "--seeds", "2"], "leaves nothing to chance"),
        (&["direct-shear", "missing.toml"], "missing.toml"),
        (&["triaxial", "sand.toml", "--stress", "100kPa,50kPa,100kPa"], "--stress: 100000 Pa is given twice"),
        (&["oedometer", "sand.toml", "--stress", "1kPa,2kPa,2kPa"], "--stress: 2000 Pa is given twice"),
        (&["triaxial", "sand.toml", "--size", "20"], "grains, more than 1e7: give a smaller --size"),
        (&["triaxial", "sand.toml", "--print-scene", "--plot", "a.svg"], "--plot has no effect"),
        (&["triaxial", "sand.toml", "--print-scene", "--rest", "1e-3"], "--rest has no effect on the scene"),
        (
            &["triaxial", "sand.toml", "--print-preparation", "--seeds", "2"],
            "--seeds has no effect on the scene",
        ),
    ] {
        let done = tool(path, "lab-test", &[words, &["-o", "x.csv"]].concat());
        assert!(done.code != 0 && done.stderr.contains(said), "{words:?}: {}", done.stderr);
        assert!(!path.join("x.csv").exists());
    }
    // A guard that stops a specimen: exit code 3, and no curve of it.
    let soft = [SHEAR, &["--set", "material.0.young=2e4", "-q", "-o", "x.csv"]].concat();
    // The same again: what the run has left does not count as finished.
    let mut said = Vec::new();
    for _ in 0..2 {
        let done = tool(path, "lab-test", &soft);
        let stderr = done.stderr;
        assert_eq!(done.code, 3, "{stderr}");
        assert!(
            stderr.contains("a guard has stopped 1 of 1 specimens") && stderr.contains("overlaps"),
            "{stderr}"
        );
        said.push(stderr);
        assert!(!path.join("x.csv").exists(), "a file without a curve");
    }
    assert_eq!(said[0], said[1]);
    // What is doubtful in the sample is said before anything runs.
    let light =
        ["triaxial", "sand.toml", "--set", "material.0.density=2.65", "--print-scene", "-o", "x.toml"];
    let done = succeed(path, "lab-test", &light);
    assert!(
        done.stderr.contains("is lighter than any grain; if g/cm³ are meant, write 2650"),
        "{}",
        done.stderr
    );
}
