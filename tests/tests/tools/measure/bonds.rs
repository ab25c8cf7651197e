//! Bonds: how many, how they broke, and the fragments.

use super::made::{Grain, Made, at_rest};
use super::{column, failed, measure, saved, sum};
use grainpipe_tests::tools::succeed;
use std::fs;
use std::path::Path;
use tempfile::{TempDir, tempdir};

/// A row of ten grains, of material b at the end; the bonds break one after the other, the last leaves with its grain.
fn row_that_breaks() -> TempDir {
    let mut grains: Vec<Grain> = at_rest((0..10).map(|k| [0.02 * f64::from(k), 0.0, 0.01]), 0.01);
    grains[9].material = 1;
    let whole = |k: u32| ([k, k + 1], [0.5e6, 0.1e6 * f64::from(k)], None);
    let mut rows: Vec<_> = (0..9).map(whole).collect();
    let mut made = Made::new("");
    made.frame(0.0, &grains).bonds(0.0, &rows);
    rows[3] = ([3, 4], [1.0001e6, 9e9], Some((0.05, 1)));
    made.frame(0.1, &grains).bonds(0.1, &rows);
    rows[8] = ([8, 9], [1.9e6, 4.1e6], Some((0.15, 2)));
    // Of a run that does not say.
    rows[0] = ([0, 1], [0.2e6, 0.0], Some((0.2, 0)));
    made.frame(0.2, &grains).bonds(0.2, &rows);
    grains.pop();
    made.frame(0.3, &grains).bonds(0.3, &rows[..8]);
    saved(made)
}

#[test]
fn broken_bonds_are_counted_by_what_broke_them() {
    let folder = row_that_breaks();
    let done = measure(&folder, &["--bonds", "--plot", "bonds.svg"]);
    let is = |name: &str, values: [f64; 4]| assert_eq!(column(&done, name), values, "{name}");
    is("bonds", [9.0, 9.0, 9.0, 8.0]);
    is("whole", [9.0, 8.0, 6.0, 6.0]);
    is("broken", [0.0, 1.0, 3.0, 2.0]);
    is("broken_by_tension", [0.0, 1.0, 1.0, 1.0]);
    is("broken_by_shear", [0.0, 0.0, 1.0, 0.0]);
    is("broken_unknown", [0.0, 0.0, 1.0, 1.0]);
    is("broken_since", [0.0, 1.0, 2.0, 0.0]);
    is("fragments", [1.0, 2.0, 4.0, 3.0]);
    is("largest_fragment", [10.0, 6.0, 5.0, 5.0]);
    is("largest_tension", [0.5e6; 4]);
    is("largest_shear", [0.8e6, 0.8e6, 0.7e6, 0.7e6]);
    for part in ["how 1 bond broke is unknown", "1 bond left the run"] {
        assert!(done.stderr.contains(part), "{part}: {}", done.stderr);
    }
    assert!(fs::read(folder.path().join("bonds.svg")).unwrap().starts_with(b"<svg"));
    assert_eq!(sum(&folder, &["--bonds"], "first_break"), 0.05);
    let part = measure(&folder, &["--bonds", "--from", "0.15", "--until", "0.25"]);
    assert_eq!(column(&part, "broken"), [3.0]);
    let message = failed(&folder, &["--bonds", "--from", "5"]);
    assert!(message.contains("no frame from 5 to inf s") && message.contains("from 0 to 0.3 s"), "{message}");
}

/// The beam of the examples: dem-run says how many bonds broke, dem-measure says the same and how.
#[test]
fn the_beam_of_the_examples_breaks_by_tension() {
    let folder = tempdir().unwrap();
    let beam = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/beam.toml")).to_str().unwrap();
    let ran = succeed(folder.path(), "dem-run", &[beam, "-o", "run.mcap", "--report", "run.json"]);
    let report = fs::read_to_string(folder.path().join("run.json")).unwrap();
    let done = measure(&folder, &["--bonds"]);
    let (all, broken) = (column(&done, "bonds"), column(&done, "broken"));
    let last = |name: &str| *column(&done, name).last().unwrap();
    assert!(broken[0] == 0.0 && last("broken") > 0.0, "{broken:?}: {} {report}", ran.stderr);
    assert_eq!(last("broken_by_tension") + last("broken_by_shear"), last("broken"));
    assert!(last("broken_by_tension") > last("broken_by_shear"), "a beam that bends");
    assert!(last("fragments") >= 2.0 && column(&done, "fragments")[0] == 1.0);
    assert!(all.iter().all(|n| *n == all[0]));
}
