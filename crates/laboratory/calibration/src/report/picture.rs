//! The picture of a calibration: fits, pairs, sensitivities, convergence.

use crate::recipe::{Part, Recipe, Step};
use crate::report::judge::{Judged, quantile, rank_correlation};
use crate::session::{StepEnd, Tried};
use kuva::prelude::*;
use plot::COLOURS;
use std::path::Path;
use std::sync::Arc;

const BLACK: &str = "#000000";
const GREY: &str = "#9a9a9a";
/// Size of a panel [px].
const PANEL: (f64, f64) = (520.0, 340.0);
/// Panels side by side.
const COLUMNS: usize = 2;
/// Panels of fits and of pairs, at most.
const FITS: usize = 8;
const PAIRS: usize = 3;
/// Curves of the posterior that an interval is drawn from.
const CURVES: usize = 200;
/// Points of a pair.
const POINTS: usize = 600;

type Panel = (Vec<Plot>, Layout);

/// The bytes of the picture; the ending of the name chooses the format.
///
/// # Errors
/// Another ending than .svg or .png; what cannot be drawn.
pub fn draw(
    file: &Path,
    recipe: &Recipe,
    judged: &Judged,
    ends: &[StepEnd],
    tried: &[Tried],
) -> Result<Vec<u8>, plot::PlotError> {
    let Some(last) = ends.last() else { return plot::bytes(file, &Figure::new(1, 1).render()) };
    let parts = last.fitted.step.to.iter().enumerate();
    let mut panels: Vec<Panel> = parts.take(FITS).map(|(k, part)| fit(recipe, last, (k, part))).collect();
    panels.extend(pairs(recipe, last));
    panels.extend(sensitivities(judged, last.fitted.step));
    panels.push(misfits(recipe, tried));
    panels.extend(ends.iter().filter(|e| e.widths.len() > 1).map(|e| convergence(recipe, e)));
    let rows = panels.len().div_ceil(COLUMNS);
    let (plots, layouts): (Vec<_>, Vec<_>) = panels.into_iter().unzip();
    let figure = Figure::new(rows, COLUMNS).with_plots(plots).with_layouts(layouts);
    plot::bytes(file, &figure.with_cell_size(PANEL.0, PANEL.1).with_keep_panel_legends().render())
}

fn labelled(plots: Vec<Plot>, title: &str, x: &str, y: &str) -> Panel {
    let layout = Layout::auto_from_plots(&plots).with_title(title).with_x_label(x).with_y_label(y);
    let ticks = || TickFormat::Custom(Arc::new(|v| geom::Shown(v).to_string()));
    (plots, layout.with_title_wrap(52).with_x_tick_format(ticks()).with_y_tick_format(ticks()))
}

fn unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// Data with their deviations, the best point as the emulator says and as it was simulated, and the interval of the posterior.
fn fit(recipe: &Recipe, end: &StepEnd, of: (usize, &Part)) -> Panel {
    let (test, emulator) = (&recipe.tests[of.1.test], &end.fitted.emulators[of.0]);
    let Some(target) = &test.target else { return labelled(Vec::new(), &test.name, "", "") };
    let test_points = target.part(of.1.from, of.1.until);
    let points: Vec<_> = test_points.iter().map(|&k| target.points[k]).collect();
    let data: Vec<(f64, f64)> =
        points.iter().map(|p| (if test.x.is_some() { p.x } else { 1.0 }, p.y)).collect();
    let bars: Vec<f64> = points
        .iter()
        .map(|p| (p.deviation * p.deviation + target.discrepancy * target.discrepancy).sqrt())
        .collect();
    let every = end.samples.list.len().div_ceil(CURVES).max(1);
    let curves: Vec<Vec<f64>> =
        end.samples.list.iter().step_by(every).map(|s| emulator.curve(&s.z)).collect();
    let tail = 0.5 * (1.0 - recipe.settings.interval);
    let at = |k: usize, share: f64| {
        let mut values: Vec<f64> = curves.iter().map(|c| c[k]).collect();
        values.sort_by(f64::total_cmp);
        quantile(&values, share)
    };
    let x: Vec<f64> = data.iter().map(|p| p.0).collect();
    let best = emulator.curve(&end.best_point());
    let run = simulated(end, of.1, &test_points);
    let scatter = ScatterPlot::new()
        .with_data(data)
        .with_y_err(bars)
        .with_color(BLACK)
        .with_size(2.5)
        .with_legend("data");
    let mut plots = vec![Plot::from(scatter)];
    if x.len() > 1 {
        let (low, high): (Vec<f64>, Vec<f64>) =
            (0..x.len()).map(|k| (at(k, tail), at(k, 1.0 - tail))).unzip();
        plots.insert(
            0,
            Plot::from(BandPlot::new(x.clone(), low, high).with_color(COLOURS[0]).with_opacity(0.25)),
        );
        let line: Vec<(f64, f64)> = x.iter().copied().zip(best).collect();
        plots.push(Plot::from(
            LinePlot::new()
                .with_data(line)
                .with_color(COLOURS[0])
                .with_stroke_width(1.6)
                .with_legend("best, predicted"),
        ));
        if let Some(run) = run {
            let line: Vec<(f64, f64)> = x.iter().copied().zip(run).collect();
            plots.push(Plot::from(
                LinePlot::new()
                    .with_data(line)
                    .with_color(COLOURS[1])
                    .with_stroke_width(1.6)
                    .with_line_style(LineStyle::Dashed)
                    .with_legend("best, simulated"),
            ));
        }
    } else {
        let middle = at(0, 0.5);
        let ends = (middle - at(0, tail), at(0, 1.0 - tail) - middle);
        let dot = ScatterPlot::new()
            .with_data(vec![(2.0, middle)])
            .with_y_err_asymmetric(vec![ends])
            .with_color(COLOURS[0])
            .with_size(3.0);
        plots.push(Plot::from(dot.with_legend("posterior")));
        if let Some(run) = run {
            let dot = ScatterPlot::new().with_data(vec![(2.5, run[0])]).with_color(COLOURS[1]).with_size(3.0);
            plots.push(Plot::from(dot.with_legend("best, simulated")));
        }
    }
    let (x_label, y_label) = (test.x.as_deref().unwrap_or(""), test.y.as_deref().unwrap_or("value"));
    let (plots, layout) =
        labelled(plots, &test.name, &unit(x_label, &target.x_unit), &unit(y_label, test.unit()));
    if test.x.is_some() {
        return (plots, layout);
    }
    // A number has no x: data and fit stand side by side.
    let layout = layout.with_x_axis_min(0.0).with_x_axis_max(3.0);
    (plots, layout.with_x_tick_format(TickFormat::Custom(Arc::new(|_| String::new()))))
}

/// What the run that stands for the best point has at points of a test.
fn simulated(end: &StepEnd, part: &Part, points: &[usize]) -> Option<Vec<f64>> {
    let output = end.best.shown()?.outputs[part.test].as_ref()?;
    Some(points.iter().map(|&k| output[k]).collect())
}

/// Samples of the pairs that are most correlated.
fn pairs(recipe: &Recipe, end: &StepEnd) -> Vec<Panel> {
    let fit = &end.fitted.step.fit;
    let column = |at: usize| -> Vec<f64> { end.samples.list.iter().map(|s| s.z[at]).collect() };
    let mut all: Vec<(f64, usize, usize)> = Vec::new();
    for i in 0..fit.len() {
        all.extend((0..i).map(|j| (rank_correlation(&column(j), &column(i)), j, i)));
    }
    all.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let panel = |(correlation, j, i): (f64, usize, usize)| {
        let (p, q) = (&recipe.parameters[fit[j]], &recipe.parameters[fit[i]]);
        let every = end.samples.list.len().div_ceil(POINTS).max(1);
        let points: Vec<(f64, f64)> =
            end.samples.list.iter().step_by(every).map(|s| (p.value(s.z[j]), q.value(s.z[i]))).collect();
        let cloud = ScatterPlot::new()
            .with_data(points)
            .with_color(COLOURS[0])
            .with_size(1.6)
            .with_marker_opacity(0.4);
        let point = end.best_point();
        let best = vec![(p.value(point[j]), q.value(point[i]))];
        let best =
            ScatterPlot::new().with_data(best).with_color(COLOURS[1]).with_size(4.0).with_legend("best");
        let plots = vec![Plot::from(cloud), Plot::from(best)];
        labelled(
            plots,
            &format!("posterior, rank correlation {correlation:.2}"),
            &unit(&p.name, &p.unit),
            &unit(&q.name, &q.unit),
        )
    };
    all.into_iter().take(PAIRS).map(panel).collect()
}

/// Slant of names that stand close [degrees].
const SLANT: f64 = -30.0;
/// Names that fit side by side.
const ABREAST: usize = 4;

/// Total Sobol indices of a step, a group for each parameter.
fn sensitivities(judged: &Judged, step: &Step) -> Option<Panel> {
    let mine = judged.sensitivities.iter().filter(|s| s.step == step.name);
    let of: Vec<_> = mine.take(COLOURS.len()).collect();
    let names = &of.first()?.parameters;
    let mut bars = BarPlot::new();
    for (k, name) in names.iter().enumerate() {
        bars = bars.with_group(
            name.as_str(),
            of.iter().enumerate().map(|(c, s)| (s.total[k], COLOURS[c])).collect::<Vec<_>>(),
        );
    }
    let bars = bars.with_legend(of.iter().map(|s| s.test.as_str()).collect());
    let (plots, layout) =
        labelled(vec![Plot::from(bars)], "total sensitivity between the bounds", "", "Sobol index [–]");
    let layout = layout.with_y_axis_min(0.0);
    Some((plots, if names.len() > ABREAST { layout.with_x_tick_rotate(SLANT) } else { layout }))
}

/// Misfit of each trial.
fn misfits(recipe: &Recipe, tried: &[Tried]) -> Panel {
    let mut plots = Vec::new();
    for (k, step) in recipe.steps.iter().enumerate() {
        let of: Vec<(f64, f64)> = tried
            .iter()
            .filter(|t| t.trial.step == k)
            .filter_map(|t| Some((t.trial.number as f64, t.misfit.filter(|m| *m > 0.0)?)))
            .collect();
        let points = ScatterPlot::new().with_data(of).with_color(COLOURS[k % COLOURS.len()]).with_size(2.5);
        plots.push(Plot::from(if recipe.steps.len() > 1 {
            points.with_legend(step.name.as_str())
        } else {
            points
        }));
    }
    let (plots, layout) = labelled(plots, "misfit of each trial", "trial", "square of the misfit [–]");
    (plots, layout.with_log_y())
}

/// Width of the intervals after each batch.
fn convergence(recipe: &Recipe, end: &StepEnd) -> Panel {
    let tail = 0.5 * (1.0 - recipe.settings.interval);
    let mut plots = Vec::new();
    for (j, &k) in end.fitted.step.fit.iter().enumerate() {
        let p = &recipe.parameters[k];
        let whole = p.prior_quantile(1.0 - tail) - p.prior_quantile(tail);
        let line: Vec<(f64, f64)> =
            end.widths.iter().map(|(n, w)| (*n as f64, (w[j] / whole).max(1e-4))).collect();
        let colour = if j < COLOURS.len() { COLOURS[j] } else { GREY };
        plots.push(Plot::from(
            LinePlot::new()
                .with_data(line)
                .with_color(colour)
                .with_stroke_width(1.6)
                .with_legend(p.name.as_str()),
        ));
    }
    let title = format!("step '{}': width of the intervals over that of the prior", end.fitted.step.name);
    let (plots, layout) = labelled(plots, &title, "trials", "width [–]");
    (plots, layout.with_log_y())
}
