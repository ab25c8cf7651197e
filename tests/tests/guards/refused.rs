//! Limits, numbers and starts that cannot be are refused before the run.

use super::{COLLISION, scene};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::tools::tool;

const REFUSED: Case = case("Guards", "invalid limits are refused");

/// Numbers that no scene can mean are refused before the run, with key, value, unit and range.
#[test]
fn numbers_beyond_all_meaning() {
    let refused = |on: &str, particles: &str, more: &str, set: &[&str], words: &[&str]| {
        let folder = scene(particles, more);
        let done = tool(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], set].concat());
        assert!(done.code == 1 && !folder.path().join("run.mcap").exists(), "{on}: {}", done.stderr);
        REFUSED.refused(on, &done.stderr, words);
    };
    for spin in ["1e15", "1e18", "1e99"] {
        let words = ["particle 7: spin", "rad/s is outside −1e12 to 1e12"];
        refused(
            &format!("a spin of {spin} rad/s"),
            &format!("7,0,0,0,0.01,0,0,0,0,{spin},0\n"),
            "",
            &[],
            &words,
        );
    }
    for speed in ["1e15", "1e99"] {
        let words = ["particle 7: velocity", "m/s is outside −1e12 to 1e12"];
        refused(
            &format!("a speed of {speed} m/s"),
            &format!("7,0,0,0,0.01,{speed},0,0,0,0,0\n"),
            "",
            &[],
            &words,
        );
    }
    let bond = "[[bond]]\nbetween = [\"glass\", \"glass\"]\ngap = 1e-3\nyoung = 1e308\npoisson = 0.2\n";
    let pair = "1,0,0,0,0.01,0,0,0,0,0,0\n2,0.0205,0,0,0.01,0,0,0,0,0,0\n";
    refused("a bond of 1e308 Pa", pair, bond, &[], &["bond.0.young", "1e-9 to 1e35 Pa"]);
    let domain = "[domain]\nperiodic = [\"x\"]\nlow = [-1, nan, 0]\nhigh = [1, 0, inf]\n";
    refused("NaN of an axis that is not periodic", pair, domain, &[], &["domain.low", "must be finite"]);
    for (set, words) in [
        ("gravity=[0,0,-1e300]", ["gravity", "m/s²"]),
        ("material.0.young=1e300", ["material.0.young", "1e-9 to 1e35 Pa"]),
        ("material.0.density=1e300", ["material.0.density", "kg/m³"]),
        ("time.until=1e300", ["time.until", "4e9 s"]),
        ("time.dt=1e-300", ["time.dt", "1e-18 to 4e9 s"]),
        ("neighbours.skin=1e300", ["neighbours.skin", "1e15 m"]),
    ] {
        refused(set, pair, "", &["--set", set], &words);
    }
}

/// Starts that cannot be are the scene's fault: refused with code 1 and the grains, and no file.
#[test]
fn grains_at_one_place() {
    for distance in ["0", "1e-300", "1e-12"] {
        let folder = scene(&format!("41,0,0,0,0.01,0,0,0,0,0,0\n42,{distance},0,0,0.01,0,0,0,0,0,0\n"), "");
        let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
        assert!(
            done.code == 1
                && !folder.path().join("run.mcap").exists()
                && !folder.path().join("run.mcap.part").exists()
        );
        REFUSED.refused(
            &format!("centres {distance} m apart"),
            &done.stderr,
            &["s.toml", "41", "42", "move it"],
        );
    }
}

#[test]
fn limits_that_are_none() {
    let folder = scene(COLLISION, "");
    for (set, words) in [
        ("guards.overlap=0", ["guards.overlap", "above 0"]),
        ("guards.overlap=-1", ["guards.overlap", "-1"]),
        ("guards.overlap=nan", ["guards.overlap", "NaN"]),
        ("guards.overlap=2", ["guards.overlap", "2"]),
        ("guards.motion=0", ["guards.motion", "above 0"]),
        ("guards.motion=nan", ["guards.motion", "NaN"]),
        ("guards.motion=-inf", ["guards.motion", "-inf"]),
        ("guards.zones=3", ["wrong kind of value", "expected true, false or \"remove\""]),
        ("guards.overlaps=0.1", ["overlaps", "did you mean 'overlap'"]),
    ] {
        let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap", "--set", set]);
        assert_eq!(done.code, 1, "{set}: {}", done.stderr);
        REFUSED.refused(
            set,
            &done.stderr.to_lowercase(),
            &words.map(str::to_lowercase).each_ref().map(String::as_str),
        );
    }
}
