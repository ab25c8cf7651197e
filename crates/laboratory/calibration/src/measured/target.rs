//! Targets from files: units, specimens, deviations.

use crate::error::{CalibrateError, Location, Result};
use crate::measured::data::{Point, Target, at, binned, mean, own_scatter};
use crate::measured::sheet::Sheet;
use crate::recipe::shown;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Units of the command's columns, as text; absent: SI.
#[derive(Debug, Clone, Default)]
pub(crate) struct Units {
    pub x: Option<String>,
    pub y: Option<String>,
}

/// What is asked of the data of a test.
pub(crate) struct Asked {
    /// Column of x; absent: a number.
    pub x: Option<String>,
    pub y: String,
    pub from: f64,
    pub until: f64,
    pub points: usize,
    pub deviation: Option<f64>,
    pub share: bool,
    pub discrepancy: (f64, bool),
    pub correlation: Option<f64>,
    pub units: Units,
}

/// Column of the data that holds the deviation of each row.
const DEVIATION: &str = "deviation";
/// Smallest deviation that scatter may give, as a share of the largest value.
const LEAST: f64 = 1e-3;
/// Distance over which specimens deviate alike, unless it is given.
const SPECIMENS_ALIKE: f64 = 0.1;

/// The target of measured numbers.
pub(crate) fn value(asked: &Asked, values: &[f64]) -> Result<Target, String> {
    let n = values.len() as f64;
    let y = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|v| (v - y) * (v - y)).sum::<f64>() / (n - 1.0) / n;
    let (deviation, origin) = match asked.deviation {
        Some(d) if asked.share => (d * y.abs(), "given".to_owned()),
        Some(d) => (d, "given".to_owned()),
        None if values.len() < 2 => {
            return Err("one value has no scatter: give deviation, or several values".to_owned());
        }
        None => (square.sqrt(), format!("scatter of {} values", values.len())),
    };
    if !(deviation > 0.0) {
        return Err("the deviation is 0: give deviation in the unit of y".to_owned());
    }
    let points = vec![Point { x: 0.0, y, deviation }];
    let discrepancy = if asked.discrepancy.1 { asked.discrepancy.0 * y.abs() } else { asked.discrepancy.0 };
    Ok(Target {
        points,
        places: vec![vec![0.0]],
        x_unit: String::new(),
        correlation: 0.0,
        discrepancy,
        specimens: values.len(),
        origin,
    })
}

/// The target of one curve or of several specimens; of numbers, where there is no x.
pub(crate) fn curve(asked: &Asked, files: &[PathBuf], warnings: &mut Vec<String>) -> Result<Target> {
    check_distinct(files)?;
    let Some(x) = &asked.x else {
        let mut values = Vec::new();
        for file in files {
            let sheet = sheet(file)?;
            let (column, factor) = sheet.in_unit(&asked.y, asked.units.y.as_deref())?;
            values.extend(sheet.numbers(&[column], &BTreeMap::new())?.iter().map(|(_, v)| v[0] * factor));
        }
        return value(asked, &values).map_err(CalibrateError::Usage);
    };
    let mut curves = Vec::new();
    for file in files {
        curves.push(measured(asked, x, file, warnings)?);
    }
    let mut target = match curves.as_slice() {
        [one] => single(asked, one, &files[0])?,
        several => specimens(asked, several)?,
    };
    let size = target.size();
    if !(size > 0.0) {
        return Err(CalibrateError::Usage(format!(
            "{}: every y is 0: nothing can be fitted to it",
            files[0].display()
        )));
    }
    let given = asked.deviation.map(|d| if asked.share { d * size } else { d });
    let small = target.points.iter().filter(|p| p.deviation < LEAST * size).count();
    if given.is_none() && 2 * small > target.points.len() {
        let (name, share) = (files[0].display(), 100.0 * LEAST);
        warnings.push(format!(
            "{name}: its scatter ({}) is next to none: {share} % of the largest value is taken as deviation: give deviation",
            target.origin
        ));
    }
    for p in &mut target.points {
        p.deviation = given.unwrap_or(p.deviation.max(LEAST * size));
    }
    if given.is_some() {
        target.origin = "given".to_owned();
    }
    target.correlation = asked.correlation.unwrap_or(target.correlation);
    target.discrepancy = if asked.discrepancy.1 { asked.discrepancy.0 * size } else { asked.discrepancy.0 };
    Ok(target)
}

/// A measured curve: x, y, and the deviation of each point if the file has it.
struct Measured {
    curve: Vec<(f64, f64)>,
    deviation: Option<Vec<f64>>,
}

/// Refuses the same data as two specimens: their interval would be too small.
fn check_distinct(files: &[PathBuf]) -> Result<()> {
    let mut seen: BTreeMap<String, &Path> = BTreeMap::new();
    for file in files.iter().filter(|_| files.len() > 1) {
        let bytes = stream::whole::file(file).map_err(crate::error::file(file, "cannot read the data"))?;
        if let Some(other) = seen.insert(stream::sha256(&bytes), file) {
            let (file, other) = (file.display(), other.display());
            let what = if other.to_string() == file.to_string() {
                "is given twice".to_owned()
            } else {
                format!("holds the same as {other}")
            };
            return Err(CalibrateError::Usage(format!(
                "{file}: {what}: a specimen that counts twice makes intervals too small: leave one out"
            )));
        }
    }
    Ok(())
}

fn sheet(file: &Path) -> Result<Sheet> {
    let text = stream::whole::text(file).map_err(crate::error::file(file, "cannot read the data"))?;
    Sheet::parse(&file.display().to_string(), &text)
}

fn measured(asked: &Asked, x: &str, file: &Path, warnings: &mut Vec<String>) -> Result<Measured> {
    let sheet = sheet(file)?;
    let name = file.display().to_string();
    let (cx, fx) = sheet.in_unit(x, asked.units.x.as_deref())?;
    let (cy, fy) = sheet.in_unit(&asked.y, asked.units.y.as_deref())?;
    let own = if asked.deviation.is_none() && sheet.has(DEVIATION) {
        Some(sheet.in_unit(DEVIATION, asked.units.y.as_deref())?)
    } else {
        None
    };
    let columns: Vec<usize> = [cx, cy].into_iter().chain(own.map(|o| o.0)).collect();
    let rows = sheet.numbers(&columns, &BTreeMap::new())?;
    let refuse =
        |line: usize, message: String| CalibrateError::Data { place: Location::line(&name, line), message };
    let mut found = Measured { curve: Vec::new(), deviation: own.map(|_| Vec::new()) };
    let mut before = f64::NEG_INFINITY;
    for (line, row) in &rows {
        let (px, py) = (row[0] * fx, row[1] * fy);
        if px <= before {
            let message = format!(
                "x = {} follows x = {}: x has to grow: sort the rows, and keep one of equal ones",
                shown(row[0]),
                shown(before / fx)
            );
            return Err(refuse(*line, message));
        }
        before = px;
        if px < asked.from || px > asked.until {
            continue;
        }
        found.curve.push((px, py));
        if let (Some(list), Some((_, factor))) = (&mut found.deviation, own) {
            if !(row[2] > 0.0) {
                return Err(refuse(*line, format!("deviation = {}: give a number above 0", shown(row[2]))));
            }
            list.push(row[2] * factor);
        }
    }
    if found.curve.len() < 2 {
        let last = rows.last().map_or(1, |r| r.0);
        return Err(refuse(
            last,
            format!(
                "{}{}: a curve has two or more",
                geom::counted(found.curve.len(), "point"),
                if asked.from.is_finite() || asked.until.is_finite() {
                    format!(" from {} to {}", shown(asked.from), shown(asked.until))
                } else {
                    String::new()
                }
            ),
        ));
    }
    warnings.extend(gap(&name, &found.curve));
    Ok(found)
}

/// Where a curve has no points for long.
fn gap(name: &str, curve: &[(f64, f64)]) -> Option<String> {
    let mut steps: Vec<f64> = curve.windows(2).map(|w| w[1].0 - w[0].0).collect();
    let wide = curve.windows(2).max_by(|a, b| (a[1].0 - a[0].0).total_cmp(&(b[1].0 - b[0].0)))?;
    steps.sort_by(f64::total_cmp);
    let (median, widest) = (steps[steps.len() / 2], wide[1].0 - wide[0].0);
    let length = curve[curve.len() - 1].0 - curve[0].0;
    (steps.len() >= 4 && widest > 8.0 * median && widest > 0.1 * length).then(|| {
        format!(
            "{name}: no points from x = {} to {}: nothing is compared there",
            shown(wide[0].0),
            shown(wide[1].0)
        )
    })
}

fn single(asked: &Asked, one: &Measured, file: &Path) -> Result<Target> {
    let bins = binned(&one.curve, asked.points);
    let points = |of: &dyn Fn(f64, usize) -> f64| -> Vec<Point> {
        let point = |bin: &Vec<(f64, f64)>| {
            let (x, y) = mean(bin);
            Point { x, y, deviation: of(x, bin.len()) }
        };
        bins.iter().map(point).collect()
    };
    let (points, origin): (Vec<Point>, &str) = match (&one.deviation, asked.deviation) {
        (Some(list), None) => {
            // Of a bin: that of its nearest row, not less, since deviations of a table are those of its curve.
            let far = |p: &&((f64, f64), f64), x: f64| (p.0.0 - x).abs();
            let all: Vec<((f64, f64), f64)> = one.curve.iter().copied().zip(list.iter().copied()).collect();
            let near =
                |x: f64| all.iter().min_by(|a, b| far(a, x).total_cmp(&far(b, x))).map_or(0.0, |p| p.1);
            (points(&|x, _| near(x)), "column deviation")
        }
        (_, Some(_)) => (points(&|_, _| 0.0), ""),
        (None, None) => {
            let scatter = own_scatter(&one.curve).ok_or_else(|| {
                CalibrateError::Usage(format!(
                    "{}: {} points are too few to see their scatter: give deviation, such as \"3 %\"",
                    file.display(),
                    one.curve.len()
                ))
            })?;
            (points(&|_, n| scatter / (n as f64).sqrt()), "the curve's own scatter")
        }
    };
    Ok(Target {
        points,
        places: bins.iter().map(|bin| bin.iter().map(|p| p.0).collect()).collect(),
        x_unit: asked.units.x.clone().unwrap_or_default(),
        correlation: 0.0,
        discrepancy: 0.0,
        specimens: 1,
        origin: origin.to_owned(),
    })
}

/// Mean of several specimens, with the deviation of the mean: half of a point's own, half of all, since few specimens have noisy deviations.
fn specimens(asked: &Asked, all: &[Measured]) -> Result<Target> {
    let n = all.len() as f64;
    let inside = |x: f64| all.iter().all(|m| at(&m.curve, x).is_some());
    let grid: Vec<f64> =
        binned(&all[0].curve, asked.points).iter().map(|b| mean(b).0).filter(|x| inside(*x)).collect();
    if grid.len() < 2 {
        return Err(CalibrateError::Usage(
            "the curves of the specimens have no common x: are their units the same?".to_owned(),
        ));
    }
    let mut points = Vec::new();
    for x in grid {
        let values: Vec<f64> = all.iter().filter_map(|m| at(&m.curve, x)).collect();
        let y = values.iter().sum::<f64>() / n;
        let square = values.iter().map(|v| (v - y) * (v - y)).sum::<f64>() / (n - 1.0);
        points.push(Point { x, y, deviation: square });
    }
    let mean = points.iter().map(|p| p.deviation).sum::<f64>() / points.len() as f64;
    for p in &mut points {
        p.deviation = (0.5 * (p.deviation + mean) / n).sqrt();
    }
    let origin = format!("scatter of {} specimens", all.len());
    Ok(Target {
        places: points.iter().map(|p| vec![p.x]).collect(),
        points,
        x_unit: asked.units.x.clone().unwrap_or_default(),
        correlation: SPECIMENS_ALIKE,
        discrepancy: 0.0,
        specimens: all.len(),
        origin,
    })
}
