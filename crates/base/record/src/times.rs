//! The record of times of a run.

use crate::Map;

/// The record [`crate::metadata::TIME`]. A number that is missing or cannot be read is `None`: another program may have left it out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RunTimes {
    /// Time step [s].
    pub dt: Option<f64>,
    /// First time of the file [s].
    pub start: Option<f64>,
    /// Time at which the run is to end [s].
    pub end: Option<f64>,
}

impl RunTimes {
    /// Reads the record.
    pub fn read(map: &Map) -> RunTimes {
        let number = |key: &str| map.get(key)?.parse().ok();
        RunTimes { dt: number("dt"), start: number("start"), end: number("end") }
    }

    /// The record.
    pub fn to_map(self) -> Map {
        let RunTimes { dt, start, end } = self;
        let all = [("dt", dt), ("start", start), ("end", end)];
        all.into_iter().filter_map(|(key, time)| Some((key.to_owned(), time?.to_string()))).collect()
    }
}
