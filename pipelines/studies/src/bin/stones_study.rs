//! The strengths of crushed stones as Weibull lines, and how they fall with size: `stones_study PLOT.svg STRENGTHS.csv…` prints tables for docs/evidence/stones.md.
//!
//! ```text
//! P(σ) = 1 − exp(−(σ/σ₀)^m)        m, σ₀ by maximum likelihood; intervals of m and σ₀: 95 %, by their asymptotic deviations 0.780 m/√n and 1.053 σ₀/(m √n)
//! ```

use kuva::prelude::*;
use lab::summary::weibull;
use plot::COLOURS;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::{env, fs};

/// Stones of one diameter.
struct Size {
    diameter: f64,
    /// Their mean number of grains.
    grains: f64,
    /// Strengths [Pa], the lowest first.
    strengths: Vec<f64>,
    m: f64,
    scale: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (picture, files) = arguments.split_first().ok_or("give PLOT.svg and the files of strengths")?;
    let mut rows: BTreeMap<u64, Vec<[f64; 2]>> = BTreeMap::new();
    for file in files {
        let text = fs::read_to_string(file)?;
        for line in text.lines().skip(1) {
            let numbers = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
            let [diameter, _, grains, _, strength, _] = numbers[..] else {
                return Err(format!("{file}: {line}").into());
            };
            rows.entry(diameter.to_bits()).or_default().push([grains, strength]);
        }
    }
    let sizes: Vec<Size> = rows.into_iter().map(|(bits, rows)| size(f64::from_bits(bits), &rows)).collect();
    print(&sizes);
    fs::write(picture, draw(Path::new(picture), &sizes)?)?;
    Ok(())
}

fn size(diameter: f64, rows: &[[f64; 2]]) -> Size {
    let mut strengths: Vec<f64> = rows.iter().map(|row| row[1]).collect();
    strengths.sort_by(f64::total_cmp);
    let (m, scale) = weibull(&strengths);
    Size {
        diameter,
        grains: rows.iter().map(|row| row[0]).sum::<f64>() / rows.len() as f64,
        strengths,
        m,
        scale,
    }
}

impl Size {
    /// ln σ, and ln(−ln(1 − P)) by median ranks (Benard & Bos-Levenbach 1953): on a line if strengths follow Weibull.
    fn line(&self) -> Vec<(f64, f64)> {
        let count = self.strengths.len() as f64;
        let of = |(s, k): (&f64, usize)| {
            let share = (k as f64 - 0.3) / (count + 0.4);
            (s.ln(), (-(1.0 - share).ln()).ln())
        };
        self.strengths.iter().zip(1..).map(of).collect()
    }

    /// Share of the scatter of that line that a straight one explains.
    fn straight(&self) -> f64 {
        let (points, n) = (self.line(), self.strengths.len() as f64);
        let [x, y] = [0, 1].map(|k| points.iter().map(|p| [p.0, p.1][k]).sum::<f64>() / n);
        let sum = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
        let both = sum(&|p| (p.0 - x) * (p.1 - y));
        both * both / (sum(&|p| (p.0 - x).powi(2)) * sum(&|p| (p.1 - y).powi(2)))
    }

    fn mean(&self) -> (f64, f64) {
        let n = self.strengths.len() as f64;
        let mean = self.strengths.iter().sum::<f64>() / n;
        let square = self.strengths.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / (n - 1.0);
        (mean, 1.96 * (square / n).sqrt())
    }
}

fn print(sizes: &[Size]) {
    println!(
        "| diameter | stones | grains | mean strength | σ₀ | m | straight line explains |\n|---|---|---|---|---|---|---|"
    );
    for s in sizes {
        let (n, (mean, interval)) = (s.strengths.len() as f64, s.mean());
        let (of_m, of_scale) = (1.96 * 0.780 * s.m / n.sqrt(), 1.96 * 1.053 * s.scale / (s.m * n.sqrt()));
        println!(
            "| {:.0} mm | {} | {:.0} | {:.1} ± {:.1} kPa | {:.1} ± {:.1} kPa | {:.2} ± {:.2} | {:.1} % |",
            1e3 * s.diameter,
            n,
            s.grains,
            mean / 1e3,
            interval / 1e3,
            s.scale / 1e3,
            of_scale / 1e3,
            s.m,
            of_m,
            100.0 * s.straight()
        );
    }
    if let Some((power, interval)) = power(sizes) {
        println!(
            "\nMean strength goes with the diameter to the power {power:.2} ± {interval:.2} (a line through the logarithms of all means, weighted by their intervals)."
        );
    }
}

/// The power p of mean strength ∝ diameter^p, and its 95 % interval: least squares of the logarithms, weighted by their variances; `None` for one size.
fn power(sizes: &[Size]) -> Option<(f64, f64)> {
    let points: Vec<[f64; 3]> = sizes
        .iter()
        .map(|s| {
            let (mean, interval) = s.mean();
            [s.diameter.ln(), mean.ln(), (1.96 * mean / interval).powi(2)]
        })
        .collect();
    let sum = |of: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(|p| p[2] * of(p)).sum::<f64>();
    let all = sum(&|_| 1.0);
    let (x, y) = (sum(&|p| p[0]) / all, sum(&|p| p[1]) / all);
    let spread = sum(&|p| (p[0] - x).powi(2));
    (spread > 0.0).then(|| (sum(&|p| (p[0] - x) * (p[1] - y)) / spread, 1.96 / spread.sqrt()))
}

fn draw(file: &Path, sizes: &[Size]) -> Result<Vec<u8>, String> {
    let mut plots = Vec::new();
    for (s, colour) in sizes.iter().zip(COLOURS) {
        let name = format!("{:.0} mm", 1e3 * s.diameter);
        let log10 = |x: f64| x / std::f64::consts::LN_10;
        let points: Vec<(f64, f64)> = s.line().iter().map(|p| (log10(p.0), p.1)).collect();
        let fit = [points[0].0, points[points.len() - 1].0]
            .map(|x| (x, s.m * (x * std::f64::consts::LN_10 - s.scale.ln())));
        plots.push(Plot::from(
            ScatterPlot::new().with_data(points).with_color(colour).with_size(2.5).with_legend(&name),
        ));
        plots.push(Plot::from(
            LinePlot::new().with_data(fit.to_vec()).with_color(colour).with_stroke_width(1.2),
        ));
    }
    let layout = Layout::auto_from_plots(&plots)
        .with_title("Strength of crushed stones")
        .with_x_label("log10 of the strength [Pa]")
        .with_y_label("ln(−ln(1 − P))");
    plot::diagram(file, plots, layout).map_err(|e| e.to_string())
}
