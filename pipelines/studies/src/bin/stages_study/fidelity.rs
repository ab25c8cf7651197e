//! Fidelity: the plant undivided and cut, by place of the cut, motion and length of the zone, stiffness and step.

use crate::page::{SMALL, difference, put, table};
use crate::picture::{Panel, draw};
use crate::plant::{CUTS, Cut, Found, QUANTITIES, Setting, seen};
use measure::statistics::Mean;
use rayon::prelude::*;
use std::path::Path;

/// The plain setting: stiffness of the scene, nine tenths of the critical step.
const PLAIN: Setting = Setting { cut: None, stiffness: 1.0, safety: 0.9 };
const MOTIONS: [&str; 3] = ["constant", "ballistic", "recorded"];
const LENGTHS: [f64; 4] = [1.2, 2.0, 3.0, 4.0];
/// Cuts that every motion, length, stiffness and step is tried on: in the bed, at the mouth, across the chute.
const THOROUGH: [usize; 3] = [0, 2, 4];

/// All runs of a setting, seed by seed.
struct Runs {
    setting: Setting,
    /// What each cut saw; of a cut run only its own. A run that could not be made says why.
    seeds: Vec<Result<Vec<Found>, String>>,
}

impl Runs {
    /// What cut `at` saw with a seed.
    fn seen(&self, at: usize, seed: usize) -> Option<&Found> {
        let all = self.seeds.get(seed)?.as_ref().ok()?;
        if self.setting.cut.is_some() { all.first() } else { all.get(at) }
    }
}

/// Runs everything and writes the part "fidelity" of the page, and its plots.
///
/// # Errors
/// Undivided runs that fail, files that cannot be written.
pub fn study(folder: &Path, page: &Path, seeds: usize) -> Result<(), String> {
    let quick = std::env::var_os("QUICK").is_some();
    let settings = settings(quick);
    let jobs: Vec<(usize, u64)> =
        (0..settings.len()).flat_map(|s| (0..seeds as u64).map(move |seed| (s, seed))).collect();
    let done: Vec<_> = jobs.par_iter().map(|(s, seed)| seen(folder, &settings[*s], *seed)).collect();
    let all: Vec<Runs> = settings
        .iter()
        .zip(done.chunks(seeds))
        .map(|(setting, seeds)| Runs { setting: *setting, seeds: seeds.to_vec() })
        .collect();
    for runs in all.iter().filter(|r| r.setting.cut.is_none()) {
        runs.seeds.iter().find_map(|s| s.as_ref().err()).map_or(Ok(()), |why| Err(why.clone()))?;
    }
    let mut text = format!(
        "Each line gives the mean difference from the undivided runs with the same {seeds} seeds, ± its 95 % \
         interval (Student). It is bold if the interval does not include zero. The first line of each table \
         gives the undivided runs: mean ± deviation of one run between seeds.\n"
    );
    if quick {
        text += "Quick form (QUICK=1): the shortest zone, and neither other stiffness nor other steps. `make -C pipelines stages-study` runs all.\n";
    }
    for at in 0..CUTS.len() {
        text += &section(&all, at, seeds);
    }
    pictures(&all, (folder, page), seeds)?;
    put(folder, page, ("fidelity", SMALL), &text)
}

/// What is run; `quick`: each cut and motion once, with the shortest zone.
fn settings(quick: bool) -> Vec<Setting> {
    let others = [Setting { stiffness: 4.0, ..PLAIN }, Setting { safety: 0.3, ..PLAIN }];
    let mut all = if quick { vec![PLAIN] } else { vec![PLAIN, others[0], others[1]] };
    for at in 0..CUTS.len() {
        let thorough = !quick && THOROUGH.contains(&at);
        for motion in MOTIONS {
            let lengths = &LENGTHS[..if thorough { LENGTHS.len() } else { 1 }];
            all.extend(lengths.iter().map(|l| Setting { cut: Some((at, motion, *l)), ..PLAIN }));
        }
        if thorough {
            all.extend(others.map(|other| Setting { cut: Some((at, "constant", 1.2)), ..other }));
        }
    }
    all
}

/// The undivided runs with the stiffness and step of a setting.
fn whole<'a>(all: &'a [Runs], of: &Setting) -> Option<&'a Runs> {
    all.iter().find(|r| r.setting == Setting { cut: None, ..*of })
}

fn section(all: &[Runs], at: usize, seeds: usize) -> String {
    let units = ["kg/s", "m/s", "N", "kg/s", "m/s", "°"];
    let mut rows = Vec::new();
    let Some(plain) = whole(all, &PLAIN) else { return String::new() };
    let mut first = vec!["undivided".to_owned()];
    for (k, unit) in units.iter().enumerate() {
        let values: Vec<f64> = (0..seeds).filter_map(|s| Some(plain.seen(at, s)?.values[k])).collect();
        let mean = Mean::of(&values);
        first.push(format!("{} ± {} {unit}", digits(mean.mean), digits(mean.deviation)));
    }
    rows.push(first);
    for runs in all.iter().filter(|r| r.setting.cut.is_some_and(|c| c.0 == at)) {
        let mut row = vec![name(&runs.setting)];
        row.extend((0..QUANTITIES.len()).map(|k| cell(all, runs, (at, k), seeds)));
        rows.push(row);
    }
    let Cut { says, .. } = CUTS[at];
    let columns: Vec<&str> = ["zone"].into_iter().chain(QUANTITIES).collect();
    let mut text = format!("\n### Cut {says}\n{}", table(&columns, &rows));
    let reason = all.iter().filter(|r| r.setting.cut.is_some_and(|c| c.0 == at)).find_map(|r| {
        (0..seeds)
            .find_map(|s| r.seen(at, s).and_then(|f| f.stopped.clone()).map(|why| (name(&r.setting), why)))
    });
    if let Some((setting, why)) = reason {
        text += &format!("\nStopped, for instance ({setting}): `{why}`\n");
    }
    text
}

fn name(setting: &Setting) -> String {
    let Some((_, motion, length)) = setting.cut else { return "undivided".to_owned() };
    let mut name = format!("{motion}, {length} d");
    if setting.stiffness != PLAIN.stiffness {
        name += &format!(", stiffness × {}", setting.stiffness);
    }
    if setting.safety != PLAIN.safety {
        name += &format!(", step ÷ {}", PLAIN.safety / setting.safety);
    }
    name
}

fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "–".to_owned() };
    }
    let places = (2 - value.abs().log10().floor() as i32).clamp(0, 4) as usize;
    format!("{value:.places$}")
}

/// The mean difference of a quantity, as a share of the undivided mean, of an angle in degrees.
fn cell(all: &[Runs], runs: &Runs, (at, k): (usize, usize), seeds: usize) -> String {
    let stopped = (0..seeds).filter(|s| runs.seen(at, *s).is_none_or(|f| f.stopped.is_some())).count();
    if k >= 3 && stopped > 0 {
        return format!("stopped {stopped} of {seeds}");
    }
    let Some(whole) = whole(all, &runs.setting) else { return "–".to_owned() };
    let pairs: Vec<(f64, f64)> = (0..seeds)
        .filter_map(|s| Some((runs.seen(at, s)?.values[k], whole.seen(at, s)?.values[k])))
        .filter(|(a, b)| a.is_finite() && b.is_finite())
        .collect();
    let differ = Mean::of(&pairs.iter().map(|(a, b)| a - b).collect::<Vec<_>>());
    let scale = Mean::of(&pairs.iter().map(|p| p.1).collect::<Vec<_>>()).mean;
    let angle = k == 5;
    let (factor, unit) = if angle { (1.0, "°") } else { (100.0 / scale, " %") };
    let (mean, off) = (differ.mean * factor, (differ.interval * factor).abs());
    if !(mean.is_finite() && off.is_finite()) {
        return "–".to_owned();
    }
    difference(mean, off, unit)
}

/// Mean of curves of one setting over the seeds, point by point.
fn mean_curve(
    runs: &Runs,
    at: usize,
    seeds: usize,
    of: impl Fn(&Found) -> &Vec<(f64, f64)>,
) -> Vec<(f64, f64)> {
    let curves: Vec<&Vec<(f64, f64)>> = (0..seeds).filter_map(|s| Some(of(runs.seen(at, s)?))).collect();
    let shortest = curves.iter().map(|c| c.len()).min().unwrap_or(0);
    let mean = |k: usize| curves.iter().map(|c| c[k].1).sum::<f64>() / curves.len() as f64;
    // A hundred points of a curve are more than can be seen.
    (0..shortest).step_by(shortest / 30 + 1).map(|k| (curves[0][k].0, mean(k))).collect()
}

fn pictures(all: &[Runs], (folder, page): (&Path, &Path), seeds: usize) -> Result<(), String> {
    let shown = |at: usize| -> Vec<(String, &Runs)> {
        let wanted = |r: &&Runs| match r.setting.cut {
            None => r.setting == PLAIN,
            Some((cut, _, length)) => {
                cut == at && length == 1.2 && r.setting.stiffness == 1.0 && r.setting.safety == PLAIN.safety
            }
        };
        all.iter().filter(wanted).map(|r| (name(&r.setting), r)).collect()
    };
    let (mut flows, mut profiles) = (Vec::new(), Vec::new());
    for at in THOROUGH {
        let axes = |x: &str, y: &str| (x.to_owned(), y.to_owned());
        for (k, what) in ["mass through the cut [kg]", "mass in the box [kg]"].into_iter().enumerate() {
            let line = |(name, runs): (String, &Runs)| (name, mean_curve(runs, at, seeds, |f| &f.passed[k]));
            let lines = shown(at).into_iter().map(line).collect();
            let title = format!("cut {}", CUTS[at].says);
            flows.push(Panel {
                title,
                axes: axes("time [s]", what),
                lines,
                closed: Vec::new(),
                from_zero: true,
            });
        }
        let line = |(name, runs): (String, &Runs)| (name, mean_curve(runs, at, seeds, |f| &f.profile));
        let lines = shown(at).into_iter().map(line).collect();
        let axes = axes("x [m]", "downward speed [m/s]");
        let title = format!("cut {}", CUTS[at].says);
        profiles.push(Panel { title, axes, lines, closed: Vec::new(), from_zero: false });
    }
    for (name, columns, panels) in [("stages-flow.svg", 2, flows), ("stages-profile.svg", 3, profiles)] {
        let png = name.replace(".svg", ".png");
        for (file, name) in [(page.with_file_name(name), name), (folder.join(&png), png.as_str())] {
            let told = |why: std::io::Error| format!("{}: {why}", file.display());
            std::fs::write(&file, draw(name, columns, &panels)?).map_err(told)?;
        }
    }
    Ok(())
}
