//! The table and the picture of `docs/evidence/holes.md`.

use crate::bodies::Body;
use crate::cuts::{Outcome, Score};
use kuva::prelude::*;
use std::path::Path;

/// Sizes of holes in local spacings, by column of the table.
const COLUMNS: [f64; 6] = [3.0, 6.0, 8.0, 12.0, 25.0, 61.0];
/// The same of the picture.
const SIZES: [f64; 9] = [3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 12.0, 25.0, 61.0];

/// A row of the table.
pub struct Row {
    pub name: String,
    pub body: Option<Body>,
    pub outcomes: Vec<Outcome>,
    /// Holes that a scan has before the cuts.
    pub own: usize,
}

impl Row {
    fn scores(&self) -> impl Iterator<Item = &Score> {
        self.outcomes.iter().flat_map(|o| &o.scores)
    }

    /// Found and cut holes of sizes from `low` to `high`.
    fn found(&self, low: f64, high: f64) -> (usize, usize) {
        let of = || self.scores().filter(|s| s.size >= low && s.size < high);
        (of().filter(|s| s.found).count(), of().count())
    }

    fn line(&self) -> String {
        let columns = COLUMNS.windows(2).map(|c| self.found(c[0], c[1]));
        let columns: Vec<String> = columns.map(|(found, all)| format!("{found} of {all}")).collect();
        let (found, all) = self.found(8.0, f64::INFINITY);
        let points: usize = self.outcomes.iter().map(|o| o.points).sum();
        let false_finds: usize = self.outcomes.iter().map(|o| o.false_finds).sum();
        let sum = |a: (f64, usize), s: &Score| (a.0 + s.squares.0, a.1 + s.squares.1);
        let (squares, added) = self.scores().filter(|s| s.found).fold((0.0, 0), sum);
        format!(
            "| {} | {} | {:.1} % | {:.2} | {} | {:.2} | {:.2} | {:.1} |\n",
            self.name,
            columns.join(" | "),
            100.0 * found as f64 / all.max(1) as f64,
            1e5 * false_finds as f64 / points.max(1) as f64,
            if matches!(self.body, Some(Body::Scan(_))) { self.own.to_string() } else { "–".to_owned() },
            median(self.scores().filter(|s| s.found).filter_map(Score::rms)),
            (squares / added.max(1) as f64).sqrt(),
            median(self.scores().filter(|s| s.found).map(|s| s.hausdorff)),
        )
    }
}

/// The outcomes of all rows.
pub fn sum(name: &str, rows: &[Row]) -> Row {
    let outcomes = rows.iter().flat_map(|row| row.outcomes.clone()).collect();
    Row { name: name.to_owned(), body: None, outcomes, own: 0 }
}

pub fn table<'a>(rows: impl IntoIterator<Item = &'a Row>) -> String {
    let head = "| cut out of | found: 3–6 spacings wide | 6–8 | 8–12 | 12–25 | 25–60 | 8 and more | false per 10⁵ points | own holes | RMS of a hole, median [spacings] | RMS of all points [spacings] | \
                Hausdorff, median [spacings] |\n";
    let lines: String = rows.into_iter().map(Row::line).collect();
    format!("{head}|{}\n{lines}", "---|".repeat(12))
}

/// The median of some numbers.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Puts a table into its part of the page.
///
/// # Errors
/// A file that cannot be read or written, or has no such part.
pub fn replace(page: &Path, part: &str, table: &str) -> Result<(), String> {
    let name = |why: &dyn std::fmt::Display| format!("{}: {why}", page.display());
    let text = std::fs::read_to_string(page).map_err(|why| name(&why))?;
    let [begins, ends] = ["begins", "ends"].map(|which| format!("<!-- {part} {which} -->"));
    let cut = text.split_once(&begins).and_then(|(before, rest)| Some((before, rest.split_once(&ends)?.1)));
    let (before, after) = cut.ok_or_else(|| name(&format!("the lines {begins} and {ends} are missing")))?;
    std::fs::write(page, format!("{before}{begins}\n{table}{ends}{after}")).map_err(|why| name(&why))
}

/// Puts the table into its part of the page, and the picture beside it.
///
/// # Errors
/// A file that cannot be read or written, or has no such part.
pub fn write(page: &Path, rows: &[Row], sums: &[Row]) -> Result<(), String> {
    replace(page, "holes-study", &table(rows.iter().chain(sums)))?;
    let svg = page.with_file_name("filling-holes.svg");
    let (plots, layout) = picture(rows);
    let picture = plot::diagram(&svg, plots, layout).map_err(|why| why.to_string())?;
    std::fs::write(&svg, picture).map_err(|why| format!("{}: {why}", svg.display()))
}

/// Name and colour of a line of the picture, and the bodies that it shows.
type Kind<'a> = (&'a str, &'a str, &'a dyn Fn(Option<Body>) -> bool);

/// Share of the holes that were found over their size, by kind of body.
fn picture(rows: &[Row]) -> (Vec<Plot>, Layout) {
    let is_uneven = |body: Option<Body>| matches!(body, Some(Body::Gradient | Body::Steps));
    let is_scan = |body: Option<Body>| matches!(body, Some(Body::Scan(_)));
    let kinds: [Kind; 3] = [
        ("even density", "steelblue", &|body| body.is_some() && !is_uneven(body) && !is_scan(body)),
        ("density that varies", "darkorange", &is_uneven),
        ("scans", "seagreen", &is_scan),
    ];
    let line = |(legend, colour, of): Kind| {
        let share = |sizes: &[f64]| {
            let counts = rows.iter().filter(|row| of(row.body)).map(|row| row.found(sizes[0], sizes[1]));
            let (found, all) = counts.fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
            (all > 0).then(|| ((sizes[0] * sizes[1]).sqrt(), 100.0 * found as f64 / all as f64))
        };
        let data: Vec<(f64, f64)> = SIZES.windows(2).filter_map(share).collect();
        Plot::from(LinePlot::new().with_data(data).with_color(colour).with_legend(legend))
    };
    let plots: Vec<Plot> = kinds.into_iter().map(line).collect();
    let layout = Layout::auto_from_plots(&plots)
        .with_x_label("width of the hole [local spacings]")
        .with_y_label("found [%]");
    (plots, layout)
}
