//! What grains did to the spheres and triangles of walls since the frame before (topic `/wall_wear`).

use super::table::Columns;
use crate::MeasureError;
use geom::Vec3;
use record::column::{
    IMPACT_ENERGY, IMPACTS, INTERVAL, LARGEST_NORMAL, NORMAL_IMPULSE, PART, POSITION, WALL, WORK,
};
use record::topic::WALL_WEAR;
use stream::Table;

/// What grains did to a sphere or a triangle of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartWear {
    /// Index of the wall, and number of the part in it.
    pub part: (u64, u64),
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
    /// From the table of a message.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite.
    pub fn new(time: f64, table: &Table) -> Result<WallWear, MeasureError> {
        let columns = Columns { topic: WALL_WEAR, time, table };
        let (wall, part) = (columns.whole(WALL)?, columns.whole(PART)?);
        let (position, interval) = (columns.vectors(POSITION)?, columns.numbers(INTERVAL)?);
        let [normal, largest, work, head_on, along] =
            [NORMAL_IMPULSE, LARGEST_NORMAL, WORK, IMPACT_ENERGY[0], IMPACT_ENERGY[1]]
                .map(|name| columns.numbers(name));
        let (normal, largest, work, head_on, along) = (normal?, largest?, work?, head_on?, along?);
        let impacts = columns.whole(IMPACTS)?;
        let row = |k: usize| PartWear {
            part: (wall[k], part[k]),
            position: position[k],
            normal_impulse: normal[k],
            largest_normal: largest[k],
            work: work[k],
            impacts: impacts[k],
            impact_energy: [head_on[k], along[k]],
        };
        let rows = (0..wall.len()).map(row).collect();
        Ok(WallWear { time, interval: interval.first().copied().unwrap_or(0.0), rows })
    }
}
