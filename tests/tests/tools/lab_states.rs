//! lab-test: what is said of a specimen is true of it at that moment, in every test.

use grainpipe_tests::lab::{ROCK, SAND, cube};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::succeed;
use serde_json::Value;
use std::fs;
use std::path::Path;

const PARTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

/// Runs a test; its report, and the columns of its curve by name.
fn tested(path: &Path, words: &str) -> (Value, Vec<String>, Vec<Vec<f64>>) {
    let line: Vec<&str> = words.split(' ').collect();
    succeed(path, "lab-test", &[&line[..], &["-q", "--report", "r.json", "-o", "c.csv"]].concat());
    let report = serde_json::from_slice(&fs::read(path.join("r.json")).unwrap()).unwrap();
    let text = fs::read_to_string(path.join("c.csv")).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').map(|n| n.split(" [").next().unwrap().to_owned()).collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    (report, names, lines.map(row).collect())
}

fn number(state: &Value, key: &str) -> f64 {
    let found = state.pointer(&format!("/{key}")).unwrap_or_else(|| panic!("no {key} in {state}"));
    found.as_f64().unwrap_or_else(|| panic!("{key} is {found} in {state}"))
}

/// Relations of one moment of a specimen between walls, or in a periodic domain.
fn check(state: &Value) {
    let size: f64 = (0..3).map(|k| number(state, &format!("size/{k}"))).product();
    let (n, e) = (number(state, "porosity"), number(state, "void_ratio"));
    let (volume, solid) = (number(state, "volume"), number(state, "solid_volume"));
    assert!((e - n / (1.0 - n)).abs() < 1e-9, "{state}");
    assert!((volume * (1.0 - n) / solid - 1.0).abs() < 1e-9 && volume <= size * (1.0 + 1e-9), "{state}");
    assert!((number(state, "mass") / solid - 2650.0).abs() < 1e-6 * 2650.0, "{state}");
    // Loosely packed spheres at least, and no more than the densest.
    assert!(n > 0.25 && n < 0.6, "{state}");
    let trace: f64 = PARTS[..3].iter().map(|part| number(state, &format!("fabric/{part}"))).sum();
    assert!((trace - 1.0).abs() < 1e-9, "{state}");
    let (z, zm) = (number(state, "coordination"), number(state, "mechanical_coordination"));
    assert!(z > 2.0 && z < 9.0 && zm >= z * (1.0 - number(state, "rattlers")), "{state}");
    assert!(number(state, "inertial_number") < 0.1, "{state}");
}

fn moments(report: &Value) -> [&Value; 3] {
    ["start", "peak", "end"].map(|moment| &report["states"][0][moment])
}

#[test]
fn specimens_are_as_large_full_and_stressed_as_is_said() {
    let lab = folder(&[("sand.toml", SAND.to_owned())]);
    let path = lab.path();
    let cases = [
        (
            "triaxial sand.toml --set gravity=[0,0,0] --grains 200 --stress 1000 --rows 40 --strain 4%",
            "axial_stress",
        ),
        (
            "triaxial-periodic sand.toml --set gravity=[0,0,0] --grains 200 --stress 1000 --rows 40 --strain 4%",
            "axial_stress",
        ),
        ("oedometer sand.toml --grains 300 --stress 1000,2000 --rows 40", "stress"),
        ("direct-shear sand.toml --grains 200 --stress 1000 --rows 40 --strain 4%", "lid_stress"),
    ];
    for (words, axial) in cases {
        let (report, names, rows) = tested(path, words);
        let column = |name: &str| {
            let at = names.iter().position(|n| n == name).unwrap_or_else(|| panic!("{words}: no {name}"));
            rows.iter().map(|row| row[at]).collect::<Vec<f64>>()
        };
        let all = moments(&report);
        all.iter().for_each(|state| check(state));
        // The tensor follows from forces and branches, the axial stress from the walls or the engine: the mean over the height has half of the weight above it.
        for (state, row) in [(all[0], 0), (all[2], rows.len() - 1)] {
            let area = number(state, "size/0") * number(state, "size/1");
            let weight = number(state, "mass") * if words.contains("gravity") { 0.0 } else { 9.81 };
            let (tensor, walls) = (number(state, "stress/zz"), column(axial)[row] + 0.5 * weight / area);
            assert!((tensor / walls - 1.0).abs() < 0.03, "{words}: {tensor} {walls}");
            assert!((number(state, "time") - column("time")[row]).abs() <= 1e-5 * number(all[2], "time"));
            for (name, key) in
                [("void_ratio", "void_ratio"), ("size_z", "size/2"), ("fabric_zz", "fabric/zz")]
            {
                assert!((column(name)[row] / number(state, key) - 1.0).abs() < 1e-5, "{words}: {name}");
            }
        }
        // The height falls by what the axial strain says.
        if let Some(strain) = names.iter().position(|n| n == "axial_strain" || n == "strain") {
            let (first, last) = (number(all[0], "size/2"), number(all[2], "size/2"));
            let said = rows[rows.len() - 1][strain];
            assert!((1.0 - last / first - said).abs() < 2e-3, "{words}: {first} {last} {said}");
        }
        assert_eq!(report["size"], all[0]["size"], "{words}");
        let peak = number(all[1], "time");
        assert!(peak > 0.0 && peak <= number(all[2], "time"), "{words}");
    }
}

/// A periodic specimen is as large as its domain, which is smaller than that of its filling.
#[test]
fn a_periodic_specimen_has_the_size_of_its_domain_when_the_test_starts() {
    let lab = folder(&[("sand.toml", SAND.to_owned())]);
    let path = lab.path();
    let words = "triaxial-periodic sand.toml --set gravity=[0,0,0] --grains 200 --stress 1000 --rows 40 --strain 1% --dir d";
    let (report, ..) = tested(path, words);
    let domain = fs::read_to_string(path.join("d/stress=1000,seed=0/domain.csv")).unwrap();
    let cells: Vec<f64> = domain.lines().nth(1).unwrap().split(',').map(|c| c.parse().unwrap()).collect();
    for k in 0..3 {
        let said = report["size"][k].as_f64().unwrap();
        assert!((said / cells[1 + k] - 1.0).abs() < 1e-9, "{said} {cells:?}");
    }
    // The stress of forces and branches in the whole domain is that of the engine.
    let engine = report["states"][0]["start"]["stress"]["zz"].as_f64().unwrap() / cells[10];
    assert!((engine - 1.0).abs() < 1e-6, "{engine}");
}

/// Tests without walls around the specimen have sizes and contacts, and neither volume nor stress.
#[test]
fn what_no_walls_bound_has_no_volume() {
    let lab = folder(&[("rock.toml", ROCK.to_owned()), ("stone.csv", cube())]);
    let (report, names, _) = tested(lab.path(), "crush rock.toml --rows 40");
    let [start, peak, end] = moments(&report);
    for state in [start, peak, end] {
        assert!(
            state["volume"].is_null() && state["stress"]["zz"].is_null() && state["void_ratio"].is_null()
        );
        assert!(number(state, "size/2") > 0.0 && number(state, "coordination") > 0.0, "{state}");
    }
    assert!(names.iter().any(|n| n == "size_x") && names.iter().any(|n| n == "coordination"), "{names:?}");
}
