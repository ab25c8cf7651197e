//! How long each grain has been in a run, and whether it was there from the start.

use crate::ViewError;
use record::column::ID;
use std::collections::HashMap;
use stream::{Table, Values};

/// Time since the first frame with a grain [s].
const RESIDENCE: &str = "residence";

/// 0: in the first frame; 1: came in later.
const ORIGIN: &str = "origin";

/// When each grain was first seen.
#[derive(Default)]
pub struct History {
    /// Time of the first frame with each id [s].
    first: HashMap<u64, f64>,
    /// Time of the first frame [s].
    start: Option<f64>,
}

impl History {
    /// Adds both fields to a frame.
    ///
    /// # Errors
    /// Grains without ids.
    pub fn add(&mut self, time: f64, table: &mut Table) -> Result<(), ViewError> {
        let ids = table.get(ID).map(Values::to_f64);
        let ids = ids.ok_or(ViewError::NoPosition { name: "/particles".to_owned(), column: ID })?;
        let start = *self.start.get_or_insert(time);
        let since: Vec<f64> = ids.iter().map(|id| *self.first.entry(*id as u64).or_insert(time)).collect();
        let residence = since.iter().map(|first| time - first).collect();
        let origin = since.iter().map(|first| u8::from(*first > start)).collect();
        for (name, values) in [(RESIDENCE, Values::F64(residence)), (ORIGIN, Values::U8(origin))] {
            table.replace(name, values).map_err(|e| ViewError::Table { why: e.to_string() })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grain_that_comes_in_later_has_been_there_for_less() {
        let mut history = History::default();
        let mut frame = |time: f64, ids: &[u32]| {
            let mut table = Table::default();
            table.push(ID, Values::U32(ids.to_vec())).expect("fits");
            history.add(time, &mut table).expect("ids");
            [RESIDENCE, ORIGIN].map(|name| table.get(name).expect("added").to_f64())
        };
        assert_eq!(frame(0.5, &[3, 7]), [vec![0.0, 0.0], vec![0.0, 0.0]]);
        assert_eq!(frame(1.0, &[7, 9]), [vec![0.5, 0.0], vec![0.0, 1.0]]);
        assert_eq!(frame(2.0, &[9, 7]), [vec![1.0, 1.5], vec![1.0, 0.0]]);
    }
}
