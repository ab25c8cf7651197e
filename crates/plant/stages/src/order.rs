//! The order of a stream: crossings, samples of paths and watermarks come in the order of their times.
//!
//! A watermark says that nothing follows that is earlier. One that is too late would make a reader stop before the rows that follow it,
//! and lose their particles; so each row and each watermark is checked against what came before it.

use geom::Shown;
use record::RecordError;

/// Times that a stream has reached [s].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Order {
    crossing: f64,
    sample: f64,
    watermark: f64,
}

impl Default for Order {
    fn default() -> Order {
        let never = f64::NEG_INFINITY;
        Order { crossing: never, sample: never, watermark: never }
    }
}

impl Order {
    /// The last watermark [s]; −∞ before the first.
    pub fn watermark(&self) -> f64 {
        self.watermark
    }

    /// The last crossing or sample [s]; −∞ before the first.
    pub fn last(&self) -> f64 {
        self.crossing.max(self.sample)
    }

    /// Takes a crossing at `time` [s].
    ///
    /// # Errors
    /// It is earlier than the last crossing or watermark.
    pub fn take_crossing(&mut self, stream: &str, id: u32, time: f64) -> Result<(), RecordError> {
        self.check(stream, ("passes", "crossing"), id, (time, self.crossing))?;
        self.crossing = time;
        Ok(())
    }

    /// Takes a sample of a path at `time` [s].
    ///
    /// # Errors
    /// It is earlier than the last sample or watermark.
    pub fn take_sample(&mut self, stream: &str, id: u32, time: f64) -> Result<(), RecordError> {
        self.check(stream, ("has a sample of its path", "sample"), id, (time, self.sample))?;
        self.sample = time;
        Ok(())
    }

    /// Takes a watermark [s].
    ///
    /// # Errors
    /// It is earlier than the one before it.
    pub fn take_watermark(&mut self, stream: &str, until: f64) -> Result<(), RecordError> {
        if until < self.watermark {
            let (until, before) = (Shown(until), Shown(self.watermark));
            let why = format!("a watermark of {until} s follows one of {before} s");
            return Err(RecordError::new(stream, why, CURE));
        }
        self.watermark = until;
        Ok(())
    }

    fn check(
        &self,
        stream: &str,
        (does, row): (&str, &str),
        id: u32,
        (time, last): (f64, f64),
    ) -> Result<(), RecordError> {
        let (reached, by) = if self.watermark > last { (self.watermark, "watermark") } else { (last, row) };
        if !(time < reached) {
            return Ok(());
        }
        let (time, reached) = (Shown(time), Shown(reached));
        let why = format!("particle {id} {does} at {time} s, after a {by} of {reached} s");
        Err(RecordError::new(stream, why, CURE))
    }
}

const CURE: &str = "times must not go back: write the stream again (dem-run, then stage-replay)";
