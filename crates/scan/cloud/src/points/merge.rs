//! Several scans in one coordinate system → one cloud, with a column that says which scan a point is of.

use super::cloud::Cloud;
use stream::table::TableError;
use stream::{Table, Values};

/// The column that says which scan a point is of.
pub const SCAN: &str = "scan";

/// The points of all clouds, one cloud after the other, with the properties of all; NaN where a cloud lacks one. A column `scan` counts the clouds from 0; a cloud
/// that has such a column already keeps its scans apart, as those of an E57 file.
///
/// # Errors
/// More columns than a table can have.
pub fn merge(clouds: Vec<Cloud>) -> Result<Cloud, TableError> {
    let rows = clouds.iter().map(|cloud| cloud.points.len()).sum();
    let mut names: Vec<&str> = Vec::new();
    for column in clouds.iter().flat_map(|cloud| cloud.attributes.columns()) {
        if column.name != SCAN && !names.contains(&column.name.as_str()) {
            names.push(&column.name);
        }
    }
    let mut attributes = Table::with_rows(rows);
    for name in names {
        let parts: Vec<Option<&Values>> = clouds.iter().map(|cloud| cloud.attributes.get(name)).collect();
        let lengths = clouds.iter().map(|cloud| cloud.points.len());
        attributes.push(name, joined(&parts, lengths))?;
    }
    attributes.push(SCAN, Values::U32(scans(&clouds)))?;
    let mut all = Cloud { attributes, double: clouds.iter().any(|cloud| cloud.double), ..Cloud::default() };
    all.position_column = clouds.first().map_or(0, |cloud| cloud.position_column);
    for cloud in clouds {
        all.points.extend(cloud.points);
        for comment in cloud.comments {
            if !all.comments.contains(&comment) {
                all.comments.push(comment);
            }
        }
        all.warnings.extend(cloud.warnings);
    }
    Ok(all)
}

/// The scan of each point.
fn scans(clouds: &[Cloud]) -> Vec<u32> {
    let mut first = 0u32;
    let mut scans = Vec::new();
    for cloud in clouds {
        let own: Vec<u32> = match cloud.attributes.get(SCAN) {
            Some(values) => values.iter().map(|scan| scan.clamp(0.0, f64::from(u16::MAX)) as u32).collect(),
            None => vec![0; cloud.points.len()],
        };
        let last = own.iter().max().copied().unwrap_or(0);
        scans.extend(own.into_iter().map(|scan| first.saturating_add(scan)));
        first = first.saturating_add(last + 1);
    }
    scans
}

/// Columns one after the other: in their type if all have one, else as 8-byte numbers.
fn joined(parts: &[Option<&Values>], lengths: impl Iterator<Item = usize>) -> Values {
    macro_rules! in_type {
        ($($t:ident),*) => {$(
            let of_type = |part: &Option<&Values>| matches!(part, Some(Values::$t(_)));
            if parts.iter().all(of_type) {
                let mut all = Vec::new();
                for part in parts {
                    if let Some(Values::$t(values)) = part { all.extend_from_slice(values); }
                }
                return Values::$t(all);
            }
        )*};
    }
    in_type!(U8, I8, U16, I16, U32, I32, F32, F64);
    let mut all = Vec::new();
    for (part, length) in parts.iter().zip(lengths) {
        match part {
            Some(values) => all.extend(values.iter()),
            None => all.resize(all.len() + length, f64::NAN),
        }
    }
    Values::F64(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    fn cloud(points: usize, columns: &[(&str, Values)]) -> Cloud {
        let mut attributes = Table::with_rows(points);
        columns.iter().for_each(|(name, values)| attributes.push(name, values.clone()).unwrap());
        Cloud { points: vec![Vec3::repeat(points as f64); points], attributes, ..Cloud::default() }
    }

    #[test]
    fn properties_of_all_scans_stand_side_by_side() {
        let first = cloud(2, &[("tone", Values::U8(vec![1, 2])), ("age", Values::F32(vec![0.5, 0.25]))]);
        let mut second = cloud(3, &[("tone", Values::U8(vec![3, 4, 5])), (SCAN, Values::U32(vec![0, 0, 4]))]);
        second.double = true;
        second.add_viewpoint(&Vec3::new(1.0, 2.0, 3.0));
        let third = cloud(1, &[("tone", Values::U8(vec![6])), ("age", Values::F64(vec![7.0]))]);
        let all = merge(vec![first, second, third]).unwrap();
        assert_eq!(all.points.iter().map(|p| p.x).collect::<Vec<_>>(), [2.0, 2.0, 3.0, 3.0, 3.0, 1.0]);
        assert_eq!(all.attributes.get("tone"), Some(&Values::U8(vec![1, 2, 3, 4, 5, 6])));
        assert_eq!(all.attributes.get(SCAN), Some(&Values::U32(vec![0, 0, 1, 1, 5, 6])));
        let age = all.attributes.get("age").unwrap().to_f64();
        assert!(age[1] == 0.25 && age[2..5].iter().all(|v| v.is_nan()) && age[5] == 7.0, "{age:?}");
        assert!(all.double && all.viewpoints().count() == 1);
        assert!(merge(Vec::new()).unwrap().points.is_empty());
    }
}
