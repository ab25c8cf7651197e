//! Soil with stones in a shear box, over packings and stresses: `rock_fill_study PLOT.svg CASE=FOLDER,FOLDER… …` prints tables and sentences for docs/how-to/rock-fill.md.
//!
//! A folder is that of one packing, by `lab-test direct-shear --dir`, with `report.json` of lab-test, and in each specimen `grading.json` of dem-measure where
//! there are bonds. Cases are named `soil`, or `kind content`, such as `bonded 0.4`.
//!
//! ```text
//! ± : 95 % interval of the mean over packings (Student); a difference of two cases is that of the same packings, one by one
//! ```

use kuva::prelude::*;
use measure::statistics::Mean;
use plot::COLOURS;
use serde_json::Value;
use std::error::Error;
use std::path::Path;
use std::{env, fs};

type Failure = Box<dyn Error>;

/// Weibull's modulus of stones of bonded grains, and the power of their size with which their strength falls (docs/evidence/stones.md) [–].
const WEIBULL: f64 = 2.6;
const MEASURED: f64 = -0.36;

/// What one packing gave under one stress [Pa].
struct Specimen {
    stress: f64,
    peak: f64,
    residual: f64,
    dilation: f64,
    /// Cracks, and Marsal's B_g; NaN without bonds.
    broken: [f64; 2],
}

/// All packings of a case.
struct Case {
    name: String,
    packings: Vec<Vec<Specimen>>,
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (picture, cases) = arguments.split_first().ok_or("give PLOT.svg and CASE=FOLDER,FOLDER…")?;
    let case = |text: &String| -> Result<Case, Failure> {
        let (name, folders) = text.rsplit_once('=').ok_or("give CASE=FOLDER,FOLDER…")?;
        let packings =
            folders.split(',').map(|folder| packing(Path::new(folder))).collect::<Result<_, _>>()?;
        Ok(Case { name: name.to_owned(), packings })
    };
    let cases = cases.iter().map(case).collect::<Result<Vec<_>, _>>()?;
    table(&cases);
    println!();
    let said = sentences(&cases).into_iter().chain(cases.iter().filter_map(envelope));
    said.for_each(|sentence| println!("- {sentence}"));
    fs::write(picture, draw(Path::new(picture), &cases)?)?;
    Ok(())
}

fn json(file: &Path) -> Result<Value, Failure> {
    let text = fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(serde_json::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?)
}

/// The specimens of one packing, by stress.
fn packing(folder: &Path) -> Result<Vec<Specimen>, Failure> {
    let report = json(&folder.join("report.json"))?;
    let levels = report["levels"].as_array().ok_or("a report without levels")?;
    levels.iter().map(|level| specimen(folder, level)).collect()
}

fn specimen(folder: &Path, level: &Value) -> Result<Specimen, Failure> {
    let stress = level["stress"].as_f64().ok_or("a level without stress")?;
    let figures = level["figures"].as_array().map_or(&[][..], Vec::as_slice);
    let figure = |name: &str| {
        let found = figures.iter().find(|figure| figure["name"] == name);
        found.and_then(|figure| figure["mean"].as_f64()).unwrap_or(f64::NAN)
    };
    let grading = folder.join(format!("stress={stress},seed=0/grading.json"));
    let broken = match grading.exists() {
        true => {
            let summary = json(&grading)?;
            ["fragments_after", "breakage"].map(|key| summary[key].as_f64().unwrap_or(f64::NAN))
        }
        false => [f64::NAN; 2],
    };
    let [peak, residual, dilation] = ["peak_angle", "residual_angle", "dilation_angle"].map(figure);
    Ok(Specimen { stress, peak, residual, dilation, broken })
}

impl Case {
    /// Stresses of all packings: a guard may have stopped a specimen of one of them.
    fn stresses(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.packings.iter().flatten().map(|s| s.stress).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Values of all packings under a stress.
    fn values(&self, stress: f64, of: impl Fn(&Specimen) -> f64) -> Vec<f64> {
        let at = |packing: &Vec<Specimen>| packing.iter().find(|s| s.stress == stress).map_or(f64::NAN, &of);
        self.packings.iter().map(at).collect()
    }
}

/// Mean and half width of its interval, of those that are numbers.
fn mean(values: &[f64]) -> Mean {
    Mean::of(&values.iter().copied().filter(|v| v.is_finite()).collect::<Vec<f64>>())
}

fn shown(values: &[f64], digits: usize, unit: &str) -> String {
    let of = mean(values);
    match (of.mean.is_finite(), of.interval.is_finite()) {
        (false, _) => "–".to_owned(),
        (true, false) => format!("{:.digits$}{unit}", of.mean),
        (true, true) => format!("{:.digits$} ± {:.digits$}{unit}", of.mean, of.interval),
    }
}

fn table(cases: &[Case]) {
    println!(
        "| stones | normal stress | packings | peak angle | residual angle | dilation angle | pieces at the end | B_g |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for case in cases {
        for stress in case.stresses() {
            let of = |value: &dyn Fn(&Specimen) -> f64, digits, unit| {
                shown(&case.values(stress, value), digits, unit)
            };
            println!(
                "| {} | {} kPa | {} | {} | {} | {} | {} | {} |",
                case.name,
                stress / 1e3,
                case.values(stress, |s| s.peak).iter().filter(|v| v.is_finite()).count(),
                of(&|s| s.peak, 1, "°"),
                of(&|s| s.residual, 1, "°"),
                of(&|s| s.dilation, 1, "°"),
                of(&|s| s.broken[0], 0, ""),
                of(&|s| s.broken[1], 3, ""),
            );
        }
    }
}

/// What differs between two cases of the same packings, in words: only what its interval keeps away from 0.
fn difference(one: &Case, other: &Case, (what, of): (&str, &dyn Fn(&Specimen) -> f64)) -> Option<String> {
    let stresses = one.stresses();
    let pairs = |stress: &f64| {
        let both = one.values(*stress, of).into_iter().zip(other.values(*stress, of));
        both.map(|(a, b)| a - b).collect::<Vec<f64>>()
    };
    // Of each packing its mean over the stresses: these are independent.
    let by_stress: Vec<Vec<f64>> = stresses.iter().map(pairs).collect();
    let count = by_stress.first()?.len();
    let of_packing = |k: usize| mean(&by_stress.iter().map(|d| d[k]).collect::<Vec<f64>>()).mean;
    let Mean { mean, interval, .. } = mean(&(0..count).map(of_packing).collect::<Vec<f64>>());
    let (a, b) = (&one.name, &other.name);
    if !interval.is_finite() {
        return None;
    }
    Some(match mean.abs() > interval {
        true => format!(
            "The {what} of {a} is {:.1} ± {interval:.1}° {} that of {b}.",
            mean.abs(),
            if mean > 0.0 { "above" } else { "below" }
        ),
        false => {
            format!("The {what} of {a} and {b} do not differ beyond chance: {mean:.1} ± {interval:.1}°.")
        }
    })
}

/// The exponent of the envelope τ ∝ σ^b of a case, and what it means for larger stones, in words.
fn envelope(case: &Case) -> Option<String> {
    let stresses = case.stresses();
    let of_packing = |packing: &Vec<Specimen>| {
        let points = packing.iter().filter(|s| s.peak.is_finite());
        let points: Vec<[f64; 2]> =
            points.map(|s| [s.stress.ln(), s.stress.ln() + s.peak.to_radians().tan().ln()]).collect();
        (points.len() == stresses.len()).then(|| slope(&points))
    };
    let all: Vec<f64> = case.packings.iter().filter_map(of_packing).collect();
    if stresses.len() < 3 || all.len() < 2 {
        return None;
    }
    let Mean { mean: b, interval, .. } = mean(&all);
    let weaker = |power: f64| {
        let [low, middle, high] =
            [b - interval, b, b + interval].map(|b| 10f64.powf(power * (1.0 - b)).min(1.0));
        format!("{middle:.2} ({low:.2} to {high:.2})")
    };
    let sentence = format!("{}: τ ∝ σ^b with b = {b:.2} ± {interval:.2} at the peak.", case.name);
    let rule = format!(
        " By Frossard's rule stones ten times as large bear {} of its shear stress where strengths fall as D^(−3/m), m = {WEIBULL}, and {} where they fall as D^−{}.",
        weaker(-3.0 / WEIBULL),
        weaker(MEASURED),
        -MEASURED
    );
    Some(if case.name.starts_with("bonded") { sentence + &rule } else { sentence })
}

/// Slope of a line by least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let [x, y] = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let [xy, xx] = [1, 0].map(|k| points.iter().map(|p| (p[0] - x) * (p[k] - [x, y][k])).sum::<f64>());
    xy / xx
}

/// Pairs of cases worth comparing: with each content bonded with rigid, bonded with loose; soil with each.
fn sentences(cases: &[Case]) -> Vec<String> {
    let find = |name: &str| cases.iter().find(|case| case.name == name);
    let contents: Vec<&str> = cases.iter().filter_map(|c| c.name.strip_prefix("bonded ")).collect();
    let mut said = Vec::new();
    for content in contents {
        let Some(bonded) = find(&format!("bonded {content}")) else { continue };
        let others = ["rigid", "loose"].map(|kind| find(&format!("{kind} {content}")));
        for other in others.into_iter().chain([find("soil")]).flatten() {
            said.extend(difference(bonded, other, ("peak angle", &|s| s.peak)));
            said.extend(difference(bonded, other, ("residual angle", &|s| s.residual)));
        }
    }
    said
}

fn draw(file: &Path, cases: &[Case]) -> Result<Vec<u8>, String> {
    let mut plots = Vec::new();
    // Grains without bonds lie on the line of soil.
    let drawn = cases.iter().filter(|case| !case.name.starts_with("loose"));
    for (case, colour) in drawn.zip(COLOURS.into_iter().cycle()) {
        let point = |stress: f64| (stress / 1e3, mean(&case.values(stress, |s| s.peak)).mean);
        let points = case.stresses().into_iter().map(point).filter(|(_, angle)| angle.is_finite());
        let points: Vec<(f64, f64)> = points.collect();
        plots.push(Plot::Line(
            LinePlot::new().with_data(points).with_color(colour).with_legend(case.name.clone()),
        ));
    }
    let layout =
        Layout::auto_from_plots(&plots).with_x_label("normal stress [kPa]").with_y_label("peak angle [°]");
    plot::diagram(file, plots, layout).map_err(|e| e.to_string())
}
