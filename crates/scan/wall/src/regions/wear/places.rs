//! Wear that a run measured, by place.

use super::error::{Load, WearError};
use geom::{Grid, Vec3};
use rayon::prelude::*;

/// A point of a wall is at most this many radii from the centre of its sphere [–]; more is another wall.
const REACH: f64 = 2.0;

/// What was measured at places [m].
#[derive(Debug, Clone)]
pub(super) struct Places {
    at: Vec<Vec3>,
    wears: Vec<f64>,
    /// How far from each its wear counts [m].
    reach: Vec<f64>,
}

impl Places {
    /// The places of a table with the columns x, y, z [m], and this one.
    pub(super) fn read(file: &str, column: &str, text: Load<String>) -> Result<Places, WearError> {
        let wrong = |why: String| WearError::File { file: file.to_owned(), why };
        let text = text(file).map_err(wrong)?;
        let mut lines = (1..).zip(text.lines()).filter(|(_, l)| !l.trim().is_empty());
        let head = lines.next().map_or("", |(_, head)| head);
        // "x [m]" is x.
        let names: Vec<&str> = head.split(',').map(|n| n.split('[').next().unwrap_or(n).trim()).collect();
        let find = |name: &str| {
            let missing =
                || wrong(format!("has no column '{name}': give a table that dem-measure --wear wrote"));
            names.iter().position(|n| *n == name).ok_or_else(missing)
        };
        let columns = [find("x")?, find("y")?, find("z")?, find("radius")?, find(column)?];
        let (mut at, mut wears, mut reach) = (Vec::new(), Vec::new(), Vec::new());
        for (line, row) in lines {
            let cells: Vec<&str> = row.split(',').map(str::trim).collect();
            let numbers =
                columns.map(|k| cells.get(k).and_then(|c| c.parse::<f64>().ok()).filter(|x| x.is_finite()));
            let [Some(x), Some(y), Some(z), Some(radius), Some(wear)] = numbers else {
                let (file, what) = (file.to_owned(), "a line has a place and a wear, not");
                return Err(WearError::Line { file, line, what, text: row.chars().take(60).collect() });
            };
            at.push(Vec3::new(x, y, z));
            wears.push(wear);
            reach.push(REACH * radius);
        }
        if at.is_empty() {
            Err(wrong("has no line below its names".to_owned()))
        } else {
            Ok(Places { at, wears, reach })
        }
    }

    /// The wear at the place nearest to each point [m]; not a number where that is farther away than twice its radius.
    pub(super) fn nearest(&self, points: &[Vec3]) -> Vec<f64> {
        let (low, high) = geom::grid::bounds(&self.at);
        let first = ((high - low).norm() / (self.at.len() as f64).sqrt()).max(1e-9);
        let grid = Grid::new(&self.at, first);
        let wear = |p: &Vec3| {
            let near = grid.nearest(&self.at, *p, first).map(|k| k as usize);
            let near = near.filter(|&k| (self.at[k] - p).norm() <= self.reach[k]);
            near.map_or(f64::NAN, |k| self.wears[k])
        };
        points.par_iter().map(wear).collect()
    }
}
