//! How the periodic domain is strained, and the stress in it, as a run with `[domain.strain]` tells it with each frame (`/domain`).
//!
//! ```text
//! ε = ln(h₀/h) by axis,  ε_v = Σ ε,   p = tr σ/3,   q = √(3/2 s_ab s_ab),  s = σ − p 1          compression is positive
//! ```

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::Observer;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::stress::invariants;
use crate::{MeasureError, Run, RunMessage};
use nalgebra::Matrix3;
use record::DomainRecord;
use record::topic::DOMAIN;

/// Where the first strain stands in a row.
const STRAIN: usize = 4;
/// Where the first stress stands.
const STRESS: usize = 8;

/// Reads strain and stress of the domain.
#[derive(Default)]
pub struct Domain {
    seen: bool,
    last: Option<Row>,
}

fn row(record: &DomainRecord, stress: [[f64; 3]; 3]) -> Row {
    let length = |a: usize| record.high[a].unwrap_or(f64::NAN) - record.low[a].unwrap_or(f64::NAN);
    let s = Matrix3::from_fn(|a, b| 0.5 * (stress[a][b] + stress[b][a]));
    let parts = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| s[at]);
    let strains = record.strain;
    let strains = [strains[0], strains[1], strains[2], strains.iter().sum()];
    [&[record.time], &[0, 1, 2].map(length)[..], &strains[..], &parts[..], &invariants(&s)[..]].concat()
}

impl Observer for Domain {
    fn heads(&self) -> Vec<Head> {
        let lengths = ["length_x", "length_y", "length_z"].map(|name| (name, "m"));
        let strains = ["strain_x", "strain_y", "strain_z", "volumetric_strain"].map(|name| (name, "1"));
        let parts = ["xx", "yy", "zz", "xy", "xz", "yz", "p", "q"].map(|name| (name, "Pa"));
        Head::list(&[&[("time", "s")], &lengths[..], &strains[..], &parts[..]].concat())
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Domain(record) = message else { return Ok(()) };
        self.seen = true;
        let Some(stress) = record.stress else { return Ok(()) };
        rows.push(row(&record, stress));
        self.last = rows.last().cloned();
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let Some(last) = &self.last else {
            let cure = match self.seen {
                true => "set domain.strain, or look at another time",
                false => "set domain.strain for an axis that is periodic",
            };
            return Err(MeasureError::Channel { topic: DOMAIN, what: "strain of the domain", cure });
        };
        let strains =
            ["strain_x", "strain_y", "strain_z", "volumetric_strain"].into_iter().zip(&last[STRAIN..]);
        let stresses = ["xx", "yy", "zz"].into_iter().zip(&last[STRESS..]);
        let summary = strains.fold(Summary::default(), |s, (name, value)| s.with(name, "1", *value));
        let summary = stresses.fold(summary, |s, (name, value)| s.with(name, "Pa", *value));
        Ok(summary.with("time", "s", last[0]))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let stresses = [("x", STRESS), ("y", STRESS + 1), ("z", STRESS + 2)];
        let strains = [("x", STRAIN), ("y", STRAIN + 1), ("z", STRAIN + 2), ("volume", STRAIN + 3)];
        Chart::new("Domain").columns(("time [s]", 0), "mean stress [Pa]", &stresses, rows).columns(
            ("time [s]", 0),
            "strain, compression positive",
            &strains,
            rows,
        )
    }
}

impl Measure for Domain {
    const NAME: &'static str = "domain";
    const HELP: &'static str =
        "Strain of the periodic domain, and the mean stress in it, where the scene has [domain.strain]";
    const FRAMES: Frames = Frames::OverTime;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<Domain>::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_becomes_a_row() {
        let text = r#"{"time": 2.0, "low": [0, 0, null], "high": [0.5, 1, null], "strain": [0.25, -0.125, 0],
            "stress": [[3, 1, 0], [3, 6, 0], [0, 0, 0]]}"#;
        let record = DomainRecord::read(text.as_bytes()).expect("sound");
        let row = row(&record, record.stress.expect("it has one"));
        assert_eq!(row[..3], [2.0, 0.5, 1.0]);
        assert!(row[3].is_nan());
        assert_eq!(
            row[STRAIN..],
            [&[0.25, -0.125, 0.0, 0.125][..], &[3.0, 6.0, 0.0, 2.0, 0.0, 0.0], &row[14..]].concat()
        );
        assert_eq!(row[14], 3.0);
        assert!((row[15] - (1.5f64 * (0.0 + 9.0 + 9.0 + 8.0)).sqrt()).abs() < 1e-12, "{row:?}");
        assert!(DomainRecord::read(br#"{"time": 0, "low": [0, 0, 0], "high": [1, 0, 1]}"#).is_err());
    }
}
