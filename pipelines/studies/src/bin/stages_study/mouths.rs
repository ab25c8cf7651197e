//! Mouths: a cone and a slot (pipelines/stages/mouth.toml), cut at the mouth and below it, with and without a settled bed, and with a
//! lid that opens half.

use crate::page::{MOUTH, difference, put, table};
use crate::plant::scenes;
use crate::shell::{line, measure, summary};
use measure::statistics::Mean;
use rayon::prelude::*;
use serde_json::Value;
use std::path::Path;

/// A hopper, and how its lid moves.
struct Case {
    says: &'static str,
    mesh: &'static str,
    lid: &'static str,
    /// When grains are counted [s].
    window: [f64; 2],
}

const SETTLED: &str = "{ translate = [4, 0, 0], from = 0.35, until = 0.375 }";
const OPEN: &str = "{ translate = [4, 0, 0], from = 0, until = 0.025 }";
const PARTLY: &str = "{ translate = [1.6, 0, 0], from = 0.35, until = 0.375 }";
const CONE: &str = "mouth-cone.obj";
const SLOT: &str = "mouth-slot.obj";
const CASES: [Case; 4] = [
    Case { says: "a cone with a settled bed", mesh: CONE, lid: SETTLED, window: [0.4, 0.5] },
    Case { says: "a cone that is open from the start", mesh: CONE, lid: OPEN, window: [0.2, 0.3] },
    Case { says: "a slot with a settled bed", mesh: SLOT, lid: SETTLED, window: [0.4, 0.5] },
    Case {
        says: "a slot with a settled bed, the gate half open",
        mesh: SLOT,
        lid: PARTLY,
        window: [0.45, 0.6],
    },
];
/// Where it is cut, with the height of the plane [m]; a mean diameter is 8 mm.
const PLACES: [(&str, f64); 2] = [("at the mouth", 0.0), ("3.5 d below", -0.028)];
const MOTIONS: [&str; 3] = ["recorded", "ballistic", "constant"];
/// The plate is below this plane.
const ONTO: &str = "--flow=0,0,-0.2,0,0,-1";

/// What is counted of a run, or of two stages: grains through the cut in the window, grains that come down to the plate, and what the zone holds back [–].
type Counted = [f64; 3];

/// Runs everything and writes the part "mouths" of the page.
///
/// # Errors
/// Runs that fail, files that cannot be written.
pub fn study(folder: &Path, page: &Path, seeds: usize) -> Result<(), String> {
    let mut text = format!(
        "Each line gives the mean difference from the undivided runs with the same {seeds} fills, ± its 95 % interval (Student). It is bold if the interval \
         does not include zero. \"Holds back\" is the momentum that grains behind the plane push back, over that of those that pass (the run's report). A case whose downstream stage a guard stopped has no numbers.\n"
    );
    for case in &CASES {
        text += &format!("\n### Mouth of {}\n{}", case.says, section(folder, case, seeds)?);
    }
    put(folder, page, ("mouths", MOUTH), &text)
}

fn section(folder: &Path, case: &Case, seeds: usize) -> Result<String, String> {
    let cuts = PLACES.iter().flat_map(|place| MOTIONS.map(|motion| Some((*place, motion))));
    // Undivided, each cut is seen.
    let all: Vec<_> = PLACES.iter().map(|_| None).chain(cuts).collect();
    let jobs: Vec<(usize, u64)> =
        (0..all.len()).flat_map(|k| (0..seeds as u64).map(move |seed| (k, seed))).collect();
    let height = |k: usize| all[k].map_or_else(|| PLACES[k].1, |((_, height), _)| height);
    let counted = jobs
        .par_iter()
        .map(|&(k, seed)| counted(folder, case, (all[k].map(|(_, motion)| motion), height(k)), seed));
    let counted: Vec<Result<Counted, String>> = counted.collect();
    let of = |k: usize, seed: usize| &counted[k * seeds + seed];
    let mut rows = Vec::new();
    for (p, (place, _)) in PLACES.iter().enumerate() {
        let whole: Vec<&Counted> =
            (0..seeds).map(|s| of(p, s).as_ref().map_err(Clone::clone)).collect::<Result<_, _>>()?;
        let mean = |q: usize| {
            let m = Mean::of(&whole.iter().map(|w| w[q]).collect::<Vec<_>>());
            format!("{:.0} ± {:.0}", m.mean, m.deviation)
        };
        rows.push(vec![format!("undivided, {place}"), mean(0), mean(1), String::new()]);
        for (m, motion) in MOTIONS.iter().enumerate() {
            let k = PLACES.len() + p * MOTIONS.len() + m;
            let runs: Vec<(usize, &Counted)> =
                (0..seeds).filter_map(|s| Some((s, of(k, s).as_ref().ok()?))).collect();
            let stopped = seeds - runs.len();
            let share = |q: usize| {
                if stopped > 0 {
                    return format!("stopped {stopped} of {seeds}");
                }
                let differ: Vec<f64> =
                    runs.iter().map(|(s, found)| 100.0 * (found[q] / whole[*s][q] - 1.0)).collect();
                let Mean { mean, interval, .. } = Mean::of(&differ);
                difference(mean, interval, " %")
            };
            let held: Vec<f64> = runs.iter().map(|(_, found)| 100.0 * found[2]).collect();
            let held =
                if held.is_empty() { "–".to_owned() } else { format!("{:.0} %", Mean::of(&held).mean) };
            rows.push(vec![format!("{motion}, {place}"), share(0), share(1), held]);
        }
    }
    Ok(table(&["cut", "grains through the cut", "grains onto the plate", "holds back"], &rows))
}

/// Runs a case with a fill, undivided or cut at a height [m], or takes what an earlier study of the same scene kept.
fn counted(
    folder: &Path,
    case: &Case,
    (motion, height): (Option<&str>, f64),
    seed: u64,
) -> Result<Counted, String> {
    let scene = scenes().join("mouth.toml");
    let text = std::fs::read(&scene).map_err(|why| format!("mouth.toml: {why}"))?;
    let name = format!("{}-{}-{motion:?}-{height}-{seed}", case.mesh, case.says)
        .replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let kept = folder.join(format!("{name}-{:.8}.json", stream::sha256(&text)));
    if let Some(found) = std::fs::read(&kept).ok().and_then(|b| serde_json::from_slice(&b).ok()) {
        return found;
    }
    let own = folder.join(&name);
    std::fs::create_dir_all(&own).map_err(|why| format!("{}: {why}", own.display()))?;
    let found = run(&own, &scene, case, (motion, height), seed);
    std::fs::remove_dir_all(&own).map_err(|why| format!("{}: {why}", own.display()))?;
    let text = serde_json::to_vec(&found).map_err(|why| why.to_string())?;
    std::fs::write(&kept, text).map_err(|why| format!("{}: {why}", kept.display()))?;
    found
}

fn run(
    own: &Path,
    scene: &Path,
    case: &Case,
    (motion, height): (Option<&str>, f64),
    seed: u64,
) -> Result<Counted, String> {
    // Both stages are cut from the scene of the case: near the mouth the hopper and its lid are in both.
    let text = std::fs::read_to_string(scene).map_err(|why| format!("mouth.toml: {why}"))?;
    let mesh = scenes().join(case.mesh);
    let changes = [
        (format!("\"{CONE}\""), format!("\"{}\"", mesh.display())),
        (format!("motion = {SETTLED}"), format!("motion = {}", case.lid)),
        ("count = 700".to_owned(), format!("count = 700\nseed = {seed}")),
    ];
    let text = changes.into_iter().try_fold(text, |text, (from, to)| {
        if text.contains(&from) {
            Ok(text.replace(&from, &to))
        } else {
            Err(format!("mouth.toml: has no {from}"))
        }
    })?;
    let scene = own.join("plant.toml");
    std::fs::write(&scene, text).map_err(|why| format!("{}: {why}", scene.display()))?;
    let through = format!("--flow=0,0,{height},0,0,-1 --from {} --until {}", case.window[0], case.window[1]);
    let count =
        |run: &str, what: &str| -> Result<f64, String> { Ok(summary(&measure(own, run, what)?, "forward")) };
    let Some(motion) = motion else {
        line(own, "dem-run plant.toml --threads 1 -q -o whole.mcap")?;
        return Ok([count("whole.mcap", &through)?, count("whole.mcap", ONTO)?, 0.0]);
    };
    for keep in ["upstream", "downstream"] {
        line(
            own,
            &format!(
                "stage-split plant.toml --at=0,0,{height},0,0,-1 --motion {motion} --keep {keep} -o {keep}.toml -q"
            ),
        )?;
    }
    line(own, "dem-run upstream.toml --threads 1 -q --report up.json -o up.mcap")?;
    let report = std::fs::read(own.join("up.json")).map_err(|why| format!("up.json: {why}"))?;
    let report: Value = serde_json::from_slice(&report).map_err(|why| format!("up.json: {why}"))?;
    let held = &report["returned"]["held_back"][0];
    let [impulse, momentum] = ["impulse", "momentum"].map(|key| held[key].as_f64().unwrap_or(f64::NAN));
    line(own, "stage-replay up.mcap --keep-times -o in.mcap -q")?;
    line(own, "dem-run downstream.toml in.mcap --threads 1 -q -o down.mcap")?;
    Ok([count("up.mcap", &through)?, count("down.mcap", ONTO)?, impulse / momentum])
}
