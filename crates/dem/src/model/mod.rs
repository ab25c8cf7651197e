//! What is resolved once.

pub mod bonds;
pub mod check;
pub mod clumps;
pub mod crowd;
pub mod error;
pub mod limit;
pub mod start;
