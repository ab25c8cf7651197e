//! What accuracy costs: the runs of a study, the error of each setting and its interval, the settings that nothing beats, the fastest
//! that is good enough, and all of it in plain words.
//!
//! ```text
//! Study → sweep (settings, runs, scripts) → judge (values, errors, front, choice) → words, table
//! ```
//!
//! [`point`], [`error`], [`front`] and [`words`] are numbers in, numbers and sentences out; [`sweep`] lays out, runs and measures points with the
//! programs dem-run and dem-measure; [`judge`] joins both. The caller prints and draws. Uses `scene` to check settings, `measure` for statistics.

mod error;
mod front;
mod judge;
mod point;
mod study;
pub mod sweep;
mod table;
mod words;

pub use error::{Norm, Repeats, Truth, errors};
pub use front::{Choice, front, recommend};
pub use judge::{Cost, Judged, check_reference, first_of_reference, judge};
pub use point::{Error, MeasuredRun, Point};
pub use study::{CurveError, PHASES, Study, TrueValue, Wanted, Work};
pub use table::csv;
pub use words::{amount, change, order, percent, sentence, share_of_time};
