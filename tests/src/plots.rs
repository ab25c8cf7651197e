//! Draws orders of convergence and curves, a panel for each line of the page.

use crate::page::{Line, Page};
use kuva::prelude::*;
use plot::COLOURS;
use std::path::Path;

/// Of a slope.
const BLACK: &str = "#000000";
/// Size of a panel [px].
const PANEL: (f64, f64) = (560.0, 340.0);
/// Letters of a title in one row of a panel.
const TITLE: usize = 52;
/// Panels side by side.
const COLUMNS: usize = 2;
/// Series that a panel shows at most: more cannot be distinguished.
const SERIES: usize = 8;

/// Error over step, log–log, a panel for each line that has an order; dashed: the slope that is expected. `None` without any.
///
/// # Errors
/// What cannot be drawn.
pub fn orders(page: &Page, file: &Path, step: &str) -> Result<Option<Vec<u8>>, String> {
    let panels: Vec<_> =
        page.lines().filter(|l| !l.orders.is_empty()).map(|line| order_panel(line, step)).collect();
    draw(panels, file)
}

/// A panel for each line that has curves. `None` without any.
///
/// # Errors
/// What cannot be drawn.
pub fn curves(page: &Page, file: &Path) -> Result<Option<Vec<u8>>, String> {
    let panels: Vec<_> = page.lines().filter(|l| !l.curves.is_empty()).map(curve_panel).collect();
    draw(panels, file)
}

type Drawn = (Vec<Plot>, Layout);

fn draw(panels: Vec<Drawn>, file: &Path) -> Result<Option<Vec<u8>>, String> {
    if panels.is_empty() {
        return Ok(None);
    }
    let columns = COLUMNS.min(panels.len());
    let rows = panels.len().div_ceil(columns);
    let wrapped = |(plots, layout): Drawn| (plots, layout.with_title_wrap(TITLE));
    let (plots, layouts): (Vec<_>, Vec<_>) = panels.into_iter().map(wrapped).unzip();
    let figure = Figure::new(rows, columns).with_plots(plots).with_layouts(layouts);
    let scene = figure.with_cell_size(PANEL.0, PANEL.1).with_keep_panel_legends().render();
    plot::bytes(file, &scene).map(Some).map_err(|e| e.to_string())
}

fn series(points: &[(f64, f64)], colour: &str, name: &str, marked: bool) -> Vec<Plot> {
    let line = LinePlot::new().with_data(points.to_vec()).with_color(colour).with_stroke_width(1.6);
    let mut plots = vec![Plot::from(line.with_legend(name))];
    if marked {
        plots.push(Plot::from(
            ScatterPlot::new().with_data(points.to_vec()).with_color(colour).with_size(2.5),
        ));
    }
    plots
}

/// What holds, as far as the first colon: panels are narrow.
fn title(line: &Line) -> &str {
    line.holds.split(": ").next().unwrap_or(&line.holds)
}

fn order_panel(line: &Line, step: &str) -> Drawn {
    let mut plots = Vec::new();
    for (k, order) in line.orders.iter().take(SERIES).enumerate() {
        // A logarithm has no zero.
        let points: Vec<(f64, f64)> =
            order.points.iter().map(|p| (p.0, p.1.abs())).filter(|p| p.0 > 0.0 && p.1 > 0.0).collect();
        plots.extend(series(&points, COLOURS[k % COLOURS.len()], &order.on, true));
    }
    plots.extend(slope(line));
    let layout = Layout::auto_from_plots(&plots).with_log_scale().with_x_label(step).with_y_label("error");
    (plots, layout.with_title(title(line)))
}

/// The slope that is expected, beside the first series.
fn slope(line: &Line) -> Option<Plot> {
    let order = line.orders.first()?;
    let low = order.points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let high = order.points.iter().map(|p| p.0).fold(0.0, f64::max);
    let top = order.points.iter().find(|p| p.0 == high)?.1.abs() * 2.0;
    if !(low > 0.0 && top > 0.0) {
        return None;
    }
    let guide = vec![(low, top * (low / high).powf(order.expected)), (high, top)];
    let plot = LinePlot::new().with_data(guide).with_color(BLACK).with_stroke_width(1.0).with_dashed();
    Some(Plot::from(plot.with_legend(format!("slope {}", order.expected))))
}

fn curve_panel(line: &Line) -> Drawn {
    let mut plots = Vec::new();
    for (k, curve) in line.curves.iter().take(SERIES).enumerate() {
        plots.extend(series(&curve.points, COLOURS[k % COLOURS.len()], &curve.on, false));
    }
    let mut layout = Layout::auto_from_plots(&plots).with_title(title(line));
    if let Some(first) = line.curves.first() {
        layout = layout.with_x_label(first.x.clone()).with_y_label(first.y.clone());
    }
    (plots, layout)
}
