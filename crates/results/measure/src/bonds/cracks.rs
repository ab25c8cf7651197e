//! Cracks: bonds that broke, where and when each did.

use super::Break;
use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::Observer;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{MeasureError, Run, RunMessage};

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

impl Measure for CrackList {
    const NAME: &'static str = "cracks";
    const HELP: &'static str = "Each bond that broke: when, where, by what, with what energy";
    const FRAMES: Frames = Frames::Events;

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(CrackList::new(asked.between)))
    }
}
