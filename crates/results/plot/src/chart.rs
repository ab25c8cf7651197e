//! Draws charts of measures: panels one above the other.

use crate::{COLOURS, PlotError, bytes};
use kuva::prelude::*;
use measure::{Chart, Curve, Look, Panel};
use std::path::Path;
use std::sync::Arc;

/// Of a fit or a reference.
const BLACK: &str = "#000000";
/// Size of a panel [px].
const PANEL: (f64, f64) = (820.0, 420.0);

/// The bytes of the picture; the ending of the name chooses the format.
///
/// # Errors
/// As for [`bytes`].
pub fn chart(file: &Path, chart: &Chart) -> Result<Vec<u8>, PlotError> {
    let (mut plots, mut layouts) = (Vec::new(), Vec::new());
    for (k, panel) in chart.panels.iter().enumerate() {
        let (own, layout, name) = drawn(panel);
        let title = if k == 0 { vec![chart.title.clone(), name] } else { vec![name] };
        let title: Vec<String> = title.into_iter().filter(|part| !part.is_empty()).collect();
        // Kuva's own labels have too few digits where an axis does not begin at 0.
        let layout = layout.with_tick_format(TickFormat::Custom(Arc::new(|v| geom::Shown(v).to_string())));
        layouts.push(if title.is_empty() { layout } else { layout.with_title(title.join(": ")) });
        plots.push(own);
    }
    let count = plots.len().max(1);
    let figure = Figure::new(count, 1).with_plots(plots).with_layouts(layouts);
    let scene = figure.with_cell_size(PANEL.0, PANEL.1).with_keep_panel_legends().render();
    bytes(file, &scene)
}

/// What to draw, and what the colours of a map mean.
fn drawn(panel: &Panel) -> (Vec<Plot>, Layout, String) {
    match panel {
        Panel::Curves { x, y, curves } => {
            let plots: Vec<Plot> =
                curves.iter().enumerate().map(|(k, c)| curve(c, COLOURS[k % COLOURS.len()])).collect();
            let layout = Layout::auto_from_plots(&plots);
            (plots, layout.with_x_label(x.clone()).with_y_label(y.clone()), String::new())
        }
        Panel::Map { x, y, value, range, cells } => {
            let [x0, y0, x1, y1] = *range;
            let map = Heatmap::new()
                .with_data(cells.iter().map(|row| row.iter().copied()))
                .with_x_range(x0, x1)
                .with_y_range(y0, y1)
                .with_cell_size(1.0)
                .with_color_map(ColorMap::Custom(Arc::new(colour)));
            let plots = vec![Plot::from(map)];
            let layout = Layout::auto_from_plots(&plots).with_x_label(x.clone());
            (plots, layout.with_y_label(y.clone()), value.clone())
        }
    }
}

/// White where there is nothing.
fn colour(share: f64) -> String {
    if share.is_nan() { "#ffffff".to_owned() } else { ColorMap::Viridis.map(share) }
}

fn curve(curve: &Curve, colour: &str) -> Plot {
    let points: Vec<(f64, f64)> =
        curve.points.iter().filter(|p| p.iter().all(|v| v.is_finite())).map(|p| (p[0], p[1])).collect();
    if curve.look == Look::Dots {
        let dots = ScatterPlot::new().with_data(points).with_color(colour).with_size(2.5);
        return Plot::from(if curve.name.is_empty() { dots } else { dots.with_legend(curve.name.clone()) });
    }
    let colour = if curve.look == Look::Dashed { BLACK } else { colour };
    let line = LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.8);
    let line = match curve.look {
        Look::Dashed => line.with_dashed(),
        Look::Steps => line.with_step(),
        _ => line,
    };
    Plot::from(if curve.name.is_empty() { line } else { line.with_legend(curve.name.clone()) })
}
