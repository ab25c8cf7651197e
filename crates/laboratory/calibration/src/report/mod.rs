//! What a calibration has found: judgement, page, pictures and words.

mod explained;
pub(crate) mod fitness;
pub mod guess;
pub(crate) mod judge;
pub(crate) mod page;
pub(crate) mod picture;
pub mod words;
