//! `lab-test uniaxial` is slow enough for bonded grains by itself, and says where it is not.

use grainpipe_tests::lab::ROCK;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::tool;
use serde_json::Value;
use std::fs;

/// A column of 3 × 3 × 8 touching grains.
fn column() -> String {
    let at = |k: usize| 0.001 * k as f64;
    let row = |k: usize| format!("{},{},{},0.0005\n", at(k % 3), at(k / 3 % 3), at(k / 9));
    ["x,y,z,radius\n".to_owned()].into_iter().chain((0..72).map(row)).collect()
}

#[test]
fn a_core_is_tested_slowly_and_a_fast_test_warns() {
    // Contacts as stiff as bonds are: the whole column strains.
    let rock = ROCK.replace("stiffness = 1e5\n", "stiffness = 1e6\n");
    let lab = folder(&[("rock.toml", rock), ("stone.csv", column())]);
    let path = lab.path();
    let test = |name: &str, more: &[&str]| -> (f64, f64, String) {
        let report = format!("{name}.json");
        let words =
            ["uniaxial", "rock.toml", "--strain", "0.004", "--report", &report, "-o", "c.csv", "--dir", name];
        let done = tool(path, "lab-test", &[&words[..], more].concat());
        assert_eq!(done.code, 0, "{}", done.stderr);
        let json: Value = serde_json::from_slice(&fs::read(path.join(report)).unwrap()).unwrap();
        let value = |name: &str| json[name].as_f64().unwrap();
        (value("young"), value("strength"), done.stderr)
    };
    let (young, strength, said) = test("slow", &[]);
    assert!(!said.contains("too fast"), "{said}");
    // 20 passes of a wave until ε = 2e-3: 0.02 m/s.
    let (slower, weaker, _) = test("slower", &["--speed", "0.005"]);
    assert!(
        (young / slower - 1.0).abs() < 0.03 && (strength / weaker - 1.0).abs() < 0.05,
        "{young} {slower}"
    );
    let (fast, _, said) = test("fast", &["--speed", "1"]);
    assert!(said.contains("too fast") && said.contains("use --speed"), "{said}");
    assert!((fast / slower - 1.0).abs() > 0.1, "{fast} {slower}");
}
