//! The map of a worn wall.

use crate::sheet::{Chart, Panel, Row};

/// Most squares of a map along an axis.
const MOST_SQUARES: f64 = 240.0;

/// A map over the two axes along which the wall reaches farthest: sums of cubes of space behind each other, means of
/// the wall spheres in squares that hold two or so.
pub(super) fn chart(cell: Option<f64>, rows: &[Row]) -> Chart {
    let of = |k: usize| rows.iter().map(move |r| r[k]);
    let least = |k: usize| of(k).fold(f64::INFINITY, f64::min);
    let reach = |k: usize| of(k).fold(f64::NEG_INFINITY, f64::max) - least(k);
    let mut axes = [0, 1, 2];
    axes.sort_by(|a, b| reach(*b).total_cmp(&reach(*a)));
    let axes = [axes[0].min(axes[1]), axes[0].max(axes[1])];
    let mut chart = Chart::new("Wear of walls");
    let Some(first) = rows.first() else { return chart };
    let margin = 0.5 * cell.unwrap_or(2.0 * first[3]);
    let wide = axes.map(|k| reach(k) + 2.0 * margin);
    let fine = wide[0].max(wide[1]) / MOST_SQUARES;
    let step = cell.unwrap_or((2.0 * wide[0] * wide[1] / rows.len() as f64).sqrt()).max(fine);
    let low = axes.map(|k| least(k) - margin);
    let count = wide.map(|w| (libm::ceil(w / step - 1e-6) as usize).max(1));
    let range = [low[0], low[1], low[0] + count[0] as f64 * step, low[1] + count[1] as f64 * step];
    let [x, y] = axes.map(|k| format!("{} [m]", ["x", "y", "z"][k]));
    let per = if cell.is_some() { "" } else { " of a wall sphere" };
    for (value, column) in [("sliding work", 7), ("mean normal force", 5)] {
        let mut cells = vec![vec![(0.0, 0.0); count[0]]; count[1]];
        for row in rows {
            let [i, j] = [0, 1].map(|k| (((row[axes[k]] - low[k]) / step) as usize).min(count[k] - 1));
            let (sum, rows) = &mut cells[j][i];
            (*sum, *rows) = (*sum + row[column], *rows + 1.0);
        }
        let mean = |(sum, rows): (f64, f64)| match cell {
            Some(_) if rows > 0.0 => sum,
            _ => sum / rows,
        };
        let cells = cells.into_iter().map(|row| row.into_iter().map(mean).collect()).collect();
        let value = format!("{value}{per} [{}]", if column == 7 { "J" } else { "N" });
        chart.panels.push(Panel::Map { x: x.clone(), y: y.clone(), value, range, cells });
    }
    chart
}
