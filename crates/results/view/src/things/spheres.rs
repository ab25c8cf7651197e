//! Positions and radii from a table, checked.

use crate::ViewError;
use crate::appearance::scale::Range;
use geom::{LARGEST, Vec3};
use std::collections::HashSet;
use stream::{Table, Values};

/// Spheres in columns of a table, which are read where they are: of millions a second copy would be felt.
pub(crate) struct Spheres<'a> {
    /// x, y and z of the centres [m].
    pub centre: [&'a Values; 3],
    /// Radii [m], where they are a column.
    radius: Option<&'a Values>,
    /// Radius of points without one [m]: half their usual distance.
    usual: f64,
    /// Size as drawn [–].
    pub shrunk: f64,
}

impl Spheres<'_> {
    /// Takes x, y, z and radius out of `table`; `name` is for messages.
    ///
    /// # Errors
    /// A position is missing, a number is not finite, or a radius is not above 0.
    pub fn of<'a>(table: &'a Table, name: &str) -> Result<Spheres<'a>, ViewError> {
        let column = |column| {
            let missing = || ViewError::NoPosition { name: name.to_owned(), column };
            finite(table, name, column)?.ok_or_else(missing)
        };
        let centre = [column("x")?, column("y")?, column("z")?];
        let radius = finite(table, name, "radius")?;
        if let Some((row, value)) = radius.and_then(|r| r.iter().enumerate().find(|(_, r)| !(*r > 0.0))) {
            return Err(ViewError::Radius { name: name.to_owned(), row, value });
        }
        let usual = if radius.is_some() { 0.0 } else { 0.5 * spacing(&centre) };
        Ok(Spheres { centre, radius, usual, shrunk: 1.0 })
    }

    pub fn len(&self) -> usize {
        self.centre[0].len()
    }

    /// Whether the radius is a column of the table.
    pub fn sized(&self) -> bool {
        self.radius.is_some()
    }

    /// The centre of one [m].
    pub fn at(&self, i: usize) -> Vec3 {
        Vec3::from(self.centre.map(|axis| axis.get(i)))
    }

    /// The radius of one [m].
    pub fn radius(&self, i: usize) -> f64 {
        self.shrunk * self.radius.map_or(self.usual, |radius| radius.get(i))
    }

    /// The radii of all [m].
    pub fn radii(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.len()).map(|i| self.radius(i))
    }
}

/// The values of a column, all of them finite.
fn finite<'a>(table: &'a Table, name: &str, column: &'static str) -> Result<Option<&'a Values>, ViewError> {
    let Some(values) = table.get(column) else { return Ok(None) };
    match values.iter().enumerate().find(|(_, v)| !(v.abs() <= LARGEST)) {
        Some((row, value)) => Err(ViewError::NotFinite { name: name.to_owned(), row, column, value }),
        None => Ok(Some(values)),
    }
}

/// All values, unless the outer 1 % of them take up more than half the width.
fn most_of(values: &Values) -> Range {
    let (all, most) = (Range::of(values.iter()), Range::of_most(values.iter()));
    let far = values.len() > 200 && all.hi - all.lo > 2.0 * (most.hi - most.lo);
    if far { most } else { all }
}

/// The usual distance of neighbours on a surface [m]: the area is counted in occupied boxes of a coarse grid.
fn spacing(centre: &[&Values; 3]) -> f64 {
    let box_of = centre.map(most_of);
    let widest = box_of.iter().map(|r| r.hi - r.lo).fold(0.0, f64::max);
    let count = centre[0].len();
    if count < 2 || widest <= 0.0 {
        return 1e-3;
    }
    let cells = ((count as f64 / 8.0).sqrt()).clamp(2.0, 128.0);
    let side = widest / cells;
    let cell = |k: usize, i: usize| {
        ((centre[k].get(i).clamp(box_of[k].lo, box_of[k].hi) - box_of[k].lo) / side) as u16
    };
    let occupied: HashSet<[u16; 3]> = (0..count).map(|i| [cell(0, i), cell(1, i), cell(2, i)]).collect();
    side * (occupied.len() as f64 / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(x: Vec<f64>) -> Table {
        let mut table = Table::default();
        let zeros = vec![0.0; x.len()];
        table.push("x", Values::F64(x)).expect("fits");
        table.push("y", Values::F64(zeros.clone())).expect("fits");
        table.push("z", Values::F64(zeros)).expect("fits");
        table
    }

    #[test]
    fn a_missing_or_broken_position_is_named() {
        let broken = Spheres::of(&table(vec![1.0, f64::NAN]), "run").err().expect("refused").to_string();
        assert!(broken.contains("run: row 1: x is NaN"), "{broken}");
        let missing = Spheres::of(&Table::with_rows(3), "run").err().expect("refused").to_string();
        assert!(missing.contains("no column 'x'"), "{missing}");
    }

    #[test]
    fn a_radius_that_is_not_above_zero_is_named() {
        for bad in [-0.01, 0.0] {
            let mut spheres = table(vec![1.0, 2.0]);
            spheres.push("radius", Values::F64(vec![0.01, bad])).expect("fits");
            let refused = Spheres::of(&spheres, "walls").err().expect("refused").to_string();
            assert!(refused.contains(&format!("walls: row 1: radius {bad} m")), "{refused}");
        }
    }

    #[test]
    fn points_of_a_square_lattice_get_half_its_spacing() {
        let lattice = |i: i32| [f64::from(i % 100) * 0.1, f64::from(i / 100) * 0.1];
        let points: Vec<[f64; 2]> = (0..10_000).map(lattice).collect();
        let column = |k: usize| Values::F64(points.iter().map(|p| p[k]).collect());
        let found = spacing(&[&column(0), &column(1), &Values::F64(vec![0.0; 10_000])]);
        assert!((found / 0.1 - 1.0).abs() < 0.3, "{found}");
    }
}
