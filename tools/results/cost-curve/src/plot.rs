//! The work–precision diagram: error over work, both logarithmic, with the Pareto front and the setting in use.

use ::plot::COLOURS;
use anyhow::anyhow;
use curve::{Choice, Judged};
use kuva::plot::scatter::MarkerShape;
use kuva::prelude::*;
use std::path::Path;
use std::sync::Arc;

const GREY: &str = "#999999";
const BLACK: &str = "#000000";
const SIZE: (f64, f64) = (760.0, 480.0);

/// A point of the diagram: work, error, half width of the interval, name.
struct Dot {
    at: (f64, f64),
    interval: f64,
    label: String,
    group: String,
    index: usize,
}

/// Points with an error; what has none lies on the floor, where a logarithm has no room for 0.
fn dots(judged: &Judged) -> Vec<Dot> {
    let sizes = judged.errors.iter().flatten().map(|e| e.size).filter(|s| *s > 0.0);
    let floor = sizes.fold(f64::INFINITY, f64::min) / 3.0;
    let floor = if floor.is_finite() { floor } else { 1e-16 };
    let dot = |(index, point): (usize, &curve::Point)| {
        let error = judged.errors[index].filter(|_| judged.marks.0 != Some(index))?;
        let (_, label) = point.setting.first()?;
        let group =
            point.setting.iter().skip(1).map(|(k, v)| format!("{k} {v}")).collect::<Vec<_>>().join(", ");
        let interval = if error.interval.is_nan() { 0.0 } else { error.interval };
        let zero = if error.size > 0.0 { "" } else { " (none)" };
        let label = format!("{label}{zero}");
        Some(Dot { at: (point.work(), error.size.max(floor)), interval, label, group, index })
    };
    judged.points.iter().enumerate().filter_map(dot).collect()
}

/// The bytes of the picture; the ending of the name chooses the format.
pub fn draw(file: &Path, judged: &Judged, title: &str) -> anyhow::Result<Vec<u8>> {
    let dots = dots(judged);
    if dots.is_empty() {
        let why =
            "no setting but the reference has an error to draw: the column 'why' says what stopped them";
        return Err(anyhow!("-o {}: {why}", file.display()));
    }
    let mut plots = vec![line(&on_front(judged, &dots), GREY, "nothing beats these")];
    let mut groups: Vec<&str> = Vec::new();
    dots.iter().for_each(|d| {
        if !groups.contains(&d.group.as_str()) {
            groups.push(&d.group)
        }
    });
    for (k, group) in groups.iter().enumerate() {
        let own: Vec<&Dot> = dots.iter().filter(|d| d.group == **group).collect();
        plots.push(scatter(&own, COLOURS[k % COLOURS.len()], group));
    }
    plots.extend(marked(judged).into_iter().filter_map(|mark| ring(&dots, mark)));
    plots.extend(wanted(judged, &dots));
    let layout = layout(judged, &plots, title);
    ::plot::diagram(file, plots, layout).map_err(|e| anyhow!("-o {e}"))
}

/// A ring around a point with a mark.
fn ring(dots: &[Dot], mark: Mark) -> Option<Plot> {
    let dot = dots.iter().find(|d| d.index == mark.index)?;
    let ring = ScatterPlot::new().with_data(vec![dot.at]).with_color(BLACK).with_size(8.0);
    let ring = ring.with_marker(mark.shape).with_marker_opacity(0.0).with_marker_stroke_width(1.5);
    Some(Plot::from(ring.with_legend(mark.name)))
}

/// The level of the error that is good enough.
fn wanted(judged: &Judged, dots: &[Dot]) -> Option<Plot> {
    let works = || dots.iter().map(|d| d.at.0);
    let (low, high) = (works().fold(f64::INFINITY, f64::min), works().fold(0.0, f64::max));
    if judged.choice.is_none() || !low.is_finite() {
        return None;
    }
    let level = vec![(low, judged.wanted.0), (high.max(low * 1.01), judged.wanted.0)];
    let wanted = LinePlot::new().with_data(level).with_color(BLACK).with_dotted();
    Some(Plot::from(wanted.with_legend(match judged.wanted.1 {
        true => format!("{} wanted", curve::percent(judged.wanted.0)),
        false => "wanted".to_owned(),
    })))
}

fn layout(judged: &Judged, plots: &[Plot], title: &str) -> Layout {
    let share = judged.relative;
    let unit = if share { "%" } else { judged.what.1.as_str() };
    let tick = move |v: f64| geom::Shown(if share { 100.0 * v } else { v }).to_string();
    let key = judged.points.first().and_then(|p| p.setting.first()).map_or("", |(k, _)| k.as_str());
    Layout::auto_from_plots(plots)
        .with_width(SIZE.0)
        .with_height(SIZE.1)
        .with_log_scale()
        .with_title(title.to_owned())
        .with_x_label(match judged.of {
            "time" => format!("wall time for a simulated second [s]; beside the points: {key}"),
            "processor time" => {
                format!("processor time for a simulated second [s]; beside the points: {key}")
            }
            of => format!("{of} for a simulated second; beside the points: {key}"),
        })
        .with_y_label(format!("error in {} [{unit}]", judged.what.0))
        .with_x_tick_format(TickFormat::Custom(Arc::new(|v| geom::Shown(v).to_string())))
        .with_y_tick_format(TickFormat::Custom(Arc::new(tick)))
}

fn on_front(judged: &Judged, dots: &[Dot]) -> Vec<(f64, f64)> {
    judged.front.iter().filter_map(|k| dots.iter().find(|d| d.index == *k)).map(|d| d.at).collect()
}

/// A point that is marked.
struct Mark {
    index: usize,
    name: &'static str,
    shape: MarkerShape,
}

fn marked(judged: &Judged) -> Vec<Mark> {
    let mark = |name, shape| move |index| Mark { index, name, shape };
    let recommended = match judged.choice {
        Some(Choice::Point(k)) => Some(k),
        _ => None,
    };
    let in_use = judged.marks.1.map(mark("in use", MarkerShape::Circle));
    in_use.into_iter().chain(recommended.map(mark("recommended", MarkerShape::Diamond))).collect()
}

fn line(points: &[(f64, f64)], colour: &str, name: &str) -> Plot {
    let line =
        LinePlot::new().with_data(points.to_vec()).with_color(colour).with_stroke_width(1.2).with_dashed();
    Plot::from(if points.len() > 1 { line.with_legend(name) } else { line })
}

fn scatter(dots: &[&Dot], colour: &str, group: &str) -> Plot {
    let plot = ScatterPlot::new()
        .with_data(dots.iter().map(|d| d.at).collect::<Vec<_>>())
        // An arm that reaches 0 has no end on a logarithm.
        .with_y_err_asymmetric(
            dots.iter().map(|d| (d.interval.min(0.7 * d.at.1), d.interval)).collect::<Vec<_>>(),
        )
        .with_color(colour)
        .with_size(4.0)
        .with_labels(dots.iter().map(|d| d.label.clone()).collect::<Vec<_>>());
    Plot::from(if group.is_empty() { plot } else { plot.with_legend(group) })
}
