//! From the columns of a table to fields of VTK: vectors in one, all else as it is.

use super::polydata::Field;
use stream::{Table, Values};

/// Columns that belong together, and what ParaView calls them.
const TOGETHER: [([&str; 3], &str); 5] = [
    (["vx", "vy", "vz"], "velocity"),
    (["wx", "wy", "wz"], "angular_velocity"),
    (["fx", "fy", "fz"], "force"),
    (["nx", "ny", "nz"], "normal"),
    (["red", "green", "blue"], "rgb"),
];

/// The fields of a table; the places are none.
pub fn of(table: &Table) -> Vec<Field> {
    let mut fields = Vec::new();
    for column in table.columns() {
        let name = column.name.as_str();
        let group = TOGETHER.iter().find(|(of, _)| of.contains(&name));
        let joined = group.and_then(|(of, joined)| Some((of[0], *joined, interleaved(table, of)?)));
        match joined {
            _ if ["x", "y", "z"].contains(&name) => {}
            Some((first, joined, values)) if first == name => {
                fields.push(Field { name: joined.to_owned(), components: 3, values });
            }
            Some(_) => {}
            None => {
                fields.push(Field { name: name.to_owned(), components: 1, values: column.values.clone() })
            }
        }
    }
    fields
}

/// Three columns of one type, row by row.
fn interleaved(table: &Table, names: &[&str; 3]) -> Option<Values> {
    let [a, b, c] = [table.get(names[0])?, table.get(names[1])?, table.get(names[2])?];
    macro_rules! join {
        ($($t:ident),*) => {
            match (a, b, c) {
                $((Values::$t(a), Values::$t(b), Values::$t(c)) => {
                    Some(Values::$t((0..a.len()).flat_map(|i| [a[i], b[i], c[i]]).collect()))
                })*
                _ => None,
            }
        };
    }
    join!(I8, U8, I16, U16, I32, U32, F32, F64)
}

/// Appends `more` points with their fields behind `rows` points: what one side lacks is NaN, or 0 for whole numbers.
pub fn append(fields: &mut Vec<Field>, rows: usize, more: Vec<Field>, count: usize) {
    for field in &mut *fields {
        if !more.iter().any(|m| m.name == field.name && m.components == field.components) {
            let missing = blank(&field.values, count * field.components);
            extend(&mut field.values, missing);
        }
    }
    for new in more {
        match fields.iter_mut().find(|f| f.name == new.name && f.components == new.components) {
            Some(field) => extend(&mut field.values, new.values),
            None => {
                let mut values = blank(&new.values, rows * new.components);
                extend(&mut values, new.values);
                fields.push(Field { values, ..new });
            }
        }
    }
}

/// Values that stand where there are none.
fn blank(like: &Values, count: usize) -> Values {
    let empty = like.zeros_like(count);
    match empty {
        Values::F32(v) => Values::F32(vec![f32::NAN; v.len()]),
        Values::F64(v) => Values::F64(vec![f64::NAN; v.len()]),
        whole => whole,
    }
}

/// Joins two columns; as double precision when their types differ.
fn extend(values: &mut Values, more: Values) {
    macro_rules! same {
        ($($t:ident),*) => {
            match (&mut *values, &more) {
                $((Values::$t(a), Values::$t(b)) => { a.extend(b); return; })*
                _ => {}
            }
        };
    }
    same!(I8, U8, I16, U16, I32, U32, F32, F64);
    *values = Values::F64([values.to_f64(), more.to_f64()].concat());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(name: &str, values: Values) -> Vec<Field> {
        vec![Field { name: name.into(), components: 1, values }]
    }

    #[test]
    fn a_velocity_is_one_field_and_a_lone_component_stays_itself() {
        let mut table = Table::with_rows(2);
        for name in ["x", "y", "z", "vx", "vy", "vz", "wx"] {
            let start = f32::from(name.as_bytes()[name.len() - 1]);
            table.push(name, Values::F32(vec![start, start + 0.5])).expect("fits");
        }
        let fields = of(&table);
        let names: Vec<_> = fields.iter().map(|f| (f.name.as_str(), f.components)).collect();
        assert_eq!(names, [("velocity", 3), ("wx", 1)]);
        assert_eq!(fields[0].values, Values::F32(vec![120.0, 121.0, 122.0, 120.5, 121.5, 122.5]));
    }

    #[test]
    fn what_one_side_lacks_is_not_a_number_or_zero() {
        let mut fields = one("id", Values::U32(vec![7, 8]));
        append(&mut fields, 2, one("load", Values::F32(vec![0.5])), 1);
        assert_eq!(fields[0].values, Values::U32(vec![7, 8, 0]));
        let Values::F32(load) = &fields[1].values else { panic!("{:?}", fields[1]) };
        assert!(load[0].is_nan() && load[1].is_nan() && load[2] == 0.5);
        append(&mut fields, 3, one("id", Values::U16(vec![9])), 1);
        assert_eq!(fields[0].values, Values::F64(vec![7.0, 8.0, 0.0, 9.0]));
        assert!(fields.iter().all(|f| f.values.len() == 4));
    }
}
