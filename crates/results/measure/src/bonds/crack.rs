//! Bonds that broke, as a message of `/cracks` lists them.

use super::{Break, break_of};
use crate::MeasureError;
use crate::reading::table::Columns;
use geom::Vec3;
use record::column::{CLUSTERS, ENERGY, FIRST, MODE, NORMAL, POSITION, RADIUS, SECOND, TIME};
use record::topic::CRACKS;
use stream::Table;

/// A bond that broke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crack {
    /// When [s].
    pub time: f64,
    /// Where [m].
    pub place: Vec3,
    /// Along the bond [–].
    pub normal: Vec3,
    /// Radius of the bond [m].
    pub radius: f64,
    /// What broke it.
    pub by: Break,
    /// Elastic energy that it held [J].
    pub energy: f64,
    /// Ids of both grains.
    pub grains: [u64; 2],
    /// Their clusters; 0: none.
    pub clusters: [u64; 2],
}

impl Crack {
    /// Cracks from the table of a message.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite.
    pub fn list(time: f64, table: &Table) -> Result<Vec<Crack>, MeasureError> {
        let columns = Columns { topic: CRACKS, time, table };
        let (place, normal) = (columns.vectors(POSITION)?, columns.vectors(NORMAL)?);
        let (radius, energy, at) =
            (columns.numbers(RADIUS)?, columns.numbers(ENERGY)?, columns.numbers(TIME)?);
        let (mode, i, j) = (columns.whole(MODE)?, columns.whole(FIRST)?, columns.whole(SECOND)?);
        let clusters = [columns.whole(CLUSTERS[0])?, columns.whole(CLUSTERS[1])?];
        let row = |k: usize| Crack {
            time: at[k],
            place: place[k],
            normal: normal[k],
            radius: radius[k],
            by: break_of(mode[k]),
            energy: energy[k],
            grains: [i[k], j[k]],
            clusters: [clusters[0][k], clusters[1][k]],
        };
        Ok((0..at.len()).map(row).collect())
    }
}
