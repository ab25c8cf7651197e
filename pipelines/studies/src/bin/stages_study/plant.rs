//! The small plant (pipelines/stages/small.toml), its cuts, and what is measured of a run of it.

use crate::kept;
use crate::shell::{column, line, measure, summary};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Largest diameter [m].
pub const GRAIN: f64 = 0.005;
/// Stiffness of the scene [N/m].
const STIFFNESS: f64 = 1000.0;
/// When grains pass every cut steadily [s].
const STEADY: &str = "--from 0.15 --until 0.4";

/// Where the plant is cut.
#[derive(Debug, Clone, Copy)]
pub struct Cut {
    /// In words.
    pub says: &'static str,
    /// Plane as stage-split takes it.
    pub plane: &'static str,
    /// Box before the plane, in which the speed is taken.
    pub before: &'static str,
}

/// Inside the bed of the hopper, at its mouth, below it, across the chute.
pub const CUTS: [Cut; 5] = [
    Cut {
        says: "in the bed, 8 d above the mouth",
        plane: "0,0,0.25,0,0,-1",
        before: "-0.05,-0.008,0.25,0.05,0.008,0.258",
    },
    Cut {
        says: "in the bed, 2 d above the mouth",
        plane: "0,0,0.22,0,0,-1",
        before: "-0.02,-0.008,0.22,0.02,0.008,0.228",
    },
    Cut { says: "at the mouth", plane: "0,0,0.21,0,0,-1", before: "-0.015,-0.008,0.21,0.015,0.008,0.218" },
    Cut { says: "2 d below the mouth", plane: "0,0,0.2,0,0,-1", before: "-0.02,-0.008,0.2,0.02,0.008,0.208" },
    Cut {
        says: "across the chute",
        plane: "0.023,0,0.1557,0.766,0,-0.643",
        before: "0.008,-0.008,0.13,0.02,0.008,0.19",
    },
];

/// How a run is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Index of the cut and its zone: motion, length in largest diameters; `None`: undivided.
    pub cut: Option<(usize, &'static str, f64)>,
    /// Factor on the stiffness.
    pub stiffness: f64,
    /// Share of the critical step.
    pub safety: f64,
}

/// Names and units of what is measured.
pub const QUANTITIES: [&str; 6] = [
    "flow through the cut",
    "speed before the cut",
    "force through the cut",
    "flow into the box",
    "speed on the chute",
    "heap angle",
];

/// What was measured of the plant, seen from one cut.
#[derive(Debug, Clone)]
pub struct Found {
    /// As [`QUANTITIES`]; NaN where something could not be measured.
    pub values: [f64; 6],
    /// Mass that has passed the cut, and that has come into the box, over time [s, kg].
    pub passed: [Vec<(f64, f64)>; 2],
    /// Downward speed before the cut over x [m, m/s].
    pub profile: Vec<(f64, f64)>,
    /// Why the downstream stage ended early.
    pub stopped: Option<String>,
}

/// Folder of the scene.
pub fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../stages")
}

/// What each cut sees of the plant with a setting and a seed, or the one cut that it has: run now, or kept in the folder by an earlier study
/// of the same scene.
///
/// # Errors
/// What the upstream stage says where it fails.
pub fn seen(folder: &Path, setting: &Setting, seed: u64) -> Result<Vec<Found>, String> {
    let text = std::fs::read(scenes().join("small.toml")).map_err(|why| format!("small.toml: {why}"))?;
    let name = format!("{setting:?}-{seed}").replace(|c: char| !c.is_ascii_alphanumeric() && c != '.', "-");
    let kept = folder.join(format!("{name}-{:.8}.json", stream::sha256(&text)));
    if let Some(found) =
        std::fs::read(&kept).ok().and_then(|b| serde_json::from_slice(&b).ok()).as_ref().and_then(kept::read)
    {
        return Ok(found);
    }
    let found = run(folder, setting, seed)?;
    std::fs::write(&kept, kept::text(&found)).map_err(|why| format!("{}: {why}", kept.display()))?;
    Ok(found)
}

fn run(folder: &Path, setting: &Setting, seed: u64) -> Result<Vec<Found>, String> {
    let own = folder
        .join(format!("{:?}-{seed}", setting).replace(|c: char| !c.is_ascii_alphanumeric() && c != '.', "-"));
    std::fs::create_dir_all(&own).map_err(|why| format!("{}: {why}", own.display()))?;
    let scene = scenes().join("small.toml");
    let scene = scene.display();
    let set = |k: usize| format!("--set contact.{k}.stiffness={}", STIFFNESS * setting.stiffness);
    let common = format!("{} {} --set time.safety={} --threads 1 -q", set(0), set(1), setting.safety);
    let found = match setting.cut {
        None => {
            line(&own, &format!("dem-run {scene} {common} --set fill.0.seed={seed} -o whole.mcap"))?;
            CUTS.iter().map(|cut| see(&own, cut, "whole.mcap", "whole.mcap")).collect()
        }
        Some((at, motion, length)) => {
            let cut = &CUTS[at];
            let zone = format!("--at={} --length {} --motion {motion}", cut.plane, length * GRAIN);
            for keep in ["upstream", "downstream"] {
                line(&own, &format!("stage-split {scene} {zone} --keep {keep} -o {keep}.toml -q"))?;
            }
            line(&own, &format!("dem-run upstream.toml {common} --set fill.0.seed={seed} -o up.mcap"))?;
            // Grains arrive T late, some milliseconds: all that is measured is of steady flow, or of the end.
            line(&own, "stage-replay up.mcap --from 0 -o in.mcap -q")?;
            let done = line(&own, &format!("dem-run downstream.toml in.mcap {common} -o down.mcap"));
            let mut found = see(&own, cut, "up.mcap", "down.mcap");
            if let Err(why) = done {
                found.stopped = Some(why);
                found.values[3..].fill(f64::NAN);
            }
            vec![found]
        }
    };
    std::fs::remove_dir_all(&own).map_err(|why| format!("{}: {why}", own.display()))?;
    Ok(found)
}

/// What is seen of a run, or of a pair of stages; what cannot be measured is NaN.
fn see(folder: &Path, cut: &Cut, up: &str, down: &str) -> Found {
    let (flow, into) = (format!("--flow={}", cut.plane), "--flow=0,0,0.1,0,0,-1");
    let ask = |run: &str, what: &str| measure(folder, run, what).unwrap_or(Value::Null);
    let before =
        |bins: usize| format!("--profile --axis x --bins {bins} --within box:{} --mean {STEADY}", cut.before);
    let speed = |found: &Value| {
        let (grains, speeds) = (column(found, "grains"), column(found, "speed"));
        speeds.first().copied().filter(|_| grains.first().is_some_and(|n| *n > 0.0)).unwrap_or(f64::NAN)
    };
    let lower = "--profile --axis x --bins 1 --within box:0.03,-0.008,0.11,0.049,0.008,0.17 --mean --from 0.25 --until 0.5";
    let heap = ask(down, "--repose --side x+ --sectors 2 --ground 0");
    let values = [
        summary(&ask(up, &format!("{flow} {STEADY}")), "mass_flow"),
        speed(&ask(up, &before(1))),
        summary(&ask(up, &format!("--plane-force={} {STEADY}", cut.plane)), "mean_normal"),
        summary(&ask(down, &format!("{into} --from 0.3 --until 0.55")), "mass_flow"),
        speed(&ask(down, lower)),
        summary(&heap, "angle"),
    ];
    let profile = ask(up, &before(8));
    let sums = |run: &str, plane: &str| {
        let found = ask(run, plane);
        column(&found, "to").into_iter().zip(column(&found, "mass_sum")).collect()
    };
    let speeds = column(&profile, "vz").into_iter().map(|v| -v);
    Found {
        values,
        passed: [sums(up, &flow), sums(down, into)],
        profile: column(&profile, "x").into_iter().zip(speeds).collect(),
        stopped: None,
    }
}
