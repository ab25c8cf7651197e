//! The load of the spheres and triangles of walls, from sums over every step (topic `/wall_wear`).

use crate::sheet::Row;
use crate::{PartWear, Run, WallWear};
use geom::Vec3;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// What was done to one part.
#[derive(Debug, Clone, Copy, Default)]
struct PartLoad {
    normal_impulse: f64,
    largest: f64,
    work: f64,
    impacts: u64,
    impact_energy: f64,
}

/// What was done to all parts, by wall and number.
#[derive(Debug, Default)]
pub(super) struct PartLoads {
    by_part: BTreeMap<(u64, u64), PartLoad>,
    /// Sum of the intervals [s], and the end of the last [s].
    length: f64,
    until: Option<f64>,
}

impl PartLoads {
    /// Takes the parts of a message that are `wanted`.
    pub fn add(&mut self, wear: &WallWear, wanted: impl Fn(&PartWear) -> bool) {
        let since = self.until.map_or(0.0, |until| wear.time - until);
        self.length += if wear.interval > 0.0 { wear.interval } else { since };
        self.until = Some(wear.time);
        for row in wear.rows.iter().filter(|row| wanted(row)) {
            let load = self.by_part.entry(row.part).or_default();
            load.normal_impulse += row.normal_impulse;
            load.largest = load.largest.max(row.largest_normal);
            load.work += row.work;
            load.impacts += row.impacts;
            load.impact_energy += row.impact_energy[0] + row.impact_energy[1];
        }
    }

    /// Rows of the wall spheres, which are at `home` with their radii [m], and of the triangles of the walls that are `wanted`.
    pub fn rows(&self, run: &Run, home: &[(Vec3, f64)], wanted: impl Fn(u64) -> bool) -> Vec<Row> {
        let mut rows = Vec::new();
        let (mut of_wall, mut number) = (u64::MAX, 0);
        for ((position, radius), &wall) in home.iter().zip(&run.spheres.wall) {
            number = if wall == of_wall { number + 1 } else { 0 };
            of_wall = wall;
            // What a sphere stands for of a wall is not known here.
            rows.push(self.row((wall, number), *position, *radius, f64::NAN));
        }
        for wall in (0..run.meshes.len() as u64).filter(|wall| wanted(*wall)) {
            for ((position, radius), part) in run.triangles_of_file(wall as usize).into_iter().zip(0..) {
                rows.push(self.row((wall, part), position, radius, PI * radius * radius));
            }
        }
        rows
    }

    fn row(&self, part: (u64, u64), position: Vec3, radius: f64, area: f64) -> Row {
        let load = self.by_part.get(&part).copied().unwrap_or_default();
        let mean = if self.length > 0.0 { load.normal_impulse / self.length } else { 0.0 };
        // How many contacts frames show is not known here.
        let contacts = f64::NAN;
        let (largest, work, impacts) = (load.largest, load.work, load.impacts as f64);
        let of_area = [work / area, mean / area];
        let place = [position.x, position.y, position.z, radius, contacts, mean, largest, work];
        [&place[..], &of_area, &[impacts, load.impact_energy]].concat()
    }
}
