//! How far particles are from rest, as a message of `/settling` tells it.

use crate::MeasureError;
use record::topic::SETTLING;
use serde_json::Value;

/// How far the grains are from rest at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Time [s].
    pub time: f64,
    /// Mean unbalanced force over mean contact force [–]; NaN where no contact carries a force.
    pub unbalanced: f64,
    /// Kinetic energy [J].
    pub kinetic: f64,
}

impl Settled {
    /// From a message; `time` [s] is used where it names none.
    ///
    /// # Errors
    /// A message that is no JSON, or lacks the kinetic energy.
    pub fn new(time: f64, data: &[u8]) -> Result<Settled, MeasureError> {
        let wrong = |why: String| MeasureError::Message { topic: SETTLING.to_owned(), time, why };
        let message: Value = serde_json::from_slice(data).map_err(|e| wrong(e.to_string()))?;
        let number = |key: &str| message[key].as_f64();
        let kinetic = number("kinetic").ok_or_else(|| wrong("its 'kinetic' is missing".to_owned()))?;
        let unbalanced = number("unbalanced").unwrap_or(f64::NAN);
        Ok(Settled { time: number("time").unwrap_or(time), unbalanced, kinetic })
    }
}
