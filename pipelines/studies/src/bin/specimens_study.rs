//! Modulus, Poisson's ratio and strength of compressed cylinders: `specimens_study PLOT.svg NAME=FOLDER,FOLDER… …` prints a table for docs/evidence/specimens.md.
//!
//! ```text
//! σ = −F/A of the upper plate,  ε = shift/height       strength: the largest σ;  E: σ/ε at half of it
//! ν = −(ε_xx + ε_yy)/2ε_zz of the grains in the middle at that time         ± : 95 % interval of the mean (Student)
//! ```

use kuva::prelude::*;
use plot::COLOURS;
use std::error::Error;
use std::path::Path;
use std::{env, fs};

/// What one specimen gave.
struct Specimen {
    /// ε and σ [–, Pa] over time, up to where σ has fallen to a quarter.
    curve: Vec<(f64, f64)>,
    modulus: f64,
    poisson: f64,
    strength: f64,
    /// ε at the strength [–].
    strain: f64,
    /// Cracks before half of the strength, before the strength, and in all; of them by tension.
    cracks: [f64; 4],
    porosity: f64,
}

/// Specimens of one kind.
struct Kind {
    name: String,
    all: Vec<Specimen>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (picture, kinds) = arguments.split_first().ok_or("give PLOT.svg and NAME=FOLDER,FOLDER…")?;
    let kind = |text: &String| -> Result<Kind, Box<dyn Error>> {
        let (name, folders) = text.rsplit_once('=').ok_or("give NAME=FOLDER,FOLDER…")?;
        let all = folders.split(',').map(specimen).collect::<Result<_, _>>()?;
        Ok(Kind { name: name.to_owned(), all })
    };
    let kinds = kinds.iter().map(kind).collect::<Result<Vec<_>, _>>()?;
    print(&kinds);
    fs::write(picture, draw(Path::new(picture), &kinds)?)?;
    Ok(())
}

/// Columns of a CSV file, by name without unit.
fn columns(folder: &str, file: &str, names: &[&str]) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let text = fs::read_to_string(Path::new(folder).join(file))?;
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name: &&str| {
        let is = |h: &&str| h.split([' ', '[']).next() == Some(*name);
        head.iter().position(is).ok_or_else(|| format!("{folder}/{file}: no column {name}"))
    };
    let places = names.iter().map(place).collect::<Result<Vec<_>, _>>()?;
    let row = |line: &str| -> Vec<f64> {
        let cells: Vec<&str> = line.split(',').collect();
        places.iter().map(|k| cells.get(*k).and_then(|c| c.parse().ok()).unwrap_or(f64::NAN)).collect()
    };
    Ok(lines.map(row).collect())
}

fn specimen(folder: &str) -> Result<Specimen, Box<dyn Error>> {
    let [height, area, porosity] = columns(folder, "size.csv", &["height", "area", "porosity"])?
        .first()
        .and_then(|row| <[f64; 3]>::try_from(row.clone()).ok())
        .ok_or("an empty size.csv")?;
    let force = columns(folder, "force.csv", &["time", "fz", "shift_z"])?;
    let whole: Vec<(f64, f64, f64)> =
        force.iter().map(|row| (row[0], -row[2] / height, row[1] / area)).collect();
    let (peak, strength) = whole
        .iter()
        .enumerate()
        .fold((0, 0.0), |(at, most), (k, row)| if row.2 > most { (k, row.2) } else { (at, most) });
    let half = whole.iter().position(|row| row.2 >= 0.5 * strength).ok_or("no force on the plate")?;
    let strains = columns(folder, "strain.csv", &["time", "xx", "yy", "zz"])?;
    let then = strains
        .iter()
        .min_by(|a, b| (a[0] - whole[half].0).abs().total_cmp(&(b[0] - whole[half].0).abs()))
        .ok_or("no strains")?;
    let cracks = columns(folder, "cracks.csv", &["time", "mode"])?;
    let before = |time: f64| cracks.iter().filter(|row| row[0] <= time).count() as f64;
    let end =
        whole.iter().skip(peak).position(|row| row.2 < 0.25 * strength).map_or(whole.len(), |k| peak + k);
    Ok(Specimen {
        curve: whole[..end].iter().map(|row| (row.1, row.2)).collect(),
        modulus: whole[half].2 / whole[half].1,
        poisson: -0.5 * (then[1] + then[2]) / then[3],
        strength,
        strain: whole[peak].1,
        cracks: [
            before(whole[half].0),
            before(whole[peak].0),
            cracks.len() as f64,
            cracks.iter().filter(|row| row[1] == 1.0).count() as f64,
        ],
        porosity,
    })
}

/// Student's t of 95 % for n − 1 degrees of freedom.
fn student(n: usize) -> f64 {
    [f64::INFINITY, 12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262]
        .get(n - 1)
        .copied()
        .unwrap_or(2.0)
}

impl Kind {
    /// Mean and half width of its interval.
    fn mean(&self, of: impl Fn(&Specimen) -> f64) -> (f64, f64) {
        let n = self.all.len() as f64;
        let mean = self.all.iter().map(&of).sum::<f64>() / n;
        let square = self.all.iter().map(|s| (of(s) - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean, student(self.all.len()) * (square / n).sqrt())
    }
}

fn print(kinds: &[Kind]) {
    println!(
        "| specimen | packings | porosity | E | ν | strength | strain at the strength | cracks at half, at it, in all | by tension |\n|---|---|---|---|---|---|---|---|---|"
    );
    for kind in kinds {
        let shown = |(mean, interval): (f64, f64), times: f64, digits: usize| {
            format!("{:.digits$} ± {:.digits$}", times * mean, times * interval)
        };
        let crack = |k: usize| kind.mean(|s| s.cracks[k]).0;
        println!(
            "| {} | {} | {} | {} MPa | {} | {} kPa | {} % | {:.0}, {:.0}, {:.0} | {:.0} % |",
            kind.name,
            kind.all.len(),
            shown(kind.mean(|s| s.porosity), 1.0, 3),
            shown(kind.mean(|s| s.modulus), 1e-6, 1),
            shown(kind.mean(|s| s.poisson), 1.0, 3),
            shown(kind.mean(|s| s.strength), 1e-3, 0),
            shown(kind.mean(|s| s.strain), 100.0, 2),
            crack(0),
            crack(1),
            crack(2),
            100.0 * crack(3) / crack(2),
        );
    }
}

fn draw(file: &Path, kinds: &[Kind]) -> Result<Vec<u8>, String> {
    let mut plots = Vec::new();
    for (kind, colour) in kinds.iter().zip(COLOURS) {
        for (k, one) in kind.all.iter().enumerate() {
            let points: Vec<(f64, f64)> = one.curve.iter().map(|(e, s)| (100.0 * e, s / 1e3)).collect();
            let line = LinePlot::new().with_data(points).with_color(colour);
            plots.push(Plot::Line(if k == 0 { line.with_legend(kind.name.clone()) } else { line }));
        }
    }
    let layout =
        Layout::auto_from_plots(&plots).with_x_label("axial strain [%]").with_y_label("axial stress [kPa]");
    plot::diagram(file, plots, layout).map_err(|e| e.to_string())
}
