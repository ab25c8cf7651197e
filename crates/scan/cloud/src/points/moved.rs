//! A cloud in other coordinates: what of it turns, and what the comments then say.

use super::cloud::Cloud;
use geom::{Transform, Vec3};
use std::collections::HashSet;
use stream::{Table, Values};

/// How a comment begins that says that coordinates were moved; 16 numbers follow, row by row.
const MOVED: &str = "coordinates were transformed by";
/// What becomes of the comments that hold for the coordinates before.
const BEFORE: &str = "before they were transformed:";
/// Properties that are directions, without the letter or number of their axis and what stands around it, in small letters: normals, velocities, spins, forces.
const DIRECTIONS: [&str; 11] =
    ["n", "normal", "normals", "v", "velocities", "velocity", "w", "omega", "f", "force", "direction"];

/// What the axes are called.
const AXES: [[char; 3]; 3] = [['x', 'y', 'z'], ['X', 'Y', 'Z'], ['0', '1', '2']];

/// Three columns whose names differ only in the letter of their axis, or in its number.
struct Triple {
    columns: [usize; 3],
    /// The name of the first one, and what is left of it without its axis.
    name: String,
    kind: String,
}

impl Cloud {
    /// Moves positions and viewpoints, and turns the columns of directions. Coordinates are 8-byte numbers from then on, and a comment says so.
    ///
    /// Gives the names of the columns that look like directions and are not known: they stay as they are.
    pub fn transform(&mut self, by: &Transform) -> Vec<String> {
        self.points.iter_mut().for_each(|p| *p = by.point(p));
        self.double = true;
        let eyes: Vec<Vec3> = self.viewpoints().map(|eye| by.point(&eye)).collect();
        self.comments.retain(|line| !crate::points::is_viewpoint(line));
        for line in self.comments.iter_mut().filter(|line| line.starts_with(crate::points::SYSTEM)) {
            *line = format!("{BEFORE} {line}");
        }
        eyes.iter().for_each(|eye| self.add_viewpoint(eye));
        self.comments.push(format!("{MOVED} {}", by.rows().map(|v| v.to_string()).join(" ")));
        turn(&mut self.attributes, by)
    }
}

/// Turns what is known to be directions; gives the names of what may be.
fn turn(table: &mut Table, by: &Transform) -> Vec<String> {
    let (known, unknown): (Vec<Triple>, Vec<Triple>) =
        triples(table).into_iter().partition(|triple| DIRECTIONS.contains(&triple.kind.as_str()));
    for triple in known {
        let columns = triple.columns.map(|k| &table.columns()[k]);
        let names = columns.map(|column| column.name.clone());
        let short = columns.iter().all(|column| matches!(column.values, Values::F32(_)));
        let mut turned = [const { Vec::<f64>::new() }; 3];
        for row in 0..table.rows() {
            let along = by.direction(&Vec3::from(columns.map(|column| column.values.get(row))));
            (0..3).for_each(|k| turned[k].push(along[k]));
        }
        for (name, values) in names.iter().zip(turned) {
            let values = match short {
                true => Values::F32(values.iter().map(|v| *v as f32).collect()),
                false => Values::F64(values),
            };
            // As many values as before: there is nothing to refuse.
            let _ = table.replace(name, values);
        }
    }
    unknown.into_iter().map(|triple| triple.name).collect()
}

/// Columns `…x…`, `…y…`, `…z…`, or with `0`, `1`, `2` and no `3`, in the order of the first ones.
fn triples(table: &Table) -> Vec<Triple> {
    let names: Vec<&str> = table.columns().iter().map(|column| column.name.as_str()).collect();
    let find = |name: &str| names.iter().position(|other| *other == name);
    let mut used = HashSet::new();
    let mut found = Vec::new();
    for (first, name) in names.iter().enumerate() {
        for (at, letter) in name.char_indices() {
            let Some([_, y, z]) = AXES.iter().find(|axes| axes[0] == letter) else { continue };
            let (before, behind) = (&name[..at], &name[at + 1..]);
            let other = |axis: char| find(&format!("{before}{axis}{behind}"));
            let (Some(second), Some(third)) = (other(*y), other(*z)) else { continue };
            // "t10", and the first three numbers of a longer list.
            let is_digit = |c: char| c.is_ascii_digit();
            let is_part = before.ends_with(is_digit) || behind.starts_with(is_digit) || other('3').is_some();
            if letter == '0' && is_part {
                continue;
            }
            if used.insert(first) {
                let rest = [before, behind].concat().replace(['_', ' ', ':', '[', ']', '(', ')', '.'], "");
                found.push(Triple {
                    columns: [first, second, third],
                    name: (*name).to_owned(),
                    kind: rest.to_ascii_lowercase(),
                });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x̂ ↦ ŷ ↦ ẑ ↦ x̂, then (1, 2, 3).
    fn around() -> Transform {
        Transform::parse("0 0 1 1 1 0 0 2 0 1 0 3 0 0 0 1").unwrap()
    }

    fn cloud(columns: &[(&str, Values)]) -> Cloud {
        let points = vec![Vec3::new(10.0, 20.0, 30.0), Vec3::new(f64::NAN, 0.0, 0.0)];
        let mut attributes = Table::with_rows(points.len());
        columns.iter().for_each(|(name, values)| attributes.push(name, values.clone()).unwrap());
        Cloud { points, attributes, ..Cloud::default() }
    }

    #[test]
    fn positions_viewpoints_and_directions_turn_and_the_rest_stays() {
        let mut columns = Vec::new();
        for name in ["nx", "ny", "nz", "Normal_X", "Normal_Y", "Normal_Z"] {
            let value = ["x", "y", "z"].iter().position(|c| name.to_lowercase().ends_with(c)).unwrap() as f32;
            columns.push((name, Values::F32(vec![value; 2])));
        }
        columns.push(("vx", Values::I8(vec![7, 7])));
        columns.push(("vy", Values::F64(vec![0.1; 2])));
        columns.push(("vz", Values::F64(vec![0.2; 2])));
        columns.push(("intensity", Values::U16(vec![9; 2])));
        let mut moved = cloud(&columns);
        moved.add_viewpoint(&Vec3::new(0.0, 0.0, 1.8));
        moved.comments.push("coordinate reference system EPSG:2994".to_owned());
        assert_eq!(moved.transform(&around()), [""; 0]);
        assert_eq!(moved.points[0], Vec3::new(31.0, 12.0, 23.0));
        assert!(moved.points[1].iter().any(|c| c.is_nan()) && moved.double);
        assert_eq!(moved.viewpoints().collect::<Vec<_>>(), [Vec3::new(2.8, 2.0, 3.0)]);
        let column = |name: &str| moved.attributes.get(name).unwrap();
        for [x, y, z] in [["nx", "ny", "nz"], ["Normal_X", "Normal_Y", "Normal_Z"]] {
            assert_eq!(column(x), &Values::F32(vec![2.0; 2]), "{x}");
            assert_eq!(column(y), &Values::F32(vec![0.0; 2]));
            assert_eq!(column(z), &Values::F32(vec![1.0; 2]));
        }
        assert_eq!(column("vx"), &Values::F64(vec![0.2; 2]));
        assert_eq!(column("vy"), &Values::F64(vec![7.0; 2]));
        assert_eq!(column("intensity"), &Values::U16(vec![9; 2]));
        let names: Vec<&str> = moved.attributes.columns().iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, columns.iter().map(|(name, _)| *name).collect::<Vec<_>>(), "their order stays");
        assert!(
            moved
                .comments
                .contains(&"before they were transformed: coordinate reference system EPSG:2994".to_owned())
        );
        assert_eq!(
            moved.comments.last().unwrap(),
            "coordinates were transformed by 0 0 1 1 1 0 0 2 0 1 0 3 0 0 0 1"
        );
    }

    #[test]
    fn columns_that_may_be_directions_are_named_and_stay() {
        let values = Values::F32(vec![1.0; 2]);
        let names = ["beam x", "beam y", "beam z", "exact", "eyact", "max", "nx", "ny"];
        let mut moved = cloud(&names.map(|name| (name, values.clone())));
        assert_eq!(moved.transform(&around()), ["beam x"]);
        assert!(moved.attributes.columns().iter().all(|column| column.values == values));
    }
}
