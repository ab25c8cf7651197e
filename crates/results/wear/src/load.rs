//! The loads of parts, summed over messages.

use crate::{Part, PartWear, WallWear};
use std::collections::BTreeMap;

/// What was done to one part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PartLoad {
    /// Time integral of the normal force [N·s].
    pub normal_impulse: f64,
    /// Largest normal force of one contact [N].
    pub largest_normal: f64,
    /// Sliding work [J].
    pub work: f64,
    /// Grains that came to touch it.
    pub impacts: u64,
    /// Energy of their approach along the normal, and along the surface [J].
    pub impact_energy: [f64; 2],
}

/// What was done to all parts that were touched.
#[derive(Debug, Clone, Default)]
pub struct PartLoads {
    by_part: BTreeMap<Part, PartLoad>,
    /// Sum of the intervals [s].
    length: f64,
    /// End of the last interval [s].
    until: Option<f64>,
}

impl PartLoads {
    /// Takes in the parts of a message that are `wanted`.
    pub fn add(&mut self, wear: &WallWear, wanted: impl Fn(&PartWear) -> bool) {
        // A message without rows does not tell its length.
        let since = self.until.map_or(0.0, |until| wear.time - until);
        self.length += if wear.interval > 0.0 { wear.interval } else { since };
        self.until = Some(wear.time);
        for row in wear.rows.iter().filter(|row| wanted(row)) {
            let load = self.by_part.entry(row.part).or_default();
            load.normal_impulse += row.normal_impulse;
            load.largest_normal = load.largest_normal.max(row.largest_normal);
            load.work += row.work;
            load.impacts += row.impacts;
            (0..2).for_each(|k| load.impact_energy[k] += row.impact_energy[k]);
        }
    }

    /// The load of a part; nothing where it was never touched.
    pub fn of(&self, part: Part) -> PartLoad {
        self.by_part.get(&part).copied().unwrap_or_default()
    }

    /// The parts that were touched, with their loads.
    pub fn iter(&self) -> impl Iterator<Item = (Part, &PartLoad)> {
        self.by_part.iter().map(|(part, load)| (*part, load))
    }

    /// How many parts were touched.
    pub fn touched(&self) -> usize {
        self.by_part.len()
    }

    /// Time that the sums are of [s].
    pub fn length(&self) -> f64 {
        self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    fn row(part: Part, work: f64, largest_normal: f64) -> PartWear {
        let position = Vec3::zeros();
        PartWear {
            part,
            position,
            normal_impulse: 2.0,
            largest_normal,
            work,
            impacts: 1,
            impact_energy: [0.5, 0.25],
        }
    }

    #[test]
    fn sums_add_up_and_the_largest_stays() {
        let mut loads = PartLoads::default();
        let first = WallWear { time: 0.1, interval: 0.1, rows: vec![row((0, 3), 1.0, 9.0)] };
        let none = WallWear { time: 0.3, interval: 0.0, rows: Vec::new() };
        let last =
            WallWear { time: 0.4, interval: 0.1, rows: vec![row((0, 3), 2.0, 4.0), row((1, 0), 5.0, 1.0)] };
        for wear in [first, none, last] {
            loads.add(&wear, |row| row.part.0 == 0);
        }
        let load = loads.of((0, 3));
        assert_eq!((load.work, load.largest_normal, load.impacts), (3.0, 9.0, 2));
        assert_eq!((load.normal_impulse, load.impact_energy), (4.0, [1.0, 0.5]));
        assert_eq!((loads.of((1, 0)), loads.touched()), (PartLoad::default(), 1));
        assert!((loads.length() - 0.4).abs() < 1e-12);
    }
}
