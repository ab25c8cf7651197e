//! How far the grains are from rest, as a run with `until_unbalanced` or `until_kinetic` tells it with each frame (`/settling`).
//!
//! ```text
//! unbalanced = ⟨|Σ F|⟩ of grains / ⟨|F|⟩ of contacts        kinetic = Σ ½ m v² + ½ I ω²
//! ```

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::Observer;
use crate::settled::Settled;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{MeasureError, Run, RunMessage};
use record::topic::SETTLING;

/// Reads how far the grains are from rest.
#[derive(Default)]
pub struct Settling {
    last: Option<Settled>,
}

impl Observer for Settling {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("time", "s"), ("unbalanced", "1"), ("kinetic", "J")])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let RunMessage::Settled(s) = message {
            rows.push(vec![s.time, s.unbalanced, s.kinetic]);
            self.last = Some(s);
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let Some(last) = self.last else {
            let cure = "set until_unbalanced or until_kinetic in [time]";
            return Err(MeasureError::Channel { topic: SETTLING, what: "measure of rest", cure });
        };
        Ok(Summary::default()
            .with("unbalanced", "1", last.unbalanced)
            .with("kinetic", "J", last.kinetic)
            .with("time", "s", last.time))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let ratio = "mean unbalanced over mean contact force";
        Chart::new("Settling").columns(("time [s]", 0), ratio, &[("", 1)], rows).columns(
            ("time [s]", 0),
            "kinetic energy [J]",
            &[("", 2)],
            rows,
        )
    }
}

impl Measure for Settling {
    const NAME: &'static str = "settling";
    const HELP: &'static str =
        "How far the grains are from rest: mean unbalanced force over mean contact force, kinetic energy";
    const FRAMES: Frames = Frames::OverTime;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<Settling>::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_without_contacts_has_no_ratio() {
        let read = |text: &str| Settled::new(0.5, text.as_bytes());
        let air = read(r#"{"time": 0.25, "unbalanced": null, "kinetic": 2.0}"#).expect("sound");
        assert!(air.unbalanced.is_nan() && air.kinetic == 2.0 && air.time == 0.25);
        assert!(read(r#"{"unbalanced": 1.0}"#).is_err() && read("?").is_err());
    }
}
