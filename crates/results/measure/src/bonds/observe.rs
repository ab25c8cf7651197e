//! The bonds of a run over time.

use super::{Bonds, Fragments, NO_BONDS};
use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::Observer;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{MeasureError, Run, RunMessage};
use geom::counted;

/// Counts bonds.
pub struct BondNumbers {
    /// Ids of the grains of the last frame, and its time [s].
    grains: (f64, Vec<u64>),
    /// Time of the frame before [s].
    before: Option<f64>,
    /// Bonds of the frame before, and how many went since with their grains.
    bonds: u64,
    gone: u64,
    first_break: f64,
    last: Option<Row>,
}

impl Default for BondNumbers {
    fn default() -> BondNumbers {
        BondNumbers {
            grains: (f64::NAN, Vec::new()),
            before: None,
            bonds: 0,
            gone: 0,
            first_break: f64::NAN,
            last: None,
        }
    }
}

impl BondNumbers {
    fn row(&mut self, bonds: &Bonds) -> Row {
        let (mut by, mut since, mut largest) = ([0u64; 3], 0u64, [0.0f64; 2]);
        for bond in &bonds.rows {
            let Some(at) = bond.broken else {
                largest = [0, 1].map(|k| largest[k].max(bond.stress[k]));
                continue;
            };
            by[bond.by as usize] += 1;
            since += u64::from(self.before.is_none_or(|before| at > before));
            self.first_break = self.first_break.min(at);
        }
        let all = bonds.rows.len() as u64;
        self.gone += self.bonds.saturating_sub(all);
        (self.bonds, self.before) = (all, Some(bonds.time));
        let broken: u64 = by.iter().sum();
        // Frames come before the bonds of their time.
        let grains = Some(&self.grains).filter(|grains| grains.0 == bonds.time).map(|grains| &grains.1[..]);
        let fragments = Fragments::of(grains.unwrap_or_default(), &bonds.rows);
        let counts =
            [all, all - broken, broken, by[0], by[1], by[2], since, fragments.count, fragments.largest];
        let mut row = vec![bonds.time];
        row.extend(counts.map(|n| n as f64));
        row.extend(largest);
        row
    }
}

impl Observer for BondNumbers {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("bonds", "1"),
            ("whole", "1"),
            ("broken", "1"),
            ("broken_by_tension", "1"),
            ("broken_by_shear", "1"),
            ("broken_unknown", "1"),
            ("broken_since", "1"),
            ("fragments", "1"),
            ("largest_fragment", "1"),
            ("largest_tension", "Pa"),
            ("largest_shear", "Pa"),
        ])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        match message {
            RunMessage::Frame(frame) => self.grains = (frame.time, frame.id),
            RunMessage::Bonds(bonds) => {
                let row = self.row(&bonds);
                self.last = Some(row.clone());
                rows.push(row);
            }
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let last = self.last.as_ref().ok_or(NO_BONDS)?;
        let summary = Summary::default()
            .with("bonds", "1", last[1])
            .with("broken", "1", last[3])
            .with("broken_by_tension", "1", last[4])
            .with("broken_by_shear", "1", last[5])
            .with("fragments", "1", last[8])
            .with("largest_fragment", "1", last[9])
            .with("first_break", "s", self.first_break)
            .with("time", "s", last[0]);
        let unknown =
            format!("how {} broke is unknown: the run does not say it", counted(last[6] as u64, "bond"));
        let gone = counted(self.gone, "bond");
        let gone = format!("{gone} left the run together with grains: these counts are of the rest");
        let summary = if last[6] > 0.0 { summary.note(unknown) } else { summary };
        Ok(if self.gone > 0 { summary.note(gone) } else { summary })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let broken = [("by tension", 4), ("by shear", 5), ("unknown", 6)];
        let ways = if rows.iter().any(|row| row[6] > 0.0) { &broken[..] } else { &broken[..2] };
        Chart::new("Bonds").columns(("time [s]", 0), "broken bonds [1]", ways, rows).columns(
            ("time [s]", 0),
            "fragments [1]",
            &[("", 8)],
            rows,
        )
    }
}

impl Measure for BondNumbers {
    const NAME: &'static str = "bonds";
    const HELP: &'static str =
        "Bonds over time: how many are whole, how many broke and how, and the fragments that they leave";
    const FRAMES: Frames = Frames::OverTime;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<BondNumbers>::default())
    }
}
