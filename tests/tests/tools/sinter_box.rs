//! The sinter box, scaled down and softened: in stages it makes the slope that the plant makes undivided, and all its forms have one friction.
//!
//! The full case is `make -C pipelines sinter-box`; what it found is in docs/evidence/stages.md.

use grainpipe_tests::tools::{line, succeed};
use grainpipe_tests::tree::root;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

fn folder() -> PathBuf {
    root().join("pipelines/stages").canonicalize().expect("pipelines/stages")
}

/// Slope of the heap that leans on the far wall [deg].
fn slope(folder: &Path, run: &str) -> f64 {
    let measure = ["--repose", "--side", "x+", "--sectors", "2", "--ground", "0", "--report", "slope.json"];
    succeed(folder, "dem-measure", &[&[run], &measure[..]].concat());
    let report = fs::read_to_string(folder.join("slope.json")).expect("a report");
    serde_json::from_str::<serde_json::Value>(&report).expect("JSON")["angle"].as_f64().expect("an angle")
}

/// 600 grains, three seeds: the slope with the friction of the full box, cut as that one is: at the mouth with zones of 1.2 d, along recorded paths.
///
/// A heap of 15 grains in height is flatter than the full one, which is 50 high: undivided it has 30.5°, the mean of twelve seeds with a deviation of
/// 2.6° from one to the next. The mean of three is allowed 4°, two and a half of its own deviations; with almost no rolling resistance the heap has less than 10°.
#[test]
fn the_small_box_in_stages_has_the_slope_of_the_small_box() {
    let place = folder();
    let own = tempdir().expect("a folder");
    let scene = place.join("small.toml");
    for keep in ["upstream", "downstream"] {
        let cut =
            ["--at", "0,0,0.21,0,0,-1", "--length", "0.006", "--motion", "recorded", "--keep", keep, "-o"];
        let file = format!("{keep}.toml");
        succeed(own.path(), "stage-split", &[&[scene.to_str().expect("UTF-8")], &cut[..], &[&file]].concat());
    }
    let angles: Vec<f64> = (0..3)
        .map(|seed| {
            let quiet = "--set output.contacts=false --threads 1 -q";
            let up =
                format!("dem-run upstream.toml --set fill.0.seed={seed} --set outlet.0.samples=2e-4 {quiet}");
            let run = format!(
                "{up} | stage-replay --keep-times -q | dem-run downstream.toml - {quiet} -o down-{seed}.mcap"
            );
            let done = line(own.path(), &run);
            assert_eq!(done.code, 0, "{}", done.stderr);
            slope(own.path(), &format!("down-{seed}.mcap"))
        })
        .collect();
    let mean = angles.iter().sum::<f64>() / 3.0;
    assert!((mean - 30.5).abs() < 4.0, "{mean}° of {angles:?}");
}

/// What is stated is what is run: friction, restitution and stiffness ratio of the full box, its slice and the small plant are the same.
#[test]
fn all_forms_of_the_box_have_the_same_friction() {
    let keys = ["restitution", "sliding_friction", "rolling_resistance", "tangential_ratio"];
    let contacts = |name: &str| -> Vec<(String, String)> {
        let text = fs::read_to_string(folder().join(name)).expect(name);
        let of_sinter = text.split("[[contact]]").skip(1).take(2).collect::<String>();
        let pairs = of_sinter.lines().filter_map(|l| l.split_once(" = "));
        let plain = |v: &str| v.split('#').next().unwrap_or_default().trim().to_owned();
        pairs.filter(|(k, _)| keys.contains(k)).map(|(k, v)| (k.to_owned(), plain(v))).collect()
    };
    let full = contacts("sinter-box.toml");
    assert_eq!(full.len(), 8, "{full:?}");
    for name in ["sinter-slice.toml", "small.toml", "../calibration/sinter-slice.toml"] {
        assert_eq!(contacts(name), full, "{name}");
    }
}

/// The surfaces are those that the scenes say they were drawn with.
#[test]
fn the_surfaces_are_drawn_by_their_script() {
    let forms = [("", ""), ("slice-", "low=-0.024 high=0.024")];
    let small = ("small-", "scale=0.35 mouth=0.03 low=-0.008 high=0.008");
    let of_calibration = ("../calibration/sinter-", "low=-0.008 high=0.008");
    for (prefix, settings) in forms.into_iter().chain([small, of_calibration]) {
        for part in ["hopper", "chute", "box"] {
            let done = line(&folder(), &format!("./geometry.sh {part} {settings}"));
            let file = format!("{prefix}{part}.ply");
            assert_eq!(
                String::from_utf8_lossy(&done.stdout),
                fs::read_to_string(folder().join(&file)).expect("a surface"),
                "{file}"
            );
        }
    }
    assert_eq!(line(&folder(), "./geometry.sh lid").code, 2);
}
