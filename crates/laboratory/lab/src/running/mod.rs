//! Running the programs of all specimens.

pub(crate) mod chain;
pub mod lab;
pub(crate) mod specimens;
pub(crate) mod warnings;
