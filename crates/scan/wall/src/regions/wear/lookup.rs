//! Roughness from a table indexed by a wear measurement and a position.
//!
//! ```toml
//! roughness = 0.0005            # [m] where wear was not measured
//! [wear]
//! table = "wear.csv"            # beside this file
//! measured = "wear"             # a property of the cloud; or: drawing = "new.stl", or: value = 0.004
//! run = "run-wear.csv"          # if given, `measured` is a column of it: what `dem-measure --wear` found
//! from = [0, 0, 0]              # position [m]: distance from here …
//! along = [1, 0, 0]             # … in this direction
//! ```
//!
//! ```csv
//! wear, 0, 0.5, 1.0             first line: positions [m], ascending
//! 0,     0.0005, 0.0005, 0.0008 other lines: a wear, ascending, in the unit of the measurement; then roughness ζ [m] at each position
//! 0.01,  0.0010, 0.0015, 0.0020
//! ```
//!
//! Between the entries ζ is linear in both; beyond the table the value at its edge is used, and the report counts these points. With a
//! drawing, the wear is the distance of a point from the drawn surface [m]; with a run, that of the nearest wall sphere.

use super::error::{Load, WearError};
use super::places::Places;
use super::table::{WearTable, place};
use geom::mesh::{TriMesh, closest_point};
use geom::{Boxes, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The section `[wear]` of a file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Section {
    table: String,
    measured: Option<String>,
    run: Option<String>,
    drawing: Option<String>,
    value: Option<f64>,
    #[serde(default)]
    from: [f64; 3],
    along: [f64; 3],
}

#[derive(Debug, Clone)]
enum WearSource {
    Property(String),
    Run(Places),
    Drawing(TriMesh),
    Value(f64),
}

/// A table, and where its two indices come from.
#[derive(Debug, Clone)]
pub struct Wear {
    source: WearSource,
    from: Vec3,
    along: Vec3,
    table: WearTable,
}

/// What a table was asked.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct WearReport {
    /// Least and largest measured wear, in its unit.
    pub wear: [f64; 2],
    /// Least and largest position [m].
    pub position: [f64; 2],
    /// Points without a measurement.
    pub not_measured: usize,
    /// Points beyond the table, in either index.
    pub beyond: usize,
    /// Least and largest roughness [m].
    pub roughness: [f64; 2],
}

impl Wear {
    pub(crate) fn new(section: Section, text: Load<String>, mesh: Load<TriMesh>) -> Result<Wear, WearError> {
        let given = [section.measured.is_some(), section.drawing.is_some(), section.value.is_some()];
        let given = given.iter().filter(|g| **g).count();
        let source = match (section.measured, section.drawing, section.value) {
            (Some(column), None, None) => match section.run {
                Some(file) => WearSource::Run(Places::read(&file, &column, text)?),
                None => WearSource::Property(column),
            },
            _ if section.run.is_some() => return Err(WearError::RunColumn(section.run.unwrap_or_default())),
            (None, Some(file), None) => {
                WearSource::Drawing(mesh(&file).map_err(|why| WearError::File { file: file.clone(), why })?)
            }
            (None, None, Some(value)) if !value.is_finite() => return Err(WearError::Value(value)),
            (None, None, Some(value)) => WearSource::Value(value),
            _ => return Err(WearError::WearSource { given }),
        };
        let along = Vec3::from(section.along).try_normalize(0.0).filter(|a| a.iter().all(|c| c.is_finite()));
        let along = along.ok_or(WearError::Along { along: section.along })?;
        let file = section.table;
        let text = text(&file).map_err(|why| WearError::File { file: file.clone(), why })?;
        Ok(Wear { source, from: section.from.into(), along, table: WearTable::parse(&file, &text)? })
    }

    /// ζ [m] of each point [m]; where nothing was measured it is `outside`. `property` gives a column of the cloud.
    ///
    /// # Errors
    /// No such property; points without a measurement when nothing holds outside.
    pub fn roughness(
        &self,
        points: &[Vec3],
        property: &dyn Fn(&str) -> Option<Vec<f64>>,
        outside: Option<f64>,
    ) -> Result<(Vec<f64>, WearReport), WearError> {
        let wears = self.measured(points, property)?;
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let mut report = WearReport { wear: none, position: none, roughness: none, ..WearReport::default() };
        let mut all = Vec::with_capacity(points.len());
        for (point, (p, &wear)) in points.iter().zip(&wears).enumerate() {
            let zeta = if wear.is_finite() {
                let position = (p - self.from).dot(&self.along);
                let (row, is_in) = place(&self.table.wears, wear);
                let (column, is_along) = place(&self.table.positions, position);
                report.beyond += usize::from(!(is_in && is_along));
                widen(&mut report.wear, wear);
                widen(&mut report.position, position);
                self.at(row, column)
            } else {
                report.not_measured += 1;
                outside.ok_or(WearError::NotMeasured { point, found: wear })?
            };
            widen(&mut report.roughness, zeta);
            all.push(zeta);
        }
        Ok((all, report))
    }

    fn measured(
        &self,
        points: &[Vec3],
        property: &dyn Fn(&str) -> Option<Vec<f64>>,
    ) -> Result<Vec<f64>, WearError> {
        match &self.source {
            WearSource::Value(value) => Ok(vec![*value; points.len()]),
            WearSource::Property(name) => property(name)
                .filter(|column| column.len() == points.len())
                .ok_or_else(|| WearError::NoProperty(name.clone())),
            WearSource::Run(places) => Ok(places.nearest(points)),
            WearSource::Drawing(mesh) => Ok(distances(points, mesh)),
        }
    }

    /// Linear in both indices, each a place between two entries and the share of the second.
    fn at(&self, (row, t): (usize, f64), (column, s): (usize, f64)) -> f64 {
        let along = |row: usize| {
            let line = &self.table.roughness[row];
            let next = (column + 1).min(line.len() - 1);
            line[column] * (1.0 - s) + line[next] * s
        };
        along(row) * (1.0 - t) + along((row + 1).min(self.table.roughness.len() - 1)) * t
    }
}

fn widen(range: &mut [f64; 2], value: f64) {
    *range = [range[0].min(value), range[1].max(value)];
}

/// Distance of each point from a surface [m].
fn distances(points: &[Vec3], mesh: &TriMesh) -> Vec<f64> {
    let boxed = |tri: [Vec3; 3]| [tri[0].inf(&tri[1]).inf(&tri[2]), tri[0].sup(&tri[1]).sup(&tri[2])];
    let boxes = Boxes::new(&mesh.triangles().map(boxed).collect::<Vec<_>>());
    let [lo, hi] = boxes.bounds();
    let first = 1e-3 * (hi - lo).norm() + 1e-9;
    let distance = |p: &Vec3| {
        let mut reach = first;
        for _ in 0..60 {
            let mut least = f64::INFINITY;
            boxes.near(*p, reach, |face| {
                least = least.min((closest_point(mesh.triangle(face as usize), *p) - p).norm());
            });
            if least <= reach {
                return least;
            }
            reach *= 2.0;
        }
        f64::NAN
    };
    points.par_iter().map(distance).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "wear, 0, 1, 3\n0, 1e-3, 2e-3, 2e-3\n\n# worn\n10, 3e-3, 4e-3, 8e-3\n";

    fn wear(source: &str) -> Result<Wear, WearError> {
        let section =
            toml::from_str(&format!("table = 't.csv'\nalong = [2, 0, 0]\nfrom = [1, 0, 0]\n{source}"))
                .unwrap();
        let mesh = geom::mesh::cuboid(Vec3::new(-9.0, -9.0, -1.0), Vec3::new(9.0, 9.0, 0.0));
        Wear::new(section, &|_| Ok(TABLE.to_owned()), &|_| Ok(mesh.clone()))
    }

    #[test]
    fn roughness_is_linear_between_the_entries_and_constant_beyond() {
        let points = [1.0, 1.5, 2.0, 3.0, 4.0, 9.0, -5.0].map(|x| Vec3::new(x, 7.0, 7.0));
        let worn = vec![0.0, 0.0, 10.0, 5.0, 20.0, f64::NAN, 0.0];
        let (zeta, report) =
            wear("measured = 'w'").unwrap().roughness(&points, &|_| Some(worn.clone()), Some(0.1)).unwrap();
        for (found, wanted) in zeta.iter().zip([1e-3, 1.5e-3, 4e-3, 4e-3, 8e-3, 0.1, 1e-3]) {
            assert!((found - wanted).abs() < 1e-12, "{zeta:?}");
        }
        assert_eq!((report.not_measured, report.beyond), (1, 2));
        let none = wear("measured = 'w'").unwrap().roughness(&points, &|_| Some(worn.clone()), None);
        assert!(matches!(none, Err(WearError::NotMeasured { point: 5, .. })));
        assert!(matches!(
            wear("measured = 'w'").unwrap().roughness(&points, &|_| None, None),
            Err(WearError::NoProperty(_))
        ));
    }

    #[test]
    fn wear_is_the_distance_from_the_drawing_or_a_value() {
        let points = [Vec3::new(1.0, 0.0, 5.0), Vec3::new(1.0, 0.0, 0.0)];
        let (zeta, _) = wear("drawing = 'new.stl'").unwrap().roughness(&points, &|_| None, None).unwrap();
        assert!((zeta[0] - 2e-3).abs() < 1e-12 && (zeta[1] - 1e-3).abs() < 1e-12, "{zeta:?}");
        let (zeta, _) = wear("value = 10").unwrap().roughness(&points, &|_| None, None).unwrap();
        assert_eq!(zeta, [3e-3, 3e-3]);
    }

    #[test]
    fn wear_is_that_of_a_run_at_the_nearest_of_its_places() {
        let csv = "x [m],y [m],z [m],radius [m],sliding_work [J]\n1,0,0,0.3,0\n2,0,0,0.3,10\n2,5,0,0.3,2.5\n";
        let of = |keys: &str| {
            let section =
                toml::from_str(&format!("table = 't.csv'\nalong = [1, 0, 0]\nfrom = [1, 0, 0]\n{keys}"));
            let text = |file: &str| Ok(if file == "t.csv" { TABLE } else { csv }.to_owned());
            Wear::new(section.unwrap(), &text, &|_| Err("no drawing".to_owned()))
        };
        let wear = of("run = 'r.csv'\nmeasured = 'sliding_work'").unwrap();
        let points = [Vec3::new(1.2, 0.1, 0.3), Vec3::new(1.7, 0.0, -0.2), Vec3::new(2.0, 5.5, 0.0)];
        let (_, report) = wear.roughness(&points, &|_| None, None).unwrap();
        assert_eq!(wear.measured(&points, &|_| None), Ok(vec![0.0, 10.0, 2.5]));
        assert_eq!((report.wear, report.not_measured), ([0.0, 10.0], 0));
        // Another wall was not measured.
        let far = [Vec3::new(1.0, 90.0, 0.0)];
        assert!(matches!(
            wear.roughness(&far, &|_| None, None),
            Err(WearError::NotMeasured { point: 0, .. })
        ));
        for (keys, part) in [
            ("run = 'r.csv'", "measured = \"sliding_work\""),
            ("run = 'r.csv'\nvalue = 3", "leave drawing and value out"),
            ("run = 'r.csv'\nmeasured = 'work'", "r.csv: has no column 'work'"),
        ] {
            let told = of(keys).unwrap_err().to_string();
            assert!(told.contains(part), "{told}");
        }
    }

    #[test]
    fn wrong_tables_are_named() {
        assert!(matches!(wear(""), Err(WearError::WearSource { given: 0 })));
        assert!(matches!(wear("value = 1\nmeasured = 'w'"), Err(WearError::WearSource { given: 2 })));
        for (table, words) in [
            ("", "is empty"),
            ("wear\n", "line 1"),
            ("wear, 1, 1\n0, 1, 1", "ascending"),
            ("wear, 1, 2\n0, 1", "line 2"),
            ("wear, 1\n0, 1\n0, 2", "ascend"),
            ("wear, 1\n0, -1", "positive"),
            ("wear, 1\n", "no line"),
        ] {
            let told = WearTable::parse("t.csv", table).unwrap_err().to_string();
            assert!(told.contains(words) && told.contains("t.csv"), "{told}");
        }
    }
}
