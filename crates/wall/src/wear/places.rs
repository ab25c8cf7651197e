//! Wear that a run measured, by place.

use super::{Load, WearError};
use geom::{Grid, Vec3};
use rayon::prelude::*;

/// What was measured at places [m].
#[derive(Debug, Clone)]
pub(super) struct Places {
    at: Vec<Vec3>,
    wears: Vec<f64>,
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
        let columns = [find("x")?, find("y")?, find("z")?, find(column)?];
        let (mut at, mut wears) = (Vec::new(), Vec::new());
        for (line, row) in lines {
            let cells: Vec<&str> = row.split(',').map(str::trim).collect();
            let numbers =
                columns.map(|k| cells.get(k).and_then(|c| c.parse::<f64>().ok()).filter(|x| x.is_finite()));
            let [Some(x), Some(y), Some(z), Some(wear)] = numbers else {
                let (file, what) = (file.to_owned(), "a line has a place and a wear, not");
                return Err(WearError::Line { file, line, what, text: row.chars().take(60).collect() });
            };
            at.push(Vec3::new(x, y, z));
            wears.push(wear);
        }
        if at.is_empty() {
            Err(wrong("has no line below its names".to_owned()))
        } else {
            Ok(Places { at, wears })
        }
    }

    /// The wear at the place nearest to each point [m].
    pub(super) fn nearest(&self, points: &[Vec3]) -> Vec<f64> {
        let (low, high) = geom::grid::bounds(&self.at);
        let first = ((high - low).norm() / (self.at.len() as f64).sqrt()).max(1e-9);
        let grid = Grid::new(&self.at, first);
        let wear = |p: &Vec3| {
            let apart = |k: &u32| (self.at[*k as usize] - p).norm_squared();
            // From outside of their box all of them are at most this far.
            let most = (p - 0.5 * (low + high)).norm() + (high - low).norm() + first;
            let mut reach = first;
            loop {
                let near = grid
                    .within(&self.at, *p, reach)
                    .min_by(|a, b| apart(a).total_cmp(&apart(b)).then(a.cmp(b)));
                match near {
                    Some(k) => return self.wears[k as usize],
                    None if reach > most => return f64::NAN,
                    None => reach *= 2.0,
                }
            }
        };
        points.par_iter().map(wear).collect()
    }
}
