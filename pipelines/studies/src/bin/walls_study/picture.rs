//! Panels of lines, as SVG or PNG.

use kuva::prelude::*;
use plot::COLOURS;
use std::path::Path;

/// Size of a panel [px].
const SIZE: (f64, f64) = (420.0, 320.0);

/// One panel.
#[derive(Default)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// What is along x and y.
    pub axes: (String, String),
    /// Lines with points: name and points.
    pub lines: Vec<(String, Vec<(f64, f64)>)>,
    /// Dashed lines without points, in the colours of the lines.
    pub closed: Vec<Vec<(f64, f64)>>,
    /// Whether y starts at 0.
    pub from_zero: bool,
}

/// The picture; the ending of the name chooses the format.
///
/// # Errors
/// What cannot be drawn.
pub fn draw(name: &str, columns: usize, panels: &[Panel]) -> Result<Vec<u8>, String> {
    let (plots, layouts): (Vec<_>, Vec<_>) = panels.iter().map(panel).unzip();
    let rows = panels.len().div_ceil(columns);
    let figure = Figure::new(rows, columns).with_plots(plots).with_layouts(layouts);
    let scene = figure.with_cell_size(SIZE.0, SIZE.1).with_keep_panel_legends().render();
    plot::bytes(Path::new(name), &scene).map_err(|e| e.to_string())
}

fn panel(panel: &Panel) -> (Vec<Plot>, Layout) {
    let mut plots = Vec::new();
    for (k, (name, points)) in panel.lines.iter().enumerate() {
        let points: Vec<(f64, f64)> =
            points.iter().copied().filter(|p| p.0.is_finite() && p.1.is_finite()).collect();
        let colour = COLOURS[k % COLOURS.len()];
        let line = LinePlot::new().with_data(points.clone()).with_color(colour).with_stroke_width(1.6);
        plots.push(Plot::from(if name.is_empty() { line } else { line.with_legend(name.clone()) }));
        plots.push(Plot::from(ScatterPlot::new().with_data(points).with_color(colour).with_size(2.5)));
    }
    for (k, points) in panel.closed.iter().enumerate() {
        let line = LinePlot::new().with_data(points.clone()).with_color(COLOURS[k % COLOURS.len()]);
        plots.push(Plot::from(line.with_stroke_width(1.0).with_dashed()));
    }
    let mut layout = Layout::auto_from_plots(&plots).with_title(panel.title.clone());
    if panel.from_zero {
        layout = layout.with_y_axis_min(0.0);
    }
    (plots, layout.with_x_label(panel.axes.0.clone()).with_y_label(panel.axes.1.clone()))
}
