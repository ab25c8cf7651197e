//! Rigid clumps: which spheres of a table are one body, and how many of both there are.

use record::column::{BODY, ID};
use std::fmt;
use stream::{Table, Values};

/// The rows of each clump in the order of their ids; a grain of one sphere is none.
pub(crate) fn bodies(table: &Table) -> Vec<Vec<u32>> {
    let Some(body) = table.get(BODY).map(Values::to_f64) else { return Vec::new() };
    let id = table.get(ID).map_or_else(|| vec![0.0; body.len()], Values::to_f64);
    let mut rows: Vec<u32> = (0..body.len() as u32).collect();
    let order = |a: &u32, b: &u32| {
        let [a, b] = [*a as usize, *b as usize];
        body[a].total_cmp(&body[b]).then(id[a].total_cmp(&id[b])).then(a.cmp(&b))
    };
    rows.sort_unstable_by(order);
    let groups = rows.chunk_by(|a, b| body[*a as usize] == body[*b as usize]);
    groups.filter(|rows| rows.len() > 1).map(<[u32]>::to_vec).collect()
}

/// Gives all members of a clump the mean of their values, so that the clump has one colour.
pub(crate) fn even_out(values: &mut [f64], bodies: &[Vec<u32>]) {
    for rows in bodies {
        let mean = rows.iter().map(|&row| values[row as usize]).sum::<f64>() / rows.len() as f64;
        rows.iter().for_each(|&row| values[row as usize] = mean);
    }
}

/// How many grains there are: spheres alone, and clumps of spheres.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GrainCount {
    /// Spheres that are grains of their own.
    pub spheres: usize,
    /// Rigid clumps.
    pub clumps: usize,
    /// Spheres of all clumps.
    pub members: usize,
}

impl GrainCount {
    /// Counts the grains of a table.
    pub fn of(table: &Table) -> GrainCount {
        GrainCount::with(table.rows(), &bodies(table))
    }

    /// Counts from the number of spheres and the spheres of each clump in `bodies`.
    pub(crate) fn with(spheres: usize, bodies: &[Vec<u32>]) -> GrainCount {
        let members = bodies.iter().map(Vec::len).sum();
        GrainCount { spheres: spheres - members, clumps: bodies.len(), members }
    }

    /// Bodies: a clump counts as one.
    pub fn grains(&self) -> usize {
        self.spheres + self.clumps
    }

    /// The sum of both counts.
    #[must_use]
    pub fn plus(self, other: GrainCount) -> GrainCount {
        GrainCount {
            spheres: self.spheres + other.spheres,
            clumps: self.clumps + other.clumps,
            members: self.members + other.members,
        }
    }

    /// The larger of each number.
    pub(crate) fn most(self, other: GrainCount) -> GrainCount {
        GrainCount {
            spheres: self.spheres.max(other.spheres),
            clumps: self.clumps.max(other.clumps),
            members: self.members.max(other.members),
        }
    }
}

/// "50 000 grains", or with clumps "120 clumps of 840 spheres, 30 spheres"; nothing without any.
impl fmt::Display for GrainCount {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            GrainCount { spheres: 0, clumps: 0, .. } => Ok(()),
            GrainCount { spheres, clumps: 0, .. } => f.write_str(&counted(*spheres, "grains")),
            GrainCount { spheres, clumps, members } => {
                write!(f, "{} of {}", counted(*clumps, "clumps"), counted(*members, "spheres"))?;
                if *spheres == 0 { Ok(()) } else { write!(f, ", {}", counted(*spheres, "spheres")) }
            }
        }
    }
}

/// A number and what it counts, a word that ends in s.
pub(crate) fn counted(count: usize, word: &str) -> String {
    let word = if count == 1 { word.trim_end_matches('s') } else { word };
    format!("{} {word}", grouped(count))
}

/// Digits in groups of three.
pub(crate) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let groups: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
    groups.iter().map(|g| String::from_utf8_lossy(g)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_one_body_are_a_clump_and_one_row_is_not() {
        let mut table = Table::default();
        table.push(ID, Values::U32(vec![5, 0, 3, 2, 1])).expect("fits");
        table.push(BODY, Values::U32(vec![5, 0, 2, 2, 0])).expect("fits");
        assert_eq!(bodies(&table), [vec![1, 4], vec![3, 2]]);
        assert_eq!(GrainCount::of(&table), GrainCount { spheres: 1, clumps: 2, members: 4 });
        assert_eq!(GrainCount::of(&Table::with_rows(7)), GrainCount { spheres: 7, clumps: 0, members: 0 });
    }

    #[test]
    fn digits_stand_in_groups_of_three() {
        assert_eq!([grouped(50_000), grouped(999), grouped(1_234_567)], ["50 000", "999", "1 234 567"]);
    }

    #[test]
    fn clumps_are_counted_as_bodies_and_grains_as_before() {
        let words = |spheres, clumps, members| GrainCount { spheres, clumps, members }.to_string();
        assert_eq!(words(50_000, 0, 0), "50 000 grains");
        assert_eq!([words(1, 0, 0), words(0, 0, 0)], ["1 grain", ""]);
        assert_eq!(words(30, 120, 1840), "120 clumps of 1 840 spheres, 30 spheres");
        assert_eq!(
            [words(0, 1, 7), words(1, 2, 4)],
            ["1 clump of 7 spheres", "2 clumps of 4 spheres, 1 sphere"]
        );
    }
}
