//! Cracks: bonds that broke, where and when each did.

use super::{Break, break_of};
use crate::observer::Observer;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::table::Columns;
use crate::{MeasureError, Run, RunMessage};
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

/// Lists cracks.
pub struct CrackList {
    between: (f64, f64),
    has_bonds: bool,
    count: [usize; 3],
    energy: f64,
    span: Option<(f64, f64)>,
}

impl CrackList {
    /// Of those between two times [s].
    pub fn new(between: (f64, f64)) -> CrackList {
        CrackList { between, has_bonds: false, count: [0; 3], energy: 0.0, span: None }
    }
}

impl Observer for CrackList {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("nx", "1"),
            ("ny", "1"),
            ("nz", "1"),
            ("radius", "m"),
            ("mode", "1"),
            ("energy", "J"),
            ("id_i", "1"),
            ("id_j", "1"),
            ("cluster_i", "1"),
            ("cluster_j", "1"),
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Cracks(cracks) = message else {
            self.has_bonds |= matches!(message, RunMessage::Bonds(_));
            return Ok(());
        };
        for c in cracks.iter().filter(|c| run.is_between(self.between, c.time)) {
            self.count[c.by as usize] += 1;
            self.energy += c.energy;
            self.span = Some((self.span.map_or(c.time, |s| s.0), c.time));
            let mode = match c.by {
                Break::Tension => 1.0,
                Break::Shear => 2.0,
                Break::Unknown => f64::NAN,
            };
            let ([x, y, z], [nx, ny, nz]): ([f64; 3], [f64; 3]) = (c.place.into(), c.normal.into());
            let [i, j, a, b] = [c.grains[0], c.grains[1], c.clusters[0], c.clusters[1]].map(|n| n as f64);
            rows.push(vec![c.time, x, y, z, nx, ny, nz, c.radius, mode, c.energy, i, j, a, b]);
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let all: usize = self.count.iter().sum();
        if all == 0 && !self.has_bonds {
            return Err(super::NO_BONDS);
        }
        let (first, last) = self.span.unwrap_or((f64::NAN, f64::NAN));
        Ok(Summary::default()
            .with("cracks", "1", all as f64)
            .with("by_tension", "1", self.count[0] as f64)
            .with("by_shear", "1", self.count[1] as f64)
            .with("energy", "J", self.energy)
            .with("first", "s", first)
            .with("last", "s", last))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let of = |name: &str, mode: f64| {
            let times = rows.iter().filter(|row| row[8] == mode).map(|row| row[0]);
            let points = times.zip(1..).map(|(time, n)| [time, f64::from(n)]).collect();
            Curve { name: name.to_owned(), points, look: Look::Steps }
        };
        let curves = vec![of("by tension", 1.0), of("by shear", 2.0)];
        Chart::new("Cracks").curves("time [s]", "cracks [1]", curves)
    }
}
