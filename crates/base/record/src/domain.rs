//! The periodic domain at one time, where it changes: the message of the topic `/domain`.

use serde::{Deserialize, Serialize};

/// The periodic domain at one time; compression is positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DomainRecord {
    /// Time [s].
    pub time: f64,
    /// Lowest coordinate of each periodic axis [m].
    pub low: [Option<f64>; 3],
    /// Highest coordinate of each periodic axis [m].
    pub high: [Option<f64>; 3],
    /// Logarithmic strain of each axis since the start of the run [–].
    #[serde(default)]
    pub strain: [f64; 3],
    /// Its rate [1/s].
    #[serde(default)]
    pub rate: [f64; 3],
    /// Mean stress of contacts and bonds, row by row [Pa]; absent where no axis is strained.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<[[f64; 3]; 3]>,
    /// Stress that each axis follows [Pa].
    #[serde(default)]
    pub target: [Option<f64>; 3],
}

impl DomainRecord {
    /// Lowest and highest coordinate of each axis that is periodic [m].
    pub fn range(&self) -> [Option<(f64, f64)>; 3] {
        [0, 1, 2].map(|a| self.low[a].zip(self.high[a]))
    }

    /// From a message.
    ///
    /// # Errors
    /// No JSON of this kind, a length that is not above 0.
    pub fn read(data: &[u8]) -> Result<DomainRecord, String> {
        let record: DomainRecord = serde_json::from_slice(data).map_err(|e| e.to_string())?;
        let sound = |(low, high): (f64, f64)| low.is_finite() && high.is_finite() && low < high;
        match record.range().into_iter().flatten().all(sound) {
            true => Ok(record),
            false => Err("an axis of the domain has no length".to_owned()),
        }
    }
}
