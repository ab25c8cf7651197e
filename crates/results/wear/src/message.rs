//! A message of `/wall_wear`: what grains did to parts of walls since the frame before.

use crate::Part;
use geom::Vec3;
use record::column::{
    IMPACT_ENERGY, IMPACTS, INTERVAL, LARGEST_NORMAL, NORMAL_IMPULSE, PART, POSITION, WALL, WORK,
};
use record::topic::WALL_WEAR;
use record::{Columns, RecordError};
use stream::Table;

/// Largest index of a wall or part: tables hold whole numbers of 32 bits.
const MOST: f64 = u32::MAX as f64;

/// What grains did to a sphere or a triangle of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartWear {
    /// Which one.
    pub part: Part,
    /// Where it is at the end of the interval [m].
    pub position: Vec3,
    /// Time integral of the normal force [N·s].
    pub normal_impulse: f64,
    /// Largest normal force of a contact [N].
    pub largest_normal: f64,
    /// Sliding work [J].
    pub work: f64,
    /// Grains that came to touch the wall there.
    pub impacts: u64,
    /// Energy of their approach along the normal, and along the surface [J].
    pub impact_energy: [f64; 2],
}

/// All parts that were touched in an interval.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WallWear {
    /// Its end [s].
    pub time: f64,
    /// Its length [s]; 0 where no part was touched.
    pub interval: f64,
    /// By wall and part.
    pub rows: Vec<PartWear>,
}

impl WallWear {
    /// From the table of a message at a time [s].
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite, indices that are not whole.
    pub fn new(time: f64, table: &Table) -> Result<WallWear, RecordError> {
        let columns = Columns { name: WALL_WEAR, table };
        let (wall, part) = (columns.needed(WALL, MOST)?, columns.needed(PART, MOST)?);
        let impacts = columns.needed(IMPACTS, MOST)?;
        let (position, interval) = (columns.vectors(POSITION)?, columns.numbers(INTERVAL)?);
        let number = |name| columns.numbers(name);
        let (normal, largest, work) = (number(NORMAL_IMPULSE)?, number(LARGEST_NORMAL)?, number(WORK)?);
        let (head_on, along) = (number(IMPACT_ENERGY[0])?, number(IMPACT_ENERGY[1])?);
        let row = |k: usize| PartWear {
            part: (u64::from(wall[k]), u64::from(part[k])),
            position: position[k],
            normal_impulse: normal[k],
            largest_normal: largest[k],
            work: work[k],
            impacts: u64::from(impacts[k]),
            impact_energy: [head_on[k], along[k]],
        };
        let rows = (0..wall.len()).map(row).collect();
        Ok(WallWear { time, interval: interval.first().copied().unwrap_or(0.0), rows })
    }
}
