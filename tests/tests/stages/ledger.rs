//! The ledger of both stages where clumps and bonded lumps are in the zones.

use super::{bonds::lumps, clumps::clumped};
use grainpipe_tests::tools::succeed;
use std::path::Path;

/// Sum of the changes of all terms over the energy exchanged [–].
fn closure(folder: &Path, run: &str) -> f64 {
    let told = succeed(folder, "dem-measure", &[run, "--energy", "-o", "energy.csv"]).stderr;
    let number = |name: &str| -> f64 {
        let rest = told.split(name).nth(1).unwrap_or_else(|| panic!("{name}: {told}"));
        rest.trim_start().split(' ').next().and_then(|n| n.parse().ok()).unwrap_or_else(|| panic!("{told}"))
    };
    number("largest_closure_error") / number("exchanged")
}

/// The sum of all terms stays on both sides of a cut, with every motion, and the energy guard stops neither.
#[test]
fn the_ledger_closes_with_clumps_and_bonds_in_both_zones() {
    for motion in ["constant", "ballistic", "recorded"] {
        let option = format!("--motion {motion}");
        for (name, folder) in [("clumps", clumped(&option)), ("bonds", lumps(motion))] {
            let path = folder.path();
            let ledger = ["--set", "output.energy=true", "-q"];
            succeed(path, "dem-run", &[&["up.toml", "-o", "up.mcap"], &ledger[..]].concat());
            succeed(path, "stage-replay", &["up.mcap", "--keep-times", "-q", "-o", "in.mcap"]);
            succeed(path, "dem-run", &[&["down.toml", "in.mcap", "-o", "down.mcap"], &ledger[..]].concat());
            for run in ["up.mcap", "down.mcap"] {
                let closure = closure(path, run);
                assert!(closure < 1e-10, "{name}, {motion}, {run}: {closure:e} of the energy exchanged");
            }
        }
    }
}
